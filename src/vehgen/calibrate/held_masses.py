"""What hangs on the masses that a calibration takes as known: recordings of motion alone tell everything only over the mass.

Where all masses, stiffnesses and dampings are k times larger, a vehicle moves over the same road as before. If a file gives its bodies'
masses no range, that is what makes the rest identifiable, and an error of theirs is an error of all the rest, which no interval counts.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vehgen.calibrate.identifiability import Structure, distinct_trials, driven, stacked_derivatives
from vehgen.calibrate.result import HeldMasses
from vehgen.fit.problem import Problem

Array = NDArray[np.float64]
MASSES_UNSEEN = 1e-6
"""The responses do not see a change that leaves less than this share of what the masses alone change; exact derivatives leave 1e-14."""
LEAST_FOLLOWING = 1e-3
"""A parameter follows the masses where it changes by more than this share of their relative change."""


def find_held_masses(problem: Problem, structure: Structure, values: Array) -> HeldMasses | None:
    """Return the bodies' masses that no search changes, where all that is searched makes up for a common error of theirs.

    Parameters
    ----------
    problem
        Runs and searched parameters.
    structure
        What the responses tell: only parameters that they tell one by one are said to follow.
    values
        The searched parameters, `shape (n_parameters,)` [SI].

    Returns
    -------
    None where the responses tell such an error (by a force that is known, or a stiffness that is held), where nothing that they tell
    follows, or where no mass is held that is a parameter.
    """
    names, trials = problem.space.names, distinct_trials(problem)
    masses = {name for body in trials[0].run.vehicle.bodies.values() for name in body.mass.names}
    own_values = [problem.values_of(values, trial) for trial in trials]
    held = tuple(name for name in own_values[0] if name in masses and name not in names and any(own[name] > 0 for own in own_values))
    if not held:
        return None
    searched, common = [], []
    for trial, own in zip(trials, own_values, strict=True):
        flat = stacked_derivatives(trial.simulator.model, own, (*names, *held), driven(trial))
        flat *= np.array([own[name] for name in (*names, *held)])
        flat[:, [i for i, name in enumerate(names) if name in trial.fixed]] = 0.0
        searched.append(flat[:, : len(names)])
        common.append(flat[:, len(names) :].sum(axis=1))
    by_parameter, by_masses = np.concatenate(searched), np.concatenate(common)
    norms = np.linalg.norm(by_parameter, axis=0)
    scale = np.where(norms > 0, norms, 1.0)
    shares = np.linalg.lstsq(by_parameter / scale, -by_masses, rcond=1e-9)[0] / scale
    if np.linalg.norm(by_parameter @ shares + by_masses) > MASSES_UNSEEN * np.linalg.norm(by_masses):
        return None
    told = np.abs(structure.null).max(axis=0, initial=0.0) == 0
    follows = {name: float(share) for name, share, known in zip(names, shares, told, strict=True) if known and abs(share) > LEAST_FOLLOWING}
    return HeldMasses(held, follows) if follows else None
