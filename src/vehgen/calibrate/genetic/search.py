"""The genetic search: one population (GA) or several that exchange their best (MPGA), as Wu & Li 2023 (Sect. 2.4) configure them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vehgen.calibrate.genetic.operators import migrate, mutate, rank_fitness, recombine, sample_parents
from vehgen.errors import InputError

Array = NDArray[np.float64]
Objective = Callable[[Array], Array]
CROSSOVER_RATES = (0.7, 0.9)
MUTATION_RATES = (0.01, 0.05)
SETTLED_GENERATIONS = 50
SETTLED_FALL = 0.2
"""A search is settled once so many generations in a row took no more than this share off its best objective."""


@dataclass(frozen=True)
class SearchState:
    """Where a search stands after `generation` generations; all that is needed to go on bit for bit.

    `genes shape (n_populations, size, n_genes)` in the unit cube, `objective shape (n_populations, size)`, `elite shape (n_genes,)` the
    best individual ever seen with its `elite_objective`, `rates shape (n_populations, 2)` each population's crossover and mutation rate,
    `history` the best objective after each generation, `random` the state of the generator.
    """

    generation: int
    genes: Array
    objective: Array
    elite: Array
    elite_objective: float
    rates: Array
    history: tuple[float, ...]
    random: dict[str, Any]

    @property
    def is_settled(self) -> bool:
        """Whether a fit from here gains more than further generations would."""
        return len(self.history) > SETTLED_GENERATIONS and self.history[-1] >= (1 - SETTLED_FALL) * self.history[-1 - SETTLED_GENERATIONS]

    def to_data(self) -> dict[str, Any]:
        """Return the state as numbers, texts and lists, which JSON keeps and :meth:`from_data` reads back exactly."""
        return {key: value.tolist() if isinstance(value, np.ndarray) else value for key, value in vars(self).items()}

    @classmethod
    def from_data(cls, data: Mapping[str, Any]) -> SearchState:
        """Return a state; raises InputError for data that are none."""
        try:
            arrays = {key: np.array(data[key], dtype=np.float64) for key in ("genes", "objective", "elite", "rates")}
            state = cls(
                generation=int(data["generation"]),
                elite_objective=float(data["elite_objective"]),
                history=tuple(float(value) for value in data["history"]),
                random=data["random"],
                **arrays,
            )
            _generator(state.random)
        except (ValueError, KeyError, TypeError, OverflowError) as error:
            raise InputError(f"this is not the state of a search: {error}") from error
        if not state._is_whole:
            raise InputError("this is not the state of a search: its arrays do not fit together, or hold genes outside of 0 to 1")
        return state

    @property
    def _is_whole(self) -> bool:
        """Whether the arrays fit together, and all genes lie in the unit cube."""
        if self.genes.ndim != 3 or self.generation < 0:
            return False
        populations, size, n_genes = self.genes.shape
        shapes = self.objective.shape, self.elite.shape, self.rates.shape
        inside = all(bool(((item >= 0) & (item <= 1)).all()) for item in (self.genes, self.elite))
        return shapes == ((populations, size), (n_genes,), (populations, 2)) and inside and bool(np.isfinite(self.rates).all())


@dataclass(frozen=True)
class GeneticSearch:
    """A genetic algorithm over the unit cube.

    Parameters
    ----------
    populations
        1 for a GA; the paper's MPGA has 3.
    size
        Individuals of a population, even.
    generations
        How many generations follow the first, at most.
    """

    populations: int = 3
    size: int = 100
    generations: int = 300

    def __post_init__(self) -> None:
        if self.populations < 1 or self.size < 4 or self.size % 2 or self.generations < 0:
            raise InputError(
                "a genetic search needs at least 1 population of an even number of at least 4 individuals, and generations not below 0; "
                f"found {self.populations} of {self.size} over {self.generations}"
            )

    @property
    def evaluations(self) -> int:
        """How many individuals are evaluated in all."""
        return self.populations * self.size * (self.generations + 1)

    def start(
        self, objective: Objective, n_genes: int, seed: int, first: Array | None = None, quick: Objective | None = None
    ) -> SearchState:
        """Return the first generation, uniform over the unit cube.

        Parameters
        ----------
        objective
            Maps points `shape (n, n_genes)` to values `shape (n,)`, the smaller the better; inf for what cannot be used.
        n_genes
            Number of searched parameters.
        seed
            Of the random numbers.
        first
            `shape (n_genes,)`: a point that takes the place of the first individual of each population.
        quick
            In place of the objective, less exact: it ranks the individuals, and each population's best has its value by the objective.
        """
        random = np.random.Generator(np.random.PCG64(seed))
        genes = random.random((self.populations, self.size, n_genes))
        if first is not None:
            genes[:, 0] = first
        rates = np.column_stack([random.uniform(*CROSSOVER_RATES, self.populations), random.uniform(*MUTATION_RATES, self.populations)])
        values = self._evaluate(objective, genes, quick)
        if not np.isfinite(values).any():
            raise InputError("no individual of the first generation has a finite objective: look at the ranges")
        best = int(values.argmin())
        elite = genes.reshape(-1, n_genes)[best].copy()
        value = float(values.ravel()[best])
        return SearchState(0, genes, values, elite, value, rates, (value,), _state(random))

    def advance(self, state: SearchState, objective: Objective, quick: Objective | None = None) -> SearchState:
        """Return the next generation: selection, crossover, mutation, evaluation (as :meth:`start` does it), elite, migration."""
        random = _generator(state.random)
        n_genes = state.genes.shape[2]
        children = np.empty_like(state.genes)
        for i in range(self.populations):
            parents = sample_parents(rank_fitness(state.objective[i]), self.size, random)
            crossed = recombine(state.genes[i][parents], state.rates[i, 0], random)
            children[i] = mutate(crossed, state.rates[i, 1], random)
        values = self._evaluate(objective, children, quick, state.objective.min(axis=1))
        for i in range(self.populations):  # each population keeps its best over the generations
            best, worst = state.objective[i].argmin(), values[i].argmax()
            if state.objective[i, best] < values[i].min():
                children[i, worst], values[i, worst] = state.genes[i, best], state.objective[i, best]
        children, values = migrate(children, values)
        best = int(values.argmin())
        elite, value = state.elite, state.elite_objective
        if values.ravel()[best] < value:
            elite, value = children.reshape(-1, n_genes)[best].copy(), float(values.ravel()[best])
        return replace(
            state,
            generation=state.generation + 1,
            genes=children,
            objective=values,
            elite=elite,
            elite_objective=value,
            history=(*state.history, value),
            random=_state(random),
        )

    def _evaluate(self, objective: Objective, genes: Array, quick: Objective | None, below: Array | None = None) -> Array:
        """Return the values of all individuals; where `quick` ranks them, each population's best by `objective`.

        A best that is not `below` that of the generation before `shape (n_populations,)` will not be carried on, and may stay as it is.
        """
        flat = genes.reshape(-1, genes.shape[2])
        values = _finite_or_inf((quick or objective)(flat)).reshape(genes.shape[:2])
        exact = np.full(values.shape, quick is None)
        while True:
            best = values.argmin(axis=1)
            least = np.take_along_axis(values, best[:, None], axis=1)[:, 0]
            told = np.take_along_axis(exact, best[:, None], axis=1)[:, 0]
            asked = np.flatnonzero(~told & np.isfinite(least) & (below is None or least <= below))
            if not len(asked):
                return values
            values[asked, best[asked]] = _finite_or_inf(objective(genes[asked, best[asked]]))
            exact[asked, best[asked]] = True


def _finite_or_inf(values: Array) -> Array:
    return np.where(np.isnan(values), np.inf, values)


def _generator(state: Any) -> np.random.Generator:
    random = np.random.Generator(np.random.PCG64(0))
    random.bit_generator.state = state
    return random


def _state(random: np.random.Generator) -> dict[str, Any]:
    return dict(random.bit_generator.state)
