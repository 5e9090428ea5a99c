"""Intervals from the Fisher information, for parameters, combinations and natural frequencies.

The information of a fit counts how the lines of a windowed record hang together (:mod:`vehgen.fit.stationary`). Nuisances are
marginalised. Along unidentifiable directions there is none, and what depends on them gets no interval; for all else the covariance is
V (V' F V)^-1 V', V a basis of the identifiable combinations. Where the residuals of a run are larger than the noise model says (its chi2
above 1), the recordings' information is divided by chi2: intervals grow by its root. The noise is estimated from all runs together, so that
chi2 of all is near 1 wherever a fit ends.

Intervals of positive quantities are symmetric on a logarithmic scale.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy
from numpy.typing import NDArray

from vehgen.calibrate.identifiability import Structure, remaining_directions
from vehgen.errors import InputError, shown
from vehgen.files.expressions import Expression, ExpressionError, parse
from vehgen.files.units import Dimension
from vehgen.fit.least_squares import LeastSquaresFit
from vehgen.fit.prior_data import PriorData
from vehgen.fit.problem import Problem
from vehgen.fit.stationary import recorded_information
from vehgen.simulate import Mode, natural_modes
from vehgen.vehicle import Vehicle

Array = NDArray[np.float64]
LEVEL = 0.90
"""Confidence level of all intervals."""
_GRADIENT_STEP = 1e-5
LEAST_INFORMATION = 0.25
"""What recordings say nothing of, such as a stop that no run meets, is known to two ranges: an interval beyond both ends, not none."""


@dataclass(frozen=True)
class Estimate:
    """A quantity's value with its interval at LEVEL; `low` and `high` are None where it is not identifiable."""

    name: str
    value: float
    low: float | None = None
    high: float | None = None

    def covers(self, truth: float) -> bool:
        """Return whether the interval holds a value."""
        return self.low is not None and self.high is not None and self.low <= truth <= self.high


@dataclass(frozen=True)
class Frozen:
    """What an earlier step tells of parameters that it keeps: their `names`, and its `information` on them, all others marginalised.

    The information is of the unit cube's coordinates, `shape (n, n)`.
    """

    names: tuple[str, ...]
    information: Array


Quantity = Callable[[Array], float]
"""Maps searched values `shape (n_parameters,)` [SI] to a number."""


def run_chi2(fit: LeastSquaresFit) -> dict[str, float]:
    """Return the mean square of each run's whitened residuals; 1 is noise alone."""
    white = fit.misfit.whitened_spectrum(fit.x)
    return {trial.name: float(np.mean(np.abs(lines) ** 2)) for trial, lines in zip(fit.misfit.problem.trials, white, strict=True)}


def read_combination(vehicle: Vehicle, text: str) -> tuple[Expression, Dimension]:
    """Return an expression of a vehicle's parameters and its dimension; raises InputError for text that is none."""
    try:
        expression = parse(text)
        unknown = expression.names - set(vehicle.parameters)
        if unknown:
            raise InputError(f"the combination {shown(text)} names {', '.join(sorted(unknown))}, which {vehicle.name} does not have")
        return expression, expression.dimension(vehicle.dimensions)
    except ExpressionError as error:
        raise InputError(f"{shown(text)}: {error}") from error


def combination_value(vehicle: Vehicle, expression: Expression, free: Mapping[str, float]) -> float:
    """Return an expression of a vehicle's parameters at values [SI] of its free ones; raises InputError where it has none."""
    try:
        return float(expression.evaluate(vehicle.all_values(dict(free))))
    except ExpressionError as error:
        raise InputError(f"the combination {error}") from error


def check_combination(problem: Problem, text: str) -> None:
    """Raise InputError for text that is no expression of a problem's parameters, or has no value where they begin."""
    trial = problem.trials[0]
    vehicle = trial.run.vehicle
    combination_value(vehicle, read_combination(vehicle, text)[0], {name: trial.values[name] for name in vehicle.free_parameters})


class Uncertainty:
    """The covariance of a fit's parameters, and intervals of anything that depends on them.

    Parameters
    ----------
    fit
        A polished fit.
    structure
        Structural rank and unidentifiable directions.
    facts
        What else was known, as residuals.
    frozen
        What an earlier step told of some of the parameters: the fit kept these as they were, though its runs depend on them.

    Attributes
    ----------
    information, covariance
        Of the searched parameters in the unit cube, `shape (n_parameters, n_parameters)`.
    null
        The directions that recordings and facts together leave open, `shape (n_null, n_parameters)`.
    inflation
        The factor by which intervals are wider than the noise model alone would have them.
    """

    def __init__(self, fit: LeastSquaresFit, structure: Structure, facts: PriorData | None = None, frozen: Frozen | None = None) -> None:
        self.fit = fit
        self.structure = structure
        self.values = fit.values
        space = fit.misfit.problem.space
        information = recorded_information(fit)
        n = fit.misfit.n_parameters
        cross, own = information[:n, n:], information[n:, n:]
        told = information[:n, :n] - cross @ np.linalg.solve(own, cross.T) if own.size else information[:n, :n]
        self.inflation = max(1.0, *run_chi2(fit).values()) ** 0.5
        self.information = told / self.inflation**2
        if facts is not None:
            known = facts.jacobian(self.values) * space.slopes(self.values)
            self.information = self.information + known.T @ known
        if frozen is not None:
            self.information = _with_frozen(self.information, space.names, frozen)
        self.null = structure.null
        if facts is not None:
            self.null = remaining_directions(structure.null, facts.jacobian(self.values) * space.slopes(self.values))
        self.basis = replace(structure, null=self.null).row_space
        reduced = self.basis.T @ self.information @ self.basis
        self.covariance = self.basis @ _covariance(reduced) @ self.basis.T

    def told_of(self, names: Sequence[str]) -> Frozen:
        """Return what is known of some of the parameters, all others marginalised."""
        kept = np.isin(self.structure.space.names, names)
        cross, others = self.information[np.ix_(kept, ~kept)], self.information[np.ix_(~kept, ~kept)]
        told = self.information[np.ix_(kept, kept)] - cross @ _covariance(others) @ cross.T
        return Frozen(tuple(name for name in self.structure.space.names if name in names), told)

    def gradient(self, quantity: Quantity) -> Array:
        """Return a quantity's derivatives by the unit cube's coordinates, `shape (n_parameters,)`."""
        space = self.fit.misfit.problem.space
        unit = self.fit.misfit.split(self.fit.x)[0]
        steps = np.eye(space.size) * _GRADIENT_STEP
        return np.array(
            [(quantity(space.values(unit + step)) - quantity(space.values(unit - step))) / (2 * _GRADIENT_STEP) for step in steps]
        )

    def estimate(self, name: str, quantity: Quantity) -> Estimate:
        """Return a quantity with its interval."""
        value, gradient = quantity(self.values), self.gradient(quantity)
        return self._interval(name, value, gradient) if self.is_identifiable(gradient) else Estimate(name, value)

    def is_identifiable(self, gradient: Array) -> bool:
        """Return whether the recordings, with what is known from elsewhere, determine a quantity with these derivatives."""
        rest = gradient - self.basis @ (self.basis.T @ gradient)
        return bool(np.linalg.norm(rest) <= 1e-4 * max(float(np.linalg.norm(gradient)), 1e-300))

    def parameters(self) -> list[Estimate]:
        """Return every searched parameter."""
        return [self.estimate(name, _component(i)) for i, name in enumerate(self.structure.space.names)]

    def given_fixed_parameters(self) -> list[Estimate]:
        """Return every parameter with its interval for the case that the fixed parameters are known exactly."""
        kept = [i for i in range(self.structure.space.size) if i not in self.structure.fixed_parameters]
        covariance = np.zeros_like(self.information)
        covariance[np.ix_(kept, kept)] = _covariance(self.information[np.ix_(kept, kept)])
        slopes = self.structure.space.slopes(self.values)
        found = []
        for i, name in enumerate(self.structure.space.names):
            gradient = np.zeros(len(slopes))
            gradient[i] = slopes[i]
            found.append(self._interval(name, float(self.values[i]), gradient, covariance))
        return found

    def combination(self, text: str) -> Estimate:
        """Return an expression of the vehicle's parameters, such as `k1/(mT + mS)`.

        Raises
        ------
        InputError
            For text that is no expression of them.
        """
        return self.estimate(text, self.expression(text))

    def expression(self, text: str) -> Quantity:
        """Return an expression of the vehicle's parameters as a quantity; raises InputError for text that is none."""
        trial = self.fit.misfit.problem.trials[0]
        vehicle = trial.run.vehicle
        names = self.structure.space.names
        expression, _ = read_combination(vehicle, text)

        def quantity(values: Array) -> float:
            free = {name: trial.values[name] for name in vehicle.free_parameters} | dict(zip(names, values.tolist(), strict=True))
            return combination_value(vehicle, expression, free)

        return quantity

    def frequencies(self) -> list[tuple[Estimate, Estimate]]:
        """Return each mode's undamped frequency [Hz] and damping ratio."""
        space = self.fit.misfit.problem.space
        unit = self.fit.misfit.split(self.fit.x)[0]
        middle = self.mode_table(self.values)
        steps = np.eye(space.size) * _GRADIENT_STEP
        derived = np.array(
            [(self.mode_table(space.values(unit + s)) - self.mode_table(space.values(unit - s))) / (2 * _GRADIENT_STEP) for s in steps]
        )
        labels = [mode.name for mode in self._modes(self.values)]
        pairs = []
        for j, label in enumerate(labels):
            both = [
                self._interval(label, float(middle[k, j]), derived[:, k, j])
                if self.is_identifiable(derived[:, k, j])
                else Estimate(label, float(middle[k, j]))
                for k in (0, 1)
            ]
            pairs.append((both[0], both[1]))
        return pairs

    def mode_table(self, values: Array) -> Array:
        """Return all undamped frequencies [Hz] and damping ratios at searched values, `shape (2, n_modes)`."""
        found = self._modes(values)
        return np.array([[mode.undamped_hz for mode in found], [mode.damping_ratio for mode in found]])

    def _modes(self, values: Array) -> Sequence[Mode]:
        trial = self.fit.misfit.problem.trials[0]
        names = self.structure.space.names
        return natural_modes(trial.simulator.model, trial.values | dict(zip(names, values.tolist(), strict=True)))

    def _interval(self, name: str, value: float, gradient: Array, covariance: Array | None = None) -> Estimate:
        covariance = self.covariance if covariance is None else covariance
        variance = max(float(gradient @ covariance @ gradient), 0.0)
        spread = float(scipy.stats.norm.ppf(0.5 + LEVEL / 2)) * variance**0.5
        if value > 0:
            factor = float(np.exp(min(spread / value, 50.0)))
            return Estimate(name, value, value / factor, value * factor)
        return Estimate(name, value, value - spread, value + spread)


def _with_frozen(information: Array, names: Sequence[str], frozen: Frozen) -> Array:
    """Return the information `shape (n, n)` of a fit that kept some parameters where an earlier step had left them.

    With information I of its runs on the frozen parameters a and those that it fitted, b, an error of a moves b by -I_bb^-1 I_ba, whatever
    its runs could have told of a themselves. The covariance of both (Murphy and Topel 1985, doi:10.2307/1391724) has this inverse.
    """
    kept = np.array([names.index(name) for name in frozen.names])
    fitted = np.setdiff1d(np.arange(len(names)), kept)
    cross = information[np.ix_(kept, fitted)]
    found = information.copy()
    found[np.ix_(kept, kept)] = frozen.information + cross @ _covariance(information[np.ix_(fitted, fitted)]) @ cross.T
    return found


def _covariance(information: Array) -> Array:
    """Return the covariance of coordinates of the unit cube, `shape (n, n)`, from what is known of them."""
    return np.asarray(np.linalg.pinv(information + LEAST_INFORMATION * np.eye(len(information)), hermitian=True))


def _component(i: int) -> Quantity:
    return lambda values: float(values[i])
