"""Satellite fixes of a phone: speeds once a second, noisy and late."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from benchmarks.measured_world.driver import Drive

Array = NDArray[np.float64]
NOISE = 0.1
"""Standard deviation of a fix's speed [m/s]."""
DELAYS = (0.3, 1.0)
"""How late a phone's fixes are [s]."""


def fixes(drive: Drive, start: float, end: float, rng: np.random.Generator) -> Array:
    """Return time stamps [s after `start`] and speeds [m/s] of the fixes between true times `start` and `end` [s], `shape (n, 2)`."""
    delay = rng.uniform(*DELAYS)
    stamps = np.arange(rng.uniform(0.1, 1.0), end - start, 1.0)
    speed = drive.speed(start + stamps - delay) + NOISE * rng.standard_normal(len(stamps))
    return np.column_stack([stamps, np.maximum(speed, 0.0)])
