"""What makes the next generation: selection by rank, variation of the chosen, and migration, populations exchanging their best.

Variation is the breeder genetic algorithm's (H. Muehlenbein and D. Schlierkamp-Voosen, Evolutionary Computation 1(1), 1993,
doi:10.1162/evco.1993.1.1.25): two parents make two children, and now and then a gene moves by itself.
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
