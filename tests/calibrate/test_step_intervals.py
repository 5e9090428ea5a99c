"""Intervals of a calibration in two steps: what the first one froze is no more certain for that."""

import numpy as np
import pytest

from tests.calibrate.trucks import fit_at, truck_problem
from tests.fit.recordings import sedan_truth, write_run
from vehgen.calibrate.calibration import Settings, StepResult, calibrate_problem
from vehgen.calibrate.genetic import GeneticSearch
from vehgen.calibrate.identifiability import find_structure
from vehgen.calibrate.intervals import Frozen, Uncertainty, _with_frozen
from vehgen.calibrate.methods import plan
from vehgen.calibrate.step_intervals import step_uncertainties
from vehgen.calibrate.summary import summarise
from vehgen.fit.prior_data import load_prior_data
from vehgen.fit.problem import make_problem
from vehgen.fit.trial import load_trials

TRUTH = sedan_truth()


def test_two_linear_steps_have_the_covariance_of_their_estimators():
    """Each step is a matrix that maps recordings to estimates, so that both estimates' covariance is a product of matrices."""
    random = np.random.default_rng(1)
    first, second = random.standard_normal((60, 5)), random.standard_normal((80, 5))
    kept, fitted = [3, 0], [1, 2, 4]
    of_first = np.linalg.pinv(first)[kept]
    of_second = np.linalg.pinv(second[:, fitted])
    both = np.zeros((5, 140))
    both[kept, :60] = of_first
    both[fitted, 60:] = of_second
    both[fitted, :60] = -of_second @ second[:, kept] @ of_first
    covariance = both @ both.T
    whole = first.T @ first
    cross, others = whole[np.ix_(kept, fitted)], whole[np.ix_(fitted, fitted)]
    told = Frozen(("d", "a"), whole[np.ix_(kept, kept)] - cross @ np.linalg.solve(others, cross.T))
    found = _with_frozen(second.T @ second, ("a", "b", "c", "d", "e"), told)
    assert np.linalg.inv(found) == pytest.approx(covariance, rel=0.02, abs=2e-4)  # a little is known of all parameters beforehand
    assert np.linalg.inv(second.T @ second) != pytest.approx(covariance, rel=0.1)


@pytest.fixture(scope="module")
def truck(tmp_path_factory):
    return truck_problem(tmp_path_factory.mktemp("truck"))


def ended_at_the_start(problem):
    """Return what two steps over a truck's sensors would be that had ended where they began."""
    values, results = dict(zip(problem.space.names, problem.space.start.tolist(), strict=True)), []
    for step in plan(problem, "dhcm"):
        own = problem.of_sensors(step.sensors).searching(step.searched, {k: v for k, v in values.items() if k not in step.searched})
        results.append(StepResult(step, own, None, (fit_at(own, own.space.start),)))
    return results


def test_what_a_truck_s_two_steps_cannot_tell_has_no_interval_though_one_of_it_is_frozen(truck):
    """All masses, stiffnesses and dampings may grow together: what is kept from the first sensor does not tell how large they are."""
    results = ended_at_the_start(truck)
    _, both = step_uncertainties(truck, results)
    alone = Uncertainty(results[1].fits[0], find_structure(results[1].problem, results[1].problem.space.start))
    assert {item.name for item in alone.parameters() if item.low is not None} >= {"mS", "k2", "kt5"}
    assert {item.name for item in both.parameters() if item.low is not None}.isdisjoint({"mS", "m1", "k1", "k2", "kt5"})
    ratio = both.combination("k2/(mT + mS)")
    assert ratio.low < ratio.value < ratio.high
    (hop, _), (before, _) = both.frequencies()[-1], alone.frequencies()[-1]
    assert before.value == pytest.approx(hop.value)
    assert hop.high - hop.low > 10 * (before.high - before.low)


def test_facts_tell_what_two_steps_cannot(truck, tmp_path):
    (tmp_path / "facts.yaml").write_text("parameters: {mS: {value: 38 t, uncertainty: 0.2 t}}\n", encoding="utf-8")
    facts = load_prior_data(tmp_path / "facts.yaml", truck)
    _, both = step_uncertainties(truck, ended_at_the_start(truck), facts)
    assert all(item.low is not None for item in both.parameters() if item.name in ("k1", "k2", "mS"))


@pytest.fixture(scope="module")
def five(tmp_path_factory):
    """Five calibrations of a sedan in two steps, polished from the file's values, each of other recordings."""
    folder, found = tmp_path_factory.mktemp("runs"), []
    for seed in range(5):
        runs = [write_run(folder, f"r{seed}{speed}", TRUTH, speed, seed=10 * seed + int(speed), rough=4e-4) for speed in (1.5, 2.5)]
        problem = make_problem(load_trials(runs))
        found.append(calibrate_problem(problem, Settings("dhcm", search=GeneticSearch(1, 10, 0), starts=2)))
    return found


@pytest.mark.slow
def test_intervals_of_two_steps_cover_the_truth(five):
    covered, as_if_known = [], []
    for found in five:
        both = step_uncertainties(found.problem, found.steps)[-1]
        last = found.steps[-1]
        alone = Uncertainty(last.fits[0], find_structure(last.problem, last.fits[0].values))
        covered += [item.covers(TRUTH[item.name]) for item in both.parameters()]
        as_if_known += [item.covers(TRUTH[item.name]) for item in alone.parameters()]
    assert len(covered) == 5 * five[0].problem.space.size
    assert 0.8 <= np.mean(covered) <= 1.0
    assert np.mean(as_if_known) < np.mean(covered) - 0.05


@pytest.mark.slow
def test_a_bootstrap_of_two_steps_strays_as_far_as_their_intervals_say(five):
    outcome = summarise(five[0], combinations=["kf/mH"], replicates=8)
    widths = [np.ptp(outcome.bootstrap[f"{mode.name} [Hz]"].interval) / np.ptp(mode.interval) for mode in outcome.modes]
    assert 0.5 < np.median(widths) < 1.6
    assert all(item.interval is not None for item in outcome.parameters.values())
    assert {item.step for item in outcome.parameters.values()} == {"sensor F", "sensor R"}
