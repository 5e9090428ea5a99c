"""Migration: populations exchange their best."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def migrate(genes: Array, objective: Array) -> tuple[Array, Array]:
    """Let the best of each population take the place of the worst of the next, around a ring.

    Parameters
    ----------
    genes
        `shape (n_populations, size, n_genes)`.
    objective
        `shape (n_populations, size)`.

    Returns
    -------
    New genes and objective values; with one population nothing moves.
    """
    genes, objective = genes.copy(), objective.copy()
    count = len(genes)
    best, worst = objective.argmin(axis=1), objective.argmax(axis=1)
    travellers = [(genes[i, best[i]].copy(), objective[i, best[i]]) for i in range(count)]
    if count > 1:
        for i, (individual, value) in enumerate(travellers):
            target = (i + 1) % count
            genes[target, worst[target]], objective[target, worst[target]] = individual, value
    return genes, objective
