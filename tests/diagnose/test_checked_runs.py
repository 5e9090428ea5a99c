"""Validation runs are laid over their recordings where the errors of another model's fit to them lead astray."""

from dataclasses import replace

import numpy as np
import pytest

from tests.diagnose.conftest import HUMPS
from vehgen.diagnose.fits import model_fit as module
from vehgen.diagnose.fits.model_fit import evaluate_fit


@pytest.fixture(scope="module")
def detection(detection_of):
    """Of a sedan that hides nothing."""
    return detection_of(runs=HUMPS)


def with_clocks(fit, sigmas):
    """Return a fit to runs whose clocks are off by so many standard deviations."""
    at = [sigmas if item.name == "delay" else number for item, number in zip(fit.conditions(), fit.misfit.split(fit.x)[1], strict=True)]
    return replace(fit, x=np.concatenate([fit.x[: fit.misfit.n_unknowns - len(at)], at]), linearisation=None)


def checked(detection, near):
    return evaluate_fit((), detection.base.least_squares, detection.validation_runs, detection.floor.noises, near=(near,))


def test_runs_whose_phase_another_model_had_lost_are_laid_over_their_recordings(detection, monkeypatch):
    near = with_clocks(detection.base.validation_fit, -4.0)
    found = checked(detection, near)
    assert found.validation == pytest.approx(detection.base.validation, rel=0.02)
    monkeypatch.setattr(module, "MUCH_WORSE", np.inf)
    assert checked(detection, near).validation > 1.5


def test_errors_that_are_right_serve_without_another_fit(detection, monkeypatch):
    fits = []
    plain = module.fit_least_squares

    def counted(*arguments, **options):
        fits.append(options["start"])
        return plain(*arguments, **options)

    monkeypatch.setattr(module, "fit_least_squares", counted)
    found = checked(detection, detection.base.validation_fit)
    assert len(fits) == 1
    assert found.validation == pytest.approx(detection.base.validation, rel=0.02)
