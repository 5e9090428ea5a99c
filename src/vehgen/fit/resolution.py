"""The time step that a run needs: halved until halving it further changes nothing that the noise would show.

Of smooth laws the error's mean square falls sixteenfold with half the step. Dry friction is not smooth: its force jumps, a jump within a
step comes late by a part of the step, and a sample that falls in between is off by the whole jump, so that the error's mean square falls
but in proportion to the step.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from vehgen.fit.misfit import Misfit
from vehgen.fit.problem import Problem
from vehgen.fit.trial import Trial, samples_kept

Array = NDArray[np.float64]
RESOLVED_SHARE = 0.1
"""A step is short enough when half of it moves the whitened lines by this mean square or less (noise alone: 1)."""
HALVINGS = 3
"""A run's step is halved so often at most, in all."""
SMOOTH_RATIO = 1 / 6
"""Where half the step leaves more than this share of the error, the response jumps."""


def resolve(misfit: Misfit, x: Array) -> Problem:
    """Return the problem of a misfit with every trial's step halved as often as its response at `x` asks, and marked where it jumps."""
    values, numbers = misfit.problem.space.values(misfit.split(x)[0])[None], misfit.adjusted(x)
    found = []
    for number, trial in enumerate(misfit.problem.trials):
        error = misfit.errors_of(x, number)
        most = samples_kept(trial.run, trial.recording.dt) * 2**HALVINGS
        coarse, before, jumps = misfit.respond(number, values, numbers, error, trial)[0], 0.0, trial.jumps
        while trial.scenario.decimation < most:
            finer = _halved(trial)
            fine = misfit.respond(number, values, numbers, error, finer)[0]
            moved = float(np.mean(np.abs(misfit.whitened_signal(number, fine - coarse)) ** 2))
            jumps = jumps or moved > SMOOTH_RATIO * before > 0.0
            if not moved > RESOLVED_SHARE:
                break
            trial, coarse, before = finer, fine, moved
        found.append(replace(trial, jumps=jumps))
    return Problem(tuple(found), misfit.problem.space)


def _halved(trial: Trial) -> Trial:
    scenario = trial.scenario
    return replace(trial, scenario=replace(scenario, dt=scenario.dt / 2, decimation=2 * scenario.decimation))
