"""How a run begins: displaced or moving bodies and axles, from the run file's `initial`."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from vehgen.errors import InputError, did_you_mean, shown
from vehgen.mechanics.equations_of_motion import EquationsOfMotion
from vehgen.simulate.run_file import Run

Array = NDArray[np.float64]


@dataclass(frozen=True)
class InitialValue:
    """What the run file states of a body's or an axle's begin: `key` (displacement, velocity, pitch, pitch_rate) of `owner`.

    `place` is its number in the state (displacements, then velocities, of the independent coordinates); `tolerance` the standard deviation
    of `value` [SI], 0 where it is exact.
    """

    owner: str
    key: str
    place: int
    value: float
    tolerance: float


def initial_values(run: Run, model: EquationsOfMotion) -> tuple[InitialValue, ...]:
    """Return what a run file states of how the run begins.

    Raises
    ------
    InputError
        For what the vehicle does not have, and for motions that follow from others.
    """
    vehicle, places = model.vehicle, {item.name: i for i, item in enumerate(model.coordinates)}
    found = []
    for owner, entry in run.file.initial.items():
        known = (*vehicle.bodies, *vehicle.axles)
        if owner not in known:
            where = run.document.find(("initial", owner), key=True)
            raise InputError(f"{vehicle.name} has no body or axle {shown(owner)}; {did_you_mean(owner, known)}", where)
        upward = "heave" if owner in vehicle.bodies else "hop"
        asked = {"displacement": (upward, 0), "velocity": (upward, 1), "pitch": ("pitch", 0), "pitch_rate": ("pitch", 1)}
        for key, (value, tolerance) in entry.stated().items():
            motion, order = asked[key]
            if f"{motion}.{owner}" not in places:
                free = ", ".join(places)
                where = run.document.find(("initial", owner, key), key=True)
                raise InputError(
                    f"the {motion} of {owner} cannot be chosen: it follows from others, or there is none; free are {free}", where
                )
            found.append(InitialValue(owner, key, order * len(places) + places[f"{motion}.{owner}"], value, tolerance))
    return tuple(found)


def initial_state(run: Run, model: EquationsOfMotion) -> Array | None:
    """Return displacements, then velocities, of the independent coordinates, `shape (2 n_dof,)` [m, rad, per s]; None at rest.

    They count from static equilibrium. Raises InputError as :func:`initial_values` does.
    """
    if not run.file.initial:
        return None
    found = np.zeros(2 * len(model.coordinates))
    for item in initial_values(run, model):
        found[item.place] = item.value
    return found
