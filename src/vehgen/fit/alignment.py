"""Where the errors of runs begin in a fit: each run laid over its recording, slow motions first.

How a speed and its wander are off turns the phase of fast motions by whole cycles, and least squares would lock onto a wrong one. So speeds
are tried, and lengths of a hump that is but guessed, each with the delay at which measured and simulated correlate best; from the best of
them each run's own errors are fitted to slow motions, then to faster and faster ones. Over a measured road they are fitted to all of these
at once, too, and the better of both stands: there the few lines of slow motions may ask for a speed that wanders far off.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import product

import numpy as np
from numpy.typing import NDArray

from vehgen.fit.descent import descend
from vehgen.fit.linearisation import Lineariser
from vehgen.fit.misfit import Misfit
from vehgen.fit.window import transform

Array = NDArray[np.float64]
SPEED_SIGMAS = tuple(0.5 * i for i in range(-7, 8))
"""Errors of the speed that are tried, in standard deviations."""
GUESSED, LENGTH_SIGMAS = 0.1, (-1.0, -0.5, 0.0, 0.5, 1.0)
"""Of a hump whose length has a larger standard deviation than this share, errors of the length that are tried, in standard deviations."""
BANDS_HZ = (3.0, 8.0, 20.0)
"""Highest frequencies of the motions that are laid over one another, the slow ones first [Hz]."""
WIDER = 1.2
"""A band is left out that does not reach so many times as high as it begins."""
MOST_SIGMAS = 4.0
"""No error of a run or a sensor is larger than so many standard deviations: what needs more is no small error."""
MOST_SHARPENED = 1.0
"""Edges of a hump are drawn sharp: they may be sharper still by so many standard deviations of their wear, no more."""
LEAST_SHARE = 0.1
"""No speed, and no height or length of a hump, is less than this share of what was stated, however little is known of it."""
LATEST = 1.0
"""Largest delay of a recording looked for [s]."""
STEPS = 10
"""So many steps at most in each band."""
TOLERANCE = 1e-3
SLOPES_SERVE, FORETOLD = 2, 1
"""Derivatives by a run's errors serve so often, and so many between follow from the step (`refresh` and `secants` of Lineariser)."""


def align(misfit: Misfit, unit: Array, begun: Sequence[float] = (), bands: Sequence[float] = BANDS_HZ) -> Array:
    """Return errors `shape (n_errors,)` at which each run lies over its recording; those of sensors are none.

    Parameters
    ----------
    misfit
        Whose errors begin.
    unit
        Parameters in the unit cube, `shape (n_parameters,)`.
    begun
        Shared adjustments in units of their scales (default: neutral).
    bands
        Highest frequencies [Hz] to which each run's errors are fitted in turn; without any, only delay and speed are looked for.
    """
    x = np.concatenate([unit, begun or np.zeros(len(misfit.shared)), np.zeros(misfit.n_errors)])
    for number in range(len(misfit.problem.trials)):
        if misfit.error_position(number, "delay") is not None and misfit.problem.trials[number].scenario.track.parts:
            x[misfit.own_columns(number)] = _laid_over(misfit, x, number, bands)
    return x[misfit.n_parameters + len(misfit.shared) :]


def _laid_over(misfit: Misfit, x: Array, number: int, bands: Sequence[float]) -> Array:
    """Return the own errors of one run, `shape (n_own,)`."""
    trial = misfit.problem.trials[number]
    alone = _alone(misfit, number, x)
    names = [item.name for item in alone.errors[0].own]
    sigma = alone.errors[0].own[names.index("delay")].sigma
    low, high = misfit.band
    top = BANDS_HZ[1] if WIDER * low < BANDS_HZ[1] < high else high
    best, start = -np.inf, np.zeros(len(names))
    guessed = any(item.name == "length" and item.sigma > GUESSED for item in alone.errors[0].own)
    ways = {"speed": SPEED_SIGMAS, "length": LENGTH_SIGMAS if guessed else (0.0,)}
    known = [name for name in ways if name in names]
    least = dict(zip(names, error_bounds(alone)[0], strict=True))
    for errors in product(*(sorted({max(error, least[name]) for error in ways[name]}) for name in known)):
        tried = np.zeros(len(names))
        tried[[names.index(name) for name in known]] = errors
        simulated = alone.motions(np.concatenate([np.zeros(len(alone.shared)), tried]))[0]
        late, likeness = best_delay(trial.recording.values, simulated, trial.recording.dt, (low, top))
        if likeness > best:
            tried[names.index("delay")] = np.clip(late / sigma, -MOST_SIGMAS, MOST_SIGMAS)
            best, start = likeness, tried
    if "speed" not in names:
        return start
    found, reached = start, [highest for highest in bands if WIDER * low < highest < high]
    for highest in reached:
        found = _fitted(_alone(misfit, number, x, (low, highest)), found)
    if not trial.scenario.over_measured_road or len(reached) < 2:
        return found
    fast = _alone(misfit, number, x, (low, reached[-1]))
    return min(found, _fitted(fast, start), key=lambda errors: _loss(fast, errors))


def _alone(misfit: Misfit, number: int, x: Array, band: tuple[float, float] | None = None) -> Misfit:
    """Return the misfit of one trial by its own errors only, all else as the unknowns x have it, within another band [Hz]."""
    values = misfit.problem.best_values(misfit.problem.space.values(misfit.split(x)[0]))
    problem = misfit.problem.with_trials([misfit.problem.trials[number]]).searching((), values)
    shared = [replace(item, neutral=float(value), scale=0.0) for item, value in zip(misfit.shared, misfit.adjusted(x), strict=True)]
    return Misfit(problem, misfit.noises, np.zeros(0), misfit.nuisances, band or misfit.band, shared, misfit.common_errors(x))


def error_bounds(misfit: Misfit, most: float = MOST_SIGMAS) -> tuple[Array, Array]:
    """Return the least and the largest errors, `shape (n_errors,)` each, of `most` standard deviations where nothing else is known."""
    low = np.full(misfit.n_errors, -most)
    for i, item in enumerate(misfit.conditions(np.zeros(misfit.n_unknowns))):
        if item.name == "wear":
            low[i] = -MOST_SHARPENED
        elif item.name in ("speed", "height", "length"):
            low[i] = max(-most, (LEAST_SHARE - 1) / item.sigma)
    return low, np.full(misfit.n_errors, most)


def _fitted(alone: Misfit, start: Array) -> Array:
    shared = np.full(len(alone.shared), MOST_SIGMAS)
    low, high = error_bounds(alone)
    begun = np.concatenate([np.zeros(len(alone.shared)), start])
    bounds = np.append(-shared, low), np.append(shared, high)
    return descend(alone, begun, Lineariser(alone, SLOPES_SERVE, secants=FORETOLD), bounds, TOLERANCE, STEPS)[len(alone.shared) :]


def _loss(alone: Misfit, errors: Array) -> float:
    return float((alone.residuals(np.concatenate([np.zeros(len(alone.shared)), errors])) ** 2).sum())


def best_delay(measured: Array, simulated: Array, dt: float, band: tuple[float, float]) -> tuple[float, float]:
    """Return by how much later [s] simulated channels `shape (n_samples, n_channels)` must come to be most like the measured, and how like.

    Likeness is the correlation of all channels together within the band [Hz], each in units of its own size: a dead channel counts little.
    """
    n = len(simulated)
    frequency = np.fft.rfftfreq(n, dt)
    inside = (frequency >= band[0]) & (frequency <= band[1])
    one, other = (transform(item / np.maximum(np.sqrt(np.mean(item**2, axis=0)), 1e-300), dt, inside) for item in (measured, simulated))
    cross = np.zeros(len(frequency), dtype=np.complex128)
    cross[inside] = (one * other.conj()).sum(axis=1)
    lags = np.fft.irfft(cross, n)
    reach = min(int(LATEST / dt), n // 2 - 1)
    index = np.arange(-reach, reach + 1)
    size = float(np.sqrt((np.abs(one) ** 2).sum() * (np.abs(other) ** 2).sum()))
    place = int(np.argmax(lags[index]))
    return float(index[place] * dt), float(lags[index[place]] * n / 2 / max(size, 1e-300))
