"""The gradient polish after a search: bounded least squares on the whitened residuals, the noise estimated along the way."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from vehgen.fit.adjustments import Adjustment
from vehgen.fit.alignment import MOST_SIGMAS, align, error_bounds
from vehgen.fit.band import CALIBRATION_BAND_HZ
from vehgen.fit.descent import descend
from vehgen.fit.linearisation import Linearisation, Lineariser
from vehgen.fit.misfit import Misfit, Noises
from vehgen.fit.noise import EVEN, Noise, estimate_noise
from vehgen.fit.nuisances import Condition, Nuisances
from vehgen.fit.prior_data import PriorData
from vehgen.fit.problem import Problem
from vehgen.fit.rig_noise import RunResidual, likeliest_noises, unstated_sizes
from vehgen.fit.window import flatten

Array = NDArray[np.float64]
AT_BOUND = 1e-3
"""Nearer than this to 0 or 1 in the unit cube, a parameter counts as on its bound."""
WEAK_PRIOR_SIGMA = 2.0
"""Spring that holds parameters to the file's values where no data do: its standard deviation is twice the search range."""
NOISE_ROUNDS = 3
COARSE_TOLERANCE, FINE_TOLERANCE = 1e-4, 1e-8
"""Relative change of the sum of squares at which a fit ends: before the noise is known, and at the end."""
FIRST_NOISE = 0.03
"""White noise assumed before any is estimated, as a share of each channel's RMS."""
FIRST_LEVEL = 1e-6
"""Roughness from which the estimate of the road starts [m^3]."""


@dataclass(frozen=True)
class LeastSquaresFit:
    """A fit: `x` the unknowns of `misfit` (parameters in the unit cube, adjustments, errors of sensors and runs).

    `chi2` is the mean square of its whitened residuals; `loss` is -2 ln of the likelihood, less a constant, by which fits are compared;
    `linearisation` the last one that it took.
    """

    misfit: Misfit
    x: Array
    chi2: float
    loss: float
    linearisation: Linearisation | None = None

    def conditions(self) -> tuple[Condition, ...]:
        """Return what it supposes of sensors and runs."""
        return self.misfit.conditions(self.x)

    @property
    def values(self) -> Array:
        """The searched parameters [SI], `shape (n_parameters,)`."""
        return self.misfit.problem.space.values(self.misfit.split(self.x)[0])

    @property
    def adjusted_to_bounds(self) -> tuple[Adjustment, ...]:
        """The adjustments of runs or sensors that are at an end of their range."""
        pairs = zip(self.misfit.shared, self.misfit.adjusted(self.x), strict=True)
        return tuple(item for item, value in pairs if item.scale > 0 and min(value - item.low, item.high - value) <= AT_BOUND * item.scale)

    @property
    def on_bound(self) -> tuple[str, ...]:
        """The parameters that the bounds hold."""
        unit = self.misfit.split(self.x)[0]
        return tuple(name for name, u in zip(self.misfit.problem.space.names, unit, strict=True) if min(u, 1 - u) < AT_BOUND)


SECANTS = 1
"""In fits that end with computed derivatives so many between these follow from the step; others would end too early by them."""


@dataclass(frozen=True)
class FitOptions:
    """How a least-squares fit is done.

    `nuisances` and `band` [Hz] as in :class:`Misfit`; the noise, where it is not known, is estimated from the residuals and the fit
    repeated `noise_rounds` times; a fit evaluates the residuals at most `max_steps` times and ends at a relative change of their sum of
    squares of `tolerance`. `jacobian_refresh` as in :class:`vehgen.fit.linearisation.Lineariser`. `prior_sigma` is the standard deviation,
    in the unit cube, of the prior about the space's start, one for all or one each; the last `n_effect_parameters` parameters, of which it
    says nothing, have a prior of WEAK_PRIOR_SIGMA. No error of a run or a sensor exceeds `most_sigmas` standard deviations.
    """

    nuisances: Nuisances = field(default_factory=Nuisances)
    band: tuple[float, float] = CALIBRATION_BAND_HZ
    noise_rounds: int = NOISE_ROUNDS
    max_steps: int = 60
    tolerance: float = FINE_TOLERANCE
    jacobian_refresh: int = 1
    prior_sigma: float | Array = WEAK_PRIOR_SIGMA
    n_effect_parameters: int = 0
    most_sigmas: float = MOST_SIGMAS

    def priors(self, n_parameters: int) -> Array:
        """Return the standard deviation of every parameter's prior, `shape (n_parameters,)`."""
        n_own = self.n_effect_parameters
        return np.concatenate([np.full(n_parameters - n_own, self.prior_sigma), np.full(n_own, WEAK_PRIOR_SIGMA)])


def fit_least_squares(
    problem: Problem,
    unit: Array,
    options: FitOptions | None = None,
    *,
    noises: Noises | None = None,
    first: Noises | None = None,
    start: Array | Callable[[Misfit], Array] | None = None,
    prior_data: PriorData | None = None,
    shared: Sequence[Adjustment] = (),
    numbers: Sequence[float] = (),
    known: Mapping[tuple[str, str], float] | None = None,
    nearby: Linearisation | None = None,
) -> LeastSquaresFit:
    """Fit parameters and errors by least squares, from a point of the unit cube.

    Parameters
    ----------
    problem
        Trials and searched parameters.
    unit
        Where to begin, `shape (n_parameters,)`.
    options
        How the fit is done.
    noises
        Known noise; it is then not estimated.
    first
        Noise from which its estimation starts (default: :func:`first_noises`).
    start
        Where the errors begin, `shape (n_errors,)`, or what tells that of the misfit; by default every run is laid over its recording.
    prior_data
        What is known from elsewhere.
    shared, numbers
        Adjustments fitted along, and the numbers at which they begin (default: neutral).
    known
        Errors of sensors that stand, as in :class:`Misfit`.
    nearby
        A linearisation of a fit to the same runs, whose derivatives by the runs' errors serve first.
    """
    options = options or FitOptions()
    given = noises is not None
    noises = noises or first or first_noises(problem)
    begun = [(value - item.neutral) / item.scale for item, value in zip(shared, numbers, strict=True)] if numbers else [0.0] * len(shared)
    misfit = Misfit(problem, noises, problem.space.values(unit), options.nuisances, options.band, shared, known, begun=begun)
    errors = align(misfit, unit, begun) if start is None else start(misfit) if callable(start) else start
    if given:
        misfit = Misfit(problem, noises, problem.space.values(unit), options.nuisances, options.band, shared, known, errors, begun)
    x = np.concatenate([np.clip(unit, 0.0, 1.0), begun, errors])
    result, last = _fit(misfit, x, prior_data, options, options.tolerance if given else COARSE_TOLERANCE, nearby)
    for left in reversed(range(0 if given else options.noise_rounds - 1)):
        noises = estimate_noises(misfit, result)
        (found, supposed), begun = misfit.split(result), result[misfit.n_parameters : misfit.n_parameters + len(shared)].tolist()
        misfit = Misfit(problem, noises, problem.space.values(found), options.nuisances, options.band, shared, known, supposed, begun)
        result, last = _fit(misfit, result, prior_data, options, COARSE_TOLERANCE if left else options.tolerance, last)
    values, errors = problem.space.values(misfit.split(result)[0]), misfit.split(result)[1]
    spectrum = misfit.residual_spectrum(result)
    loss = float((errors**2).sum())
    loss += sum(misfit.noises[trial.name].loss(*own) for trial, own in zip(misfit.problem.trials, spectrum, strict=True))
    if prior_data is not None:
        loss += float((prior_data.residuals(values) ** 2).sum())
    residuals = np.concatenate([*(flatten(misfit.whiten(t, lines)) for t, (lines, _) in enumerate(spectrum)), errors])
    return LeastSquaresFit(misfit, result, float(np.mean(residuals**2)), loss, last)


def _fit(
    misfit: Misfit, x: Array, prior_data: PriorData | None, options: FitOptions, tolerance: float, nearby: Linearisation | None
) -> tuple[Array, Linearisation | None]:
    renewed, priors = options.jacobian_refresh > 1 and tolerance < COARSE_TOLERANCE, options.priors(misfit.n_parameters)
    derive, bounds = (
        Lineariser(misfit, options.jacobian_refresh, nearby, SECANTS if renewed else 0),
        unknown_bounds(misfit, options.most_sigmas),
    )
    found = descend(misfit, x, derive, bounds, tolerance, options.max_steps, priors=priors, prior_data=prior_data, renewed=renewed)
    return found, derive.last


def unknown_bounds(misfit: Misfit, most_sigmas: float = MOST_SIGMAS) -> tuple[Array, Array]:
    """Return the least and the largest values of a misfit's unknowns, each `shape (n_unknowns,)`."""
    n, errors = misfit.n_parameters, error_bounds(misfit, most_sigmas)
    shared = np.reshape([item.bounds for item in misfit.shared], (-1, 2))
    low = np.concatenate([np.zeros(n), shared[:, 0], errors[0]])
    return low, np.concatenate([np.ones(n), shared[:, 1], errors[1]])


def first_noises(problem: Problem) -> Noises:
    """Return noise to begin with, by trial: white, a share of each channel's RMS."""
    found: Noises = {}
    for trial in problem.trials:
        rms = np.sqrt(np.mean(trial.recording.values**2, axis=0))
        found[trial.name] = Noise(EVEN, FIRST_NOISE * rms)
    return found


def estimate_noises(misfit: Misfit, x: Array) -> Noises:
    """Return the noise that the residuals show: sensors alike in all trials with the same channels, roads of one kind.

    Where measured forces drive rigs, and no run file states their noise, that is part of it.
    """
    found: Noises = {}
    lines = dict(zip((trial.name for trial in misfit.problem.trials), misfit.residual_spectrum(x), strict=True))
    for channels in dict.fromkeys(trial.channels for trial in misfit.problem.trials):
        group = [trial for trial in misfit.problem.trials if trial.channels == channels]
        names = [trial.name for trial in group]
        if not any(trial.scenario.track.parts for trial in group) and any(unstated_sizes(trial) for trial in group):
            found |= likeliest_noises([RunResidual(trial, *lines[trial.name]) for trial in group])
            continue
        old = misfit.noises[names[0]]
        each = estimate_noise([lines[name] for name in names], Noise(np.maximum(old.levels, FIRST_LEVEL), old.sigma / 2))
        found |= dict(zip(names, each, strict=True))
    return found
