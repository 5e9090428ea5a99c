"""How sure a calibration in steps is: what its first step froze is not known exactly, and the second step's numbers lean on it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from vehgen.calibrate.calibration import StepResult
from vehgen.calibrate.identifiability import find_structure
from vehgen.calibrate.intervals import Frozen, Uncertainty
from vehgen.fit.least_squares import LeastSquaresFit
from vehgen.fit.misfit import Misfit
from vehgen.fit.prior_data import PriorData
from vehgen.fit.problem import Problem

Array = NDArray[np.float64]


def step_uncertainties(problem: Problem, results: Sequence[StepResult], prior_data: PriorData | None = None) -> list[Uncertainty | None]:
    """Return how sure the best fit of each step is; None of one without a polish.

    Parameters
    ----------
    problem
        All that the steps search; every sensor.
    results
        Of the steps, in their order.
    prior_data
        What was known from elsewhere.

    Returns
    -------
    The uncertainty of a step that begins with frozen parameters is that of these and its own together.
    """
    found: list[Uncertainty | None] = []
    frozen: Frozen | None = None
    for result in results:
        known = _uncertainty(problem, result, prior_data, frozen)
        frozen = None if known is None else known.told_of(result.step.kept)
        found.append(known)
    return found


def _uncertainty(problem: Problem, result: StepResult, prior_data: PriorData | None, frozen: Frozen | None) -> Uncertainty | None:
    if not result.fits:
        return None
    fit, seen = result.fits[0], result.problem
    if frozen is not None:
        fit, seen = _searching_all(problem, fit), problem
    values = np.array([fit.misfit.problem.best_values(fit.values)[name] for name in seen.space.names])
    facts = None if prior_data is None else replace(prior_data, problem=fit.misfit.problem)
    return Uncertainty(fit, find_structure(seen, values), facts, frozen)


def _searching_all(problem: Problem, fit: LeastSquaresFit) -> LeastSquaresFit:
    """Return a fit that searches what was frozen, too, ended where it did."""
    old = fit.misfit
    known = old.problem.trials[0].values | old.problem.best_values(fit.values)
    values = np.array([known[name] for name in problem.space.names])
    whole = Problem(old.problem.trials, problem.space)
    misfit = Misfit(whole, old.noises, values, old.nuisances, old.band, old.shared, old.known, old.split(fit.x)[1], old.begun)
    return replace(fit, misfit=misfit, x=np.concatenate([problem.space.unit(values), fit.x[old.n_parameters :]]), linearisation=None)
