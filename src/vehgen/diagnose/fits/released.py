"""A bound that holds a base parameter in a candidate's fit is released: the file's range counts, where the candidate needs it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from vehgen.diagnose.fits.candidate import Candidate, build_problem, carried
from vehgen.diagnose.fits.model_fit import CurrentModel, refine
from vehgen.effects import EffectLocator
from vehgen.fit.least_squares import LeastSquaresFit
from vehgen.fit.resolution import as_fine
from vehgen.simulate import SimulatorPool

WORTH_RELEASING = 10.0
"""A base parameter that its bound holds is set free where that lowers -2 ln of the likelihood by so much."""


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
