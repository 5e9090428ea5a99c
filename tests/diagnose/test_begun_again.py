"""A fit whose errors stand at their bounds is begun anew without them; any other one stays as it is."""

from dataclasses import replace

import numpy as np
import pytest

from tests.diagnose.conftest import RUNS
from vehgen.diagnose.fits.begun_again import without_strain
from vehgen.diagnose.fits.model_fit import OPTIONS
from vehgen.fit.least_squares import LeastSquaresFit, fit_least_squares

ROUGH = (RUNS[1], RUNS[3])
"""A hump, and a rough road, whose fits have many minima."""


@pytest.fixture(scope="module")
def fit(detection_of):
    """The base fitted to a hump and a rough road that hide nothing."""
    return detection_of(runs=ROUGH).base.least_squares


def strained(fit: LeastSquaresFit) -> LeastSquaresFit:
    """Return a fit whose rough run is as much lower than stated as it may be, its gains making up for it, and the rest fitted."""
    names = [(item.run, item.name) for item in fit.conditions()]
    at = {("rough", "height"): -4.0, ("", "gain"): -4.0}
    errors = np.array([at.get(name, number) for name, number in zip(names, fit.misfit.split(fit.x)[1], strict=True)])
    x = np.concatenate([fit.x[: fit.misfit.n_parameters], errors])
    residuals = fit.misfit.residuals(x)
    return LeastSquaresFit(fit.misfit, x, float(np.mean(residuals**2)), float((residuals**2).sum()))


@pytest.mark.thorough
def test_errors_at_their_bounds_are_begun_anew(fit):
    begun = strained(fit)
    found = without_strain(begun, ())
    assert begun.chi2 > 1.5
    assert found.loss < begun.loss
    assert found.chi2 == pytest.approx(fit.chi2, rel=0.02)
    assert all(abs(item.sigmas) < 3.9 for item in found.conditions())


@pytest.mark.thorough
def test_a_fit_without_strain_stays_as_it_is(fit):
    plain = fit_least_squares(fit.misfit.problem, fit.misfit.split(fit.x)[0], replace(OPTIONS, max_steps=2), noises=fit.misfit.noises)
    assert without_strain(plain, ()) is plain
