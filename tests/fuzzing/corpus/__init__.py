"""The nastiest files, each with the place at which it must be refused."""

from tests.fuzzing.corpus.entry import Nasty
from tests.fuzzing.corpus.others import OTHERS
from tests.fuzzing.corpus.runs import RUNS
from tests.fuzzing.corpus.tables import TABLES
from tests.fuzzing.corpus.vehicles import VEHICLES

CORPUS: tuple[Nasty, ...] = (*VEHICLES, *RUNS, *TABLES, *OTHERS)

__all__ = ["CORPUS", "Nasty"]
