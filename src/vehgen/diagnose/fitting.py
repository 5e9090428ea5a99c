"""Fits with equal effort: the base and every candidate, on the training runs, judged on untouched ones."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy.stats
from numpy.typing import NDArray

from vehgen.diagnose.candidate import Candidate, pose, retarget, starts
from vehgen.effects import Surveyor
from vehgen.identify.misfit import Misfit, Noises, Nuisances
from vehgen.identify.polish import Polished, polish
from vehgen.identify.problem import Problem
from vehgen.identify.space import SearchSpace
from vehgen.identify.trial import Trial
from vehgen.simulate import Simulator

Array = NDArray[np.float64]
NUISANCES = Nuisances(delay=0.05, speed=0.005, height=0.02)
"""What a run may not know of itself: its clock, 0.5 % of its speed, 2 % of its road's height."""
BOUND = 0.3
"""The base may move its parameters by this share of a logarithm about the file's values: looser, it absorbs the effect."""
HOLD = 0.17
"""Standard deviation of a base parameter in the unit cube: 0.1 of a logarithm."""
ROUGH = 1e-4
HOPELESS = 0.5
MOST_STARTS = 4
"""So many of an effect's starts are fitted."""
RENEW = 5
"""As in Misfit: saves two thirds of the time."""
FINE = 1e-6


@dataclass(frozen=True)
class Fit:
    """A fitted model: `candidate` None for the base; `train` and `held_out` mean squares of whitened residuals (1 is noise alone).

    `runs` are the mean squares run by run, training runs first; `counts` how many residuals stand behind each.
    """

    candidate: Candidate | None
    polished: Polished
    train: float
    held_out: float
    runs: dict[str, float]
    counts: dict[str, int]

    @property
    def label(self) -> str:
        """Its name in words."""
        return "base" if self.candidate is None else self.candidate.label


def narrow(problem: Problem, start: Array | None = None) -> Problem:
    """Return the problem with its space cut to BOUND about the file's values."""
    space = problem.space
    reach = np.maximum(np.abs(space.start) * (np.exp(BOUND) - 1), 0.02 * (space.upper - space.lower))
    positive = space.lower > 0
    low = np.where(positive, np.maximum(space.lower, space.start * np.exp(-BOUND)), np.maximum(space.lower, space.start - reach))
    high = np.where(positive, np.minimum(space.upper, space.start * np.exp(BOUND)), np.minimum(space.upper, space.start + reach))
    return Problem(problem.trials, SearchSpace(space.names, low, high, space.start if start is None else start))


def fit_base(problem: Problem, held_out: Sequence[Trial], noises: Noises, band: tuple[float, float]) -> Fit:
    """Fit the base model."""
    fit = polish(problem, problem.space.unit(problem.space.start), NUISANCES, band, noises=noises, hold=HOLD, tolerance=FINE, renew=RENEW)
    return judge(None, fit, held_out, noises)


def fit_candidate(
    candidate: Candidate,
    base: Problem,
    held_out: Sequence[Trial],
    noises: Noises,
    band: tuple[float, float],
    surveyor: Surveyor,
    unit: Array,
    errors: Array,
    simulators: dict[object, Simulator],
    worst: float,
) -> Fit:
    """Fit a candidate's effect together with the base parameters: roughly from every start, finely from the best.

    Parameters
    ----------
    candidate, base, held_out, noises, band, surveyor, simulators
        As elsewhere.
    unit
        Base parameters in the unit cube to begin with, e.g. those of the place test.
    errors
        Nuisances to begin with.
    worst
        The base model's mean square: a candidate that leaves HOPELESS of its excess after the rough fits is not refined.
    """
    problem = pose(candidate, base, surveyor, simulators)
    best: Polished | None = None
    for begin, combination in _promising(candidate, problem, noises, band, surveyor, unit, errors):
        fit = polish(
            problem,
            begin,
            NUISANCES,
            band,
            noises=noises,
            start=errors,
            hold=HOLD,
            free=len(candidate.parameters),
            shared=candidate.shared,
            numbers=combination if candidate.shared else (),
            max_steps=8,
            tolerance=ROUGH,
            renew=RENEW,
        )
        if best is None or fit.loss < best.loss:
            best = fit
    assert best is not None
    if best.chi2 - 1 > HOPELESS * max(worst - 1, 0.0):
        return judge(candidate, best, (), noises)
    misfit = best.misfit
    fine = polish(
        problem,
        misfit.split(best.x)[0],
        NUISANCES,
        band,
        noises=noises,
        start=misfit.split(best.x)[1].ravel(),
        hold=HOLD,
        free=len(candidate.parameters),
        shared=candidate.shared,
        numbers=tuple(misfit.adjusted(best.x)),
        max_steps=25,
        tolerance=FINE,
        renew=RENEW,
    )
    return judge(candidate, fine, held_out, noises)


def _promising(
    candidate: Candidate, problem: Problem, noises: Noises, band: tuple[float, float], surveyor: Surveyor, unit: Array, errors: Array
) -> list[tuple[Array, tuple[float, ...]]]:
    """Return the MOST_STARTS starts that fit best before any fitting: points of the unit cube, with the numbers of an adjustment."""
    n, own = len(unit), len(candidate.parameters)
    misfit = Misfit(problem, noises, problem.space.start, NUISANCES, band, candidate.shared)
    ranked = []
    for combination in starts(candidate, surveyor):
        point = problem.space.start.copy()
        if own:
            point[n:] = combination[:own]
        begin = np.concatenate([unit, problem.space.unit(point)[n:]])
        numbers = [(value - item.neutral) / item.scale for item, value in zip(candidate.shared, combination, strict=False)]
        loss = float((misfit.residuals(np.concatenate([begin, numbers, errors])) ** 2).sum())
        ranked.append((loss if np.isfinite(loss) else np.inf, begin, combination))
    ranked.sort(key=lambda item: item[0])
    return [(begin, combination) for _, begin, combination in ranked[:MOST_STARTS]]


def judge(candidate: Candidate | None, fit: Polished, held_out: Sequence[Trial], noises: Noises) -> Fit:
    """Simulate a fitted model on untouched runs, of which only the clock, speed and road height are fitted."""
    runs, counts = _by_run(fit.misfit, fit.x)
    train = _pooled(runs, counts)
    later = float("nan")
    if held_out:
        problem = fit.misfit.problem
        fixed = problem.best_values(fit.values)
        vehicle = problem.trials[0].run.vehicle
        shared: dict[object, Simulator] = {
            (id(vehicle), repr(tuple(c.output for c in trial.measurement.channels)), repr(trial.run.forces())): trial.simulator
            for trial in problem.trials
        }
        trials = [retarget(trial, vehicle, shared) for trial in held_out]
        numbers = fit.misfit.adjusted(fit.x)
        frozen = Problem(
            tuple(replace(t, values=t.values | {k: v for k, v in fixed.items() if k not in t.fixed}) for t in trials), _nothing()
        )
        frozen_shared = tuple(
            replace(item, neutral=float(value), scale=1e-12) for item, value in zip(fit.misfit.shared, numbers, strict=True)
        )
        again = polish(frozen, np.zeros(0), NUISANCES, fit.misfit.band, noises=noises, shared=frozen_shared, tolerance=FINE, renew=RENEW)
        own, own_counts = _by_run(again.misfit, again.x)
        later = _pooled(own, own_counts)
        runs |= own
        counts |= own_counts
    return Fit(candidate, fit, train, later, runs, counts)


def _nothing() -> SearchSpace:
    return SearchSpace((), np.zeros(0), np.zeros(0), np.zeros(0))


def _by_run(misfit: Misfit, x: Array) -> tuple[dict[str, float], dict[str, int]]:
    lines = misfit.white_lines(x)
    names = [trial.name for trial in misfit.problem.trials]
    return (
        {name: float(np.mean(np.abs(item) ** 2)) for name, item in zip(names, lines, strict=True)},
        {name: 2 * item.size for name, item in zip(names, lines, strict=True)},
    )


def _pooled(runs: dict[str, float], counts: dict[str, int]) -> float:
    total = sum(counts[name] for name in runs)
    return sum(runs[name] * counts[name] for name in runs) / total


def p_value(base: Fit, other: Fit, extra: int) -> float:
    """Return the probability of such a gain by chance: likelihood ratio, chi-squared with `extra` degrees of freedom."""
    names = [trial.name for trial in base.polished.misfit.problem.trials]
    gain = sum((base.runs[name] - other.runs[name]) * base.counts[name] for name in names)
    return float(scipy.stats.chi2.sf(max(gain, 0.0), max(extra, 1)))
