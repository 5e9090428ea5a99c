"""Dry friction: responses that jump, told by plain steps, their many minima, and what the place test learns in spite of them."""

import numpy as np
import pytest
from benchmarks.hidden_effects.generator import Case, Effect
from benchmarks.hidden_effects.generator.simulate import true_parameters

from tests.diagnose.conftest import RUNS
from vehgen.diagnose.localise.unknown_force import list_places
from vehgen.diagnose.localise.unknown_force import score_locations as place_test
from vehgen.diagnose.pipeline import diagnose_trials
from vehgen.diagnose.select.estimates import RunEstimate, disagreement
from vehgen.effects import EFFECTS

FRICTION = Effect("dry_friction", "front", {"force": 600.0})


@pytest.fixture(scope="module")
def found(trials_of):
    return diagnose_trials(trials_of(FRICTION), [EFFECTS["dry_friction"]])


@pytest.mark.slow
def test_friction_is_marked_as_jumping_and_its_steps_are_halved_once_at_most(found):
    base, friction = found.detection.base, found.chosen[-1]
    assert not any(trial.jumps for trial in base.least_squares.misfit.problem.trials)
    assert all(trial.jumps for trial in friction.least_squares.misfit.problem.trials)
    assert all(trial.scenario.dt >= 0.499e-3 for trial in friction.least_squares.misfit.problem.trials)


@pytest.mark.thorough
def test_at_the_truth_plain_steps_tell_the_recording_but_for_a_sample_next_to_a_jump(found):
    """The recording was made with steps of 0.05 ms by another integrator; over the rough road the friction jumps some hundred times."""
    misfit, x = found.chosen[-1].least_squares.misfit, found.chosen[-1].least_squares.x
    truth = true_parameters(Case("sedan2", effects=(FRICTION,), runs=RUNS, seed=3)) | {"dry_friction_front_force": 600.0}
    values = np.array([truth[name] for name in misfit.problem.space.names])
    x = np.concatenate([misfit.problem.space.unit(values), np.zeros(len(x) - len(values))])
    number = [trial.name for trial in misfit.problem.trials].index("rough")
    assert misfit.problem.trials[number].scenario.dt >= 0.499e-3
    whole = np.mean(np.abs(misfit.whitened_spectrum(x)[number]) ** 2)
    left = (misfit.problem.trials[number].recording.values - misfit.simulate(x)[number]) / misfit.noises["rough"].sigma
    assert whole < 1.7
    assert (np.abs(left) > 6).sum() <= 2
    assert np.median(np.abs(left)) < 0.75


@pytest.mark.thorough
def test_several_minima_are_tried_and_the_force_is_told_within_its_interval(found):
    fit = found.chosen[-1]
    assert fit.equivalent_minima
    force = found.verdict.effects[0].parameters["force"]
    assert force.interval[0] < 600.0 < force.interval[1]
    assert force.interval[1] - force.interval[0] < 60.0
    assert fit.training < 1.1


@pytest.mark.thorough
def test_the_place_test_leaves_parameters_that_the_effect_has_not_biased(found):
    detection = found.detection
    misfit, x = detection.base.least_squares.misfit, detection.base.least_squares.x
    place = next(item for item in list_places(misfit) if item.label == "suspension front")
    (result,) = place_test(misfit, x, [place])
    truth = true_parameters(Case("sedan2", effects=(FRICTION,), runs=RUNS, seed=3))
    space = misfit.problem.space
    values = dict(zip(space.names, space.values(misfit.split(result.x)[0]), strict=True))
    biased = dict(zip(space.names, detection.base.least_squares.values, strict=True))
    off = {name: abs(values[name] / truth[name] - 1) for name in ("kr", "cr", "mr", "ktr", "IZ", "Lf")}
    assert max(off.values()) < 0.05
    assert max(abs(biased[name] / truth[name] - 1) for name in off) > 0.05
    for name in ("kf", "cf"):  # hidden behind the unknown force: nothing is learnt of them
        assert values[name] == pytest.approx(space.start[space.names.index(name)], rel=0.1)


def test_runs_that_disagree_widen_the_interval_to_where_the_next_run_may_lie():
    random = np.random.default_rng(5)
    held = []
    for _ in range(400):
        asked = 10.0 + random.standard_normal(4)  # the last one is yet to come
        alone = [RunEstimate(str(i), "p", value, 1e-6) for i, value in enumerate(asked[:3])]
        held.append(abs(asked[3] - np.mean(asked[:3])) < disagreement(alone))
    assert 0.86 < np.mean(held) < 0.94


def test_runs_that_agree_within_their_errors_widen_nothing():
    random = np.random.default_rng(6)
    wide = []
    for _ in range(400):
        alone = [RunEstimate(str(i), "p", 10.0 + random.standard_normal(), 1.645) for i in range(3)]
        wide.append(disagreement(alone))
    assert np.mean(np.array(wide) == 0.0) > 0.5
    assert disagreement([RunEstimate("only", "p", 1.0, 0.1)]) == 0.0
