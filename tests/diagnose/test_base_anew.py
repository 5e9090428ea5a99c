"""A base that locked in a wrong minimum is fitted anew; one that is good, without strain, or no better anew, stays as it is."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from tests.diagnose.conftest import HUMPS
from vehgen.diagnose.detect import detection as detecting
from vehgen.diagnose.fits import base_anew as module
from vehgen.diagnose.fits.base_anew import base_anew
from vehgen.diagnose.fits.model_fit import evaluate_fit
from vehgen.fit.chain_estimate import ChainEstimate
from vehgen.fit.chain_losses import ChainFit
from vehgen.fit.recorders import FoundRecorder
from vehgen.measure.acquisition import AcquisitionChain


@pytest.fixture(scope="module")
def detection(detection_of):
    """Of a sedan that hides nothing."""
    return detection_of(runs=HUMPS)


def led_astray(base, validation_runs, noises):
    """Return a base with the speed of every run at its bound, as a fit that locked in a cycle off leaves it."""
    fit = base.least_squares
    at = [4.0 if item.name == "speed" else number for item, number in zip(fit.conditions(), fit.misfit.split(fit.x)[1], strict=True)]
    moved = replace(fit, x=np.concatenate([fit.x[: fit.misfit.n_parameters], at]), linearisation=None)
    return evaluate_fit((), moved, validation_runs, noises)


@pytest.fixture(scope="module")
def astray(detection):
    return led_astray(detection.base, detection.validation_runs, detection.floor.noises)


def again(base, detection):
    return base_anew(base, detection.validation_runs, detection.floor.noises, detection.band)


@pytest.mark.thorough
def test_a_base_that_is_astray_comes_back(detection, astray):
    assert astray.training > 10
    found = again(astray, detection)
    assert found.effects == ()
    assert found.training == pytest.approx(detection.base.training, rel=0.02)
    np.testing.assert_allclose(found.least_squares.values, detection.base.least_squares.values, rtol=0.01)


@pytest.mark.parametrize("kind", ["good", "without strain", "no better"])
def test_any_other_base_stays_as_it_is(detection, astray, monkeypatch, kind):
    tried = []
    monkeypatch.setattr(module, "fit_candidate", lambda *_, **__: tried.append(1))
    monkeypatch.setattr(module, "is_strained", lambda _: kind != "without strain")
    base = detection.base if kind == "good" else astray
    assert again(base, detection) is base
    assert len(tried) == (kind == "no better")


@pytest.mark.thorough
def test_a_base_that_another_noise_led_astray_comes_back(detection, trials_of, monkeypatch):
    """The first fit of a detection is good; what begins from it, beside noise that was found from it, is not."""
    plain = detecting.fit_base

    def misled(problem, validation_runs, noises, band, begin=None, **options):
        fit = plain(problem, validation_runs, noises, band, begin, **options)
        return fit if begin is None else led_astray(fit, validation_runs, noises)

    monkeypatch.setattr(detecting, "fit_base", misled)
    monkeypatch.setattr(detecting, "split_by_gap", lambda base, trials: None)
    found = detecting.detect(trials_of(runs=HUMPS))
    assert found.base.training == pytest.approx(detection.base.training, rel=0.02)


def recorder_of(stands, *others):
    """Return a recorder of cut-offs [Hz], with other chains of cut-offs and losses beside it."""
    best, *beside = (ChainFit(AcquisitionChain("butterworth", 4, cut_off), loss) for cut_off, loss in ((stands, 100.0), *others))
    return FoundRecorder(ChainEstimate(best, tuple(beside), 1.0, True), (0.5, 25.0), False, ("F_az",))


@pytest.mark.parametrize(
    ("cut_off", "loss", "squares", "left", "strained", "found_then", "other"),
    [
        (8.0, 110.0, 60.0, 1.9, True, 7.9, 7.9),
        (8.0, 110.0, 60.0, 1.9, True, 43.0, 8.0),
        (8.0, 110.0, 60.0, 1.9, False, 7.9, None),
        (8.0, 110.0, 80.0, 1.9, True, 7.9, None),
        (8.0, 110.0, 60.0, 2.1, True, 7.9, None),
        (8.0, 140.0, 60.0, 1.9, True, 7.9, None),
        (42.0, 110.0, 60.0, 1.9, True, 7.9, None),
    ],
    ids=["clearly better", "found elsewhere then", "no strain", "hardly better", "much is left", "no rival", "as usual"],
)
def test_a_strained_base_is_begun_anew_with_a_low_pass_that_does_as_well(
    monkeypatch, detection, cut_off, loss, squares, left, strained, found_then, other
):
    """A truck's base had bent to what a low-pass at 8 Hz took off, at ten edges of its range, and no other one was found from there.

    Where much is left, something else is missing: a tyre's footprint had been taken for a low-pass at 4 Hz, by which it was not found.
    """
    anew, asked = SimpleNamespace(squares=squares, training=left, least_squares=SimpleNamespace(misfit=None, x=None)), []

    def recorded(recorder, problem, validation_runs, noises, begin):
        asked.append((recorder.chain.cut_off, begin))
        return problem, list(validation_runs), anew

    monkeypatch.setattr(detecting, "_recorded", recorded)
    monkeypatch.setattr(detecting, "is_strained", lambda fit: strained)
    monkeypatch.setattr(detecting, "find_recorder", lambda misfit, x, channels, band: recorder_of(found_then))
    base = SimpleNamespace(squares=100.0, least_squares=None)
    runs = detection.problem, detection.validation_runs
    found = detecting._rival(recorder_of(43.0, (cut_off, loss)), *runs, detection.floor.noises, base, detection.band)
    assert (found and found[0].chain.cut_off) == other
    assert asked[:1] == ([(8.0, None)] if strained and loss < 130.0 and cut_off < 35.0 else [])
