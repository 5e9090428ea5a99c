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
SHORT_PASSAGE = 0.3
"""Humps are looked up where they are alone, unless that is more than this share of a run."""
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
    found = _Passage.of([track], speed.distance(_moments(time)), offsets)
    return _inputs(found.spread(track.height(found.under)), _step(time))


def nearby_inputs(
    track: Track, speed: SpeedLaw, tracks: Sequence[Track], ways: Sequence[tuple[SpeedLaw, Array]], offsets: Array, time: Array
) -> Iterator[WheelInputs]:
    """Return the road under every axle in drives that hardly differ from another one.

    Over other tracks the ways are the same. At other speeds, or with axles at other distances, heights change as the road slopes where
    the wheels are: exact to the first order in how far the ways differ, which derivatives by differences need, at the price of two looks
    at the road for all of them.

    Parameters
    ----------
    track, speed, offsets, time
        As in :func:`wheel_inputs`.
    tracks, ways
        Other tracks at this speed; speeds with distances `shape (n_axles,)`, both hardly different, over this track.

    Returns
    -------
    Heights and rates over the tracks, then by the other ways, each in turn.
    """
    moments = _moments(time)
    way, step = speed.distance(moments), _step(time)
    found = _Passage.of([track, *tracks], way, offsets)
    for other in tracks:
        yield _inputs(found.spread(other.height(found.under)), step)
    if ways:
        heights = track.height(found.under)
        slopes = (track.height(found.under + _SLOPE_STEP_M) - heights) / _SLOPE_STEP_M
        at, own = moments[found.moments], way[found.moments]
        for law, behind in ways:
            ahead = law.distance(at) - own - found.of_axles(np.asarray(behind - offsets))
            yield _inputs(found.spread(heights + slopes * ahead), step)


@dataclass(frozen=True)
class _Passage:
    """Where axles are [m] when tracks may move them: `under`, at the moments with these numbers.

    Over humps, that is little of a run, and `under` and `moments shape (n,)` go through the axles one after another, which `axles shape
    (n,)` numbers. Elsewhere `under` is `shape (n_axles, n_moments)`, axle by axle, as looking up neighbours in a table is quick.
    """

    under: Array
    moments: NDArray[np.intp] | slice
    axles: NDArray[np.intp] | None
    shape: tuple[int, int]

    @classmethod
    def of(cls, tracks: Sequence[Track], way: Array, offsets: Array) -> _Passage:
        """Return the passage of a way `shape (n_moments,)` [m] over any of some tracks; one that turns back is looked at as a whole."""
        offsets, shape = np.asarray(offsets, dtype=np.float64), (len(offsets), len(way))
        spans = _spans(tracks)
        if spans is not None:
            ends = np.searchsorted(way, spans[None] + offsets[:, None, None])
            counts = (ends[..., 1] - ends[..., 0]).sum(axis=1)
            if 0 < counts.sum() < SHORT_PASSAGE * len(offsets) * len(way) and np.all(way[1:] >= way[:-1]):
                moments = np.concatenate([np.arange(first, last) for first, last in ends.reshape(-1, 2)])
                axles = np.repeat(np.arange(len(offsets)), counts)
                return cls(way[moments] - offsets[axles], moments, axles, shape)
        return cls(np.asarray(way[None, :] - offsets[:, None]), slice(None), None, shape)

    def of_axles(self, values: Array) -> Array:
        """Return each axle's value `shape (n_axles,)` where that axle is under way, to be used with `under`."""
        return values[:, None] if self.axles is None else values[self.axles]

    def spread(self, heights: Array) -> Array:
        """Return heights at `under` as those of all axles at all moments, `shape (n_axles, n_moments)`."""
        if self.axles is None:
            return heights
        found = np.zeros(self.shape)
        found[self.axles, self.moments] = heights
        return found


def _moments(time: Array) -> Array:
    """Return the times, and those half a step before and after them, in turn."""
    half = _step(time) / 2
    moments = np.empty(2 * len(time) + 1)
    moments[1::2], moments[0:-1:2], moments[-1] = time, time - half, time[-1] + half
    return moments


def _step(time: Array) -> float:
    return float(time[1] - time[0]) if len(time) > 1 else 1.0


def _inputs(heights: Array, step: float) -> WheelInputs:
    """Return what heights `shape (n_axles, n_moments)` at the moments of a run make."""
    return WheelInputs(heights[:, 1::2].T, ((heights[:, 2::2] - heights[:, :-2:2]) / step).T)


def _spans(tracks: Sequence[Track]) -> Array | None:
    """Return from where to where [m] humps of tracks, or a little before, may move a wheel, `shape (n, 2)`, apart from one another.

    None where there is none, or where something else may move it.
    """
    reaches = [item.reaches for item in tracks]
    known = sorted(span for item in reaches if item is not None for span in item)
    if not known or any(item is None for item in reaches):
        return None
    spans: list[list[float]] = []
    for first, last in known:
        if spans and first - _SLOPE_STEP_M <= spans[-1][1]:
            spans[-1][1] = max(spans[-1][1], last)
        else:
            spans.append([first - _SLOPE_STEP_M, last])
    return np.array(spans)


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
