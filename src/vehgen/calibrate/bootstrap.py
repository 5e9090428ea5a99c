"""Check the intervals of a calibration: refit it to redrawn noise, and see how far its combinations and frequencies stray."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from vehgen.calibrate.calibration import Calibration, StepResult
from vehgen.calibrate.intervals import LEAST_INFORMATION, LEVEL, Estimate, Uncertainty
from vehgen.fit.alignment import error_bounds
from vehgen.fit.least_squares import FitOptions, LeastSquaresFit, fit_least_squares
from vehgen.fit.parallel import Runner
from vehgen.fit.prior_data import PriorData
from vehgen.fit.stationary import draw, recorded_information

Array = NDArray[np.float64]
LEFT_OPEN = 0.3
"""An error of a run or a sensor counts as left open where the recordings leave more than this share of its prior's deviation."""


def bootstrap_intervals(
    calibration: Calibration,
    uncertainty: Uncertainty,
    facts: PriorData | None,
    ratios: Sequence[Estimate],
    replicates: int,
    runner: Runner,
) -> list[Estimate]:
    """Return the bootstrap's intervals of combinations, then of the natural frequencies.

    Parameters
    ----------
    calibration
        Fitted by least squares, in one step or more.
    uncertainty
        Of its last step.
    facts
        What was known from elsewhere.
    ratios
        Combinations of parameters, named by their expression.
    replicates
        How many refits.
    runner
        Where the refits run.
    """
    seeds = [int(item) for item in np.random.SeedSequence([calibration.settings.seed, 3]).generate_state(replicates)]
    left_open = [errors_left_open(result.fits[0]) for result in calibration.steps]
    draw = partial(_replicate, calibration.steps, left_open, facts, uncertainty.structure.space.names)
    rows = np.array(list(runner.map(draw, seeds)))
    tail = 50 * (1 - LEVEL)
    found = []
    for estimate in ratios:
        spread = np.array([uncertainty.expression(estimate.name)(row) for row in rows])
        low, high = np.percentile(spread, [tail, 100 - tail])
        found.append(Estimate(estimate.name, estimate.value, float(low), float(high)))
    spread = np.array([uncertainty.mode_table(row)[0] for row in rows])
    for j, (hz, _) in enumerate(uncertainty.frequencies()):
        low, high = np.percentile(spread[:, j], [tail, 100 - tail])
        found.append(Estimate(f"{hz.name} [Hz]", hz.value, float(low), float(high)))
    return found


def _replicate(
    steps: Sequence[StepResult], left_open: Sequence[NDArray[np.bool_]], facts: PriorData | None, names: Sequence[str], seed: int
) -> Array:
    """Return all parameters [SI] fitted anew, step by step, each with what those before it keep."""
    random = np.random.Generator(np.random.PCG64(seed))
    known: dict[str, float] = {}
    for result, open_errors in zip(steps, left_open, strict=True):
        fit = result.fits[0]
        own = None if facts is None else replace(facts, problem=fit.misfit.problem)
        values = refit(fit, random, open_errors, own, known)
        known |= {name: value for name, value in result.problem.best_values(values).items() if name in result.step.kept}
    return np.array([known[name] for name in names])


def errors_left_open(fit: LeastSquaresFit) -> NDArray[np.bool_]:
    """Return which errors of runs and sensors the recordings leave nearly as open as their priors do, `shape (n_errors,)`."""
    information, n = recorded_information(fit), fit.misfit.n_unknowns - fit.misfit.n_errors
    information[:n, :n] += LEAST_INFORMATION * np.eye(n)
    return np.asarray(np.sqrt(np.diagonal(np.linalg.inv(information))[n:]) > LEFT_OPEN)


def refit(
    fit: LeastSquaresFit,
    random: np.random.Generator,
    left_open: NDArray[np.bool_],
    facts: PriorData | None = None,
    frozen: Mapping[str, float] | None = None,
) -> Array:
    """Return the parameters [SI] fitted to recordings drawn at random from a fit: one replicate of a parametric bootstrap.

    What is not measured but believed is drawn, too: facts, and the errors that the recordings leave open `shape (n_errors,)`, of which a
    fit that begins at the truth would learn nothing and so look far too sure. The fit is made with `frozen` parameters [SI] as an earlier
    step's replicate has them.
    """
    misfit = fit.misfit
    unit, errors = misfit.split(fit.x)
    low, high = error_bounds(misfit)
    errors = np.where(left_open, np.clip(random.standard_normal(len(errors)), low, high), errors)
    drawn = draw(misfit, np.concatenate([fit.x[: len(fit.x) - len(errors)], errors]), random)
    trials = [
        replace(trial, recording=replace(trial.recording, values=values))
        for trial, values in zip(misfit.problem.trials, drawn, strict=True)
    ]
    problem = misfit.problem.with_trials(trials).searching(misfit.problem.space.names, dict(frozen or {}))
    again = fit_least_squares(
        problem,
        unit,
        FitOptions(misfit.nuisances, misfit.band),
        noises=misfit.noises,
        start=errors,
        shared=misfit.shared,
        numbers=tuple(misfit.adjusted(fit.x)),
        prior_data=None if facts is None else replace(facts.drawn(fit.values, random), problem=problem),
    )
    return again.values
