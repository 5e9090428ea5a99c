"""Names of parts and parameters: well formed, free of other meanings, each once."""

from __future__ import annotations

import keyword

from vehgen.errors import InputError, shown
from vehgen.files.names import is_identifier
from vehgen.files.units import UNITS
from vehgen.vehicle.model import Vehicle
from vehgen.vehicle.parts import GROUND

_RESERVED = {GROUND, "k", "c", "title", "points", "laws"}


def check_names(vehicle: Vehicle) -> None:
    """Check the names of parameters, bodies, hinges, axles and links; raises InputError at the first fault."""
    if not vehicle.bodies:
        raise InputError("a vehicle needs at least one body", vehicle.position("bodies", key=True))
    for name in vehicle.parameters:
        if name in UNITS:
            message = f"{name!r} is a unit and cannot name a parameter; choose e.g. {name}1 or {name}_body"
            raise InputError(message, vehicle.position("parameters", name, key=True))
        _check_name(vehicle, "parameters", name)
    seen: dict[str, str] = {}
    for kind in ("bodies", "hinges", "axles", "links"):
        for name in getattr(vehicle, kind):
            _check_name(vehicle, kind, name)
            place = vehicle.position(kind, name, key=True)
            if name in _RESERVED:
                raise InputError(f"{name!r} has a meaning of its own and cannot be a name", place)
            if name in seen:
                raise InputError(f"duplicate name {name!r}: it is already in `{seen[name]}`", place)
            seen[name] = kind


def _check_name(vehicle: Vehicle, kind: str, name: str) -> None:
    if not is_identifier(name) or keyword.iskeyword(name):
        message = f"{shown(name)} cannot be a name: a letter, then letters, digits and underscores were expected (of ASCII)"
        raise InputError(message, vehicle.position(kind, name, key=True))
