"""Roads: half-sine humps, random roads of the classes of ISO 8608 (a realisation of our own), profiles as points, and the footprint as an
exact moving average.

Every part of a road is a height over the distance along the road and its integral, so that the mean over a contact length needs no grid.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]

ROUGHNESS = {name: 16e-6 * 4.0**i for i, name in enumerate("ABCDEFGH")}
"""Mean displacement PSD of the classes of ISO 8608 at 0.1 cycles/m [m^3]."""
SPACING = 0.01
TAPER = 2.0


@dataclass(frozen=True)
class HalfSine:
    """A hump h sin(pi s/L) of length L [m] and height h [m] that starts `at` [m]."""

    length: float
    height: float
    at: float

    def heights(self, s: Array) -> Array:
        """Return the height [m] at distances s [m]."""
        x = np.clip(s - self.at, 0.0, self.length)
        return np.asarray(self.height * np.sin(np.pi * x / self.length))

    def integral(self, s: Array) -> Array:
        """Return the integral of the height up to s [m^2]."""
        x = np.clip(s - self.at, 0.0, self.length)
        return np.asarray(self.height * self.length / np.pi * (1.0 - np.cos(np.pi * x / self.length)))


@dataclass(frozen=True)
class Points:
    """A profile linear between points, constant outside."""

    distance: Array
    height: Array

    def heights(self, s: Array) -> Array:
        """Return the height [m] at distances s [m]."""
        return np.asarray(np.interp(s, self.distance, self.height))

    def integral(self, s: Array) -> Array:
        """Return the integral of the height from the first point to s [m^2]."""
        x, y = self.distance, self.height
        total = np.concatenate([[0.0], np.cumsum(0.5 * (y[1:] + y[:-1]) * np.diff(x))])
        i = np.clip(np.searchsorted(x, s, side="right") - 1, 0, len(x) - 2)
        within = np.clip(s, x[0], x[-1]) - x[i]
        slope = (y[i + 1] - y[i]) / (x[i + 1] - x[i])
        outside = np.where(s < x[0], (s - x[0]) * y[0], np.where(s > x[-1], (s - x[-1]) * y[-1], 0.0))
        return np.asarray(total[i] + within * (y[i] + 0.5 * slope * within) + outside)


@dataclass(frozen=True)
class Road:
    """The sum of parts, averaged over the contact length `footprint` [m]."""

    parts: tuple[HalfSine | Points, ...]
    footprint: float = 0.0

    def heights(self, s: Array) -> Array:
        """Return what a tyre at distances s [m] sees [m]."""
        out = np.zeros_like(s)
        half = 0.5 * self.footprint
        for part in self.parts:
            out += (part.integral(s + half) - part.integral(s - half)) / self.footprint if half > 0 else part.heights(s)
        return out


@njit(cache=True)
def _waves(start, spacing, count, w, a, b):
    """Return the sum of a cos(w s) + b sin(w s) at `count` points, every wave turned on from point to point."""
    out = np.zeros(count)
    for i in range(w.size):
        cos, sin = np.cos(w[i] * start), np.sin(w[i] * start)
        turn_cos, turn_sin = np.cos(w[i] * spacing), np.sin(w[i] * spacing)
        for j in range(count):
            out[j] += a[i] * cos + b[i] * sin
            cos, sin = cos * turn_cos - sin * turn_sin, sin * turn_cos + cos * turn_sin
    return out


def random_road(roughness: str, start: float, end: float, rng: np.random.Generator, taper: bool, scale: float = 1.0) -> Points:
    """Return a random road with Gd(n) = Gd(n0) (n/n0)^-2 between 0.011 and 2.83 cycles/m from `start` to `end` [m], points every 10 mm.

    Sine and cosine amplitudes at 500 logarithmically spaced, jittered frequencies are normal random numbers: heights are Gaussian, unlike
    a sum of cosines of fixed amplitude. `taper`: rise from level over the first 2 m after s = 0. `scale` multiplies all heights.
    """
    edges = np.geomspace(0.011, 2.83, 501)
    n = edges[:-1] + np.diff(edges) * rng.uniform(size=500)
    sigma = np.sqrt(ROUGHNESS[roughness] * (n / 0.1) ** -2.0 * np.diff(edges))
    a, b = rng.standard_normal((2, 500)) * sigma
    s = SPACING * np.arange(np.floor(start / SPACING), np.ceil(end / SPACING) + 1)
    height = _waves(s[0], SPACING, len(s), 2.0 * np.pi * n, a, b)
    if taper:
        height *= 0.5 - 0.5 * np.cos(np.pi * np.clip(s / TAPER, 0.0, 1.0))
    return Points(s, scale * height)
