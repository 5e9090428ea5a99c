"""Recordings of the independent generator that several tests share."""

import pytest
from benchmarks.hidden_effects.generator import Case, Hump, RandomRoad, RunSpec, write_case

RUNS = (
    RunSpec((Hump(0.5, 0.03, 4.0),), 2.0, 6.0, "low"),
    RunSpec((Hump(0.5, 0.05, 5.0),), 2.5, 6.0, "high"),
    RunSpec((Hump(0.5, 0.05, 6.0),), 4.0, 5.0, "fast"),
    RunSpec((RandomRoad("C", 5),), 10.0, 8.0, "rough"),
)


@pytest.fixture(scope="session")
def record(tmp_path_factory):
    """Return a function that hides effects in a sedan and returns the run files."""

    def write(*effects, seed=3, runs=RUNS):
        folder = tmp_path_factory.mktemp("seen")
        write_case(Case("sedan2", effects=effects, runs=runs, seed=seed), folder, tmp_path_factory.mktemp("truth"))
        return sorted(folder.glob("*.yaml"))

    return write
