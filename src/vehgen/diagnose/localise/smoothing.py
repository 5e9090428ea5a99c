"""Penalised least squares of a recovered force on functions of travel and rate.

A recovered force lies within a band, so the functions pass the same filter before they are compared with it. Every spectral line counts
by its noise and by what the last fit left; then, as histories again, stretches of time are left out and drawn for intervals.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import product

import numpy as np
import scipy
from numpy.typing import NDArray

from vehgen.diagnose.localise.recovered_force import RecoveredForce

Array = NDArray[np.float64]
Basis = Callable[[Array, Array], Array]
"""(travel, rate) `shape (n,)` -> columns `shape (n, n_columns)`, zero at rest."""
N_KNOTS = 25
"""Knots of a curve."""
CLOSE_SHARE_OF_BANDWIDTH = 0.15
STRENGTHS = 10.0 ** np.arange(-6.0, 3.0)
"""Strengths of a penalty that are tried."""
RIDGE = 1e-9
"""Least penalty: it ties down what no data reach."""
BLOCK_S = 0.3
"""Length of the stretches of time [s]."""
ROUNDS, RELAX = 8, 0.5
"""So many turns between law and motion, each so far."""
FOLDS = 4
"""A single run is cut into so many parts, each of which the others predict."""


@dataclass(frozen=True, eq=False)
class Part:
    """The normal equations of a run, stretch by stretch: `normal shape (n_blocks, p, p)`, `right shape (n_blocks, p)`."""

    normal: Array
    right: Array


@dataclass(frozen=True, eq=False)
class Smooth:
    """A fit: `coefficients shape (p,)` of a basis, and the `penalty shape (p, p)` chosen."""

    coefficients: Array
    penalty: Array


@dataclass(frozen=True, eq=False)
class FittedLaw:
    """A law fitted to runs, whose motion holds what the band hides of its force; `excess` is the PSD it leaves beyond noise [N^2/Hz]."""

    runs: tuple[RecoveredForce, ...]
    basis: Basis
    coefficients: Array
    penalty: Array
    parts: tuple[Part, ...]
    excess: float

    def force(self, travel: Array, rate: Array) -> Array:
        """Return its force at a motion, `shape (n,)`."""
        return np.asarray(self.basis(travel, rate) @ self.coefficients)


def place_knots(x: Array, count: int) -> Array:
    """Return knots over all of x, evenly spaced in asinh(x/scale), scale CLOSE of the largest: closer near rest, where friction turns."""
    scale = CLOSE_SHARE_OF_BANDWIDTH * float(np.abs(x).max())
    return np.asarray(scale * np.sinh(np.linspace(np.arcsinh(x.min() / scale), np.arcsinh(x.max() / scale), count)))


def splines(x: Array, knots: Array) -> Array:
    """Return the cubic B-splines over knots at x, straight on beyond the ends, `shape (n, n_knots + 2)`."""
    count = len(knots) + 2
    curve = scipy.interpolate.BSpline(np.concatenate([[knots[0]] * 3, knots, [knots[-1]] * 3]), np.eye(count), 3)
    inside = np.clip(x, knots[0], knots[-1])
    return np.asarray(curve(inside) + curve.derivative()(inside) * (x - inside)[:, None])


def curves_basis(travel_knots: Array, rate_knots: Array) -> tuple[Basis, list[Array]]:
    """Return the basis of f(travel) + g(rate), two straight lines first, and the penalties of f and of g."""

    def raw(travel: Array, rate: Array) -> Array:
        lines = travel / np.ptp(travel_knots), rate / np.ptp(rate_knots)
        return np.column_stack([*lines, splines(travel, travel_knots), splines(rate, rate_knots)])

    n, m = len(travel_knots) + 2, len(rate_knots) + 2
    penalties = [np.zeros((2 + n + m, 2 + n + m)) for _ in range(2)]
    penalties[0][2 : 2 + n, 2 : 2 + n] = _bend(n)
    penalties[1][2 + n :, 2 + n :] = _bend(m)
    return _from_rest(raw), penalties


def coupled_basis(travel_knots: Array, rate_knots: Array) -> tuple[Basis, list[Array]]:
    """Return the basis of f(travel) + g(rate) with products of both, and its penalties.

    These are powers of the travel times the rate, its square with its sign, and a smooth sign of it: damping and friction that change
    with the travel.
    """
    curves, penalties = curves_basis(travel_knots, rate_knots)
    d0, v0 = float(np.abs(travel_knots).max()), float(np.abs(rate_knots).max())

    def basis(travel: Array, rate: Array) -> Array:
        d, v = travel / d0, rate / v0
        products = [d**i * part for i in (1, 2, 3) for part in (v, v * np.abs(v), v / (np.abs(v) + CLOSE_SHARE_OF_BANDWIDTH))]
        return np.column_stack([curves(travel, rate), *products])

    return basis, [np.pad(item, (0, 9)) for item in penalties]


def _bend(count: int) -> Array:
    """Return the matrix of squared second differences of `count` coefficients."""
    second = np.diff(np.eye(count), 2, axis=0)
    return np.asarray(second.T @ second)


def _from_rest(raw: Basis) -> Basis:
    rest = raw(np.zeros(1), np.zeros(1))
    return lambda travel, rate: raw(travel, rate) - rest


def normal_equations(run: RecoveredForce, force: Array, columns: Array, excess: float) -> Part:
    """Return a run's normal equations.

    Parameters
    ----------
    run
        The run.
    force, columns
        The recovered force `shape (n,)`, and a law's columns `shape (n, p)`, not filtered yet.
    excess
        PSD of what the law leaves beyond noise [N^2/Hz].
    """
    weight = np.zeros(len(run.lines))
    weight[run.lines] = 1 / np.sqrt(run.variance + excess)
    both = np.column_stack([force, run.observable(columns)])
    white = np.fft.irfft(np.fft.rfft(both, axis=0) * weight[:, None], len(both), axis=0)
    pieces = np.array_split(white, max(2, round(len(white) * run.dt / BLOCK_S)))
    return Part(np.array([p[:, 1:].T @ p[:, 1:] for p in pieces]), np.array([p[:, 1:].T @ p[:, 0] for p in pieces]))


def smooth(parts: Sequence[Part], penalties: Sequence[Array]) -> Smooth:
    """Return the fit whose strengths of the penalties, each `shape (p, p)`, predict left-out runs best."""
    if len(parts) > 1:
        folds = [(part.normal.sum(axis=0), part.right.sum(axis=0)) for part in parts]
    else:
        pieces = [np.array_split(item, FOLDS) for item in (parts[0].normal, parts[0].right)]
        folds = [(a.sum(axis=0), b.sum(axis=0)) for a, b in zip(*pieces, strict=True)]
    normal, right = np.sum([a for a, _ in folds], axis=0), np.sum([b for _, b in folds], axis=0)
    scale = float(np.trace(normal)) / len(right)
    ridge = RIDGE * scale * np.eye(len(right))
    best, least = ridge, np.inf
    for strengths in product(STRENGTHS, repeat=len(penalties)):
        penalty = ridge + scale * sum(s * p for s, p in zip(strengths, penalties, strict=True))
        score = 0.0
        for a, b in folds:
            c = np.linalg.solve(normal - a + penalty, right - b)
            score += float(c @ a @ c - 2 * c @ b)
        if score < least:
            best, least = penalty, score
    return Smooth(np.linalg.solve(normal + best, right), best)


def fit_law(recovered: Sequence[RecoveredForce], basis: Basis, penalties: Sequence[Array]) -> FittedLaw:
    """Fit a basis to the forces recovered in the training runs.

    With the law at hand, what the band hides of its force can be added to the motion, and the weights are known; so in turns.
    """
    runs = list(recovered)
    laws = [np.zeros(len(run.time)) for run in runs]
    for _ in range(ROUNDS):
        training = [(run, law) for run, law in zip(runs, laws, strict=True) if not run.validation]
        excess = left_over([run for run, _ in training], [law for _, law in training])
        parts = [normal_equations(run, run.force, basis(run.travel, run.rate), excess) for run, _ in training]
        found = smooth(parts, penalties)
        fitted = FittedLaw(tuple(runs), basis, found.coefficients, found.penalty, tuple(parts), excess)
        laws = [fitted.force(run.travel, run.rate) for run in runs]
        runs = [_relaxed(run, first, *first.unseen_motion(law)) for run, first, law in zip(runs, recovered, laws, strict=True)]
    return fitted


def _relaxed(run: RecoveredForce, first: RecoveredForce, travel: Array, rate: Array) -> RecoveredForce:
    """Return a run a share of the way to the motion with what the band hides: a whole step may overshoot where a law is stiff.

    A law that would move a run more than it moves reaches beyond what it was fitted to; the run is then as it was recovered.
    """
    if any(np.std(more) > np.std(own) for more, own in ((travel, first.travel), (rate, first.rate))):
        return first
    return replace(
        run,
        travel=run.travel + RELAX * (first.travel + travel - run.travel),
        rate=run.rate + RELAX * (first.rate + rate - run.rate),
    )


def bootstrap(law: FittedLaw, draws: int, random: np.random.Generator) -> Array:
    """Return coefficients fitted to stretches of time drawn with replacement from every run, `shape (draws, p)`."""
    found = []
    for _ in range(draws):
        normal, right = law.penalty.copy(), np.zeros(len(law.penalty))
        for part in law.parts:
            counts = np.bincount(random.integers(len(part.right), size=len(part.right)), minlength=len(part.right)).astype(float)
            normal += np.tensordot(counts, part.normal, 1)
            right += counts @ part.right
        found.append(np.linalg.solve(normal, right))
    return np.array(found)


def shifts(law: FittedLaw) -> Array:
    """Return by how much the coefficients change with every variant of the base fit, `shape (n_variants, p)`."""
    training = [run for run in law.runs if not run.validation]
    found = []
    for j in range(len(training[0].variants)):
        normal, right = law.penalty.copy(), np.zeros(len(law.penalty))
        for run in training:
            force, travel, rate = run.variants[j]
            part = normal_equations(run, run.force + force, law.basis(run.travel + travel, run.rate + rate), law.excess)
            normal += part.normal.sum(axis=0)
            right += part.right.sum(axis=0)
        found.append(np.linalg.solve(normal, right) - law.coefficients)
    return np.array(found).reshape(-1, len(law.coefficients))


def left_over(runs: Sequence[RecoveredForce], histories: Sequence[Array]) -> float:
    """Return the mean PSD [N^2/Hz] of what laws' force histories leave of the recovered forces beyond their noise."""
    rest = np.concatenate(
        [_lines(run, run.force - run.observable(history)) - run.variance for run, history in zip(runs, histories, strict=True)]
    )
    return max(float(rest.mean()), 0.0)


def explained_share(runs: Sequence[RecoveredForce], histories: Sequence[Array]) -> float:
    """Return the share of the recovered forces' variance beyond their noise that laws' force histories explain.

    Lines count the less the more of them is noise, by s/(s + noise) with s the mean PSD of the force.
    """
    total = rest = 0.0
    for run, history in zip(runs, histories, strict=True):
        force = _lines(run, run.force)
        signal = max(float((force - run.variance).mean()), 1e-300)
        weight = signal / (signal + run.variance)
        total += float((weight * (force - run.variance)).sum()) * _bandwidth(run)
        rest += float((weight * (_lines(run, run.force - run.observable(history)) - run.variance)).sum()) * _bandwidth(run)
    return 1.0 - max(rest, 0.0) / total if total > 0 else 0.0


def _bandwidth(run: RecoveredForce) -> float:
    return 1 / (len(run.time) * run.dt)


def _lines(run: RecoveredForce, history: Array) -> Array:
    """Return the one-sided PSD of a history as recovered at the lines that see the force [N^2/Hz]."""
    return np.asarray(np.abs(np.fft.rfft(history)[run.lines]) ** 2 * 2 * run.dt / (run.window**2).sum())
