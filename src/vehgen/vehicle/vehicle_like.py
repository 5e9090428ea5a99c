"""A vehicle as an argument: itself, its file, or the name of a bundled model."""

from __future__ import annotations

import os
from pathlib import Path

from vehgen.errors import ArgumentError
from vehgen.vehicle.loading import load_vehicle
from vehgen.vehicle.model import Vehicle

VehicleLike = Vehicle | str | os.PathLike[str]
"""A vehicle, its file, or the name of a bundled model."""


def as_vehicle(vehicle: VehicleLike) -> Vehicle:
    """Return the vehicle that an argument means.

    Raises
    ------
    InputError
        For a file that cannot be used, and for anything else than a vehicle, a file or a name.
    """
    if isinstance(vehicle, Vehicle):
        return vehicle
    if isinstance(vehicle, str | os.PathLike):
        return load_vehicle(Path(vehicle))
    found = type(vehicle).__name__
    raise ArgumentError(f"`vehicle`: a Vehicle, a file or the name of a bundled model was expected, found {found}", "vehicle")
