"""Bounded least squares by Levenberg's and Marquardt's method, on normal equations.

A fit has ten thousand residuals and more, but each run's residuals depend on few of the unknowns: their normal equations are summed up run
by run in a tenth of the time that a factorisation of the whole Jacobian takes. Every step is the best of the linearised problem within the
bounds (P. B. Stark, R. L. Parker, Bounded-variable least squares, Computational Statistics 10, 1995), so that it never leads uphill there.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

Array = NDArray[np.float64]
FIRST_DAMPING = 1e-3
"""Damping of the first step, as a share of the diagonal of the normal equations."""
RENEWED_DAMPING = 1e-6
"""Damping of a step with renewed derivatives: what is left lies along flat valleys."""
LARGEST_DAMPING, LEAST_DAMPING, LESS_DAMPING = 1e8, 1e-9, 1e-2
"""Damping that ends a fit, that is as good as none, and the factor for it where it stands in the way."""
SMALLEST_EIGENVALUE = 1e-15
"""Curvature, as a share of the largest, that counts as none."""
MOST_SETS = 20
"""After so many sets of unknowns held at their bounds, another method looks for the right one."""
SMALLEST_STEP = 1e-7
"""A step that changes no unknown by more than this ends a fit: unknowns count in the unit cube or in standard deviations."""


@dataclass(frozen=True)
class LinearisedPoint:
    """A sum of squares at a point: its `information` J'J `shape (n, n)` and `gradient` J'r `shape (n,)`."""

    information: Array
    gradient: Array


def minimise(
    square: Callable[[Array], float],
    linearise: Callable[[Array], LinearisedPoint],
    x: Array,
    bounds: tuple[Array, Array],
    tolerance: float,
    max_steps: int,
    renew: Callable[[Array], LinearisedPoint] | None = None,
) -> Array:
    """Return where a sum of squares is least within bounds.

    Parameters
    ----------
    square, linearise
        Return the sum of squares, and its normal equations, at unknowns.
    x
        Where to begin, `shape (n,)`.
    bounds
        Lower and upper bounds, `shape (n,)` each.
    tolerance
        Relative change of the sum of squares at which the fit ends.
    max_steps
        So many evaluations of `square` at most.
    renew
        Where `linearise` may use derivatives from elsewhere: returns the equations with those of the point. A fit that is to end goes on
        with them, and ends only where they, too, lead no further.
    """
    low, high = bounds
    x = np.clip(x, low, high)
    now, damping, growth = square(x), FIRST_DAMPING, 2.0
    if not np.isfinite(now):
        return x
    point, steps, renewed = linearise(x), 1, renew is None
    while steps < max_steps:
        step = _step(point, x, bounds, damping)
        expected = -2 * float(point.gradient @ step) - float(step @ point.information @ step)
        moved = x + step
        then, steps = square(moved), steps + 1
        fell = np.isfinite(then) and then < now
        if fell:
            gained = now - then
            x, now = moved, then
            damping *= max(1 / 3, 1 - (2 * min(gained / max(expected, 1e-300), 1.0) - 1) ** 3)
            growth = 2.0
            ended = gained <= tolerance * now and (damping <= LEAST_DAMPING or _left(point, x, step, bounds) <= tolerance * now)
            if gained <= tolerance * now:
                damping = max(damping * LESS_DAMPING, LEAST_DAMPING)
        else:
            ended = expected <= tolerance * now or damping > LARGEST_DAMPING
            damping, growth = damping * growth, growth * 2
        if ended or np.abs(step).max(initial=0.0) < SMALLEST_STEP:
            if renewed or renew is None:
                break
            point, renewed, damping, growth = renew(x), True, min(damping, RENEWED_DAMPING), 2.0
        elif fell:
            point, renewed = linearise(x), renew is None
    return x


def _left(point: LinearisedPoint, x: Array, step: Array, bounds: tuple[Array, Array]) -> float:
    """Return how much the sum of squares would fall by an undamped step from `x`, where the step `step` from `point` has led.

    Damping holds what is little known as firmly as what is well known, so that a damped step along a flat valley gains little.
    """
    here = LinearisedPoint(point.information, point.gradient + point.information @ step)
    full = _step(here, x, bounds, LEAST_DAMPING)
    return -2 * float(here.gradient @ full) - float(full @ here.information @ full)


def _step(point: LinearisedPoint, x: Array, bounds: tuple[Array, Array], damping: float) -> Array:
    """Return the damped Gauss-Newton step that is the best within the bounds."""
    low, high = bounds
    scale = np.maximum(np.diagonal(point.information), 1e-12)
    step = _solve(point.information + damping * np.diag(scale), -point.gradient)
    if np.all((low <= x + step) & (x + step <= high)):
        return step
    size = 1 / np.sqrt(scale)
    matrix, right = point.information * size[:, None] * size + damping * np.eye(len(x)), -point.gradient * size
    room = (low - x) / size, (high - x) / size
    found = _within(matrix, right, *room)
    return np.asarray(np.clip(x + (_slowly_within(matrix, right, *room) if found is None else found) * size, low, high) - x)


def _within(matrix: Array, right: Array, low: Array, high: Array) -> Array | None:
    """Return where y'My/2 - b'y is least between bounds, of a positive definite M, b = `right`; None where that is not found quickly.

    Unknowns are held at the bounds that they cross, and let go where they would leave them, until the sets stay as they are
    (M. Hintermueller, K. Ito, K. Kunisch, SIAM J. Optim. 13, 2002, doi:10.1137/S1052623401383558).
    """
    held = low >= high
    below, above = held.copy(), np.zeros_like(held)
    for _ in range(MOST_SETS):
        free = ~(below | above)
        found = np.where(above, high, low)
        if free.any():
            try:
                factor = scipy.linalg.cho_factor(matrix[np.ix_(free, free)])
            except np.linalg.LinAlgError:
                return None
            found[free] = scipy.linalg.cho_solve(factor, right[free] - matrix[np.ix_(free, ~free)] @ found[~free])
        pull = right - matrix @ found
        now = held | np.where(free, found < low, below & (pull < 0)), ~held & np.where(free, found > high, above & (pull > 0))
        if np.array_equal(now[0], below) and np.array_equal(now[1], above):
            return found
        below, above = now
    return None


def _slowly_within(matrix: Array, right: Array, low: Array, high: Array) -> Array:
    """Return what :func:`_within` looks for by a method that always ends."""
    values, vectors = np.linalg.eigh(matrix)
    root = np.sqrt(np.maximum(values, SMALLEST_EIGENVALUE * values[-1]))
    apart = high > low
    found = np.where(apart, 0.0, low)
    rows = root[:, None] * vectors.T
    sides = (vectors.T @ right) / root - rows @ found
    found[apart] = scipy.optimize.lsq_linear(rows[:, apart], sides, (low[apart], high[apart]), method="bvls").x
    return found


def _solve(matrix: Array, right: Array) -> Array:
    """Return the solution of positive definite equations, in unknowns so scaled that all count alike; singular, the shortest one."""
    scale = 1 / np.sqrt(np.diagonal(matrix))
    scaled = matrix * scale[:, None] * scale
    try:
        found = scipy.linalg.cho_solve(scipy.linalg.cho_factor(scaled), right * scale)
    except np.linalg.LinAlgError:
        found = np.linalg.lstsq(scaled, right * scale)[0]
    return np.asarray(found * scale)
