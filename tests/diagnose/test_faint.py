"""Effects that chi does not show: told by the likelihood, on runs that no fit has seen, too; and none where nothing is hidden."""

from dataclasses import replace
from types import SimpleNamespace

import pytest
from benchmarks.hidden_effects.generator import Effect

from tests.diagnose.conftest import HUMPS
from vehgen.diagnose import thresholds as limit
from vehgen.diagnose import without_gap
from vehgen.diagnose.fits.candidate import list_candidates
from vehgen.diagnose.pipeline import diagnose_trials
from vehgen.diagnose.select import criteria, faint
from vehgen.diagnose.select.criteria import tied
from vehgen.diagnose.select.faint import faint_exchange, faint_look_again, faint_round, faintly_told
from vehgen.diagnose.select.fitter import Fitter
from vehgen.diagnose.select.search import LOOKED_AT_AGAIN, fit_leading_again
from vehgen.effects import EFFECTS
from vehgen.fit.adjustments import Gain
from vehgen.report.pages.diagnosis_page import diagnosis_page

UNLIKE = Effect("asymmetric_damping", "rear", {"ratio": 0.975})
"""A damper that resists compression a fortieth less than extension."""
MUCH_LOWER = {"squares": -1e9, "n_residuals": 1, "last": SimpleNamespace(effect=SimpleNamespace(n_numbers=lambda runs: 0))}
MUCH_LOWER["least_squares"] = SimpleNamespace(misfit=SimpleNamespace(problem=SimpleNamespace(trials=())))
"""What stands for a fit of freed base parameters alone that lets -2 ln L fall without end."""
NAMES = ("asymmetric_damping", "quadratic_damping", "sensor_gain")


def candidates_of(detection):
    return list_candidates(detection.trials[0].run.vehicle, detection.trials, [EFFECTS[name] for name in NAMES], detection.floor.noises)


@pytest.mark.slow
def test_an_effect_that_chi_does_not_show_is_named(trials_of, detection_of):
    detection = detection_of(UNLIKE, runs=HUMPS)
    assert detection.is_quiet
    found = diagnose_trials(trials_of(UNLIKE, runs=HUMPS), [EFFECTS[name] for name in NAMES])
    (told,) = found.verdict.effects
    assert (found.verdict.verdict, told.name, told.place) == ("named", "asymmetric_damping", "rear")
    low, high = told.parameters["ratio"].interval
    assert low < 0.975 < high
    assert any("chi hardly shows a gap" in note for note in found.verdict.notes)
    assert len(found.evidence.rounds) == 1
    assert "No place was tested" in diagnosis_page(found)


def test_none_is_told_where_nothing_is_hidden(detection_of):
    detection = detection_of(runs=HUMPS)
    found, again = faint_look_again(faint_round(detection, candidates_of(detection)), detection)
    assert again is detection
    assert faintly_told(found, again) is None


@pytest.mark.thorough
@pytest.mark.parametrize(
    "spoil",
    [
        lambda monkeypatch: monkeypatch.setattr(limit, "FAINT_FALL", 1e9),
        lambda monkeypatch: monkeypatch.setattr(limit, "FAINT_VALIDATION", 1e9),
        lambda monkeypatch: monkeypatch.setattr(faint, "surely_falls", lambda *_: False),
        lambda monkeypatch: monkeypatch.setattr(faint, "is_told", lambda _: False),
        lambda monkeypatch: monkeypatch.setattr(faint, "like_a_placebo_law", lambda *_: True),
        lambda monkeypatch: monkeypatch.setattr(faint, "fitted_freed", lambda names, fit: SimpleNamespace(**MUCH_LOWER)),
    ],
    ids=["small fall", "not on validation runs", "by chance there", "size unknown", "as a random law", "as its freed damping"],
)
def test_none_is_told_unless_all_speaks_for_it(detection_of, found_of, monkeypatch, spoil):
    detection, found = detection_of(UNLIKE, runs=HUMPS), found_of
    assert faintly_told(found, detection).last.label == "asymmetric_damping at rear"
    spoil(monkeypatch)
    assert faintly_told(found, detection) is None


def at_a_bound(fit):
    x = fit.least_squares.x.copy()
    x[0] = 1.0
    return replace(fit, least_squares=replace(fit.least_squares, x=x))


@pytest.mark.thorough
def test_none_is_told_that_leaves_a_parameter_at_its_bound(detection_of, found_of):
    detection, bent = detection_of(UNLIKE, runs=HUMPS), at_a_bound(found_of.fits[0])
    assert bent.least_squares.on_bound
    assert faintly_told(replace(found_of, fits=(bent, *found_of.fits[1:])), detection) is None


@pytest.mark.thorough
def test_what_falls_as_far_within_its_bounds_goes_before_what_ends_at_one(found_of, monkeypatch):
    """As relaxation falls a little farther than a damper's mount, with a damper weaker than its file allows."""
    best = found_of.fits[0]
    inside = replace(best, effects=(replace(best.last, effect=EFFECTS["quadratic_damping"]),))
    bent = at_a_bound(best)
    falls = {id(bent): (1000.0, 300.0), id(inside): (850.0, 310.0)}
    monkeypatch.setattr(criteria, "fall", lambda found, fit: falls[id(fit)][0])
    monkeypatch.setattr(criteria, "validation_fall", lambda base, fit: falls[id(fit)][1])
    assert faint._likeliest_first(found_of, [bent, inside]) == [inside, bent]
    falls[id(inside)] = (700.0, 310.0)
    assert faint._likeliest_first(found_of, [bent, inside]) == [bent, inside]


@pytest.mark.thorough
def test_what_ends_at_a_bound_and_does_no_better_is_no_tie(found_of, monkeypatch):
    best = found_of.fits[0]
    rival = at_a_bound(replace(best, effects=(replace(best.last, effect=EFFECTS["quadratic_damping"]),)))
    monkeypatch.setattr(criteria, "falls_as_far", lambda found, fit, best: True)
    both = replace(found_of, fits=(best, rival))
    assert tied(both, best) == []
    assert tied(both, rival) == [best]
    bent = at_a_bound(best)
    assert tied(replace(both, fits=(bent, rival)), bent) == [rival]
    monkeypatch.setattr(criteria, "merit", lambda fit: 0.0 if fit is rival else 100.0)
    assert tied(both, best) == [rival]


@pytest.mark.thorough
def test_none_is_told_whose_number_ends_its_range(detection_of, found_of, monkeypatch):
    detection = detection_of(UNLIKE, runs=HUMPS)
    monkeypatch.setattr(type(found_of.fits[0].least_squares), "adjusted_to_bounds", property(lambda self: (Gain("F_az"),)))
    assert faintly_told(found_of, detection) is None


@pytest.mark.thorough
def test_laws_of_tyres_are_fitted_where_their_axles_parameters_are_at_bounds(detection_of, monkeypatch):
    detection = detection_of(runs=HUMPS)
    names = ("tyre_damping", "tyre_footprint", "relaxation")
    candidates = list_candidates(detection.trials[0].run.vehicle, detection.trials, [EFFECTS[name] for name in names])
    monkeypatch.setattr(faint, "FIRST_ORDER", 1e9)
    monkeypatch.setattr(faint, "FIRST_ORDER_OF_ERRORS", 1e9)
    assert faint_round(detection, candidates).fits == ()
    fit = detection.base.least_squares
    x = fit.x.copy()
    x[fit.misfit.problem.space.names.index("mr")] = 0.0
    bent = replace(detection, base=replace(detection.base, least_squares=replace(fit, x=x)))
    found = {item.last.label for item in faint_round(bent, candidates).fits}
    assert found == {"tyre_damping at rear", "tyre_damping at all tyres", "tyre_damping at each tyre"}


@pytest.fixture(scope="module")
def found_of(detection_of):
    """The fits beside a base that chi calls quiet."""
    detection = detection_of(UNLIKE, runs=HUMPS)
    return faint_round(detection, candidates_of(detection))


@pytest.mark.thorough
def test_a_tie_falls_nearly_as_far_on_both_kinds_of_runs(found_of, monkeypatch):
    best = found_of.fits[0]
    rival = replace(best, effects=(replace(best.last, effect=EFFECTS["quadratic_damping"]),))
    falls = {id(best): (1000.0, 300.0), id(rival): (850.0, 260.0)}
    monkeypatch.setattr(criteria, "fall", lambda found, fit: falls[id(fit)][0])
    monkeypatch.setattr(criteria, "validation_fall", lambda base, fit: falls[id(fit)][1])
    both = replace(found_of, fits=(best, rival))
    assert tied(both, best) == [rival]
    for numbers in ((750.0, 260.0), (850.0, 200.0)):
        falls[id(rival)] = numbers
        assert tied(both, best) == []


@pytest.mark.slow
def test_what_its_validation_run_does_not_show_is_checked_on_the_run_that_shows_it_most(trials_of, detection_of, found_of, monkeypatch):
    detection, best = detection_of(UNLIKE, runs=HUMPS), found_of.fits[0]
    shares = {trial.name: (detection.base.mean_squares[trial.name] - best.mean_squares[trial.name]) for trial in detection.trials}
    unchecked = replace(found_of.fits[1], validation=float("nan"), validation_fit=None)
    found, exchanged = faint_exchange(replace(found_of, fits=(best, unchecked)), detection)
    assert [fit.label for fit in found.fits] == [best.label]
    (checked,) = (trial.name for trial in exchanged.validation_runs)
    assert checked != detection.validation_runs[0].name
    assert shares[checked] == max(shares[trial.name] for trial in detection.problem.trials)
    assert faintly_told(found, exchanged).last.label == "asymmetric_damping at rear"
    monkeypatch.setattr(without_gap, "faintly_told", lambda round_, now: None if now is not exchanged else faintly_told(round_, now))
    monkeypatch.setattr(without_gap, "faint_exchange", lambda *_: (found, exchanged))
    told = diagnose_trials(trials_of(UNLIKE, runs=HUMPS), [EFFECTS[name] for name in NAMES])
    assert [(item.name, item.place) for item in told.verdict.effects] == [("asymmetric_damping", "rear")]


@pytest.mark.thorough
def test_all_that_fell_is_fitted_again_to_runs_that_changed_places(detection_of, found_of):
    """Contenders beyond the first few were weighed on the runs that had been fitted before, and not known on the run that is fitted now."""
    detection, best = detection_of(UNLIKE, runs=HUMPS), found_of.fits[0]
    found, exchanged = faint_exchange(replace(found_of, fits=(best,) * (LOOKED_AT_AGAIN + 2)), detection)
    fitted = {trial.name for trial in exchanged.problem.trials}
    assert len(found.fits) == LOOKED_AT_AGAIN + 2
    assert all({trial.name for trial in fit.least_squares.misfit.problem.trials} == fitted for fit in found.fits)
    fitter = Fitter(exchanged, exchanged.base, ())
    unchecked = replace(best, validation=float("nan"), validation_fit=None)
    again = fit_leading_again(fitter, (best,) * LOOKED_AT_AGAIN + (replace(best), unchecked), weigh=True)
    assert sum({trial.name for trial in fit.least_squares.misfit.problem.trials} == fitted for fit in again) == LOOKED_AT_AGAIN + 1


@pytest.mark.thorough
def test_no_fit_within_another_band_is_left_beside_those_that_were_fitted_again(detection_of, found_of):
    """A fit within 20 Hz was held for a tie of one within 40 Hz, as another recorder was found: its lines are half as many."""
    detection, best = detection_of(UNLIKE, runs=HUMPS), found_of.fits[0]
    low, high = detection.band
    wider = replace(detection, band=(low, 0.75 * high))
    fits = (best,) * LOOKED_AT_AGAIN + (replace(best, effects=(replace(best.last, effect=EFFECTS["quadratic_damping"]),)),)
    for now, same in ((detection, True), (wider, False)):
        again = fit_leading_again(Fitter(now, now.base, ()), fits, weigh=False)
        assert {fit.least_squares.misfit.band for fit in again} == {now.band}
        assert any(fit is fits[-1] for fit in again) == same


@pytest.mark.thorough
def test_runs_do_not_change_places_for_what_falls_too_little_or_for_what_the_kept_run_speaks_against(detection_of, found_of, monkeypatch):
    detection = detection_of(UNLIKE, runs=HUMPS)
    monkeypatch.setattr(faint, "validation_fall", lambda *_: -1.0)
    assert faint_exchange(found_of, detection) is None
    monkeypatch.undo()
    best = found_of.fits[0]
    of_all_runs = replace(best, effects=(replace(best.last, effect=EFFECTS["tyre_footprint"]),))
    assert faint_exchange(replace(found_of, fits=(of_all_runs,)), detection) is None, "every run may tell it"
    monkeypatch.setattr(limit, "FAINT_FALL", 1e9)
    assert faint_exchange(found_of, detection) is None
    assert faint_exchange(replace(found_of, fits=()), detection) is None


def test_laws_that_are_fitted_are_of_many_kinds():
    """A cab on springs gained less to the first order than one law did at several axles, and was never fitted."""
    ranked = [(SimpleNamespace(effect=SimpleNamespace(name=name), number=i), ()) for i, name in enumerate("aaaabaacbcdef")]
    assert [item.number for item, _ in faint._of_many_kinds(ranked)] == [0, 1, 2, 3, 4, 7, 10]
    assert [item.number for item, _ in faint._of_many_kinds(ranked[4:])] == [4, 5, 6, 7, 10, 11, 12]
