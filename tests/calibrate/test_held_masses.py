"""Masses that a file takes as known: what hangs on them, against the scaling that leaves a vehicle's motion as it is."""

import numpy as np
import pytest

from tests.calibrate.quarter import KNOWN_BODY, quarter_problem
from tests.calibrate.trucks import truck_problem
from tests.fit.recordings import sedan_truth, write_run
from vehgen.calibrate.held_masses import find_held_masses
from vehgen.calibrate.identifiability import find_structure
from vehgen.fit.problem import make_problem
from vehgen.fit.trial import load_trials


def held(problem):
    values = problem.space.start
    return find_held_masses(problem, find_structure(problem, values), values)


def test_what_hangs_on_the_body_mass_grows_with_it_and_the_car_moves_as_before(tmp_path):
    problem = make_problem(load_trials([write_run(tmp_path, "hump", sedan_truth())]))
    found = held(problem)
    assert found.names == ("mH",)
    assert list(found.follows) == [name for name in problem.space.names if name != "Lf"]
    trial = problem.trials[0]
    values = trial.values
    heavier = values | {"mH": 1.3 * values["mH"]} | {name: values[name] * 1.3**share for name, share in found.follows.items()}
    before, after = (trial.simulator.run(trial.simulator.parameters(item), trial.scenario).responses[0] for item in (values, heavier))
    assert np.abs(after - before).max() < 1e-6 * np.abs(before).max()


@pytest.mark.parametrize(("loads", "names"), [((0,), ("mB",)), ((50,), ("mB", "mL"))])
def test_a_load_counts_as_mass_where_a_run_carries_one(tmp_path, loads, names):
    found = held(quarter_problem(tmp_path, loads, KNOWN_BODY))
    assert found.names == names
    assert found.follows == pytest.approx(dict.fromkeys(("mG", "kS", "cS", "kT"), 1.0))


def test_known_loads_weigh_a_body_that_is_searched(tmp_path):
    found = held(quarter_problem(tmp_path, (50, 250)))
    assert found.names == ("mL",)
    assert found.follows == pytest.approx(dict.fromkeys(("mB", "mG", "kS", "cS", "kT"), 1.0))


def test_a_stiffness_that_is_held_tells_the_mass(tmp_path):
    assert held(quarter_problem(tmp_path, (0,), KNOWN_BODY.replace(", range: [90 kN/m, 360 kN/m]", ""))) is None


def test_nothing_is_said_to_follow_that_recordings_do_not_tell(tmp_path):
    assert held(truck_problem(tmp_path)) is None
    assert held(quarter_problem(tmp_path, (0,))) is None
