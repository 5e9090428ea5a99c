"""Mutation: now and then a gene moves by itself."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
LARGEST_MUTATION = 0.5
"""Largest step in units of the gene's range."""
PRECISION = 16
"""Steps reach down to REACH * 2^-PRECISION."""


def mutate(genes: Array, rate: float, random: np.random.Generator) -> Array:
    """Return genes of which each has moved with probability `rate`, by +-REACH * 2^(-PRECISION u) with u uniform in [0, 1].

    Steps of all sizes are equally likely on a logarithmic scale, so that late generations still improve (the breeder genetic algorithm's
    mutation: H. Muehlenbein and D. Schlierkamp-Voosen, 1993, doi:10.1162/evco.1993.1.1.25).
    """
    moved = random.random(genes.shape) < rate
    step = LARGEST_MUTATION * 2.0 ** (-PRECISION * random.random(genes.shape)) * random.choice([-1.0, 1.0], genes.shape)
    return np.clip(np.where(moved, genes + step, genes), 0.0, 1.0)
