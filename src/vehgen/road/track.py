"""The road that excites the wheels: humps, random roads and measured profiles added up, through the tyre's footprint."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from vehgen.errors import InputError
from vehgen.road.humps import Hump

Array = NDArray[np.float64]
_PIECE_LENGTH_M = 500.0
"""Longer stretches are integrated piece by piece [m]: a piece has a million points."""
GRID = 5e-4
"""Spacing of the grid on which the road is integrated [m]."""
UNDEFORMED = (1.0, 1.0, 0.0, 0.0)
"""Length, form, skew and rounding of a hump as it was drawn."""


class Profile(Protocol):
    """Anything with a height along the road, and the place where its last hump ends (-inf without one)."""

    @property
    def end(self) -> float:
        """Where its last hump ends [m]."""
        ...

    def height(self, s: Array) -> Array:
        """Return the height [m] at positions s [m]."""
        ...


@dataclass(frozen=True)
class MeasuredProfile:
    """A measured profile: points `distance`, `heights` [m] `shape (n,)`, linear between them, constant outside.

    Its first height counts as the level on which the vehicle starts; see :meth:`met_from` for one that begins behind it.
    """

    distance: Array
    heights: Array

    def __post_init__(self) -> None:
        if len(self.distance) < 2 or (np.diff(self.distance) <= 0).any():
            raise InputError("a profile needs at least two points, with ascending distances")

    @property
    def end(self) -> float:
        """Where the profile ends [m]."""
        return float(self.distance[-1])

    def met_from(self, s: float) -> MeasuredProfile:
        """Return the profile as a vehicle meets it whose first wheel begins at s [m], ahead of the profile's end: level up to there."""
        if s <= self.distance[0]:
            return self
        ahead, here = self.distance > s, float(np.interp(s, self.distance, self.heights))
        return MeasuredProfile(np.concatenate([[s], self.distance[ahead]]), np.concatenate([[here], self.heights[ahead]]))

    def height(self, s: Array) -> Array:
        """Return the height above the first point [m] at positions s [m]."""
        return np.asarray(np.interp(s, self.distance, self.heights) - self.heights[0])


@dataclass(frozen=True)
class Track:
    """The sum of profiles, times `scale`, averaged over a footprint [m] (0: a point contact).

    `deformation` is what its humps are deformed by: length, form, skew and rounding (see :meth:`Hump.deformed`).

    The moving average is the difference of the road's integral between the edges of the contact, taken from a grid of half a
    millimetre: a hump shorter than the footprint still counts in full.
    """

    parts: tuple[Profile, ...]
    footprint: float = 0.0
    scale: float = 1.0
    deformation: tuple[float, float, float, float] = UNDEFORMED

    @property
    def end(self) -> float:
        """Where the last hump ends for the rear edge of the footprint [m]; -inf without a hump."""
        return max((part.end for part in self.parts), default=-np.inf) + self.footprint / 2

    @property
    def reaches(self) -> tuple[tuple[float, float], ...] | None:
        """From where to where [m] each of its humps moves a wheel's centre; None where a part that is no hump may do so anywhere."""
        humps = [part for part in self._shaped if isinstance(part, Hump)]
        half = self.footprint / 2 + GRID if self.footprint > 0 else 0.0
        return tuple((item.at - half, item.end + half) for item in humps) if len(humps) == len(self.parts) else None

    @cached_property
    def _shaped(self) -> tuple[Profile, ...]:
        """The parts, humps deformed."""
        changed = self.deformation != UNDEFORMED
        return tuple(part.deformed(*self.deformation) if changed and isinstance(part, Hump) else part for part in self.parts)

    def height(self, s: Array) -> Array:
        """Return the height [m], averaged over the footprint, under a wheel centred at s [m]."""
        s = np.asarray(s, dtype=np.float64)
        if self.footprint <= 0:
            return self._raw(s)
        if np.ptp(s) <= _PIECE_LENGTH_M:
            return self._averaged(s)
        flat = s.ravel()
        window = np.floor((flat - flat.min()) / _PIECE_LENGTH_M).astype(np.int64)
        order = np.argsort(window, kind="stable")
        found = np.empty_like(flat)
        for members in np.split(order, np.flatnonzero(np.diff(window[order])) + 1):
            found[members] = self._averaged(flat[members])
        return found.reshape(s.shape)

    def _averaged(self, s: Array) -> Array:
        """Return the averaged height over one grid from the first to the last of the positions [m]."""
        half = self.footprint / 2
        first = np.floor((s.min() - half) / GRID) - 1
        grid = np.arange(first, np.ceil((s.max() + half) / GRID) + 2) * GRID
        heights = self._raw(grid)
        integral = np.concatenate([[0.0], np.cumsum((heights[1:] + heights[:-1]) * (GRID / 2))])
        return np.asarray((np.interp(s + half, grid, integral) - np.interp(s - half, grid, integral)) / self.footprint)

    def _raw(self, s: Array) -> Array:
        total = np.zeros_like(s)
        for part in self._shaped:
            total += part.height(s)
        return self.scale * total
