"""Combinations of parameters that recordings tell where they do not tell the parameters one by one: ratios, above all over the sprung mass.

Where all masses, stiffnesses and dampings may grow together, the motion tells each of them over the mass: what can be compared with data
sheets as soon as one weight is known.
"""

from __future__ import annotations

import functools
import operator

import numpy as np
from numpy.typing import NDArray

from vehgen.calibrate.intervals import Estimate, Uncertainty, read_combination
from vehgen.files.expression_tree import Symbol
from vehgen.files.expressions import Expression
from vehgen.files.units import NONE
from vehgen.vehicle import Vehicle

Array = NDArray[np.float64]
SAME_RATE = 1e-6
"""Parameters whose relative rates along all unidentifiable directions differ by less, over the largest, grow alike."""


def combination_unit(vehicle: Vehicle, text: str) -> str:
    """Return the SI unit of an expression of a vehicle's parameters, empty for a plain number."""
    dimension = read_combination(vehicle, text)[1]
    return "" if dimension == NONE else str(dimension)


def sprung_mass(vehicle: Vehicle) -> Expression | None:
    """Return the sum of the bodies' masses, where each is a parameter."""
    masses = [body.mass for body in vehicle.bodies.values()]
    if not masses or not all(isinstance(mass.root, Symbol) for mass in masses):
        return None
    return functools.reduce(operator.add, masses)


def identifiable_ratios(known: Uncertainty) -> list[Estimate]:
    """Return ratios, each identifiable, of parameters that are not: all over the sprung mass where it grows as they do.

    Parameters
    ----------
    known
        How sure a fit is, and what it leaves open.

    Returns
    -------
    Estimates named by their expression, in the order of the parameters; none where all is identifiable.
    """
    vehicle = known.fit.misfit.problem.trials[0].run.vehicle
    names = known.structure.space.names
    whole = sprung_mass(vehicle)
    found: dict[int, Estimate] = {}
    for group in _growing_alike(known):
        if whole is not None and known.is_identifiable(known.gradient(known.expression(f"{names[group[0]]}/({whole})"))):
            members = [i for i in group if names[i] not in whole.names]
            base = whole
        else:
            members, base = group[1:], Expression.symbol(names[group[0]])
        found |= {i: known.combination(str(Expression.symbol(names[i]) / base)) for i in members}
    return [found[i] for i in sorted(found)]


def _growing_alike(known: Uncertainty) -> list[list[int]]:
    """Return groups of parameters that every unidentifiable direction scales alike, by their numbers."""
    slopes = known.structure.space.slopes(known.values)
    with np.errstate(divide="ignore", invalid="ignore"):
        relative = np.where(known.values == 0, np.nan, known.null * slopes / known.values)
    close = SAME_RATE * float(np.nanmax(np.abs(relative), initial=0.0))
    groups: list[list[int]] = []
    for i, rate in enumerate(relative.T):
        if not np.isfinite(rate).all() or not (np.abs(rate) > close).any():
            continue
        alike = [group for group in groups if np.abs(relative[:, group[0]] - rate).max() <= close]
        if alike:
            alike[0].append(i)
        else:
            groups.append([i])
    return groups
