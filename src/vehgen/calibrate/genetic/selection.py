"""Selection by rank, who becomes a parent, and migration: populations exchange their best."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def rank_fitness(objective: Array) -> Array:
    """Return F_i = 2 (Pos_i - 1)/(n - 1), the smaller the better (Wu & Li 2023, Sect. 2.4, with n = 100).

    Parameters
    ----------
    objective
        `shape (n,)`; Pos_i is 1 for the smallest.
    """
    position = np.empty(len(objective))
    position[np.argsort(objective, kind="stable")] = np.arange(len(objective))
    return 2.0 * position / max(len(objective) - 1, 1)


def sample_parents(fitness: Array, count: int, random: np.random.Generator) -> NDArray[np.intp]:
    """Return `count` parents by stochastic universal sampling, in random order.

    An individual's chance is proportional to 2 - F: twice the average for the best, nothing for the worst (J. E. Baker, Reducing bias and
    inefficiency in the selection algorithm, Proc. 2nd Int. Conf. Genetic Algorithms, 1987).
    """
    weight = np.cumsum(2.0 - fitness)
    pointers = (np.arange(count) + random.random()) * (weight[-1] / count)
    chosen = np.minimum(np.searchsorted(weight, pointers, side="right"), len(fitness) - 1)
    return random.permutation(chosen)


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
