"""Of parameter sets that answer alike, the one nearest to the vehicle file's values.

Where directions are unidentifiable, a fit ends anywhere on a curved surface of sets with the same frequency responses. Steps along the
surface (its tangent is the null space of the exact derivatives) lead to the set nearest to the file's values in the unit cube; after each
step Newton's method puts the responses right again. What is identifiable, natural modes too, does not change.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import scipy
from numpy.typing import NDArray

from vehgen.calibrate.identifiability import answer_derivatives, answers, distinct_trials, driven, null_space, remaining_directions
from vehgen.fit.least_squares import LeastSquaresFit
from vehgen.fit.prior_data import PriorData

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
MAX_LOSS_CHANGE = 1e-3
"""A set whose -2 ln L differs by more from the fit's is no equivalent: responses show force laws at some amplitudes only."""
LONGEST_MOVE, SHORTEST_MOVE = 0.1, 1e-4
"""Steps along the surface, in the unit cube."""
MAX_MOVES = 40
MAX_CORRECTIONS = 8
SAME_RESPONSE = 1e-9
"""Relative difference of responses that counts as none."""
SURFACE_WEIGHT = 1e4
"""How much more a step keeps to the surface than to the shortest way."""
FACT_WEIGHT = 1e-3
"""A fact's deviation of one standard deviation counts as this relative difference of a response."""
SLACK_AT_BOUND = 1e-12
"""Width left to coordinates on their bounds: the solver takes no bounds that coincide."""


def nearest_equivalent(fit: LeastSquaresFit, facts: PriorData | None = None) -> LeastSquaresFit:
    """Return a fit moved to the nearest set of parameters that answers alike and agrees with the facts as well.

    Parameters
    ----------
    fit
        A polished fit.
    facts
        What else was known.

    Returns
    -------
    The moved fit, its loss told anew; the same fit where nothing is unidentifiable, or where the recordings tell the two sets apart.
    """
    surface = _Surface(fit, facts)
    if not len(surface.null(surface.start)):
        return fit
    moved = np.concatenate([surface.nearest(), fit.x[len(surface.start) :]])
    change = _squares(fit, moved, facts) - _squares(fit, fit.x, facts)
    return replace(fit, x=moved, loss=fit.loss + change) if change < MAX_LOSS_CHANGE else fit


def _squares(fit: LeastSquaresFit, x: Array, facts: PriorData | None) -> float:
    """Return -2 ln L at unknowns x of a fit's misfit, less a constant."""
    total = float((fit.misfit.residuals(x) ** 2).sum())
    if facts is not None:
        total += float((facts.residuals(fit.misfit.problem.space.values(fit.misfit.split(x)[0])) ** 2).sum())
    return total


class _Surface:
    """The points of the unit cube that answer as a fit does: same frequency responses at all sensors, same values of all facts."""

    def __init__(self, fit: LeastSquaresFit, facts: PriorData | None) -> None:
        self.problem = fit.misfit.problem
        self.space = self.problem.space
        self.facts = facts
        self.home = self.space.unit(self.space.start)
        self.start = fit.misfit.split(fit.x)[0]
        values = self.space.values(self.start)
        self.responses = self._responses(values)
        self.scales = [_scale(response) for response in self.responses]
        self.known = self._known(values)

    def null(self, unit: Array) -> Array:
        """Return the directions along the surface at a point, `shape (n_null, n_parameters)`."""
        return self._tangent(unit, self._derivatives(self.space.values(unit)))

    def nearest(self) -> Array:
        """Return the point of the surface nearest to the file's values, by way of the surface."""
        unit, length = self.start, LONGEST_MOVE
        for _ in range(MAX_MOVES):
            found = self._restored(self._step(unit, self.home, length))
            if found is None or np.linalg.norm(found - self.home) > np.linalg.norm(unit - self.home):
                length /= 4
            else:
                move = float(np.abs(found - unit).max())
                unit, length = found, min(2 * length, LONGEST_MOVE)
                if move < SHORTEST_MOVE:
                    break
            if length < SHORTEST_MOVE:
                break
        return unit

    def _restored(self, unit: Array) -> Array | None:
        """Return a point of the surface near another; None where none is found."""
        for _ in range(MAX_CORRECTIONS):
            if float(np.abs(self._off(self.space.values(unit))).max()) < SAME_RESPONSE:
                return unit
            unit = self._step(unit, unit, LONGEST_MOVE)
        return None

    def _step(self, unit: Array, target: Array, length: float) -> Array:
        """Return the point nearest to a target within the cube and `length`, of the surface as its tangent shows it."""
        values = self.space.values(unit)
        derivatives = self._derivatives(values)
        null = self._tangent(unit, derivatives)
        across = scipy.linalg.null_space(null) if len(null) else np.eye(len(unit))
        basis, triangle = np.linalg.qr(derivatives @ across)
        along = -np.linalg.solve(triangle, basis.T @ self._off(values))
        matrix = np.vstack([SURFACE_WEIGHT * across.T, np.eye(len(unit))])
        wanted = np.concatenate([SURFACE_WEIGHT * along, target - unit])
        low, high = np.maximum(-unit, -length) - SLACK_AT_BOUND, np.minimum(1.0 - unit, length) + SLACK_AT_BOUND
        moved = scipy.optimize.lsq_linear(matrix, wanted, (low, high), method="bvls").x
        return np.asarray(np.clip(unit + moved, 0.0, 1.0))

    def _tangent(self, unit: Array, derivatives: Array) -> Array:
        n_known = len(self.known)
        null = null_space(derivatives[: len(derivatives) - n_known])[0]
        return remaining_directions(null, derivatives[len(derivatives) - n_known :])

    def _responses(self, values: Array) -> list[Complex]:
        """Return the frequency responses of all sensors, `shape (n, n_channels, n_drives)`, a trial each; one at each travel of laws."""
        trials = distinct_trials(self.problem)
        return [answers(trial.simulator.model, self.problem.values_of(values, trial), driven(trial)) for trial in trials]

    def _known(self, values: Array) -> Array:
        return np.zeros(0) if self.facts is None else FACT_WEIGHT * self.facts.residuals(values)

    def _off(self, values: Array) -> Array:
        """Return how far responses and facts are off those of the fit."""
        parts = [
            ((now - then) / scale).ravel() for now, then, scale in zip(self._responses(values), self.responses, self.scales, strict=True)
        ]
        flat = np.concatenate(parts)
        return np.concatenate([flat.real, flat.imag, self._known(values) - self.known])

    def _derivatives(self, values: Array) -> Array:
        """Return the derivatives of :meth:`_off` by the unit cube's coordinates, those of the facts last."""
        names, parts = self.space.names, []
        for trial, scale in zip(distinct_trials(self.problem), self.scales, strict=True):
            derived = answer_derivatives(trial.simulator.model, self.problem.values_of(values, trial), names, driven(trial)) / scale
            derived[[i for i, name in enumerate(names) if name in trial.fixed]] = 0.0
            parts.append(derived.reshape(len(names), -1))
        flat = np.concatenate(parts, axis=1)
        known = np.zeros((0, len(names))) if self.facts is None else FACT_WEIGHT * self.facts.jacobian(values)
        return np.vstack([flat.real.T, flat.imag.T, known]) * self.space.slopes(values)


def _scale(response: Complex) -> Array:
    """Return the size of a channel's answers `shape (n, n_channels, n_drives)` to each drive, 1 where there are none."""
    found = np.linalg.norm(response, axis=0, keepdims=True)
    return np.where(found > 0, found, 1.0)
