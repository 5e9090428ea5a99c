"""Structural identifiability: which parameters and combinations recordings can determine at all, for any vehicle.

Frequency responses from the road, or what else drives a run, to the sensors and their derivatives by every searched parameter are exact.
Directions in parameter space along which no response changes, at any frequency, from any axle, are unidentifiable: no run over any road
determines them, whatever the noise. They are found as the null space of the stacked derivatives; as these are exact, many decades
separate its singular values from those of a parameter that the responses hardly depend on.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

from vehgen.fit.problem import Problem
from vehgen.fit.space import SearchSpace
from vehgen.fit.trial import Trial
from vehgen.mechanics.equations_of_motion import EquationsOfMotion
from vehgen.simulate.frequency import response_derivatives, transfer_functions
from vehgen.simulate.harmonic_laws import harmonic_laws

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
FREQUENCIES = np.geomspace(0.4, 40.0, 40)
"""Where responses are compared [Hz]; the null space does not depend on the choice."""
NULL_SHARE = 1e-9
"""Singular values below this share of the largest are zero: exact derivatives leave about 1e-14."""
WEIGHABLE = 3.0
"""By how much a body's mass is preferred to other parameters that could be held fixed as well."""
SEEN_BY_FACTS = 1e-8
"""Facts whose derivative along a direction is below this share of the largest do not see it."""
IN_NULL_SPACE = 1e-5
"""A quantity whose gradient has a larger share than this in the null space is not identifiable."""


@dataclass(frozen=True)
class Structure:
    """Structural rank and unidentifiable directions of a problem's searched parameters.

    `null shape (n_null, n_parameters)`: changes of the parameters in the unit cube that change no response, each of `fixed_parameters`
    changed by one of them alone. `singular_values shape (n_parameters,)` of the scaled derivatives, largest first.
    """

    space: SearchSpace
    null: Array
    fixed_parameters: tuple[int, ...]
    singular_values: Array

    @property
    def rank(self) -> int:
        """Structural rank: how many combinations of the parameters are identifiable."""
        return self.space.size - len(self.null)

    @property
    def row_space(self) -> Array:
        """An orthonormal basis of the identifiable combinations, `shape (n_parameters, rank)`."""
        return np.asarray(scipy.linalg.null_space(self.null)) if len(self.null) else np.eye(self.space.size)

    def is_identifiable(self, gradient: Array) -> bool:
        """Return whether a quantity is identifiable whose derivatives by the unit cube are `gradient shape (n_parameters,)`."""
        norm = float(np.linalg.norm(gradient))
        if norm == 0 or not len(self.null):
            return True
        basis = scipy.linalg.orth(self.null.T)
        return bool(np.linalg.norm(basis.T @ gradient) < IN_NULL_SPACE * norm)

    def directions(self, values: Array) -> list[dict[str, float]]:
        """Return each unidentifiable direction as changes [SI] of parameters, for 1 % of the range of its fixed parameter."""
        found = []
        for row, pivot in zip(self.null, self.fixed_parameters, strict=True):
            change = row * self.space.slopes(values)
            change *= 0.01 * (self.space.upper[pivot] - self.space.lower[pivot]) / change[pivot]
            moved = np.abs(row) > 1e-6 * np.abs(row).max()
            found.append({name: float(change[i]) for i, name in enumerate(self.space.names) if moved[i]})
        return found


def find_structure(problem: Problem, values: Array) -> Structure:
    """Return the structural rank and null directions at searched values `shape (n_parameters,)` [SI].

    Every trial's sensors are taken together. The axles' ways to the sensors count one by one: their roads are one road with known delays,
    which runs at several speeds separate.
    """
    found = []
    for trial in distinct_trials(problem):
        found.append(_scaled_derivatives(problem, trial, values))
    null, singular = null_space(np.concatenate(found, axis=0))
    if not len(null):
        return Structure(problem.space, null, (), singular)
    fixed = scipy.linalg.qr(null * _weighable(problem), pivoting=True, mode="r")[1][: len(null)]
    reduced = np.asarray(np.linalg.solve(null[:, fixed], null), dtype=np.float64)
    reduced[np.abs(reduced) < 1e-8 * np.abs(reduced).max()] = 0.0
    return Structure(problem.space, reduced, tuple(int(i) for i in fixed), singular)


def _weighable(problem: Problem) -> Array:
    """Return weights `shape (n_parameters,)` that let the masses of bodies be held fixed rather than others: a scale tells them."""
    masses = {name for body in problem.trials[0].run.vehicle.bodies.values() for name in body.mass.names}
    return np.array([WEIGHABLE if name in masses else 1.0 for name in problem.space.names])


def distinct_trials(problem: Problem) -> list[Trial]:
    """Return one trial of all those whose sensors, fixed parameters and drives are the same: they show the same responses."""
    return list({_shown_by(item): item for item in problem.trials}.values())


def _shown_by(trial: Trial) -> tuple[object, ...]:
    model = trial.simulator.model
    fixed = tuple((name, trial.values.get(name)) for name in trial.fixed)
    return repr(model.channels), repr(model.matrix_entries()["F"]), fixed, tuple(driven(trial).tolist())


def driven(trial: Trial) -> NDArray[np.bool_]:
    """Return which displacement inputs and forces drive a trial, `shape (n_inputs + n_forces,)`.

    A vehicle that is released answers as to its inputs, in what of it that tells: all of them count.
    """
    model, scenario = trial.simulator.model, trial.scenario
    roads = [bool(scenario.track.parts)] * (len(model.inputs) - len(scenario.ground))
    found = np.array([*roads, *(item is not None for item in scenario.ground), *(True for _ in model.forces)], dtype=bool)
    return found if found.any() else np.ones_like(found)


def remaining_directions(null: Array, known: Array) -> Array:
    """Return what facts leave of unidentifiable directions.

    Parameters
    ----------
    null
        Directions in the unit cube, `shape (n_null, n_parameters)`.
    known
        The facts' derivatives by the unit cube's coordinates, `shape (n_facts, n_parameters)`.

    Returns
    -------
    `shape (n_left, n_parameters)`.
    """
    if not len(null) or not len(known):
        return null
    free = null.T / np.linalg.norm(null, axis=1)
    _, singular, rows = np.linalg.svd(known @ free)
    rank = int((singular > SEEN_BY_FACTS * max(float(np.abs(known).max(initial=0.0)), 1e-300)).sum())
    return np.asarray((free @ rows[rank:].T).T)


def null_space(derivatives: Array) -> tuple[Array, Array]:
    """Return the directions along which exact derivatives `shape (m, n_parameters)` vanish, and the scaled derivatives' singular values.

    Returns
    -------
    Directions of unit length `shape (n_null, n_parameters)`, singular values `shape (n_parameters,)`, largest first.
    """
    norms = np.linalg.norm(derivatives, axis=0)
    scale = np.where(norms > 0, norms, 1.0)
    _, found, rows = np.linalg.svd(np.linalg.qr(derivatives / scale, mode="r"))
    singular = np.pad(np.asarray(found, dtype=np.float64), (0, len(rows) - len(found)))
    count = int((singular < NULL_SHARE * singular[0]).sum())
    null = rows[len(rows) - count :] / scale
    return np.asarray(null / np.linalg.norm(null, axis=1, keepdims=True)), singular


def _scaled_derivatives(problem: Problem, trial: Trial, searched: Array) -> Array:
    names = problem.space.names
    flat = stacked_derivatives(trial.simulator.model, problem.values_of(searched, trial), names, driven(trial))
    flat *= problem.space.slopes(searched)
    flat[:, [i for i, name in enumerate(names) if name in trial.fixed]] = 0.0
    return flat


def stacked_derivatives(
    model: EquationsOfMotion, values: Mapping[str, float], names: tuple[str, ...], drives: NDArray[np.bool_] | None = None
) -> Array:
    """Return the derivatives of all channels' frequency responses by parameters, `shape (m, len(names))`.

    To the inputs and forces `drives shape (n_inputs + n_forces,)` (default: to all), each channel's answer to each scaled to 1.
    """
    derived = answer_derivatives(model, values, names, drives)
    scale = np.linalg.norm(derived, axis=(0, 1), keepdims=True)
    flat = (derived / np.where(scale > 0, scale, 1.0)).reshape(len(names), -1)
    return np.concatenate([flat.real, flat.imag], axis=1).T


def answers(model: EquationsOfMotion, values: Mapping[str, float], drives: NDArray[np.bool_] | None = None) -> Complex:
    """Return the frequency responses of all channels, `shape (n, n_channels, n_drives)`, at FREQUENCIES.

    To the inputs and forces `drives shape (n_inputs + n_forces,)` (default: to all). Force laws are in them as what they are to harmonic
    travels: FREQUENCIES come again for every amplitude.
    """
    numeric, looks = model.numeric(values), harmonic_laws(model, values, FREQUENCIES)
    each = (transfer_functions(numeric, FREQUENCIES, [item.law for item in laws]) for laws in looks)
    found = np.concatenate([np.concatenate(pair, axis=2) for pair in each])
    return found if drives is None else found[:, :, drives]


def answer_derivatives(
    model: EquationsOfMotion, values: Mapping[str, float], names: tuple[str, ...], drives: NDArray[np.bool_] | None = None
) -> Complex:
    """Return the derivatives of :func:`answers` by parameters, exact, `shape (len(names), n, n_channels, n_drives)`."""
    looks = harmonic_laws(model, values, FREQUENCIES, names)
    found = np.concatenate([response_derivatives(model, values, names, FREQUENCIES, laws) for laws in looks], axis=1)
    return found if drives is None else found[..., drives]
