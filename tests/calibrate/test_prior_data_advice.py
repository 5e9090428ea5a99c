"""Which fact to ask for: against the intervals that a file with this fact gives."""

import numpy as np
import pytest

from tests.calibrate.trucks import fit_at, truck_problem
from tests.fit.recordings import sedan_truth, write_run
from vehgen.calibrate.identifiability import find_structure
from vehgen.calibrate.intervals import Uncertainty
from vehgen.calibrate.prior_data_advice import RANGE_SIGMA, TAPE_ERROR_M, advise_prior_data
from vehgen.fit.prior_data import load_prior_data
from vehgen.fit.problem import make_problem
from vehgen.fit.trial import load_trials


def uncertainty(problem, facts=None):
    return Uncertainty(fit_at(problem, problem.space.start), find_structure(problem, problem.space.start), facts)


@pytest.fixture(scope="module")
def truck(tmp_path_factory):
    return truck_problem(tmp_path_factory.mktemp("truck"))


@pytest.fixture(scope="module")
def advice(truck):
    return advise_prior_data(uncertainty(truck))


def widths(information):
    return np.sqrt(np.diag(np.linalg.inv(information + np.eye(len(information)) / RANGE_SIGMA**2)))


def test_a_weighbridge_is_asked_for_before_the_height_of_the_fifth_wheel(advice):
    order = [item.fact for item in advice]
    assert order[0] == "kerb mass"
    assert order.index("load of axle4") < order.index("a1")
    assert [item.width_left for item in advice] == sorted(item.width_left for item in advice)


def test_no_load_is_asked_of_what_cannot_stand_alone(advice):
    asked = {item.fact for item in advice}
    assert "load of axle1 of tractor alone" in asked
    assert not any("semitrailer alone" in fact for fact in asked)


@pytest.mark.parametrize("fact", ["kerb mass", "load of axle5", "load of axle1 of tractor alone", "a1"])
def test_a_fact_given_narrows_the_intervals_as_promised(truck, advice, tmp_path, fact):
    item = next(item for item in advice if item.fact == fact)
    known = f"{{value: {item.expected} {item.unit}, uncertainty: {item.uncertainty} {item.unit}}}"
    (tmp_path / "facts.yaml").write_text(item.entry.replace("...", known) + "\n", encoding="utf-8")
    facts = load_prior_data(tmp_path / "facts.yaml", truck)
    left = widths(uncertainty(truck, facts).information) / widths(uncertainty(truck).information)
    assert np.exp(np.log(left).mean()) == pytest.approx(item.width_left, rel=1e-3)
    assert {truck.space.names[i] for i in np.flatnonzero(left < 0.49)} <= set(item.narrows)
    assert facts.residuals(truck.space.start) == pytest.approx([0.0], abs=1e-6)
    assert fact not in {other.fact for other in advise_prior_data(uncertainty(truck, facts), facts)}


def test_a_wheelbase_is_taken_with_a_tape(tmp_path):
    (tmp_path / "own.yaml").write_text("extends: tractor5.yaml\nname: own\nparameters: {L12: {range: [3 m, 4 m]}}\n", encoding="utf-8")
    errors = {item.fact: item.uncertainty for item in advise_prior_data(uncertainty(truck_problem(tmp_path, vehicle="own.yaml")))}
    assert errors["L12"] == TAPE_ERROR_M
    assert errors["b1"] > TAPE_ERROR_M


def test_a_vehicle_that_is_told_in_full_gains_little(tmp_path):
    problem = make_problem(load_trials([write_run(tmp_path, "hump", sedan_truth())]))
    values = np.array([sedan_truth()[name] for name in problem.space.names])
    found = advise_prior_data(Uncertainty(fit_at(problem, values), find_structure(problem, values)))
    assert {item.fact for item in found} == {"kerb mass", "load of front", "load of rear", "Lf"}
    assert all(item.width_left > 0.5 for item in found)
