"""The time step that a run needs: halved until halving it further changes nothing that the noise would show.

Smooth laws are resolved by the step that recordings ask for. Dry friction is not: its force jumps, a jump within a step comes late by a
part of the step, and a sample that falls in between is off by the whole jump, so that the error's mean square falls but linearly with the
step.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from vehgen.identify.misfit import Misfit
from vehgen.identify.problem import Problem
from vehgen.identify.trial import Trial, samples_kept

Array = NDArray[np.float64]
ENOUGH = 0.1
"""A step is short enough when half of it moves the whitened lines by this mean square or less (noise alone: 1)."""
HALVINGS = 3


def resolve(misfit: Misfit, x: Array) -> Problem:
    """Return the problem of a misfit with every trial's step halved as often as its response at `x` asks, at most HALVINGS times."""
    unit, errors = misfit.split(x)
    values, numbers = misfit.problem.space.values(unit)[None], misfit.adjusted(x)
    found = []
    for number, (trial, error) in enumerate(zip(misfit.problem.trials, errors, strict=True)):
        coarse = misfit.respond(trial, values, numbers, error)[0]
        for _ in range(HALVINGS):
            finer = _halved(trial)
            fine = misfit.respond(finer, values, numbers, error)[0]
            moved = float(np.mean(np.abs(misfit.white_signal(number, fine - coarse)) ** 2))
            if not moved > ENOUGH:
                break
            trial, coarse = finer, fine
        found.append(trial)
    return Problem(tuple(found), misfit.problem.space)


def jumps(trial: Trial) -> bool:
    """Return whether a trial needs shorter steps: its response jumps, and so does its misfit as a function of parameters."""
    return trial.scenario.keep > samples_kept(trial.run, trial.measurement.dt)


def _halved(trial: Trial) -> Trial:
    scenario = trial.scenario
    return replace(trial, scenario=replace(scenario, dt=scenario.dt / 2, keep=2 * scenario.keep))
