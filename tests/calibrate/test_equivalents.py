"""Of equivalent parameter sets the one nearest to the file's values, against sets worked out by hand."""

from dataclasses import replace

import numpy as np
import pytest

from tests.calibrate.trucks import along_the_first_direction, fit_at, truck_problem
from tests.fit.recordings import sedan_truth, write_run
from vehgen.calibrate.equivalents import MAX_LOSS_CHANGE, nearest_equivalent
from vehgen.fit.prior_data import load_prior_data
from vehgen.fit.problem import make_problem
from vehgen.fit.trial import load_trials
from vehgen.mechanics import static_loads
from vehgen.simulate import natural_modes


@pytest.fixture(scope="module")
def truck(tmp_path_factory):
    return truck_problem(tmp_path_factory.mktemp("truck"))


@pytest.fixture(scope="module")
def far(truck):
    """A fit that ended at a truck whose semitrailer weighs but two thirds of the file's, and answers alike."""
    names = truck.space.names
    start = dict(zip(names, truck.space.start.tolist(), strict=True))
    other = along_the_first_direction(start, 0.65 * start["mS"])
    return fit_at(truck, np.array([other[name] for name in names]))


def of_trial(problem, fit, compute):
    model = problem.trials[0].simulator.model
    return compute(model, problem.values_of(fit.values, problem.trials[0]))


@pytest.mark.thorough
def test_a_fit_that_ended_far_off_comes_back_to_the_file_which_answers_alike(truck, far):
    found = nearest_equivalent(far)
    assert np.abs(truck.space.unit(far.values) - truck.space.unit(truck.space.start)).max() > 0.3
    assert truck.space.unit(found.values) == pytest.approx(truck.space.unit(truck.space.start), abs=2e-3)
    assert abs(found.loss - far.loss) < MAX_LOSS_CHANGE
    weights = [sum(of_trial(truck, fit, static_loads).axles.values()) for fit in (far, found)]
    assert weights[0] < 0.75 * weights[1]


def test_natural_modes_and_responses_do_not_change(truck, far):
    found = nearest_equivalent(far)
    before, after = ([(mode.undamped_hz, mode.damping_ratio) for mode in of_trial(truck, fit, natural_modes)] for fit in (far, found))
    assert np.array(after) == pytest.approx(np.array(before), rel=1e-6)
    responses = truck.respond(np.array([far.values, found.values]), truck.trials[0])[0]
    assert np.abs(responses[0] - responses[1]).max() < 1e-6 * np.abs(responses[0]).max()


def test_a_set_that_cannot_be_reached_within_the_ranges_ends_at_them(truck, far):
    """With the file's value of one parameter out of reach the nearest set still lies inside the cube."""
    space = truck.space
    start = space.start.copy()
    start[space.names.index("mS")] = space.upper[space.names.index("mS")]
    moved = replace(truck, space=replace(space, start=start))
    found = moved.space.unit(nearest_equivalent(fit_at(moved, far.values)).values)
    assert ((found >= 0) & (found <= 1)).all()
    assert np.linalg.norm(found - moved.space.unit(start)) < np.linalg.norm(space.unit(far.values) - moved.space.unit(start))


def test_what_facts_say_is_kept(truck, far, tmp_path):
    weight = of_trial(truck, far, static_loads).axles["axle1"]
    (tmp_path / "facts.yaml").write_text(f"axle_weights: {{axle1: {{value: {weight} N, uncertainty: 500 N}}}}\n", encoding="utf-8")
    found = nearest_equivalent(far, load_prior_data(tmp_path / "facts.yaml", truck))
    assert of_trial(truck, found, static_loads).axles["axle1"] == pytest.approx(weight, abs=1.0)
    assert np.linalg.norm(truck.space.unit(found.values) - truck.space.unit(truck.space.start)) > 0.05


def test_a_vehicle_that_is_told_in_full_stays_where_it_is(tmp_path):
    problem = make_problem(load_trials([write_run(tmp_path, "hump", sedan_truth())]))
    fit = fit_at(problem, 1.02 * problem.space.start)
    assert nearest_equivalent(fit) is fit
