"""Fits of laws that make the response jump: many minima lie close together, of which a single descent finds but one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from vehgen.diagnose.fits.model_fit import ModelFit, evaluate_fit, refine
from vehgen.fit.least_squares import COARSE_TOLERANCE
from vehgen.fit.misfit import Noises
from vehgen.fit.trial import Trial

SHAKES = (0.02, 0.06) * 4
"""Standard deviations, in the unit cube, of the points about a fit from which is begun anew."""
AS_GOOD = 0.02
"""Minima whose mean square is within this of the lowest cannot be told apart: the steps of the simulation leave about as much."""


def restart(fit: ModelFit, validation_runs: Sequence[Trial], noises: Noises, seed: int = 7) -> ModelFit:
    """Return the lowest of several minima about a fit, with those that do as well; a fit without jumps as it is."""
    misfit, x = fit.least_squares.misfit, fit.least_squares.x
    if not any(trial.jumps for trial in misfit.problem.trials):
        return fit
    random = np.random.Generator(np.random.PCG64(seed))
    found = [fit.least_squares]
    for shake in SHAKES:
        begin = x.copy()
        begin[: misfit.n_parameters] += shake * random.standard_normal(misfit.n_parameters)
        begin[: misfit.n_parameters] = np.clip(begin[: misfit.n_parameters], 0.01, 0.99)
        found.append(refine(misfit.problem, fit.least_squares, begin, fit.effects, tolerance=COARSE_TOLERANCE))
    best = min(found, key=lambda item: item.loss)
    if best is not fit.least_squares:
        best = refine(misfit.problem, best, best.x, fit.effects)
    equals = tuple(item.x for item in found if item.chi2 <= best.chi2 + AS_GOOD)
    return replace(evaluate_fit(fit.effects, best, validation_runs, noises, near=fit.parts[1:]), equivalent_minima=equals)
