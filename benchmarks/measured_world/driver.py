"""How a person drives: a speed that wanders about its mean, and the way that follows from it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import interpolate, ndimage, optimize

Array = NDArray[np.float64]
GRID = 0.05
"""Spacing of a speed history's points [s]."""


@dataclass(frozen=True)
class Drive:
    """A speed over time; the front wheel passes the start of the hump or of the measured road at t = 0."""

    velocity: interpolate.CubicSpline
    way: interpolate.PPoly

    def speed(self, t: Array) -> Array:
        """Return the speed [m/s] at times [s]."""
        return np.asarray(self.velocity(t))

    def acceleration(self, t: Array) -> Array:
        """Return how fast the speed changes [m/s^2] at times [s]."""
        return np.asarray(self.velocity(t, 1))

    def distance(self, t: Array) -> Array:
        """Return where the front wheel is [m] at times [s], 0 at t = 0: the integral of the speed."""
        return np.asarray(self.way(t) - self.way(0.0))

    def passes(self, distance: float) -> float:
        """Return when the front wheel is at a distance [m]. Raises ValueError where it never is."""
        first, last = self.velocity.x[0], self.velocity.x[-1]
        return float(optimize.brentq(lambda t: float(self.distance(np.array(t))) - distance, first, last))


def wandering(mean: float, peak: float, correlation: float, start: float, end: float, rng: np.random.Generator) -> Drive:
    """Return a drive from `start` to `end` [s] whose speed departs from `mean` [m/s] by at most the share `peak`.

    The departure is a Gaussian random process of Gaussian autocorrelation, which falls to 1/e after `correlation` [s].
    """
    n = round((end - start) / GRID) + 2
    margin = round(4.0 * correlation / GRID)
    smooth = ndimage.gaussian_filter1d(rng.standard_normal(n + 2 * margin), 0.5 * correlation / GRID)[margin : margin + n]
    departure = peak * smooth / np.max(np.abs(smooth))
    velocity = interpolate.CubicSpline(start + GRID * np.arange(n), mean * (1.0 + departure))
    return Drive(velocity, velocity.antiderivative())
