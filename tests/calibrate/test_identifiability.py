"""The structural rank and the unidentifiable directions, against those worked out by hand."""

import numpy as np
import pytest

from tests.calibrate.quarter import quarter_problem
from tests.calibrate.trucks import along_the_first_direction, fit_at, truck_problem
from tests.fit.recordings import sedan_truth, write_run
from vehgen.calibrate.identifiability import find_structure
from vehgen.calibrate.intervals import Uncertainty
from vehgen.fit.problem import make_problem
from vehgen.fit.trial import load_trials


@pytest.fixture(scope="module")
def truck(tmp_path_factory, request):
    return truck_problem(tmp_path_factory.mktemp("truck"), request.param)


@pytest.mark.parametrize("truck", ["both", "one"], indirect=True)
def test_a_tractor_semitrailer_has_two_unidentifiable_directions_whatever_the_sensors(truck):
    structure = find_structure(truck, truck.space.start)
    assert truck.space.size == 27
    assert structure.rank == 25
    assert structure.singular_values[24] > 1e6 * structure.singular_values[25]


@pytest.mark.parametrize("truck", ["both"], indirect=True)
@pytest.mark.parametrize("kt3", [4600.0, 4605.0, 4610.0])
def test_frequencies_of_modes_that_almost_coincide_have_intervals_too(truck, kt3):
    values = truck.space.start.copy()
    values[truck.space.names.index("kt3")] = kt3 * 8000
    known = Uncertainty(fit_at(truck, values), find_structure(truck, values))
    hertz = np.array([hz.value for hz, _ in known.frequencies()])
    assert np.diff(hertz).min() < 0.02
    assert all(hz.low is not None for hz, _ in known.frequencies())


@pytest.mark.parametrize("truck", ["both"], indirect=True)
def test_the_null_space_holds_both_directions(truck):
    space = truck.space
    p = dict(zip(space.names, space.start.tolist(), strict=True))
    structure = find_structure(truck, space.start)
    step = 1e-5 * p["mS"]
    one = np.array(
        [
            (along_the_first_direction(p, p["mS"] + step)[name] - along_the_first_direction(p, p["mS"] - step)[name]) / (2 * step)
            for name in space.names
        ]
    )
    r = 1e-6
    two = np.zeros(space.size)
    mu = 8000.0 * p["mS"] / (8000.0 + p["mS"])
    changes = {"a1": p["a1"], "a2": -p["a2"], "IT": -2 * mu * p["a1"] ** 2, "IS": 2 * mu * p["a2"] ** 2}
    for name, change in changes.items():
        two[space.names.index(name)] = change * r
    basis = np.linalg.qr(structure.null.T)[0]
    for change in (one, two):
        unit = change / space.slopes(space.start)
        assert np.linalg.norm(unit - basis @ (basis.T @ unit)) < 1e-5 * np.linalg.norm(unit)


@pytest.mark.parametrize("truck", ["both"], indirect=True)
def test_moving_far_along_an_unidentifiable_direction_changes_no_response(truck):
    p = dict(zip(truck.space.names, truck.space.start.tolist(), strict=True))
    q = along_the_first_direction(p, 1.3 * p["mS"])
    rows = np.array([[item[name] for name in truck.space.names] for item in (p, q)])
    responses = truck.respond(rows, truck.trials[0])[0]
    assert np.abs(responses[0] - responses[1]).max() < 1e-9 * np.abs(responses[0]).max()


def test_a_sedan_can_be_told_in_full(tmp_path):
    problem = make_problem(load_trials([write_run(tmp_path, "hump", sedan_truth())]))
    structure = find_structure(problem, problem.space.start)
    assert structure.rank == problem.space.size == 10
    assert structure.is_identifiable(np.ones(10))


@pytest.mark.parametrize(("loads", "rank"), [((50, 50), 4), ((50, 250), 5)])
def test_two_known_loads_weigh_a_vehicle_and_one_does_not(tmp_path, loads, rank):
    problem = quarter_problem(tmp_path, loads)
    assert find_structure(problem, problem.space.start).rank == rank
