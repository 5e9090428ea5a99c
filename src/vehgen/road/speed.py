"""How far the vehicle has come: constant or measured speed."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Protocol

import numpy as np
import scipy
from numpy.typing import NDArray

from vehgen.errors import InputError

Array = NDArray[np.float64]
_WANDER_GRID_S = 5e-3
"""Spacing of the times at which a driver's wander is added up [s]: it changes over seconds."""


class SpeedLaw(Protocol):
    """Anything that says the distance travelled [m] at times t [s]."""

    def distance(self, t: Array) -> Array:
        """Return the distance travelled since t = 0 [m]."""
        ...


@dataclass(frozen=True)
class ConstantSpeed:
    """A constant speed [m/s]."""

    speed: float

    def __post_init__(self) -> None:
        if not (np.isfinite(self.speed) and self.speed > 0):
            raise InputError(f"the speed must be finite and above 0, found {self.speed} m/s")

    def distance(self, t: Array) -> Array:
        """Return the distance travelled [m]."""
        return np.asarray(t, dtype=np.float64) * self.speed


@dataclass(frozen=True)
class SpeedHistory:
    """A measured speed: points `time` [s], `speed` [m/s] `shape (n,)`, linear between them, constant outside."""

    time: Array
    speed: Array

    def __post_init__(self) -> None:
        if len(self.time) < 2 or (np.diff(self.time) <= 0).any():
            raise InputError("a speed history needs at least two points, with ascending times")
        if not (np.isfinite(self.speed).all() and (self.speed > 0).all()):
            raise InputError("every speed of a history must be finite and above 0")

    def distance(self, t: Array) -> Array:
        """Return the distance travelled since t = 0 [m]: the exact integral of the speed."""
        t = np.asarray(t, dtype=np.float64)
        knots = np.union1d(self.time, np.array([0.0]))
        speed = np.interp(knots, self.time, self.speed)
        travelled = np.concatenate([[0.0], np.cumsum(np.diff(knots) * (speed[1:] + speed[:-1]) / 2)])
        index = np.clip(np.searchsorted(knots, t, side="right") - 1, 0, len(knots) - 1)
        late = t - knots[index]
        along = travelled[index] + late * (speed[index] + np.interp(t, self.time, self.speed)) / 2
        return np.asarray(along - np.interp(0.0, knots, travelled))


@dataclass(frozen=True)
class Wander:
    """How a driver strays about a speed: its relative error `values` at the times `knots` [s], both `shape (n,)`, ascending.

    Between the knots runs a natural cubic spline, outside the error stays as it is at the nearest knot.
    """

    knots: tuple[float, ...]
    values: tuple[float, ...]

    def at(self, t: Array) -> Array:
        """Return the relative error of the speed at times t [s]."""
        return np.asarray(_hats(self.knots)(np.clip(t, self.knots[0], self.knots[-1])) @ np.array(self.values))


@lru_cache(maxsize=64)
def _hats(knots: tuple[float, ...]) -> scipy.interpolate.CubicSpline:
    """Return the natural splines that are 1 at one knot and 0 at the others, one after another."""
    return scipy.interpolate.CubicSpline(knots, np.eye(len(knots)), bc_type="natural")


@lru_cache(maxsize=64)
def _on_grid(knots: tuple[float, ...], start: int, end: int) -> tuple[Array, Array]:
    """Return evenly spaced times from number `start` to `end` [s], and :func:`_hats` there `shape (n_times, n_knots)`."""
    grid = np.arange(start, end + 1, dtype=np.float64) * _WANDER_GRID_S
    return grid, np.asarray(_hats(knots)(np.clip(grid, knots[0], knots[-1])), dtype=np.float64)


@dataclass(frozen=True)
class AdjustedSpeed:
    """A speed law with its errors.

    Everything happens `delay` [s] later, at `scale` times the speed and, where there is a `wander`, at 1 more times that. Where the vehicle
    is at the time `anchor` of the law [s], neither scale nor wander change: they are seen from there.
    """

    law: SpeedLaw
    delay: float = 0.0
    scale: float = 1.0
    anchor: float = 0.0
    wander: Wander | None = None

    def distance(self, t: Array) -> Array:
        """Return the distance travelled [m]."""
        own = np.asarray(t, dtype=np.float64) - self.delay
        along = self.law.distance(own)
        if self.scale != 1.0:
            fixed = self.law.distance(np.array([self.anchor]))[0]
            along = fixed + self.scale * (along - fixed)
        return np.asarray(along if self.wander is None else along + self._strayed(own, self.wander))

    def _strayed(self, t: Array, wander: Wander) -> Array:
        """Return how much farther than without it the wander has brought the vehicle since the anchor [m]."""
        first, last = min(float(t.min()), self.anchor), max(float(t.max()), self.anchor)
        start, end = int(np.floor(first / _WANDER_GRID_S)), int(np.ceil(last / _WANDER_GRID_S)) + 1
        grid, hats = _on_grid(wander.knots, start, end)
        share = hats @ np.array(wander.values)
        steps = np.diff(self.law.distance(grid)) * (share[1:] + share[:-1]) / 2
        farther = np.concatenate([[0.0], np.cumsum(steps)])
        return np.asarray(np.interp(t, grid, farther) - np.interp(self.anchor, grid, farther))
