"""The time step that a run needs: halved until halving it further changes nothing that the noise would show.

The error's mean square falls sixteenfold with half the step. Dry friction jumps where its slip ends; the kernels place that within a step
(see :mod:`vehgen.codegen.friction`), so that friction is as accurate as smooth laws. But a sample next to a jump may be off by all of it,
however short the step, and a fit's parameters move jumps across samples: such trials are marked.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from vehgen.fit.misfit import Misfit
from vehgen.fit.problem import Problem
from vehgen.fit.trial import Trial, samples_kept
from vehgen.simulate.budgets import MAX_RESPONSE_NUMBERS, excitation_numbers

Array = NDArray[np.float64]
RESOLVED_SHARE = 0.1
"""A step is short enough when half of it moves the whitened lines by this mean square or less (noise alone: 1)."""
RESOLVED_BIAS = 0.1
"""Where intervals are asked: by this sum of squares or less over all runs. What moves the lines by so much moves no estimate by more
standard deviations than the root of it, 0.3 at worst and far less as a rule."""
STEP_ERROR = 4 / 3
"""The error of a step beside what half of it moves: the method is of second order, and half a step keeps a quarter of the error."""
HALVINGS = 3
"""A run's step is halved so often at most, in all."""


def resolve(misfit: Misfit, x: Array, most_bias: float | None = None) -> Problem:
    """Return the problem of a misfit with every trial's step halved as often as its response at `x` asks, and marked where it jumps.

    `most_bias` is the sum of squares by which the step's error may move the whitened lines of all trials together, shared out evenly
    (default: half a step moves those of a trial by no more than RESOLVED_SHARE of their number).
    """
    values, numbers = misfit.problem.space.values(misfit.split(x)[0])[None], misfit.adjusted(x)
    found = []
    for number, trial in enumerate(misfit.problem.trials):
        error = misfit.errors_of(x, number)
        most = samples_kept(trial.run, trial.recording.dt) * 2**HALVINGS
        coarse = misfit.respond(number, values, numbers, error, trial)[0]
        while trial.scenario.decimation < most and _may_be_halved(trial):
            finer = halved(trial)
            fine = misfit.respond(number, values, numbers, error, finer)[0]
            moved = np.abs(misfit.whitened_signal(number, fine - coarse)) ** 2
            if most_bias is None:
                hidden = np.mean(moved) <= RESOLVED_SHARE
            else:
                hidden = 2 * STEP_ERROR**2 * np.sum(moved) <= most_bias / len(misfit.problem.trials)
            if hidden:
                break
            trial, coarse = finer, fine
        found.append(replace(trial, jumps=_jumps(trial)))
    return Problem(tuple(found), misfit.problem.space)


def _may_be_halved(trial: Trial) -> bool:
    """Return whether half a trial's step leaves what excites it within a run's memory."""
    scenario, n_wheels = trial.scenario, len(trial.simulator.model.inputs)
    return excitation_numbers(2 * len(scenario.time), n_wheels, len(scenario.forces)) <= MAX_RESPONSE_NUMBERS


def _jumps(trial: Trial) -> bool:
    """Return whether a trial's channels jump: accelerations and forces of a vehicle with dry friction."""
    model = trial.simulator.model
    rough = any(term.step().friction != 0 for element in model.elements for term in element.laws)
    return rough and any(channel.quantity.endswith(("acceleration", "force", "load", "moment")) for channel in model.channels)


def halved(trial: Trial) -> Trial:
    """Return a trial simulated with half the step, its samples the same."""
    scenario = trial.scenario
    return replace(trial, scenario=replace(scenario, dt=scenario.dt / 2, decimation=2 * scenario.decimation))


def as_fine(trial: Trial, other: Trial) -> Trial:
    """Return a trial with the step of another one."""
    steps = replace(trial.scenario, dt=other.scenario.dt, decimation=other.scenario.decimation)
    return replace(trial, scenario=steps, jumps=other.jumps)
