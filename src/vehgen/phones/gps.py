"""The speed of a crossing from a phone's GPS."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from vehgen.errors import ArgumentError
from vehgen.phones.export import Stream

MIN_MEDIAN_SPEED_M_S = 0.3
"""A GPS cannot distinguish slower speeds from standing still [m/s]."""
USUAL_SPEED_SHARE = 0.01
"""Standard deviation of a run's speed over the speed, where its file states none."""
READING_DEVIATION_M_S = 0.1
"""Standard deviation that is assumed of one reading [m/s]: exports seldom tell their own, and two or three readings not their scatter."""
REPEATED_WITHIN_S = 0.5
"""Equal readings that follow so soon [s] are one."""
STEADY_SHARE, STEADY_DEVIATIONS = 0.1, 5.0
"""Readings of a steady pass differ by less than this share of their median, or by less than so many deviations of one reading."""


@dataclass(frozen=True)
class CrossingSpeed:
    """The median of `count` readings, the lowest and the highest [m/s]."""

    median: float
    low: float
    high: float
    count: int

    @property
    def deviation(self) -> float:
        """The standard deviation of the median [m/s] of a steady speed."""
        return READING_DEVIATION_M_S / float(np.sqrt(self.count))

    @property
    def deviation_in_pass(self) -> float:
        """That of the speed in a pass [m/s], which is somewhere between the lowest reading and the highest where it changes."""
        return float(np.hypot(self.deviation, (self.high - self.low) / np.sqrt(12))) if self.changes else self.deviation

    @property
    def changes(self) -> bool:
        """Whether the readings differ by more than their errors and a steady driver's wander make them."""
        return self.high - self.low > max(STEADY_SHARE * self.median, STEADY_DEVIATIONS * READING_DEVIATION_M_S)

    def __str__(self) -> str:
        return f"median {self.median:.3f} m/s of {self.count} GPS readings, {self.low:.3f} to {self.high:.3f} m/s"


def crossing_speed(stream: Stream | None, start: float, end: float, name: str, *, moving: bool = False) -> CrossingSpeed:
    """Return the speed between two moments [s] of the phone's clock; negative readings are the apps' way to say that there is none.

    Of a recording in which the vehicle may also stand, the readings of a `moving` one alone count.

    Raises
    ------
    InputError
        Where no speed was recorded, or none worth the name.
    """
    hint = "give `speed` in m/s, e.g. 2.0"
    if stream is None:
        raise ArgumentError(f"{name} recorded no GPS speed; {hint}", "speed")
    whole = stream.between(start, end)
    part = whole.values[_read_anew(whole), 0]
    part = part[np.isfinite(part) & (part >= (MIN_MEDIAN_SPEED_M_S if moving else 0.0))]
    if not len(part):
        raise ArgumentError(f"{name} has no valid GPS speed from {start:.1f} to {end:.1f} s; {hint}", "speed")
    median = float(np.median(part))
    if not MIN_MEDIAN_SPEED_M_S <= median <= 60.0:
        raise ArgumentError(f"{name}: the GPS speed over the crossing is {median:.2f} m/s, which cannot be; {hint}", "speed")
    return CrossingSpeed(median, float(part.min()), float(part.max()), len(part))


def _read_anew(stream: Stream) -> NDArray[np.bool_]:
    """Return which rows are readings of their own: loggers repeat one in all rows until the next."""
    anew = np.ones(len(stream.time), dtype=np.bool_)
    anew[1:] = (np.diff(stream.values[:, 0]) != 0) | (np.diff(stream.time) > REPEATED_WITHIN_S)
    return anew
