"""Selection by rank: who becomes a parent."""

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
