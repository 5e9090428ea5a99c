"""How alike two histories are, as they are and one of them later."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.signal
from numpy.typing import NDArray

Array = NDArray[np.float64]
LONGEST_LATE = 3.0
"""So much later or earlier one may be taken [s]."""
ALIKE_ABOVE, UNLIKE_BELOW = 0.6, 0.3
"""Correlations beyond which two histories are one motion, and below which they are not."""
ONE_MOTION = 0.8
"""The first of these where the best of many lags was taken: two decaying motions of 5 s have 0.6 by chance."""


@dataclass(frozen=True)
class Agreement:
    """Correlation of two histories as they are, the largest with one shifted, and how late the first is then [s]."""

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
    products = scipy.signal.correlate(one, other, mode="full", method="fft") / size
    lags = scipy.signal.correlation_lags(len(one), len(other)) * dt
    near = np.abs(lags) <= LONGEST_LATE
    best = int(np.argmax(np.where(near, products, -np.inf)))
    return Agreement(float(one @ other) / size, float(products[best]), float(lags[best]))
