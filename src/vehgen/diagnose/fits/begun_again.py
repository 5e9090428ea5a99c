"""Fits begun again where they may have ended badly: with errors or parameters at bounds, or in one of many minima.

Errors of runs and sensors: a candidate is fitted from where the base's fit ended, which had bent speeds, heights and gains to what it
lacked. With the right law they mostly find back, but a run over a rough road has many minima: its errors may stay at their bounds, and the
run ill explained, while errors that begin at none lead to the truth.

Parameters of the base: the file's range counts, where a candidate needs it. Laws that make the response jump: many minima lie close
together, of which a single descent finds but one.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from vehgen.diagnose.fits.candidate import Candidate, build_problem, carried
from vehgen.diagnose.fits.model_fit import CurrentModel, ModelFit, evaluate_fit, refine
from vehgen.effects import EffectLocator
from vehgen.fit.alignment import MOST_SIGMAS, align
from vehgen.fit.least_squares import COARSE_TOLERANCE, LeastSquaresFit
from vehgen.fit.misfit import Noises
from vehgen.fit.resolution import as_fine
from vehgen.fit.trial import Trial
from vehgen.simulate import SimulatorPool

STRAINED_SHARE = 0.99
"""An error of more than this share of what it may be at most stands at its bound."""
WORTH_RELEASING = 10.0
"""A base parameter that its bound holds is set free where that lowers -2 ln of the likelihood by so much."""
SHAKES = (0.02, 0.06) * 4
"""Standard deviations, in the unit cube, of the points about a fit from which is begun anew."""
AS_GOOD = 0.02
"""Minima whose mean square is within this of the lowest cannot be told apart: the steps of the simulation leave about as much."""


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
    errors = [align(misfit, fit.x[:n], begun.tolist())]
    if misfit.shared:  # a sensor's delay that clocks at bounds hold where it is would lay them there again
        errors.append(np.zeros(misfit.n_errors))
    fits = [fit, *(refine(misfit.problem, fit, np.concatenate([fit.x[:n], begun, own]), effects) for own in errors)]
    return min(fits, key=lambda item: item.loss)


def release(
    candidate: Candidate, current: CurrentModel, fit: LeastSquaresFit, locator: EffectLocator, simulators: SimulatorPool
) -> tuple[Candidate, LeastSquaresFit]:
    """Return a candidate and its fit, with the base parameters that bounds held searched within the range of the vehicle's file.

    They count as freed by the candidate, so that the base with the same freedom is held against it. Both are as they were where no
    bound holds a parameter, or where its release gains less than WORTH_RELEASING.
    """
    held = tuple(name for name in fit.on_bound if name in current.problem.space.names and name not in candidate.freed)
    if not held:
        return candidate, fit
    freed = replace(candidate, freed=(*candidate.freed, *held))
    problem = build_problem(freed, current.problem, locator, simulators)
    steps = {trial.name: trial for trial in fit.misfit.problem.trials}
    problem = problem.with_trials([as_fine(trial, steps[trial.name]) for trial in problem.trials])
    unit = carried(fit.misfit.split(fit.x)[0], fit.misfit.problem.space, problem.space)
    begin = np.concatenate([unit, fit.x[len(unit) :]])
    found = refine(problem, fit, begin, (*current.effects, freed), fit.misfit.noises)
    return (freed, found) if found.loss < fit.loss - WORTH_RELEASING else (candidate, fit)


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
