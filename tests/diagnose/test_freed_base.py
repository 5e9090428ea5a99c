"""Dampers far from the file's value, and dampers on soft mounts: told apart, not taken for one another."""

import re
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from benchmarks.hidden_effects.generator import Effect, nominal

from tests.diagnose.conftest import CUBIC, HUMPS
from vehgen.diagnose.decision import Decision
from vehgen.diagnose.fits.candidate import build_problem, carried, freed_alone, list_candidates
from vehgen.diagnose.fits.model_fit import BASE_PRIOR_SIGMA, base_priors, narrow
from vehgen.diagnose.pipeline import diagnose_trials
from vehgen.diagnose.select.fitter import Fitter
from vehgen.diagnose.select.freed_base import split_idle
from vehgen.diagnose.select.ranking import SearchRound
from vehgen.effects import EFFECTS, EffectLocator
from vehgen.fit.least_squares import WEAK_PRIOR_SIGMA
from vehgen.fit.problem import make_problem
from vehgen.simulate import SimulatorPool
from vehgen.vehicle import load_vehicle

SERIES = [EFFECTS[name] for name in ("damper_mount", "relaxation", "quadratic_damping", "asymmetric_damping")]


@pytest.mark.slow
def test_a_damper_of_twice_the_files_value_is_no_missing_effect(trials_of):
    """A law beside a damping that is free to leave the file would fit as well as that damping alone.

    That a parameter far from the file's is told in place of an effect, test_groups.py asks of a tyre's stiffness in half the time.
    """
    weak = {**nominal("sedan2"), "cf": 2 * nominal("sedan2")["cf"]}
    found = diagnose_trials(trials_of(parameters=weak), SERIES)
    assert found.verdict.verdict == "insufficient_data"
    ratio = float(re.search(r"cf of ([\d.]+) times", found.verdict.reason)[1])
    assert ratio == pytest.approx(2.0, rel=0.02)
    assert not found.verdict.effects


@pytest.mark.slow
def test_a_damper_on_a_soft_mount_is_named_with_its_stiffness(trials_of):
    """Its spring stands in series; a branch beside the dashpot leaves more, however far the dashpot may fall."""
    hidden = Effect("damper_mount", "front", {"time": 0.012})
    found = diagnose_trials(trials_of(hidden, parameters=nominal("sedan2")), SERIES)
    effect = found.verdict.effects[0]
    assert found.verdict.verdict in ("named", "ambiguous")
    assert (effect.name, effect.place) == ("damper_mount", "front")
    assert {(item.name, item.place) for item in found.verdict.effects[1:]} <= {("relaxation", "front")}
    low, high = effect.parameters["k"].interval
    assert low < nominal("sedan2")["cf"] / 0.012 < high
    others = [fit.training for fit in found.rounds[0].fits if fit.effects[-1].effect.name != "damper_mount"]
    assert min(others) > found.chosen[-1].training + 0.03
    assert found.chosen[-1].training < 1.05


@pytest.mark.slow
def test_a_freed_damper_that_leaves_the_gap_is_not_to_blame(trials_of):
    """No damper of any size imitates a spring: then neither do effects that free one, and nothing is said against the file."""
    found = diagnose_trials(trials_of(CUBIC, runs=HUMPS), [EFFECTS["damper_mount"]])
    assert found.verdict.verdict == "not_in_library"


@pytest.mark.parametrize(("left", "verdict"), [(1.07, "too_weak"), (1.00, "insufficient_data")])
def test_a_freed_parameter_is_blamed_only_for_the_gap_that_it_closes(detection_of, monkeypatch, left, verdict):
    """A gap of chi 1.08, beside which every effect does no more than a freed parameter alone."""
    detection = detection_of(runs=HUMPS)
    base = replace(detection.base, training=1.08**2, mean_squares=dict.fromkeys(detection.base.mean_squares, 1.08**2))
    detection = replace(detection, base=base)
    freed = replace(base, effects=(freed_alone(("cf",)),), training=left**2)
    monkeypatch.setattr(Decision, "_search_round", lambda self, current: SearchRound(current, (), (), (), (freed,)))
    found = Decision(detection, SERIES, False, lambda *_: None)._explain_gap().verdict
    assert found.verdict == verdict
    assert ("times the file's value" in found.reason) == (verdict == "insufficient_data")


@pytest.fixture(scope="module")
def posed(trials_of):
    trials = trials_of()
    base = narrow(make_problem(trials))
    candidate = next(item for item in list_candidates(trials[0].run.vehicle, trials, [EFFECTS["damper_mount"]]) if item.place == "front")
    locator = EffectLocator(trials[0].run.vehicle, dict(trials[0].values))
    return base, candidate, build_problem(candidate, base, locator, SimulatorPool())


def test_a_freed_parameter_is_searched_in_the_files_range_and_others_are_not(posed):
    base, candidate, problem = posed
    ranges = load_vehicle("sedan2").ranges()
    for i, name in enumerate(base.space.names):
        bounds = problem.space.lower[i], problem.space.upper[i]
        assert bounds == (ranges["cf"] if name == "cf" else (base.space.lower[i], base.space.upper[i]))
    priors = dict(zip(base.space.names, base_priors(base.space.names, [candidate]), strict=True))
    assert priors.pop("cf") == WEAK_PRIOR_SIGMA
    assert set(priors.values()) == {BASE_PRIOR_SIGMA}


def test_a_point_keeps_its_values_in_the_wider_space(posed):
    base, _, problem = posed
    unit = np.random.default_rng(3).uniform(0.1, 0.9, base.space.size)
    wide = carried(unit, base.space, problem.space)
    full = np.concatenate([wide, [0.5]])
    assert problem.space.values(full)[:-1] == pytest.approx(base.space.values(unit), rel=1e-12)


def fitted(training, squares, numbers=2):
    effect = SimpleNamespace(n_numbers=lambda runs: numbers)
    misfit = SimpleNamespace(problem=SimpleNamespace(trials=()))
    return SimpleNamespace(
        training=training,
        squares=squares,
        n_residuals=1000,
        counts={"run": 1000},
        last=SimpleNamespace(freed=("kt3", "m3"), effect=effect),
        least_squares=SimpleNamespace(misfit=misfit),
    )


@pytest.mark.parametrize(("fall", "idle"), [(100.0, True), (160.0, True), (170.0, False)])
def test_beside_freed_parameters_that_leave_noise_an_effect_does_as_much_more_as_one_that_chi_does_not_show(fall, idle):
    """A fall of 150 in -2 ln L beyond the price of its numbers, 13.8 here; chance alone would take less than 20."""
    law, freed = fitted(0.8, 800.0), fitted(0.95, 800.0 + fall, numbers=0)
    for one, without in ((lambda candidate: freed, None), (lambda candidate: None, lambda fit: freed)):
        kept, left = split_idle([law], one, 1, law.last.freed if without else (), without)
        assert (kept, left) == (([], [freed]) if idle else ([law], []))


@pytest.mark.parametrize(("best", "left"), [(1.0, 9.0), (1.0, 1.5), (4.0, 9.0)])
def test_beside_a_fit_that_leaves_noise_nobody_asks_what_leaves_twice_as_much(best, left):
    first, other = fitted(best, 1000 * best), fitted(left, 1000 * left)
    first.last.freed, asked = (), []
    kept, _ = split_idle([first, other], lambda candidate: asked.append(candidate.freed), 3)
    assert kept == [first, other]
    assert bool(asked) == (best > 1.2 or left < 2 * best)


def test_nothing_is_sought_from_where_a_fit_ended_that_freed_nothing():
    law = fitted(0.8, 800.0)
    law.last.freed = ()
    assert split_idle([law], lambda candidate: None, 1, ("mr",), lambda fit: fitted(0.8, 700.0)) == ([law], [])


@pytest.mark.thorough
def test_freed_parameters_begin_where_the_effects_fit_ended(detection_of):
    detection = detection_of(CUBIC, runs=HUMPS)
    fitter = Fitter(detection, detection.base, ())
    candidates = list_candidates(detection.trials[0].run.vehicle, detection.trials, [EFFECTS["cubic_stiffness"]])
    law = fitter.fit_at_once(next(item for item in candidates if item.place == "rear"))
    freed = fitter.fit_without(law)
    assert freed.last.freed == law.last.freed == ("kr",)
    assert freed.n_effect_parameters == 0
    assert freed.training > 10 * law.training
