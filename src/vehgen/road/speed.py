"""How far the vehicle has come: constant or measured speed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from vehgen.errors import InputError

Array = NDArray[np.float64]


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
class AdjustedSpeed:
    """A speed law with its errors: `delay` [s] by which everything happens later, and `scale` by which the speed is multiplied."""

    law: SpeedLaw
    delay: float = 0.0
    scale: float = 1.0

    def distance(self, t: Array) -> Array:
        """Return the distance travelled [m]."""
        return np.asarray(self.scale * self.law.distance(np.asarray(t, dtype=np.float64) - self.delay))
