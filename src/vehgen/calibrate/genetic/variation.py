"""Variation: two parents make two children, and now and then a gene moves by itself.

Both are the breeder genetic algorithm's (H. Muehlenbein and D. Schlierkamp-Voosen, Evolutionary Computation 1(1), 1993,
doi:10.1162/evco.1993.1.1.25).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
OVERSHOOT = 0.25
"""How far a child may lie outside the box its parents span, in units of that box."""
LARGEST_MUTATION = 0.5
"""Largest step of a mutation, in units of the gene's range."""
PRECISION = 16
"""Steps reach down to LARGEST_MUTATION * 2^-PRECISION."""


def recombine(parents: Array, rate: float, random: np.random.Generator) -> Array:
    """Return children by intermediate recombination of neighbours.

    With probability `rate` a pair is crossed: each gene of a child lies at a + t (b - a) with its own t, uniform in
    [-OVERSHOOT, 1 + OVERSHOOT]; others pass unchanged.

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


def mutate(genes: Array, rate: float, random: np.random.Generator) -> Array:
    """Return genes of which each has moved with probability `rate`, by +-LARGEST_MUTATION * 2^(-PRECISION u) with u uniform in [0, 1].

    Steps of all sizes are equally likely on a logarithmic scale, so that late generations still improve.
    """
    moved = random.random(genes.shape) < rate
    step = LARGEST_MUTATION * 2.0 ** (-PRECISION * random.random(genes.shape)) * random.choice([-1.0, 1.0], genes.shape)
    return np.clip(np.where(moved, genes + step, genes), 0.0, 1.0)
