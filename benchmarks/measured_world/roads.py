"""Random roads, and what a profiler says of them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
ROUGHNESS = {"A": 16e-6, "B": 64e-6, "C": 256e-6}
"""Mean displacement PSD of the classes of ISO 8608 at 0.1 cycles/m [m^3]."""
WAVENUMBERS = (0.01, 4.0)
"""Of the random roads [cycles/m]."""
SPACING = 0.01
JOIN = 3.0
"""Over which a measured road begins [m]."""


@dataclass(frozen=True)
class Profile:
    """Heights [m] over distance [m], linear between points and constant outside."""

    distance: Array
    height: Array

    def heights(self, s: Array) -> Array:
        """Return the height [m] at distances s [m]."""
        return np.asarray(np.interp(s, self.distance, self.height))


def random_road(roughness: str, start: float, end: float, rng: np.random.Generator, scale: float = 1.0) -> Profile:
    """Return a Gaussian road of a class from `start` to `end` [m] with Gd(n) = Gd(0.1 cycles/m) (n/0.1)^-2 within WAVENUMBERS, its
    heights times `scale`."""
    s = start + SPACING * np.arange(round((end - start) / SPACING) + 1)
    count = round(max(1.3 * len(s), 1.0 / (WAVENUMBERS[0] * SPACING)))
    n = np.fft.rfftfreq(count, SPACING)
    density = np.zeros_like(n)
    inside = (n >= WAVENUMBERS[0]) & (n <= WAVENUMBERS[1])
    density[inside] = ROUGHNESS[roughness] * (n[inside] / 0.1) ** -2.0
    lines = (rng.standard_normal(len(n)) + 1j * rng.standard_normal(len(n))) * np.sqrt(density * count / (4.0 * SPACING))
    return Profile(s, scale * np.fft.irfft(lines, count)[: len(s)])


def joined(approach: Profile, section: Profile) -> Profile:
    """Return a road that is the approach before 0 m and goes over to the section within JOIN; level with the mark at 0 m there."""
    share = 0.5 - 0.5 * np.cos(np.pi * np.clip(approach.distance / JOIN, 0.0, 1.0))
    height = (1.0 - share) * approach.height + share * section.heights(approach.distance)
    road = Profile(approach.distance, height)
    return Profile(road.distance, height - road.heights(np.zeros(1)))


@dataclass(frozen=True)
class Profiler:
    """What measured a road: relative errors of its heights and of its odometer, white noise [m] of its points and drift [m/sqrt(m)];
    `spacing` of its points [m]."""

    gain: float
    odometer: float
    noise: float
    drift: float
    spacing: float

    def measure(self, road: Profile, end: float, rng: np.random.Generator) -> Profile:
        """Return the profile from 0 to `end` [m] as measured."""
        s = self.spacing * np.arange(round(end / self.spacing) + 1)
        slow = self.drift * np.sqrt(self.spacing) * np.cumsum(rng.standard_normal(len(s)))
        height = (1.0 + self.gain) * road.heights(s) + slow + self.noise * rng.standard_normal(len(s))
        return Profile(s * (1.0 + self.odometer), np.asarray(height - height[0]))


def draw_profiler(rng: np.random.Generator) -> Profiler:
    """Return a profiler of the usual errors."""
    return Profiler(
        gain=float(rng.normal(0.0, 0.007)),
        odometer=float(rng.normal(0.0, 0.0015)),
        noise=float(rng.uniform(0.5e-4, 2e-4)),
        drift=float(rng.uniform(0.0, 2e-4)),
        spacing=0.025,
    )
