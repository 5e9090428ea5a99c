"""Populations as callers give them: values by name become an array, and what cannot be one is refused."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vehgen.errors import ArgumentError, InputError
from vehgen.mechanics import EquationsOfMotion
from vehgen.mechanics.law_terms import check_laws
from vehgen.vehicle.checks import check_values

Array = NDArray[np.float64]
Values = Mapping[str, float]


def population_of(model: EquationsOfMotion, values: Values | Sequence[Values] | None) -> Array:
    """Return the array of one individual, or of several, from values by name [SI]; what is not named keeps the file's value.

    Returns
    -------
    `shape (n_individuals, n_parameters)` in the order of `model.parameters`.

    Raises
    ------
    InputError
        For names that the vehicle does not have, values that are no numbers, and negative masses, stiffness or damping.
    """
    individuals = [values or {}] if values is None or isinstance(values, Mapping) else list(values)
    for item in individuals:
        if not isinstance(item, Mapping):
            kinds = "values by name, or a list of such (of a table: `to_dict('records')`)"
            raise ArgumentError(f"`values`: {kinds} were expected, found {type(values).__name__} of {type(item).__name__}", "values")
    usual = model.values()
    rows = []
    for number, item in enumerate(individuals):
        row = model.values(overrides=item)
        if any(row[name] <= 0 and row[name] != usual[name] for name in row):
            _check_individual(model, row, f" in individual {number}" if len(individuals) > 1 else " with the given values")
        rows.append(list(row.values()))
    return as_population(model, np.array(rows, dtype=np.float64).reshape(len(rows), len(model.parameters)))


def as_population(model: EquationsOfMotion, parameters: Any) -> Array:
    """Return a population as an array `shape (n_individuals, n_parameters)`; raises ArgumentError for what is none, or empty."""
    try:
        found = np.asarray(parameters, dtype=np.float64)
    except (TypeError, ValueError):
        found = np.empty(0)
    if found.ndim != 2 or found.shape[1] != len(model.parameters) or not len(found):
        what = f"shape {found.shape}" if isinstance(parameters, np.ndarray) else type(parameters).__name__
        expected = f"(n_individuals, {len(model.parameters)})"
        raise ArgumentError(
            f"`parameters`: an array of shape {expected} was expected, as `Simulator.parameters` makes it of values by name; found {what}",
            "parameters",
        )
    return found


def _check_individual(model: EquationsOfMotion, row: Values, where: str) -> None:
    """Refuse one individual that is not physical."""
    free = {name: row[name] for name in model.vehicle.free_parameters}
    try:
        check_values(model.vehicle, free, where)
        check_laws(model.vehicle, free, where)
    except InputError as error:
        raise ArgumentError(f"`values`: {error.message}", "values") from error
