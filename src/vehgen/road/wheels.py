"""The road under every wheel: one track, delayed by the axle's distance."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from vehgen.errors import InputError
from vehgen.road.speed import SpeedLaw
from vehgen.road.track import Track

Array = NDArray[np.float64]
LONGEST_PASS_S = 1e6
"""Longer than this nobody drives to a hump [s]."""


_SLOPE_STEP_M = 1e-6
"""Distance over which a road's slope is taken [m]: a wheel's way between two simulations of a difference is as short."""


@dataclass(frozen=True)
class WheelInputs:
    """Road `heights` [m] and their `rates` [m/s] under every axle, both `shape (n_steps + 1, n_axles)`."""

    heights: Array
    rates: Array


def wheel_inputs(track: Track, speed: SpeedLaw, offsets: Array, time: Array) -> WheelInputs:
    """Return the road under every axle.

    Parameters
    ----------
    track
        The road.
    speed
        How far the first axle has come at a time.
    offsets
        `shape (n_axles,)`: how far each axle runs behind the first to arrive [m].
    time
        `shape (n_steps + 1,)`: evenly spaced times [s].

    Returns
    -------
    Heights at these times, and central differences over half a step to both sides (second order).
    """
    return _inputs(track.height(_under(speed.distance(_moments(time)), offsets)), _step(time))


def nearby_inputs(
    track: Track, speed: SpeedLaw, tracks: Sequence[Track], speeds: Sequence[SpeedLaw], offsets: Array, time: Array
) -> Iterator[WheelInputs]:
    """Return the road under every axle in drives that hardly differ from another one.

    Over other tracks the ways are the same. At other speeds heights change as the road slopes where the wheels are: exact to the first
    order in how far the ways differ, which derivatives by differences need, at the price of two looks at the road for all of them.

    Parameters
    ----------
    track, speed, offsets, time
        As in :func:`wheel_inputs`.
    tracks, speeds
        Other tracks at this speed, and speeds that hardly differ over this track.

    Returns
    -------
    Heights and rates over the tracks, then at the speeds, each in turn.
    """
    moments = _moments(time)
    way, step = speed.distance(moments), _step(time)
    under = _under(way, offsets)
    for other in tracks:
        yield _inputs(other.height(under), step)
    if speeds:
        heights = track.height(under)
        slopes = (track.height(under + _SLOPE_STEP_M) - heights) / _SLOPE_STEP_M
        for law in speeds:
            yield _inputs(heights + slopes * (law.distance(moments) - way), step)


def _moments(time: Array) -> Array:
    """Return the times, and those half a step before and after them, in turn."""
    half = _step(time) / 2
    moments = np.empty(2 * len(time) + 1)
    moments[1::2], moments[0:-1:2], moments[-1] = time, time - half, time[-1] + half
    return moments


def _step(time: Array) -> float:
    return float(time[1] - time[0]) if len(time) > 1 else 1.0


def _under(way: Array, offsets: Array) -> Array:
    """Return where every axle is, `shape (n_axles, n_moments)`: axle by axle, as looking up neighbours in a table is quick."""
    return np.asarray(way[None, :] - np.asarray(offsets, dtype=np.float64)[:, None])


def _inputs(heights: Array, step: float) -> WheelInputs:
    """Return what heights `shape (n_axles, n_moments)` at the moments of a run make."""
    return WheelInputs(heights[:, 1::2].T, ((heights[:, 2::2] - heights[:, :-2:2]) / step).T)


def pass_time(track: Track, speed: SpeedLaw, offsets: Array) -> float:
    """Return the time [s] at which the last axle has left the last hump (0 where there is none).

    Raises
    ------
    InputError
        Where that takes longer than LONGEST.
    """
    target = track.end + float(np.max(offsets, initial=0.0))
    if not np.isfinite(target) or target <= 0:
        return 0.0
    late = 1.0
    while speed.distance(np.array([late]))[0] < target:
        if late > LONGEST_PASS_S:
            raise InputError(
                f"the last axle has not left the road's last hump, at {target:.4g} m, after {LONGEST_PASS_S:g} s; give `duration`"
            )
        late *= 2.0
    early = 0.0
    while late - early > 1e-6:
        middle = (early + late) / 2
        if speed.distance(np.array([middle]))[0] < target:
            early = middle
        else:
            late = middle
    return late
