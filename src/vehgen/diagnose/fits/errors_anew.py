"""A fit whose errors of runs and sensors stand at their bounds, begun anew without them.

A candidate is fitted from where the base's fit ended, which had bent speeds, heights and gains to what it lacked. With the right law they
mostly find back, but a run over a rough road has many minima: its errors may stay at their bounds, and the run ill explained, while
errors that begin at none lead to the truth.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from vehgen.diagnose.fits.candidate import Candidate
from vehgen.diagnose.fits.model_fit import refine
from vehgen.fit.alignment import MOST_SIGMAS, align
from vehgen.fit.least_squares import LeastSquaresFit

STRAINED_SHARE = 0.99
"""An error of more than this share of what it may be at most stands at its bound."""


def is_strained(fit: LeastSquaresFit) -> bool:
    """Return whether an error of a run or a sensor stands at its bound."""
    return any(abs(item.sigmas) > STRAINED_SHARE * MOST_SIGMAS for item in fit.conditions())


def without_strain(fit: LeastSquaresFit, effects: Sequence[Candidate]) -> LeastSquaresFit:
    """Return a fit, or where its errors stand at bounds and it ends lower with errors begun anew, that one.

    Parameters
    ----------
    fit
        A fine fit.
    effects
        Its effects, whose parameters are the last of its unknowns.
    """
    if not is_strained(fit):
        return fit
    misfit, n = fit.misfit, fit.misfit.n_parameters
    begun = fit.x[n : n + len(misfit.shared)]
    x = np.concatenate([fit.x[:n], begun, align(misfit, fit.x[:n], begun.tolist())])
    again = refine(misfit.problem, fit, x, effects)
    return again if again.loss < fit.loss else fit
