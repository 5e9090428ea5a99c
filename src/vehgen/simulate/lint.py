"""What looks wrong in a vehicle although its file can be read."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping

import numpy as np

from vehgen.errors import InputError
from vehgen.files.number_text import kilonewtons, on_terminal
from vehgen.mechanics.energies import pitch_inertia
from vehgen.mechanics.equations_of_motion import EquationsOfMotion
from vehgen.mechanics.static_loads import static_loads
from vehgen.mechanics.symbols import to_sympy
from vehgen.simulate.modes import natural_modes

GYRATION = (0.12, 0.75)
"""Radius of gyration over the span of what is attached to a body: a uniform rod has 0.29, two masses at its ends 0.5."""
BODY_BAND = (0.5, 5.0)
"""Where body modes of road vehicles lie, Hz."""
AXLE_GAP = 0.6
"""Two axles closer than this [m] would share a wheel's space."""


def lint(model: EquationsOfMotion, values: Mapping[str, float] | None = None) -> list[str]:
    """Return one sentence for each thing that deserves a second look, at these parameter values."""
    values = values or model.values()
    return [*_loads(model, values), *_gyration(model, values), *_gaps(model, values), *_modes(model, values)]


def _loads(model: EquationsOfMotion, values: Mapping[str, float]) -> Iterator[str]:
    try:
        loads = static_loads(model, values)
    except InputError as error:
        yield error.message
        return
    for name, force in loads.axles.items():
        if force < 0:
            yield f"negative load on {name}: {on_terminal(kilonewtons(force))} kN; its tyre would have to pull the vehicle down"


def _gyration(model: EquationsOfMotion, values: Mapping[str, float]) -> Iterator[str]:
    vehicle = model.vehicle
    for name, body in vehicle.bodies.items():
        places = [to_sympy(axle.x) for axle in vehicle.axles.values() if axle.body == name]
        places += [to_sympy(joint.points[name].x) for joint in (*vehicle.hinges.values(), *vehicle.links.values()) if name in joint.points]
        if "pitch" not in body.motions or len(places) < 2:
            continue
        mass, inertia, *x = model.evaluate_list([to_sympy(body.mass), pitch_inertia(body), *places], values)
        span = max(x) - min(x)
        if span <= 0 or mass <= 0:
            continue
        radius = float(np.sqrt(inertia / mass))
        if not GYRATION[0] <= radius / span <= GYRATION[1]:
            yield (
                f"radius of gyration of {name} out of scale: {radius:.2f} m for a body whose joints and axles span {span:.2f} m "
                f"({GYRATION[0] * span:.2f} to {GYRATION[1] * span:.2f} m would be usual)"
            )


def _gaps(model: EquationsOfMotion, values: Mapping[str, float]) -> Iterator[str]:
    offsets = model.wheel_offsets(values)
    names = list(model.vehicle.axles)
    order = np.argsort(offsets)
    for first, second in itertools.pairwise(order):
        gap = offsets[second] - offsets[first]
        if gap < AXLE_GAP:
            yield f"overlapping axles: {names[first]} and {names[second]} are {gap:.2f} m apart"


def _modes(model: EquationsOfMotion, values: Mapping[str, float]) -> Iterator[str]:
    vehicle = model.vehicle
    if not vehicle.axles:
        return  # a rig may move as fast or as slowly as it likes
    unsprung = {axle.body for axle in vehicle.axles.values() if axle.suspension is None and len(vehicle.axles) > 1}
    body = np.array([item.motion != "hop" and item.owner not in unsprung for item in model.coordinates])
    for mode in natural_modes(model, values):
        if mode.energy[body].sum() > 0.5 and not BODY_BAND[0] <= mode.undamped_hz <= BODY_BAND[1]:
            yield f"body mode outside {BODY_BAND[0]:g}-{BODY_BAND[1]:g} Hz: {mode.name} at {mode.undamped_hz:.2f} Hz"
