"""Roads of the study: a hump, and random roads by a realisation of their own."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

Array = np.ndarray
LEVELS = {"A": 16e-6, "B": 64e-6, "D": 1024e-6}
"""Gd(n0) of ISO 8608's mean classes at n0 = 0.1 cycles/m [m^3]."""
BAND = (0.01, 10.0)
"""Wavenumbers of the random roads [cycles/m]."""
SPACING = 0.01
"""Spacing of a profile's points [m]; the road is linear between them."""
RISE = 2.0
"""Over this distance a random road rises from level [m]."""
HUMP_LENGTH, HUMP_HEIGHT = 0.5, 0.03
"""The half-sine hump [m]."""


def half_sine(s: Array, at: float) -> Array:
    """Return the hump's height [m] at positions [m]."""
    local = (s - at) / HUMP_LENGTH
    return np.where((local > 0) & (local < 1), HUMP_HEIGHT * np.sin(np.pi * np.clip(local, 0, 1)), 0.0)


@dataclass(frozen=True)
class RandomRoad:
    """A Gaussian road of class `roughness` from `first` to `last` [m], level at `first`."""

    roughness: str
    seed: int
    first: float
    last: float

    @property
    def points(self) -> tuple[Array, Array]:
        """Positions and heights [m]."""
        s = self.first + np.arange(round((self.last - self.first) / SPACING) + 1) * SPACING
        period = max(len(s) * SPACING, 1 / BAND[0])
        count = round(period / SPACING)
        n = np.fft.rfftfreq(count, SPACING)
        inside = (n >= BAND[0]) & (n <= BAND[1])
        density = np.zeros_like(n)
        density[inside] = LEVELS[self.roughness] * (n[inside] / 0.1) ** -2
        random = np.random.default_rng(self.seed)
        lines = (random.standard_normal(len(n)) + 1j * random.standard_normal(len(n))) * np.sqrt(density * count / (4 * SPACING))
        heights = np.fft.irfft(lines, count)[: len(s)]
        return s, heights * np.clip((s - self.first) / RISE, 0, 1)

    @property
    def height(self) -> Callable[[Array], Array]:
        """The height [m] at positions [m], 0 before the road begins."""
        s, heights = self.points
        return lambda at: np.interp(at, s, heights)
