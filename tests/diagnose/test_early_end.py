"""A search ends early where one candidate settles the gap, and not where none does."""

from dataclasses import replace

import numpy as np
import pytest

from tests.diagnose.conftest import CUBIC, HUMPS
from vehgen.diagnose.fits.candidate import list_candidates
from vehgen.diagnose.fits.multi_start import BESIDE_SETTLED, HOPELESS
from vehgen.diagnose.fits.screening import FirstOrderGains
from vehgen.diagnose.localise.unknown_force import Place, PlaceResult
from vehgen.diagnose.select import early_end
from vehgen.diagnose.select.early_end import settle
from vehgen.diagnose.select.fitter import Fitter
from vehgen.diagnose.select.ranking import numbers_at_ends
from vehgen.diagnose.select.search import fit_candidates
from vehgen.effects import EFFECTS
from vehgen.fit.misfit import Misfit

NAMES = ("cubic_stiffness", "quadratic_damping", "hysteresis", "progressive_stiffness", "sensor_gain")


def list_candidates_of(detection, *names):
    return list_candidates(detection.trials[0].run.vehicle, detection.trials, [EFFECTS[name] for name in names])


def settled(detection, names=NAMES, kept_at="", nowhere=False):
    candidates = list_candidates_of(detection, *names)
    places = [Place("channel", "az", channels=("az",))] if nowhere else [Place("body", "body", ({0: 1.0}, {1: 1.0}))]
    fitter = Fitter(detection, detection.base, [PlaceResult(place, 1.0, 2, detection.base.least_squares.x) for place in places])
    fits = []
    return candidates, fits, settle(fitter, fitter.first_order_gains(), candidates, fits.append, kept_at=kept_at)


@pytest.mark.thorough
def test_the_law_that_was_hidden_settles_and_leaves_only_its_rivals(detection_of):
    candidates, fits, rivals = settled(detection_of(CUBIC, runs=HUMPS))
    assert fits[-1].last.label == "cubic_stiffness at rear"
    assert fits[-1].training < 1.06**2
    assert fits[-1].last not in rivals
    assert len(fits) + len(rivals) < len(candidates) / 2


@pytest.mark.thorough
@pytest.mark.parametrize(("ends", "hopeless"), [(True, BESIDE_SETTLED), (False, HOPELESS)])
def test_beside_what_settles_a_gap_only_what_leaves_next_to_nothing_is_refined(detection_of, monkeypatch, ends, hopeless):
    detection = detection_of(CUBIC, runs=HUMPS)
    monkeypatch.setattr(early_end, "_settles", lambda fit: ends)
    fitter = Fitter(detection, detection.base, ())
    candidates = list_candidates_of(detection, "cubic_stiffness")
    settle(fitter, fitter.first_order_gains(), candidates, lambda fit: None)
    assert fitter.hopeless == hopeless
    refined = [fitter.fit(item, checked=True, slow_first=False) for item in candidates if item.place == "front"]
    assert [np.isfinite(fit.validation) for fit in refined] == [False]
    fitter.hopeless = np.inf
    refined = [fitter.fit(item, checked=True, slow_first=False) for item in candidates if item.place == "front"]
    assert [np.isfinite(fit.validation) for fit in refined] == [True]


@pytest.mark.parametrize(("left", "hopeless"), [(0.01, 0.1), (0.05, 0.1), (0.2, 0.4), (0.4, 0.5)])
def test_what_leaves_about_as_much_as_what_settles_a_gap_is_refined_beside_it(detection_of, monkeypatch, left, hopeless):
    detection = detection_of(CUBIC, runs=HUMPS)
    base = detection.base
    fitter = Fitter(detection, base, ())
    found = replace(base, training=1 + left * (base.training - 1), effects=(list_candidates_of(detection, "cubic_stiffness")[0],))
    monkeypatch.setattr(early_end, "_settles", lambda fit: True)
    monkeypatch.setattr(early_end, "idle_instead", lambda fit, fit_without: None)
    monkeypatch.setattr(fitter, "fit_all_begun", lambda begun, runner: iter([found]))
    settle(fitter, fitter.first_order_gains(), list_candidates_of(detection, "cubic_stiffness"), lambda fit: None)
    assert fitter.hopeless == pytest.approx(hopeless)


@pytest.mark.thorough
def test_what_was_fitted_until_ctrl_c_is_kept(detection_of, monkeypatch):
    detection = detection_of(CUBIC, runs=HUMPS)
    candidates = list_candidates_of(detection, *NAMES)
    seen = []

    def stop(fit):
        seen.append(fit.label)
        raise KeyboardInterrupt

    monkeypatch.setattr(early_end, "_settles", stop)
    fits, stopped = fit_candidates(detection, detection.base, (), candidates, lambda *told: None)
    assert stopped
    assert [fit.label for fit in fits] == seen


@pytest.mark.thorough
def test_laws_at_a_place_that_is_kept_stay_rivals(detection_of):
    candidates, fits, rivals = settled(detection_of(CUBIC, runs=HUMPS), kept_at="front")
    assert {item.label for item in candidates if item.place == "front"} <= {item.label for item in rivals}
    assert fits[-1].last.place == "rear"


@pytest.mark.thorough
@pytest.mark.parametrize(("share", "stays"), [(0.68, False), (0.72, True)])
def test_what_shakes_the_vehicle_is_no_rival_of_what_gained_far_more_even_at_a_place_that_is_kept(detection_of, monkeypatch, share, stays):
    """What it gains is known to the first order."""
    detection = detection_of(CUBIC, runs=HUMPS)
    took = detection.base.squares - settled(detection)[1][-1].squares
    gains = {"cubic_stiffness at rear": took, "wheel_runout at front": share * took}
    monkeypatch.setattr(FirstOrderGains, "of", lambda self, item: (gains.get(item.label, 0.0), ()))
    monkeypatch.setattr(early_end, "MOST_AT_ONCE", 1)
    _, fits, rivals = settled(detection, ("cubic_stiffness", "wheel_runout"), kept_at="front")
    assert [fit.last.label for fit in fits] == ["cubic_stiffness at rear"]
    assert ("wheel_runout at front" in [item.label for item in rivals]) == stays


@pytest.mark.thorough
@pytest.mark.parametrize("nowhere", [True, False])
def test_laws_of_bodies_are_tried_at_once_where_no_single_force_explains_the_gap(detection_of, monkeypatch, nowhere):
    monkeypatch.setattr(early_end, "MOST_AT_ONCE", 1)
    monkeypatch.setattr(early_end, "_settles", lambda fit: False)
    _, fits, _ = settled(detection_of(CUBIC, runs=HUMPS), ("cubic_stiffness", "frame_bending", "tyre_footprint"), nowhere=nowhere)
    assert [fit.last.effect.name for fit in fits] == ["cubic_stiffness", "frame_bending"][: 1 + nowhere]


@pytest.mark.thorough
def test_special_cases_and_candidates_that_no_run_tells_apart_stay_rivals(detection_of):
    detection = detection_of(CUBIC, runs=HUMPS)
    names = ("sensor_delay", "dry_friction", "asymmetric_friction")
    listed = list_candidates_of(detection, *names)
    known = {item.label: item for item in listed}
    pairs = [("sensor_delay at F", "sensor_delay at R"), ("asymmetric_friction at rear", "dry_friction at rear")]
    assert all(
        early_end._is_inseparable(known[one], known[other]) and early_end._is_inseparable(known[other], known[one]) for one, other in pairs
    )
    assert not early_end._is_inseparable(known["dry_friction at front"], known["dry_friction at rear"])
    assert not early_end._is_inseparable(known["dry_friction at front"], known["sensor_delay at F"])


@pytest.mark.thorough
@pytest.mark.parametrize("limit", ["most", "strain"])
def test_nothing_is_left_out_where_none_settles(detection_of, monkeypatch, limit):
    if limit == "strain":
        monkeypatch.setattr(early_end, "UNSTRAINED", -1.0)
    names = NAMES if limit == "strain" else ("quadratic_damping", "sensor_gain")
    candidates, fits, rivals = settled(detection_of(CUBIC, runs=HUMPS), names)
    assert rivals == candidates
    assert len(fits) <= early_end.MOST_AT_ONCE


@pytest.mark.thorough
def test_an_effect_at_an_end_of_its_range_settles_nothing(detection_of):
    detection = detection_of(CUBIC, runs=HUMPS)
    _, fits, _ = settled(detection)
    best = fits[-1]
    assert early_end._settles(best)
    held = best.least_squares.x.copy()
    held[best.least_squares.misfit.n_parameters - 1] = 1.0
    assert not early_end._settles(replace(best, least_squares=replace(best.least_squares, x=held)))


def test_an_error_of_a_sensor_at_an_end_of_its_range_settles_nothing(detection_of):
    detection = detection_of(CUBIC, runs=HUMPS)
    fitter = Fitter(detection, detection.base, ())
    listed = list_candidates_of(detection, "sensor_tilt")
    fit = fitter.fit_at_once(next(item for item in listed if item.place == "F"))
    old = fit.least_squares
    shared = tuple(replace(item, high=float(value)) for item, value in zip(old.misfit.shared, old.misfit.adjusted(old.x), strict=True))
    held = Misfit(old.misfit.problem, old.misfit.noises, old.values, old.misfit.nuisances, old.misfit.band, shared)
    assert numbers_at_ends(fit) == []
    assert numbers_at_ends(replace(fit, least_squares=replace(old, misfit=held))) == [item.name for item in fit.last.effect.parameters]


@pytest.mark.slow
def test_beside_a_base_at_its_bounds_none_settles_that_does_no_more_than_what_it_set_free(detection_of, monkeypatch):
    detection = detection_of(CUBIC, runs=HUMPS)
    assert detection.base.least_squares.on_bound
    asked = []
    monkeypatch.setattr(early_end, "idle_instead", lambda fit, fit_without: asked.append(fit.label) or fit)
    candidates, _fits, left = settled(detection)
    assert left == candidates
    assert asked == ["cubic_stiffness at rear"]
    monkeypatch.setattr(type(detection.base.least_squares), "on_bound", ())
    assert len(settled(detection)[2]) < len(candidates)
    assert asked == ["cubic_stiffness at rear"]
