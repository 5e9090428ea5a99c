"""Crossover: two parents make two children."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
OVERSHOOT = 0.25
"""How far a child may lie outside the box its parents span, in units of that box."""


def recombine(parents: Array, rate: float, random: np.random.Generator) -> Array:
    """Return children by intermediate recombination of neighbours.

    With probability `rate` a pair is crossed: each gene of a child lies at a + t (b - a) with its own t, uniform in [-REACH, 1 + REACH]
    (H. Muehlenbein and D. Schlierkamp-Voosen, Evolutionary Computation 1(1), 1993, doi:10.1162/evco.1993.1.1.25); others pass unchanged.

    Parameters
    ----------
    parents
        `shape (n, n_genes)`, n even.
    """
    first, second = parents[0::2], parents[1::2]
    crossed = random.random((len(first), 1)) < rate
    children = np.empty_like(parents)
    for offset, (a, b) in enumerate(((first, second), (second, first))):
        t = random.uniform(-OVERSHOOT, 1.0 + OVERSHOOT, a.shape)
        children[offset::2] = np.where(crossed, a + t * (b - a), a)
    return np.clip(children, 0.0, 1.0)
