"""The road under every wheel: one track, delayed by the axle's distance."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from vehgen.errors import InputError
from vehgen.road.speed import SpeedLaw
from vehgen.road.track import Track

Array = NDArray[np.float64]
LONGEST_PASS_S = 1e6
"""Longer than this nobody drives to a hump [s]."""


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
    offsets = np.asarray(offsets, dtype=np.float64)
    half = (time[1] - time[0]) / 2 if len(time) > 1 else 0.5
    moments = np.empty(2 * len(time) + 1)  # the times, and those half a step before and after them
    moments[1::2], moments[0:-1:2], moments[-1] = time, time - half, time[-1] + half
    way = speed.distance(moments)
    along = way[None, 1::2] - offsets[:, None]  # axle by axle: looking up neighbours in a table is quick
    around = track.height(way[None, ::2] - offsets[:, None])
    return WheelInputs(track.height(along).T, np.diff(around, axis=1).T / (2 * half))


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
