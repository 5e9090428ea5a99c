"""What a calibration may search: parameters, their ranges, and the unit cube that search methods see."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from vehgen.errors import InputError, did_you_mean, shown
from vehgen.vehicle import Vehicle

Array = NDArray[np.float64]
LOG_RATIO = 3.0
"""A range of positive values whose ends differ by more than this factor is searched on a logarithmic scale."""


@dataclass(frozen=True)
class SearchSpace:
    """Parameters with their ranges [SI]: `lower`, `upper`, `start` `shape (n,)`; `start` is the vehicle file's value.

    Search methods see the unit cube: 0 is the lower bound, 1 the upper, on a logarithmic scale where `logarithmic` says so.
    """

    names: tuple[str, ...]
    lower: Array
    upper: Array
    start: Array

    @property
    def size(self) -> int:
        """Number of parameters."""
        return len(self.names)

    @property
    def logarithmic(self) -> NDArray[np.bool_]:
        """Which parameters are searched on a logarithmic scale, `shape (n,)`."""
        positive = self.lower > 0
        return np.asarray(positive & (self.upper > LOG_RATIO * np.where(positive, self.lower, 1.0)))

    def values(self, unit: Array) -> Array:
        """Return the values [SI] at points of the unit cube, both `shape (..., n)`."""
        log = self.logarithmic
        low = np.where(log, self.lower, 1.0)
        ratio = np.where(log, self.upper, 1.0) / low
        return np.asarray(np.where(log, low * ratio**unit, self.lower + unit * (self.upper - self.lower)))

    def unit(self, values: Array) -> Array:
        """Return the points of the unit cube of values [SI] within the ranges."""
        log = self.logarithmic
        low, value = np.where(log, self.lower, 1.0), np.where(log, values, 1.0)
        ratio = np.where(log, self.upper, np.e) / low
        found = np.where(log, np.log(value / low) / np.log(ratio), (values - self.lower) / (self.upper - self.lower))
        return np.asarray(np.clip(found, 0.0, 1.0))

    def slopes(self, values: Array) -> Array:
        """Return d value / d unit at values `shape (n,)`."""
        log = self.logarithmic
        ratio = np.where(log, self.upper, 1.0) / np.where(log, self.lower, 1.0)
        return np.asarray(np.where(log, values * np.log(ratio), self.upper - self.lower))

    def only(self, names: Sequence[str]) -> SearchSpace:
        """Return the space of some of its parameters, in its own order."""
        kept = [i for i, name in enumerate(self.names) if name in names]
        return SearchSpace(tuple(self.names[i] for i in kept), self.lower[kept], self.upper[kept], self.start[kept])


def search_space(vehicle: Vehicle, values: Mapping[str, float], names: Sequence[str] | None = None) -> SearchSpace:
    """Return the space of the vehicle's parameters that have a `range`, or of some of them.

    Parameters
    ----------
    vehicle
        The vehicle.
    values
        Its free parameters [SI]; the start of the search.
    names
        Only these (default: all with a range).

    Raises
    ------
    InputError
        Where no parameter has a range, a name has none, or a range excludes the value.
    """
    ranges = vehicle.ranges()
    if not ranges:
        raise InputError(
            f"no parameter of {vehicle.name} has a `range`: give those that calibration may search, e.g. `range: [1 kN/m, 9 kN/m]`"
        )
    for name in names or ():
        if name not in ranges:
            raise InputError(f"{shown(name)} is not a parameter with a range; {did_you_mean(name, ranges)}")
    chosen = [name for name in ranges if names is None or name in names]
    for name in chosen:
        low, high = ranges[name]
        if not low <= values[name] <= high:
            raise InputError(
                f"the range of {name}, {low:g} to {high:g}, excludes its value {values[name]:g} (SI units)",
                vehicle.position("parameters", name, "range"),
            )
    return SearchSpace(
        tuple(chosen),
        np.array([ranges[name][0] for name in chosen]),
        np.array([ranges[name][1] for name in chosen]),
        np.array([values[name] for name in chosen]),
    )
