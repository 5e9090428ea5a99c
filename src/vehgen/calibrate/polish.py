"""The gradient polish of a calibration: from several starts, and again through the recorder that the best fit shows."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from vehgen.fit.alignment import align
from vehgen.fit.chain_estimate import slowest_rate
from vehgen.fit.least_squares import COARSE_TOLERANCE, FitOptions, LeastSquaresFit, estimate_noises, first_noises, fit_least_squares
from vehgen.fit.misfit import Array, Misfit
from vehgen.fit.nuisances import LOW_PASS, Nuisances
from vehgen.fit.parallel import Runner
from vehgen.fit.prior_data import PriorData
from vehgen.fit.problem import Problem
from vehgen.fit.recorders import FoundRecorder, clearest, find_recorder, has_unknown
from vehgen.fit.resolution import RESOLVED_BIAS, resolve

SAME_ANSWER = 1.0
"""Two fits end in one minimum where the square of how far their answers differ is below this many times the noise's mean square."""
REFRESHED_EVERY = 4
"""Derivatives by errors of runs serve for so many steps."""
Told = Callable[[int, float], None]
"""Called with how many starts are polished, and the least loss."""


@dataclass(frozen=True)
class Polish:
    """Polished starts, best first, one of those that answer alike; what stands for undeclared recorders, or None."""

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

    All starts share the runs' alignment at the first of them. Of those that answer alike once the noise is roughly known, one goes on.
    Where a recorder is not declared, its low-pass is found at the best of the fits, and every fit is polished again through it. The last
    time every run is simulated in steps so short that its noise hides their error.

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
    errors = align(Misfit(problem, first_noises(problem), problem.space.values(points[0]), nuisances, band), points[0])
    last = FitOptions(nuisances, band, jacobian_refresh=REFRESHED_EVERY)
    coarse = replace(last, tolerance=COARSE_TOLERANCE)
    rough = replace(coarse, noise_rounds=1)
    fits: list[LeastSquaresFit] = []
    for fit in options.runner.map(partial(fit_least_squares, problem, options=rough, start=errors, prior_data=prior_data), points):
        fits.append(fit)
        if told is not None:
            told(len(fits), min(item.loss for item in fits))
    fits = distinct(fits)
    recorder = None
    if has_unknown(problem.trials):
        fits = list(options.runner.map(partial(_anew, rough, prior_data), fits))
        best = min(fits, key=lambda fit: fit.loss)
        found = find_recorder(best.misfit, best.x).with_usual(slowest_rate(problem.trials))
        tried = list(options.runner.map(partial(_through, problem, coarse, prior_data, best), found))
        recorder = found[clearest(found, [fit.loss for fit in tried])]
        fits = distinct(options.runner.map(partial(_through, problem, rough, prior_data, recorder=recorder), fits))
        last = replace(last, band=recorder.band)
    fine = _resolved(min(fits, key=lambda fit: fit.loss))
    fits = list(options.runner.map(partial(_anew, last, prior_data, problem=fine), fits))
    return Polish(tuple(sorted(fits, key=lambda fit: fit.loss)), recorder)


def distinct(fits: Iterable[LeastSquaresFit]) -> list[LeastSquaresFit]:
    """Return fits to the same runs, best first, without those that answer as a better one does within its noise."""
    kept: list[LeastSquaresFit] = []
    for fit in sorted(fits, key=lambda fit: fit.loss):
        if not any(_answer_alike(other, fit) for other in kept):
            kept.append(fit)
    return kept


def _answer_alike(better: LeastSquaresFit, other: LeastSquaresFit) -> bool:
    pairs = zip(better.misfit.residual_spectrum(better.x), other.misfit.residual_spectrum(other.x), strict=True)
    apart = [better.misfit.whiten(number, mine - theirs) for number, ((mine, _), (theirs, _)) in enumerate(pairs)]
    return 2 * sum(float(np.vdot(lines, lines).real) for lines in apart) < SAME_ANSWER * better.chi2


def _anew(options: FitOptions, prior_data: PriorData | None, fit: LeastSquaresFit, problem: Problem | None = None) -> LeastSquaresFit:
    """Return a fit done again from where it ended, by the noise that it leaves, to the same runs, or to these in other steps."""
    unit, errors = fit.misfit.split(fit.x)
    noises = estimate_noises(fit.misfit, fit.x)
    return fit_least_squares(problem or fit.misfit.problem, unit, options, first=noises, start=errors, prior_data=prior_data)


def _resolved(fit: LeastSquaresFit) -> Problem:
    """Return the problem of a fit in steps whose error is hidden by the noise that it leaves."""
    old = fit.misfit
    misfit = Misfit(old.problem, estimate_noises(old, fit.x), fit.values, old.nuisances, old.band, supposed=old.split(fit.x)[1])
    return resolve(misfit, fit.x, RESOLVED_BIAS)


def _through(
    problem: Problem, options: FitOptions, prior_data: PriorData | None, fit: LeastSquaresFit, recorder: FoundRecorder
) -> LeastSquaresFit:
    """Return a fit polished through a recorder."""
    through = problem.with_trials(recorder.applied(problem.trials))
    unit, errors = fit.misfit.split(fit.misfit.without(fit.x, LOW_PASS))
    options = replace(options, band=recorder.band)
    return fit_least_squares(through, unit, options, first=fit.misfit.noises, start=errors, prior_data=prior_data)
