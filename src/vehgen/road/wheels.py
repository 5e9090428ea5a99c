"""The road under every wheel: one track, delayed by the axle's distance."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from vehgen.errors import InputError
from vehgen.road.speed import SpeedLaw
from vehgen.road.track import Track

Array = NDArray[np.float64]
LONGEST_PASS_S = 1e6
"""Longer than this nobody drives to a hump [s]."""
SHORT_PASSAGE, LOOKED_EVERY = 0.3, 32
"""Humps are looked up where they are alone, unless that is more than this share of a run; every so many moments the way is looked at for
where that is."""
_STANDS_M = 1e-9
"""A wheel that comes no farther than this in half a step stands [m]."""
_ON_EITHER_SIDE = 2
"""So many moments more on either side of a hump, a step: its slope at an end is that in the mean of a step, too."""
_BEFORE_M = 1e-6
"""Humps are looked up from so far before they begin [m]."""


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
    found = _Passage.of([track], speed, offsets, time)
    heights = track.height(found.under)
    inputs = WheelInputs(*(np.zeros((len(time), len(offsets))) for _ in range(2)))
    found.write(heights, inputs)
    return inputs


def nearby_inputs(
    track: Track,
    speed: SpeedLaw,
    tracks: Sequence[Track],
    ways: Sequence[tuple[SpeedLaw, Array]],
    offsets: Array,
    time: Array,
    inputs: Sequence[WheelInputs],
) -> None:
    """Find the road under every axle in drives that hardly differ from another one.

    Over other tracks the ways are the same. At other speeds, or with axles at other distances, heights change as the road slopes where
    the wheels are, in the mean of a wheel's way in one step: exact to the first order in how far the ways differ, which derivatives by
    differences need, at the price of one look at the road for all of them. The slope at a point would not do: that of a measured road has
    steps between any two moments, which look at times a step apart like slow motions.

    Parameters
    ----------
    track, speed, offsets, time
        As in :func:`wheel_inputs`.
    tracks, ways
        Other tracks at this speed; speeds with distances `shape (n_axles,)`, both hardly different, over this track.
    inputs
        Zeros, in which heights and rates over the tracks, then by the other ways, are written, each in turn.
    """
    found = _Passage.of([track, *tracks], speed, offsets, time)
    for other, own in zip(tracks, inputs[: len(tracks)], strict=True):
        found.write(other.height(found.under), own)
    if ways:
        heights = track.height(found.under)
        slopes = found.slopes(heights)
        moments = _looked_at(found.pieces, _moments(time))
        way = speed.distance(moments)
        for (law, behind), own in zip(ways, inputs[len(tracks) :], strict=True):
            ahead = law.distance(moments) - way - found.of_axles(np.asarray(behind - offsets))
            found.write(heights + slopes * ahead, own)


@dataclass(frozen=True)
class _Passage:
    """Where axles are [m] when tracks may move them: `under`, at moments `step` / 2 [s] apart.

    Over humps, that is little of a run: `pieces` are an axle's number each, with the numbers of its first and last moment, both even, and
    `under shape (n,)` goes through them one after another. Elsewhere there are none: `under` is `shape (n_axles, n_moments)`, axle by
    axle, as looking up neighbours in a table is quick.
    """

    under: Array
    pieces: tuple[tuple[int, int, int], ...]
    step: float

    @classmethod
    def of(cls, tracks: Sequence[Track], speed: SpeedLaw, offsets: Array, time: Array) -> _Passage:
        """Return the passage at a speed over any of some tracks; one that turns back is looked at as a whole."""
        moments, step = _moments(time), _step(time)
        offsets = np.asarray(offsets, dtype=np.float64)
        pieces = _pieces(_spans(tracks), speed, offsets, moments)
        if 0 < sum(last + 1 - first for _, first, last in pieces) < SHORT_PASSAGE * len(offsets) * len(moments):
            return cls(speed.distance(_looked_at(pieces, moments)) - _of_axles(pieces, offsets), pieces, step)
        return cls(np.asarray(speed.distance(moments)[None, :] - offsets[:, None]), (), step)

    def of_axles(self, values: Array) -> Array:
        """Return each axle's value `shape (n_axles,)` where that axle is under way, to be used with `under`."""
        return _of_axles(self.pieces, values) if self.pieces else values[:, None]

    def slopes(self, heights: Array) -> Array:
        """Return how steep the road is under every axle, in the mean of its way in the step about each moment; level where it stands."""
        if not self.pieces:
            return _slopes(heights, self.under)
        ends = np.cumsum([last + 1 - first for _, first, last in self.pieces])[:-1]
        pairs = zip(np.split(heights, ends), np.split(self.under, ends), strict=True)
        return np.concatenate([_slopes(*pair) for pair in pairs])

    def write(self, heights: Array, inputs: WheelInputs) -> None:
        """Write what heights at `under` make where inputs are zeros."""
        if not self.pieces:
            inputs.heights[:], inputs.rates[:] = heights[:, 1::2].T, ((heights[:, 2::2] - heights[:, :-2:2]) / self.step).T
        begin = 0
        for axle, first, last in self.pieces:
            own = heights[begin : begin + last + 1 - first]
            begin += len(own)
            inputs.heights[first // 2 : last // 2, axle] = own[1::2]
            inputs.rates[first // 2 : last // 2, axle] = (own[2::2] - own[:-2:2]) / self.step


def _slopes(heights: Array, under: Array) -> Array:
    rise, run = np.gradient(heights, axis=-1), np.gradient(under, axis=-1)
    return np.divide(rise, run, out=np.zeros_like(rise), where=np.abs(run) > _STANDS_M)


def _pieces(spans: Array | None, speed: SpeedLaw, offsets: Array, moments: Array) -> tuple[tuple[int, int, int], ...]:
    """Return every axle's number with the numbers of the first and last moment of its way through each span, or a little more.

    Nothing where the way turns back, and where there are no spans.
    """
    if spans is None:
        return ()
    numbers = np.append(np.arange(0, len(moments) - 1, LOOKED_EVERY), len(moments) - 1)
    way = speed.distance(moments[numbers])
    if np.any(way[1:] < way[:-1]):
        return ()
    ends = np.searchsorted(way, spans[None] + offsets[:, None, None])
    firsts = numbers[np.maximum(ends[..., 0] - 1, 0)].tolist()
    lasts = numbers[np.minimum(ends[..., 1], len(numbers) - 1)].tolist()
    pairs = ((axle, zip(*own, strict=True)) for axle, own in enumerate(zip(firsts, lasts, strict=True)))
    most = len(moments) - 1
    return tuple(
        (axle, max(first - _ON_EITHER_SIDE, 0), min(last + _ON_EITHER_SIDE, most))
        for axle, own in pairs
        for first, last in own
        if first < last
    )


def _looked_at(pieces: Sequence[tuple[int, int, int]], moments: Array) -> Array:
    """Return the moments of all pieces one after another; all moments where there are none."""
    return np.concatenate([moments[first : last + 1] for _, first, last in pieces]) if pieces else moments


def _of_axles(pieces: Sequence[tuple[int, int, int]], values: Array) -> Array:
    return np.repeat(values[[axle for axle, _, _ in pieces]], [last + 1 - first for _, first, last in pieces])


def _moments(time: Array) -> Array:
    """Return the times, and those half a step before and after them, in turn."""
    half = _step(time) / 2
    moments = np.empty(2 * len(time) + 1)
    moments[1::2], moments[0:-1:2], moments[-1] = time, time - half, time[-1] + half
    return moments


def _step(time: Array) -> float:
    return float(time[1] - time[0]) if len(time) > 1 else 1.0


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
        if spans and first - _BEFORE_M <= spans[-1][1]:
            spans[-1][1] = max(spans[-1][1], last)
        else:
            spans.append([first - _BEFORE_M, last])
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
