"""How alike two histories are, as they are and one of them later."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

Array = NDArray[np.float64]
LEAST_SHARED = 0.5
"""Shifted histories are compared where they overlap; there lies this share of the energy of each at least."""
ALIKE_ABOVE, UNLIKE_BELOW = 0.6, 0.3
"""Correlations beyond which two histories are one motion, and below which they are not."""
ONE_MOTION = 0.8
"""The first of these where the best of many lags was taken: two decaying motions of 5 s have 0.6 by chance."""


@dataclass(frozen=True)
class Agreement:
    """Correlation of two histories as they are, the largest where they overlap with one shifted, and how late the first is then [s]."""

    at_once: float
    at_best: float
    late: float


def agreement(first: Array, second: Array, dt: float) -> Agreement:
    """Return how alike two histories `shape (n,)` of one even clock are, means taken off; not at all where one does not move.

    Parameters
    ----------
    first, second
        The histories.
    dt
        The time between samples [s].
    """
    one, other = first - first.mean(), second - second.mean()
    size = float(np.linalg.norm(one) * np.linalg.norm(other))
    if size == 0:
        return Agreement(0.0, 0.0, 0.0)
    products = scipy.signal.correlate(one, other, mode="full", method="fft")
    lags = scipy.signal.correlation_lags(len(one), len(other))
    shared = np.column_stack([_energy_after(one, lags), _energy_after(other[::-1], lags)])
    shares = shared / np.array([one @ one, other @ other])
    alike = np.where(shares.min(axis=1) >= LEAST_SHARED, products / np.sqrt(np.maximum(shared.prod(axis=1), 1e-300)), -np.inf)
    best = int(np.argmax(alike))
    return Agreement(float(one @ other) / size, float(alike[best]), float(lags[best]) * dt)


def _energy_after(values: Array, lags: NDArray[np.int64]) -> Array:
    """Return the energy of what of `values shape (n,)` overlaps with a history of the same length that begins `lags` samples later.

    Lags below nought cut off as many samples at the end.
    """
    sums = np.concatenate([[0.0], np.cumsum(values**2)])
    return np.asarray(np.where(lags >= 0, sums[-1] - sums[np.maximum(lags, 0)], sums[len(values) + np.minimum(lags, 0)]))
