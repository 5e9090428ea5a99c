"""The gradient polish after a search: bounded least squares on the whitened residuals, the noise estimated along the way."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
import scipy.optimize
from numpy.typing import NDArray
from threadpoolctl import threadpool_limits

from vehgen.fit.adjustments import Adjustment
from vehgen.fit.band import CALIBRATION_BAND_HZ
from vehgen.fit.linearisation import lineariser
from vehgen.fit.misfit import Misfit, Noises, Nuisances
from vehgen.fit.noise import EVEN, Noise, estimate_noise, transform
from vehgen.fit.prior_data import PriorData
from vehgen.fit.problem import Problem

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
LATEST = 1.0
"""Largest delay of a recording looked for [s]."""


@dataclass(frozen=True)
class LeastSquaresFit:
    """A fit: `x` the unknowns of `misfit` (parameters in the unit cube, nuisances).

    `chi2` is the mean square of its whitened residuals; `loss` is -2 ln of the likelihood, less a constant, by which fits are compared.
    """

    misfit: Misfit
    x: Array
    chi2: float
    loss: float

    @property
    def values(self) -> Array:
        """The searched parameters [SI], `shape (n_parameters,)`."""
        return self.misfit.problem.space.values(self.misfit.split(self.x)[0])

    @property
    def on_bound(self) -> tuple[str, ...]:
        """The parameters that the bounds hold."""
        unit = self.misfit.split(self.x)[0]
        return tuple(name for name, u in zip(self.misfit.problem.space.names, unit, strict=True) if min(u, 1 - u) < AT_BOUND)


@dataclass(frozen=True)
class FitOptions:
    """How a least-squares fit is done.

    `nuisances` and `band` [Hz] as in :class:`Misfit`; the noise, where it is not known, is estimated from the residuals and the fit
    repeated `noise_rounds` times; a fit evaluates the residuals at most `max_steps` times and ends at a relative change of their sum of
    squares of `tolerance`. `jacobian_refresh` as in :func:`vehgen.fit.linearisation.lineariser`. `prior_sigma` is the standard deviation,
    in the unit cube, of the prior about the space's start, one for all or one each; the last `n_effect_parameters` parameters, of which it
    says nothing, have a prior of WEAK_PRIOR_SIGMA.
    """

    nuisances: Nuisances = field(default_factory=Nuisances)
    band: tuple[float, float] = CALIBRATION_BAND_HZ
    noise_rounds: int = NOISE_ROUNDS
    max_steps: int = 60
    tolerance: float = FINE_TOLERANCE
    jacobian_refresh: int = 1
    prior_sigma: float | Array = WEAK_PRIOR_SIGMA
    n_effect_parameters: int = 0

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
    start: Array | None = None,
    prior_data: PriorData | None = None,
    shared: Sequence[Adjustment] = (),
    numbers: Sequence[float] = (),
) -> LeastSquaresFit:
    """Fit parameters and nuisances by least squares, from a point of the unit cube.

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
    start
        Where the nuisances begin, `shape (n_unknowns - n_parameters,)`; by default delays come from cross-correlation.
    prior_data
        What is known from elsewhere.
    shared, numbers
        Adjustments fitted along, and the numbers at which they begin (default: neutral).
    """
    options = options or FitOptions()
    known = noises is not None
    noises = noises or first_noises(problem)
    misfit = Misfit(problem, noises, problem.space.values(unit), options.nuisances, options.band, shared)
    begun = [(value - item.neutral) / item.scale for item, value in zip(shared, numbers, strict=True)] if numbers else [0.0] * len(shared)
    x = np.concatenate([np.clip(unit, 0.0, 1.0), begun, first_delays(misfit, unit, begun) if start is None else start])
    result = _fit(misfit, x, prior_data, options, options.tolerance if known else COARSE_TOLERANCE)
    for left in reversed(range(0 if known else options.noise_rounds - 1)):
        noises = estimate_noises(misfit, result)
        misfit = Misfit(problem, noises, problem.space.values(misfit.split(result)[0]), options.nuisances, options.band, shared)
        result = _fit(misfit, result, prior_data, options, COARSE_TOLERANCE if left else options.tolerance)
    residuals = misfit.residuals(result)
    prior = float((misfit.split(result)[1] ** 2).sum())
    lines = zip(misfit.problem.trials, misfit.residual_spectrum(result), strict=True)
    loss = prior + sum(misfit.noises[trial.name].loss(own, answer) for trial, (own, answer) in lines)
    if prior_data is not None:
        loss += float((prior_data.residuals(misfit.problem.space.values(misfit.split(result)[0])) ** 2).sum())
    return LeastSquaresFit(misfit, result, float(np.mean(residuals**2)), loss)


def _fit(misfit: Misfit, x: Array, prior_data: PriorData | None, options: FitOptions, tolerance: float) -> Array:
    n, rest = misfit.n_parameters, misfit.n_unknowns - misfit.n_parameters
    low = np.concatenate([np.zeros(n), np.full(rest, -np.inf)])
    high = np.concatenate([np.ones(n), np.full(rest, np.inf)])
    for i, item in enumerate(misfit.shared):
        low[n + i], high[n + i] = item.bounds
    inside = np.clip(x, low + 1e-6, high - 1e-6)
    space = misfit.problem.space
    middle, priors = space.unit(space.start), options.priors(n)
    inverse_priors = np.hstack([np.diag(1 / priors), np.zeros((n, rest))])
    derive = lineariser(misfit, options.jacobian_refresh)

    def residuals(x: Array) -> Array:
        own = np.concatenate([misfit.residuals(x), (x[:n] - middle) / priors])
        return own if prior_data is None else np.concatenate([own, prior_data.residuals(space.values(x[:n]))])

    def jacobian(x: Array) -> Array:
        own = np.vstack([derive(x).jacobian, inverse_priors])
        if prior_data is None:
            return own
        values = space.values(x[:n])
        return np.vstack([own, np.hstack([prior_data.jacobian(values) * space.slopes(values), np.zeros((len(prior_data.facts), rest))])])

    with threadpool_limits(1, user_api="blas"):  # tall and thin matrices: more threads only wait for one another
        found = scipy.optimize.least_squares(
            residuals,
            inside,
            jacobian,
            (low, high),
            method="trf",
            x_scale="jac",
            xtol=1e-7,
            ftol=tolerance,
            gtol=1e-8,
            max_nfev=options.max_steps,
        )
    return np.asarray(found.x)


def first_noises(problem: Problem) -> Noises:
    """Return noise to begin with, by trial: white, a share of each channel's RMS."""
    found: Noises = {}
    for trial in problem.trials:
        rms = np.sqrt(np.mean(trial.recording.values**2, axis=0))
        found[trial.name] = Noise(EVEN, FIRST_NOISE * rms)
    return found


def estimate_noises(misfit: Misfit, x: Array) -> Noises:
    """Return the noise that the residuals show: one for all trials with the same channels."""
    found: Noises = {}
    lines = dict(zip((trial.name for trial in misfit.problem.trials), misfit.residual_spectrum(x), strict=True))
    for channels in dict.fromkeys(trial.channels for trial in misfit.problem.trials):
        names = [trial.name for trial in misfit.problem.trials if trial.channels == channels]
        old = misfit.noises[names[0]]
        shared = estimate_noise([lines[name] for name in names], Noise(np.maximum(old.levels, FIRST_LEVEL), old.sigma / 2))
        found |= dict.fromkeys(names, shared)
    return found


def first_delays(misfit: Misfit, unit: Array, begun: Sequence[float] = ()) -> Array:
    """Return nuisances whose delays make measured and simulated correlate best: least squares alone may lock onto a wrong cycle.

    `begun` are the shared adjustments in units of their scales (default: neutral).
    """
    names = misfit.nuisances.names
    found = np.zeros((len(misfit.problem.trials), len(names)))
    if "delay" in names:
        x = np.concatenate([unit, begun or np.zeros(len(misfit.shared)), found.ravel()])
        for t, (trial, simulated) in enumerate(zip(misfit.problem.trials, misfit.simulate(x), strict=True)):
            found[t, names.index("delay")] = (
                best_delay(trial.recording.values, simulated, trial.recording.dt, misfit.band) / misfit.nuisances.delay
            )
    return found.ravel()


def best_delay(measured: Array, simulated: Array, dt: float, band: tuple[float, float]) -> float:
    """Return by how much later [s] the simulated channels `shape (n_samples, n_channels)` must come to correlate best with the measured."""
    n = len(simulated)
    frequency = np.fft.rfftfreq(n, dt)
    inside = (frequency >= band[0]) & (frequency <= band[1])
    scale = np.maximum(np.sqrt(np.mean(measured**2, axis=0)), 1e-300)
    one, other = (transform(item / scale, dt, inside) for item in (measured, simulated))
    cross = np.zeros(len(frequency), dtype=np.complex128)
    cross[inside] = (one * other.conj()).sum(axis=1)
    lags = np.fft.irfft(cross, n)
    reach = min(int(LATEST / dt), n // 2 - 1)
    index = np.arange(-reach, reach + 1)
    return float(index[np.argmax(lags[index])] * dt)
