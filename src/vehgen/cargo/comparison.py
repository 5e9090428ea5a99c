"""What a cargo changes: mass and COG of its carrier, static axle loads, natural frequencies."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

from vehgen.mechanics import EquationsOfMotion, derive, static_loads
from vehgen.simulate import Mode, natural_modes
from vehgen.vehicle import Vehicle

_MIN_LIKENESS = 0.1


@dataclass(frozen=True)
class Carrier:
    """A body with everything it carries: mass [kg], and its COG ahead of and above that of the body alone [m]."""

    mass: float
    x: float
    z: float


@dataclass(frozen=True)
class LadenComparison:
    """A vehicle before and after loading.

    `axles` holds static loads (before, after) [N] by axle; `modes` each laden mode's name with its undamped frequency before (None for a
    motion that the cargo brings) and after [Hz].
    """

    carrier: tuple[Carrier, Carrier]
    axles: dict[str, tuple[float, float]]
    modes: list[tuple[str, float | None, float]]

    @property
    def cog_shift(self) -> tuple[float, float]:
        """How far the carrier's COG moves forward and up [m]."""
        before, after = self.carrier
        return after.x - before.x, after.z - before.z


def compare_laden(vehicle: Vehicle, laden: Vehicle, on: str, parameter_set: str | None = None) -> LadenComparison:
    """Compare a vehicle with the same vehicle laden.

    Parameters
    ----------
    vehicle, laden
        The second extends the first.
    on
        The body that carries the cargo.
    parameter_set
        One of the vehicle's sets, or None for the values of its file.

    Raises
    ------
    InputError
        When the vehicle has no such set, rests on nothing, or a motion has no inertia.
    """
    before, after = derive(vehicle), derive(laden)
    light, heavy = vehicle.values(parameter_set), laden.values(parameter_set)
    loads, laden_loads = static_loads(before, light).axles, static_loads(after, heavy).axles
    return LadenComparison(
        (_carrier(vehicle, on, light), _carrier(laden, on, heavy)),
        {name: (loads[name], laden_loads[name]) for name in loads},
        _match(before, after, natural_modes(before, light), natural_modes(after, heavy), heavy),
    )


def _carrier(vehicle: Vehicle, on: str, free: Mapping[str, float]) -> Carrier:
    """Return mass and COG of a body with all it carries, and with all that these carry."""
    values = vehicle.all_values(free)
    places = {on: (0.0, 0.0)}
    grown = True
    while grown:
        new = {}
        for name, body in vehicle.bodies.items():
            if body.carried_by is not None and body.carried_by.body in places and name not in places:
                x, z = places[body.carried_by.body]
                new[name] = (x + body.carried_by.x.evaluate(values), z + body.carried_by.z.evaluate(values))
        places |= new
        grown = bool(new)
    masses = {name: vehicle.bodies[name].mass.evaluate(values) for name in places}
    total = sum(masses.values())
    x, z = (sum(masses[name] * place[axis] for name, place in places.items()) / total if total else 0.0 for axis in (0, 1))
    return Carrier(total, x, z)


def _match(
    before: EquationsOfMotion, after: EquationsOfMotion, light: Sequence[Mode], heavy: Sequence[Mode], values: Mapping[str, float]
) -> list[tuple[str, float | None, float]]:
    """Give each laden mode the unladen one of the most similar shape in the coordinates they share (assignment problem)."""
    names = [item.name for item in after.coordinates]
    shared = [names.index(item.name) for item in before.coordinates]
    M = after.numeric(values).M
    likeness = np.zeros((len(heavy), len(light)))
    for i, mode in enumerate(heavy):
        for j, other in enumerate(light):
            shape = np.zeros(len(names))
            shape[shared] = other.shape
            likeness[i, j] = _assurance(mode.shape, shape, M) - 0.1 * abs(
                np.log(max(mode.undamped_hz, 1e-9) / max(other.undamped_hz, 1e-9))
            )
    rows, columns = scipy.optimize.linear_sum_assignment(-likeness)
    partner = {int(i): int(j) for i, j in zip(rows, columns, strict=True) if likeness[i, j] > _MIN_LIKENESS}
    return [(mode.name, light[partner[i]].undamped_hz if i in partner else None, mode.undamped_hz) for i, mode in enumerate(heavy)]


def _assurance(first: NDArray[np.float64], second: NDArray[np.float64], M: NDArray[np.float64]) -> float:
    """Return the modal assurance criterion of two shapes, weighted by mass."""
    return float((first @ M @ second) ** 2 / ((first @ M @ first) * (second @ M @ second)))
