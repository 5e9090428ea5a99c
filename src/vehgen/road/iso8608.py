"""Random roads of the classes of ISO 8608:2016."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
import scipy
from numpy.typing import NDArray

from vehgen.errors import InputError, did_you_mean, shown

Array = NDArray[np.float64]

REFERENCE_CYCLES_PER_M = 0.1
"""Reference spatial frequency n0, cycles/m."""
SPATIAL_BAND_CYCLES_PER_M = (0.011, 2.83)
"""Spatial frequencies that the standard covers, cycles/m."""
CLASSES: dict[str, tuple[float, float, float]] = {
    name: (factor * 8e-6, factor * 16e-6, factor * 32e-6) for name, factor in zip("ABCDEFGH", (4.0**i for i in range(8)), strict=True)
}
"""Class -> (lower, geometric mean, upper) bound of the displacement PSD Gd(n0) [m^3]; A has no lower and H no upper bound of its own."""
LONGEST_ROAD_M = 50_000.0
"""No random road is longer [m]: at the spacing of its points these are five million."""
_SLOW = 1_000_000
"""A road of more points is made a little longer where the transform of their number would cost much memory."""
TAPER = 2.0
"""The road rises smoothly from level over its first metres, so that a vehicle can start at rest."""


@dataclass(frozen=True)
class Iso8608Road:
    """A random road: a sum of cosines with the mean PSD of a class, Gd(n) = Gd(n0) (n/n0)^-2, and phases from a seed.

    The cosines are spaced by 1/period, with a period of at least `length`, so that the profile does not repeat itself.
    """

    roughness: str
    seed: int
    length: float
    spacing: float = 0.01
    _heights: Array = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        if self.roughness not in CLASSES:
            raise InputError(f"unknown road class {shown(self.roughness)}; {did_you_mean(self.roughness, CLASSES)}")
        if not self.length > 0:
            raise InputError(f"a road needs a positive length, found {self.length} m")
        check_length(self.length)
        least = int(np.ceil(max(self.length, 1.0 / SPATIAL_BAND_CYCLES_PER_M[0]) / self.spacing)) + 1
        n_points = scipy.fft.next_fast_len(least, real=True) if least > _SLOW else least
        period = n_points * self.spacing
        low, high = SPATIAL_BAND_CYCLES_PER_M
        n = np.arange(min(n_points // 2, int(np.ceil(high * period))) + 1) / period  # what lies beyond is zero and need not be held
        inside = (n >= low) & (n <= high)
        amplitude = np.zeros_like(n)
        amplitude[inside] = np.sqrt(2.0 * displacement_psd(self.roughness, n[inside]) / period)
        phase = np.random.default_rng(self.seed).uniform(0.0, 2.0 * np.pi, len(n))
        heights = np.fft.irfft(0.5 * n_points * amplitude * np.exp(1j * phase), n_points)
        object.__setattr__(self, "_heights", heights)

    @property
    def end(self) -> float:
        """A random road has no hump to leave behind."""
        return -np.inf

    def height(self, s: Array) -> Array:
        """Return the height [m] at positions s along the road [m]: zero before it starts, periodic beyond its length."""
        s = np.asarray(s, dtype=np.float64)
        grid, closed = self._closed
        first, last, period = float(s.min(initial=0.0)), float(s.max(initial=0.0)), float(grid[-1])
        heights = np.interp(s if first >= 0 and last < period else np.mod(s, period), grid, closed)
        if first < TAPER:
            heights *= 0.5 - 0.5 * np.cos(np.pi * np.clip(s / TAPER, 0.0, 1.0))
        return np.asarray(heights)

    @cached_property
    def _closed(self) -> tuple[Array, Array]:
        """Places and heights of one period, both ends included."""
        heights = np.append(self._heights, self._heights[0])
        return np.asarray(np.arange(len(heights)) * self.spacing, dtype=np.float64), np.asarray(heights, dtype=np.float64)


def check_length(length: float) -> None:
    """Refuse random roads that are longer than LONGEST, together, before they are made; raises InputError."""
    if not length <= LONGEST_ROAD_M:
        raise InputError(
            f"random roads are made up to {LONGEST_ROAD_M:g} m, found {length:.3g} m: a shorter or slower run, or fewer of them"
        )


def displacement_psd(roughness: str, n: Array) -> Array:
    """Return the one-sided displacement PSD of a class's mean [m^3] at spatial frequencies n [cycles/m] (ISO 8608, exponent 2)."""
    return np.asarray(CLASSES[roughness][1] * (np.asarray(n) / REFERENCE_CYCLES_PER_M) ** -2.0)
