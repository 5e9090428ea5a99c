"""Vehicle files that extend another: written by programs, read by people."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from vehgen.files.units import FREQUENCY, NONE
from vehgen.files.yaml_writer import Commented, even_text, yaml_document
from vehgen.vehicle.loading import is_bundled
from vehgen.vehicle.model import Vehicle


def quantity(vehicle: Vehicle, name: str, value: float) -> str:
    """Return a parameter's value with its SI unit, as a vehicle file writes it; the number reads back exactly."""
    dimension = vehicle.dimensions[name]
    unit = "s^-1" if dimension == FREQUENCY else str(dimension)  # a number and `1/s` would be two numbers
    return f"{float(value)!r}" if dimension == NONE else f"{float(value)!r} {unit}"


def base_reference(vehicle: Vehicle, folder: Path) -> str:
    """Return what `extends:` must say in a file in `folder`: a bundled model's name, or a path relative to the folder."""
    if not vehicle.files:
        return vehicle.name
    path = vehicle.files[0].resolve()
    if is_bundled(path):
        return path.name
    return Path(os.path.relpath(path, folder.resolve())).as_posix()


def plain_data(vehicle: Vehicle) -> dict[str, Any]:
    """Return the plain data of a vehicle's file, with all that it extends; none for a vehicle that was not read from a file or text."""
    return {} if vehicle._document is None else dict(vehicle._document.plain())


def variant_text(
    vehicle: Vehicle,
    folder: Path,
    name: str,
    title: str,
    values: Mapping[str, float],
    comments: Iterable[str] = (),
    notes: Mapping[str, str] | None = None,
) -> str:
    """Return a vehicle file that extends a vehicle with other parameter values.

    Parameters
    ----------
    vehicle
        The vehicle to extend, read from a file.
    folder
        Where the file will stand.
    name, title
        Its own.
    values
        New values [SI] of free parameters.
    comments
        Lines for its head.
    notes
        A comment after a parameter's line, by name.
    """
    beside = notes or {}
    data = {
        "extends": base_reference(vehicle, folder),
        "name": name,
        "title": even_text(title),
        "parameters": {key: Commented({"value": quantity(vehicle, key, value)}, beside.get(key, "")) for key, value in values.items()},
    }
    return yaml_document(data, comments)
