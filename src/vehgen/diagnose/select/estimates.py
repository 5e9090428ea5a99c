"""How large an effect is and how sure: intervals, gains on validation runs, and whether every run asks for the same numbers."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy
from numpy.typing import NDArray

from vehgen.diagnose.fits.candidate import Candidate
from vehgen.diagnose.fits.model_fit import ModelFit
from vehgen.diagnose.verdict import NamedParameter
from vehgen.effects import EffectParameter
from vehgen.fit.adjustments import Adjustment
from vehgen.fit.linearisation import linearise
from vehgen.fit.misfit import Misfit
from vehgen.fit.window import flatten, seen_share
from vehgen.simulate.last_used import LastUsed

Array = NDArray[np.float64]
Normal = tuple[dict[int, Array], Array]
_NORMALS = LastUsed[Normal](lambda item: item[1].nbytes + sum(jacobian.nbytes for jacobian in item[0].values()))
"""Several questions are asked of the same fit."""
NINETY = 1.645
"""Half width of a 90 % interval in standard deviations."""
BASE_PRIOR = 0.5
"""Standard deviation of the prior of a base parameter in the unit cube, three times that of the fit, as files may be wrong throughout.

Accelerations tell masses, stiffnesses and forces in proportion only; how large they are then rests on the file.
"""
WEAK_PRIOR = 6.0
"""Standard deviation of the prior of an effect's parameter in the unit cube."""
TOLD = 0.05
"""Runs tell of a parameter that moves them by more than this share of what it moves all runs."""
SAME_WITHIN = 0.3
"""Runs that differ by less than this share of the value ask for the same number, however sure each is."""
EXCLUDE_ONE_ANOTHER = 3.0
"""Runs exclude one another's numbers where what one more of them would ask for may lie so many times a number's value away from it."""


@dataclass(frozen=True)
class RunEstimate:
    """What one run alone asks of an effect's parameter: its value and 90 % half width, in the parameter's unit."""

    run: str
    parameter: str
    value: float
    half_width: float


def estimate(fit: ModelFit, candidate: Candidate | None = None) -> dict[str, NamedParameter]:
    """Return an effect's own parameters (default: of the effect added last) with 90 % intervals.

    Four parts add up in quadrature: noise, from the Fisher information of the fit, widened by the root of its mean square; what the runs
    ask for beyond it (:func:`disagreement`); the scatter of other minima that do as well; and what the law's form makes of a parameter.
    What is solved for in every run is the median over the runs, its interval their spread and that of the base parameters.
    """
    candidate = candidate or fit.last
    misfit = fit.least_squares.misfit
    covariance = np.asarray(
        np.linalg.pinv(normal_equations(fit)[1], hermitian=True) * max(fit.training, 1.0) / share_seen(misfit),
        dtype=np.float64,
    )
    alone = estimates_by_run(fit, candidate)
    found: dict[str, NamedParameter] = {}
    for parameter, column, value, scale in parameter_columns(fit, candidate):
        noise = NINETY * abs(scale) * float(np.sqrt(max(covariance[column, column], 0.0)))
        minima = (
            NINETY * abs(scale) * float(np.std([own[column] for own in fit.equivalent_minima], ddof=1))
            if len(fit.equivalent_minima) > 1
            else 0.0
        )
        apart = disagreement([item for item in alone if item.parameter == parameter.name])
        spread = float(np.linalg.norm([noise, minima, apart, NINETY * parameter.form * value]))
        interval = (value - spread, value + spread) if spread > 0 else None
        found[parameter.name] = NamedParameter(value, interval, parameter.unit)
    return found | _solved(fit, candidate, covariance)


def disagreement(alone: Sequence[RunEstimate]) -> float:
    """Return the half width of the 90 % interval of what one more run would ask for, without its noise.

    Where the library's law has not quite the form of the real one, runs ask for different numbers, each of them sure. Their variance
    beyond their own errors is that of DerSimonian and Laird (1986, doi:10.1016/0197-2456(86)90046-2), the interval the prediction interval
    of Higgins, Thompson and Spiegelhalter (2009, doi:10.1111/j.1467-985X.2008.00552.x), here with Student's t of one degree of freedom less
    than runs (there of two).
    """
    sure = [item for item in alone if item.half_width > 0]
    if len(sure) < 2:
        return 0.0
    values = np.array([item.value for item in sure])
    weights = (NINETY / np.array([item.half_width for item in sure])) ** 2
    excess = float(weights @ (values - weights @ values / weights.sum()) ** 2) - (len(sure) - 1)
    share = float(weights.sum() - (weights**2).sum() / weights.sum())
    variance = excess / share if share > 0 else 0.0
    return float(scipy.stats.t.ppf(0.95, len(sure) - 1) * np.sqrt(max(variance, 0.0) * (1 + 1 / len(sure))))


def normal_equations(fit: ModelFit) -> Normal:
    """Return the Jacobians of trials `shape (n_residuals, n_unknowns)` by number, and the information they and the priors add up to."""
    return _NORMALS.find(id(fit.least_squares), fit.least_squares, lambda: _normal_anew(fit))


def _normal_anew(fit: ModelFit) -> Normal:
    """Return what :func:`normal_equations` remembers.

    Trials whose response jumps are left out where the others tell of all effects: what
    jumps across a difference quotient is no derivative.
    """
    misfit, x, n_effect_parameters = fit.least_squares.misfit, fit.least_squares.x, fit.n_effect_parameters
    trials = misfit.problem.trials
    n, known = misfit.n_parameters, misfit.n_parameters + len(misfit.shared)
    jacobians = {i: flatten(slopes, first=1).T for i, slopes in enumerate(linearise(misfit, x).spectra)}
    smooth = {i: jacobian for i, jacobian in jacobians.items() if not trials[i].jumps}
    asked = slice(n - n_effect_parameters, known)
    whole, part = (_moved(items.values(), misfit.n_unknowns)[asked] for items in (jacobians, smooth))
    if smooth and np.all(part > TOLD * whole):
        jacobians = smooth
    freed = {name for item in fit.effects for name in item.freed}
    base = misfit.problem.space.names[: n - n_effect_parameters]
    prior = np.concatenate(
        [
            np.array([WEAK_PRIOR if name in freed else BASE_PRIOR for name in base]) ** -2.0,
            np.full(n_effect_parameters, WEAK_PRIOR**-2),
            np.zeros(known - n),
            np.ones(misfit.n_unknowns - known),
        ]
    )
    return jacobians, np.diag(prior) + sum(item.T @ item for item in jacobians.values())


def _moved(jacobians: Iterable[Array], n_unknowns: int) -> Array:
    """Return by how much each unknown moves the residuals of some trials, `shape (n_unknowns,)`."""
    return np.sqrt(sum(((item**2).sum(axis=0) for item in jacobians), np.zeros(n_unknowns)))


def share_seen(misfit: Misfit) -> float:
    """Return the share of the records that their tapers let through: neighbouring lines of tapered records are not independent."""
    trials = misfit.problem.trials
    return float(np.mean([seen_share(len(item.recording.time), item.recording.dt, item.fade_in) for item in trials]))


def parameter_columns(fit: ModelFit, candidate: Candidate) -> list[tuple[EffectParameter, int, float, float]]:
    """Return an effect's parameters with their column among the unknowns, their value and their unit per unit of the unknown."""
    misfit, x = fit.least_squares.misfit, fit.least_squares.x
    space = misfit.problem.space
    slopes = space.slopes(space.values(misfit.split(x)[0]))
    found = []
    for parameter, symbol in zip(candidate.effect.parameters, candidate.parameters, strict=False):
        column = space.names.index(symbol)
        found.append((parameter, column, float(fit.least_squares.values[column]), float(slopes[column])))
    for parameter, item in zip(candidate.effect.parameters, candidate.shared, strict=False):
        i = _index(misfit, item)
        found.append((parameter, misfit.n_parameters + i, float(misfit.adjusted(x)[i]), item.scale))
    return found


def fitted_numbers(fit: ModelFit, candidate: Candidate) -> tuple[float, ...]:
    """Return the numbers of an effect's parameters in a fit, those of the vehicle first; what is solved for is not among them."""
    return tuple(value for _, _, value, _ in parameter_columns(fit, candidate))


def _index(misfit: Misfit, adjustment: Adjustment) -> int:
    """Return where an adjustment stands among those of a fit."""
    return next(i for i, own in enumerate(misfit.shared) if type(own) is type(adjustment) and own.place == adjustment.place)


def _solved(fit: ModelFit, candidate: Candidate, covariance: Array) -> dict[str, NamedParameter]:
    """Return those of an effect's parameters that are solved for in every run: medians with 90 % intervals."""
    misfit, x = fit.least_squares.misfit, fit.least_squares.x
    effect = candidate.effect
    if not effect.solved_parameters:
        return {}
    numbers = misfit.adjusted(x)
    adjustments = [replace(item, neutral=float(numbers[_index(misfit, item)])) for item in candidate.shared]
    unit = misfit.split(x)[0]

    def by_run(at: Array) -> Array:
        values = misfit.problem.space.values(at)
        found = []
        for t, trial in enumerate(misfit.problem.trials):
            state = misfit.state(t, values[None], misfit.errors_of(x, t), misfit.scenario(x, t))
            without = misfit.problem.respond(values[None], trial, state.scenario)[0][0]
            found.append(effect.solve(candidate.place, adjustments, trial, without, state.vehicles[0], state))
        return np.array(found)

    runs = by_run(unit)
    medians, scatter = np.median(runs, axis=0), _median_error(runs)
    n, step = len(unit), 1e-3
    slopes = [(np.median(by_run(unit + step * row), axis=0) - medians) / step for row in np.eye(n)]
    found = {}
    for parameter, value, own, gradient in zip(
        effect.solved_parameters, medians, scatter, np.reshape(slopes, (n, len(medians))).T, strict=True
    ):
        spread = NINETY * float(np.sqrt(max(gradient @ covariance[:n, :n] @ gradient, 0.0) + own**2))
        found[parameter.name] = NamedParameter(float(value), (float(value) - spread, float(value) + spread), parameter.unit)
    return found


def _median_error(runs: Array) -> Array:
    """Return what a 90 % interval of the median of few numbers `shape (n_runs, k)` spans, over NINETY; none for a single run.

    Student's t of their scatter, and the median strays by sqrt(pi/2) more than the mean, but that of two, which is their mean.
    """
    n = len(runs)
    if n < 2:
        return np.zeros(runs.shape[1])
    wider = 1.0 if n == 2 else float(np.sqrt(np.pi / 2))
    return np.asarray(wider * scipy.stats.t.ppf(0.95, n - 1) / NINETY * np.std(runs, axis=0, ddof=1) / np.sqrt(n))


def estimates_by_run(fit: ModelFit, candidate: Candidate | None = None) -> list[RunEstimate]:
    """Return what every training run alone asks of an effect's parameters: one Gauss-Newton step from the joint fit.

    The base parameters are held by what the other runs say of them, whatever the effect is; the effect's are free. Runs whose response
    jumps are left out, as they are in :func:`estimate`.
    """
    candidate = candidate or fit.last
    misfit, x = fit.least_squares.misfit, fit.least_squares.x
    columns = parameter_columns(fit, candidate)
    own = [column for _, column, _, _ in columns]
    lines = misfit.whitened_spectrum(x)
    jacobians, whole = normal_equations(fit)
    pulls = {t: jacobian.T @ flatten(lines[t]) for t, jacobian in jacobians.items()}
    blocks = misfit.n_parameters + len(misfit.shared)
    gradient = np.concatenate([np.zeros(blocks), x[blocks:]]) + sum(pulls.values())
    seen, shared = share_seen(misfit), blocks + len(misfit.common)
    found = []
    for t, jacobian in jacobians.items():
        trial, slope = misfit.problem.trials[t], pulls[t]
        information = jacobian.T @ jacobian
        own_block = np.arange(*misfit.own_columns(t).indices(misfit.n_unknowns)[:2])
        kept = np.array([i for i in range(shared) if i not in own] + list(own_block))
        dropped = np.setdiff1d(np.arange(len(whole)), kept)
        rest, pull = whole - information, gradient - slope
        through = rest[np.ix_(kept, dropped)] @ np.linalg.pinv(rest[np.ix_(dropped, dropped)], hermitian=True)
        asked = np.concatenate([kept, own]).astype(int)
        normal, force = information[np.ix_(asked, asked)].copy(), slope[asked].copy()
        n = len(kept)
        normal[:n, :n] += rest[np.ix_(kept, kept)] - through @ rest[np.ix_(dropped, kept)]
        force[:n] += pull[kept] - through @ pull[dropped]
        normal[n:, n:] += np.eye(len(own)) / WEAK_PRIOR**2
        covariance = np.linalg.pinv(normal, hermitian=True)
        step = -covariance @ force
        for k, (parameter, _, value, scale) in enumerate(columns):
            half = NINETY * abs(scale) * float(np.sqrt(max(covariance[n + k, n + k], 0.0) * max(fit.mean_squares[trial.name], 1.0) / seen))
            found.append(RunEstimate(trial.name, parameter.name, value + scale * float(step[n + k]), half))
    return found


def excluded(fit: ModelFit) -> list[str]:
    """Return the parameters of the last effect of which runs ask for numbers that exclude one another: the law is not of that form.

    So they do, too, of what is solved for in every run where the interval of all, which is their scatter, holds 0.
    """
    joint, alone = estimate(fit), estimates_by_run(fit)
    solved = [(item.name, joint[item.name].interval, item.unit) for item in fit.last.effect.solved_parameters]
    told = [f"{name} from {ends[0]:.3g} to {ends[1]:.3g} {unit}" for name, ends, unit in solved if ends and ends[0] <= 0 <= ends[1]]
    for name, item in joint.items():
        own = [one for one in alone if one.parameter == name]
        if disagreement(own) > EXCLUDE_ONE_ANOTHER * abs(item.value):
            told.append(f"{name} from {min(one.value for one in own):.3g} to {max(one.value for one in own):.3g} {item.unit}".rstrip())
    return told


def unstable(fit: ModelFit, candidate: Candidate | None = None) -> list[str]:
    """Return the parameters on which runs disagree: beyond three standard deviations and beyond SAME_WITHIN of the value."""
    joint, alone = estimate(fit, candidate), estimates_by_run(fit, candidate)
    told = []
    for name, item in joint.items():
        for own in alone:
            apart = abs(own.value - item.value)
            if own.parameter == name and apart > 3 * own.half_width / NINETY and apart > SAME_WITHIN * abs(item.value):
                told.append(f"{name} is {item.value:.4g} {item.unit}".rstrip() + f" in all runs, {own.value:.4g} in {own.run} alone")
                break
    return told


def untold(parameters: Mapping[str, NamedParameter]) -> list[str]:
    """Return the numbers of a law, which are above 0, whose intervals do not say so: runs do not tell how large they are."""
    return [name for name, item in parameters.items() if item.interval is not None and item.interval[0] <= 0 < item.value]


def p_value(base: ModelFit, other: ModelFit, extra: int) -> float:
    """Return the probability of such a gain on the training runs by chance: likelihood ratio, chi-squared with `extra` freedoms.

    The gain counts in units of what the better model leaves, so that a gap that neither explains lends no significance.
    """
    names = [trial.name for trial in base.least_squares.misfit.problem.trials]
    gain = sum((base.mean_squares[name] - other.mean_squares[name]) * base.counts[name] for name in names) / max(other.training, 1.0)
    return float(scipy.stats.chi2.sf(max(gain, 0.0), max(extra, 1)))
