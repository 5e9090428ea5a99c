"""Humps: as their maker or a tape measure says, and as they lie on the road."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

Array = NDArray[np.float64]
SHAPES = ("half_sine", "versine", "trapezoid")
RAMP = 0.25
"""Share of its length that each ramp of a trapezoid takes."""
SPACING = 0.002
"""Of a hump's points [m]."""


@dataclass(frozen=True)
class Hump:
    """A hump: one of SHAPES, length and height [m]; `wear` [m] rounds its edges (a Gaussian mean of that standard deviation);
    `tilt` makes its far side higher by that share, its near side lower."""

    shape: str
    length: float
    height: float
    wear: float = 0.0
    tilt: float = 0.0

    def points(self) -> tuple[Array, Array]:
        """Return distances from its start and heights [m]; the hump is linear between them and nought outside."""
        margin = SPACING * np.ceil((5.0 * self.wear + 0.01) / SPACING)
        s = np.arange(-margin, self.length + margin + 0.5 * SPACING, SPACING)
        x = np.clip(s / self.length, 0.0, 1.0)
        if self.shape == "half_sine":
            y = np.sin(np.pi * x)
        elif self.shape == "versine":
            y = 0.5 - 0.5 * np.cos(2.0 * np.pi * x)
        elif self.shape == "trapezoid":
            y = np.clip(np.minimum(x, 1.0 - x) / RAMP, 0.0, 1.0)
        else:
            raise ValueError(f"unknown shape {self.shape!r}; one of {', '.join(SHAPES)}")
        height = self.height * y * (1.0 + self.tilt * (2.0 * x - 1.0))
        if self.wear > 0.0:
            height = ndimage.gaussian_filter1d(height, self.wear / SPACING)
        height[0] = height[-1] = 0.0
        return s, np.asarray(height)

    def heights(self, s: Array) -> Array:
        """Return the height [m] at distances from its start [m]."""
        return np.asarray(np.interp(s, *self.points()))


def as_it_lies(stated: Hump, rng: np.random.Generator) -> Hump:
    """Return the hump that was measured as `stated`: height and length 2 to 5 % off, in half of the cases worn or tilted."""
    off = rng.uniform(0.02, 0.05, 2) * rng.choice([-1.0, 1.0], 2)
    wear = float(rng.uniform(0.004, 0.012)) if rng.random() < 0.5 else 0.0
    tilt = float(rng.uniform(-0.06, 0.06)) if rng.random() < 0.5 else 0.0
    return replace(stated, length=stated.length * (1.0 + off[0]), height=stated.height * (1.0 + off[1]), wear=wear, tilt=tilt)
