"""The gradient polish of a calibration: from several starts, and again through the recorder that the best fit shows."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from functools import partial

from vehgen.fit.alignment import align
from vehgen.fit.chain_estimate import slowest_rate
from vehgen.fit.least_squares import COARSE_TOLERANCE, FitOptions, LeastSquaresFit, first_noises, fit_least_squares
from vehgen.fit.misfit import Array, Misfit
from vehgen.fit.nuisances import LOW_PASS, Nuisances
from vehgen.fit.parallel import Runner
from vehgen.fit.prior_data import PriorData
from vehgen.fit.problem import Problem
from vehgen.fit.recorders import FoundRecorder, clearest, find_recorder, has_unknown

FIRST_ROUNDS, LAST_ROUNDS = 2, 2
"""So often is the noise estimated before the recorder is known, and after."""
REFRESHED_EVERY = 4
"""Derivatives by errors of runs serve for so many steps."""
Told = Callable[[int, float], None]
"""Called with how many starts are polished, and the least loss."""


@dataclass(frozen=True)
class Polish:
    """Polished starts, best first, and what stands for recorders that no run file declares (None where all are declared)."""

    fits: tuple[LeastSquaresFit, ...]
    recorder: FoundRecorder | None


@dataclass(frozen=True)
class PolishOptions:
    """Errors of runs and sensors fitted along, the band compared [Hz], and where the starts run."""

    nuisances: Nuisances
    band: tuple[float, float]
    runner: Runner


def polish(
    problem: Problem, points: Sequence[Array], options: PolishOptions, prior_data: PriorData | None = None, told: Told | None = None
) -> Polish:
    """Fit a problem from several points by least squares.

    All starts share the runs' alignment at the first of them. Where a recorder is not declared, its low-pass is found at the best of the
    fits, and every fit is polished again through it.

    Parameters
    ----------
    problem
        Trials and searched parameters.
    points
        Where to begin in the unit cube, `shape (n_parameters,)` each, the most promising first.
    options
        How to polish.
    prior_data
        What is known from elsewhere, of the problem's own parameters.
    told
        Told of progress.
    """
    nuisances, band = options.nuisances, options.band
    noises = first_noises(problem)
    errors = align(Misfit(problem, noises, problem.space.values(points[0]), nuisances, band), points[0])
    unknown = has_unknown(problem.trials)
    own = FitOptions(nuisances, band, jacobian_refresh=REFRESHED_EVERY)
    if unknown:
        own = replace(own, noise_rounds=FIRST_ROUNDS, tolerance=COARSE_TOLERANCE)
    fits: list[LeastSquaresFit] = []
    for fit in options.runner.map(partial(fit_least_squares, problem, options=own, start=errors, prior_data=prior_data), points):
        fits.append(fit)
        if told is not None:
            told(len(fits), min(item.loss for item in fits))
    if not unknown:
        return _sorted(fits, None)
    best = min(fits, key=lambda fit: fit.loss)
    found = find_recorder(best.misfit, best.x).with_usual(slowest_rate(problem.trials))
    tried = list(options.runner.map(partial(_through, problem, own, prior_data, best), found))
    recorder = found[clearest(found, [fit.loss for fit in tried])]
    last = replace(own, noise_rounds=LAST_ROUNDS, tolerance=FitOptions().tolerance)
    return _sorted(options.runner.map(partial(_through, problem, last, prior_data, recorder=recorder), fits), recorder)


def _sorted(fits: Iterable[LeastSquaresFit], recorder: FoundRecorder | None) -> Polish:
    return Polish(tuple(sorted(fits, key=lambda fit: fit.loss)), recorder)


def _through(
    problem: Problem, options: FitOptions, prior_data: PriorData | None, fit: LeastSquaresFit, recorder: FoundRecorder
) -> LeastSquaresFit:
    """Return a fit polished through a recorder."""
    through = problem.with_trials(recorder.applied(problem.trials))
    unit, errors = fit.misfit.split(fit.misfit.without(fit.x, LOW_PASS))
    options = replace(options, band=recorder.band)
    return fit_least_squares(through, unit, options, first=fit.misfit.noises, start=errors, prior_data=prior_data)
