"""Intervals of a law's numbers where derivatives do not tell them: a stop that no run meets, a number at an end of its range.

A stop that lies just beyond the largest travel changes nothing if it moves away and much if it comes nearer; of this a derivative makes a
narrow interval. And what is at an end of its range may lie beyond it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from vehgen.diagnose.fits.candidate import Candidate
from vehgen.diagnose.fits.model_fit import ModelFit
from vehgen.diagnose.select.estimates import NINETY, estimate, normal_equations, parameter_columns, share_seen, untold
from vehgen.diagnose.verdict import NamedParameter
from vehgen.fit.window import flatten

Array = NDArray[np.float64]
Interval = tuple[float, float]
FAR_BEYOND = 0.2, 0.4
"""So far beyond an end of its range, in the unit cube, a number is moved that stands there."""


def told_numbers(fit: ModelFit, candidate: Candidate) -> tuple[dict[str, NamedParameter], list[str]]:
    """Return an effect's parameters, and the names of those of which the runs do not tell how large they are.

    Intervals are those of :func:`vehgen.diagnose.select.estimates.estimate`, wider where that is not the whole truth: to an end of what was
    searched, if a number may lie there, all else as it is, for no more than an interval's rise of -2 ln L; and beyond an end to which
    the runs push a number, by a step of Gauss and Newton. One that may as well lie far beyond the end where it stands has none.
    """
    parameters = estimate(fit, candidate)
    if not candidate.effect.changes_vehicle:
        return parameters, []
    found, anywhere = dict(parameters), list[str]()
    names, on_bound = fit.least_squares.misfit.problem.space.names, fit.least_squares.on_bound
    for parameter, column, _, scale in parameter_columns(fit, candidate):
        item = found[parameter.name]
        if column < len(names) and item.interval is not None:
            at_end = names[column] in on_bound
            interval, is_open = _at_an_end(fit, column, scale, item.interval) if at_end else _within(fit, column, item.interval)
            found[parameter.name] = replace(item, interval=interval)
            anywhere += [parameter.name] if is_open else []
    return found, list(dict.fromkeys([*untold(parameters), *anywhere]))


def _within(fit: ModelFit, column: int, interval: Interval) -> tuple[Interval, bool]:
    """Return an interval with the ends of the range at which the number may lie, and whether there is one."""
    space, x = fit.least_squares.misfit.problem.space, fit.least_squares.x
    ends = [
        float(bound[column]) for place, bound in ((0.0, space.lower), (1.0, space.upper)) if _rise(fit, _moved(x, column, place)) <= 1.0
    ]
    return (min(*interval, *ends), max(*interval, *ends)), bool(ends)


def _at_an_end(fit: ModelFit, column: int, scale: float, interval: Interval) -> tuple[Interval | None, bool]:
    """Return the interval of a number at an end of its range, and whether it may as well lie far beyond: it has no interval then."""
    x, step = fit.least_squares.x, _unbounded_step(fit)
    side = 1.0 if x[column] > 0.5 else -1.0
    far, farther = (_rise(fit, _moved(x, column, x[column] + side * beyond)) for beyond in FAR_BEYOND)
    if far <= 1.0 and abs(farther - far) <= 1.0:
        return None, True
    stepped, pushed = x + step, 0.0
    if side * step[column] > 0 and _rise(fit, _moved(stepped, column, x[column])) - _rise(fit, stepped) > 1.0:
        pushed = scale * float(step[column])
    return (interval[0] + min(pushed, 0.0), interval[1] + max(pushed, 0.0)), False


def told_alone(parameters: Mapping[str, NamedParameter], untold_names: list[str]) -> dict[str, NamedParameter]:
    """Return the parameters of which runs tell how large they are; all where they tell none."""
    return {name: item for name, item in parameters.items() if name not in untold_names} or dict(parameters)


def _moved(x: Array, column: int, place: float) -> Array:
    """Return unknowns of which one has moved to a place."""
    return np.concatenate([x[:column], [place], x[column + 1 :]])


def _rise(fit: ModelFit, moved: Array) -> float:
    """Return by how much -2 ln L rises where the unknowns have moved, over what a 90 % interval allows."""
    misfit, x = fit.least_squares.misfit, fit.least_squares.x
    with np.errstate(all="ignore"):  # beyond its range a number may make no vehicle
        rise = float(np.sum(misfit.residuals(moved) ** 2) - np.sum(misfit.residuals(x) ** 2))
    return rise * share_seen(misfit) / (NINETY**2 * max(fit.training, 1.0))


def _unbounded_step(fit: ModelFit) -> Array:
    """Return the step of Gauss and Newton from where a fit ended, as if nothing held it, `shape (n_unknowns,)`."""
    misfit, x = fit.least_squares.misfit, fit.least_squares.x
    jacobians, whole = normal_equations(fit)
    lines, known = misfit.whitened_spectrum(x), misfit.n_parameters + len(misfit.shared)
    pull = np.concatenate([np.zeros(known), x[known:]]) + sum(jacobian.T @ flatten(lines[t]) for t, jacobian in jacobians.items())
    return np.asarray(-np.linalg.pinv(whole, hermitian=True) @ pull)
