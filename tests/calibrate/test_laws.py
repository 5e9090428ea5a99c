"""Parameters of force laws: which of them recordings can tell, and how sure of them a fit is."""

from pathlib import Path

import numpy as np
import pytest

from tests.calibrate.trucks import fit_at, truck_problem
from vehgen.calibrate.identifiability import find_structure
from vehgen.calibrate.intervals import Uncertainty
from vehgen.fit.problem import Problem

LAWS = """extends: tractor5
name: with_laws
parameters:
  slip: {value: 2 kN, range: [200 N, 8 kN], meaning: friction}
  stops: {value: 2 MN/m, range: [500 kN/m, 5 MN/m], meaning: stiffness of the stops}
  gap: {value: 120 mm, range: [50 mm, 130 mm], meaning: travel to the stops}
  mount: {value: 400 kN/m, range: [50 kN/m, 2 MN/m], meaning: branch}
  time: {value: 20 ms, range: [5 ms, 100 ms], meaning: its time}
axles:
  axle1: {suspension: {laws: [{dry_friction: {force: slip}}]}}
  axle2: {suspension: {laws: [{bump_stop: {k: stops, clearance: gap, rebound: gap}}]}}
  axle4: {suspension: {laws: [{relaxation: {k: mount, time: time}}]}}
"""
OWN = ("slip", "stops", "gap", "mount", "time")


@pytest.fixture(scope="module")
def problem(tmp_path_factory) -> Problem:
    folder: Path = tmp_path_factory.mktemp("laws")
    (folder / "with_laws.yaml").write_text(LAWS, encoding="utf-8")
    return truck_problem(folder, vehicle="with_laws.yaml")


@pytest.fixture(scope="module")
def structure(problem):
    return find_structure(problem, problem.space.start)


def of_mass(structure):
    """Return the direction that moves mass from one body to the other."""
    return next(item for item in structure.directions(structure.space.start) if "mS" in item)


def test_parameters_of_laws_are_told_beside_what_no_run_can_tell(problem, structure):
    """The point mass at the hinge may belong to either body: what it changes is over the sprung mass, forces of laws too."""
    assert problem.space.size == 27 + len(OWN)
    assert structure.rank == 25 + len(OWN)
    start = dict(zip(problem.space.names, problem.space.start.tolist(), strict=True))
    moved = {name: change / start[name] for name, change in of_mass(structure).items()}
    assert moved.keys() & OWN == {"slip", "stops", "mount"}
    for name in ("slip", "stops", "mount"):
        assert moved[name] == pytest.approx(moved["k1"], rel=1e-6)


def test_moving_along_that_direction_changes_no_response(problem, structure):
    changes = of_mass(structure)
    moved = problem.space.start + [1e-3 / abs(changes["k1"]) * changes.get(name, 0.0) for name in problem.space.names]
    there, here = (problem.respond(values[None], problem.trials[0])[0][0] for values in (moved, problem.space.start))
    assert np.abs(there - here).max() < 1e-6 * np.abs(here).max()


def test_a_stop_that_no_run_meets_is_not_taken_for_known(problem, structure):
    known = Uncertainty(fit_at(problem, problem.space.start), structure)
    found = {item.name: item for item in known.parameters()}
    assert found["gap"].low < 0.05 < 0.13 < found["gap"].high
    assert 0 < found["time"].low < 0.02 < found["time"].high < 0.12
