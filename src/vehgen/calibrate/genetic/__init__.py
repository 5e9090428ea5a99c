"""How are parameters searched? Genetic algorithms over the unit cube: their operators, and the search itself."""

from vehgen.calibrate.genetic.search import GeneticSearch, SearchState

__all__ = ["GeneticSearch", "SearchState"]
