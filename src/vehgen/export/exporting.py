"""A vehicle's equations of motion written for another program, in one call."""

from __future__ import annotations

import math
import os
from collections.abc import Iterable, Mapping
from pathlib import Path

from vehgen.errors import ArgumentError, did_you_mean, shown
from vehgen.export.formats import EXPORT_FORMATS, Format
from vehgen.export.source import ExportSource
from vehgen.files import check_results, write_bytes
from vehgen.mechanics import ModelLike, Output, Place
from vehgen.simulate.state_space import model_with_channels
from vehgen.vehicle.model import finite

SHORTEST_EXPORT_STEP, LONGEST_EXPORT_STEP = 1e-6, 0.1
"""Time steps of exported programs [s]."""


def export(
    model: ModelLike,
    to: str,
    out: str | os.PathLike[str] | None = None,
    *,
    outputs: Iterable[Output] = (),
    forces: Iterable[Place] = (),
    values: Mapping[str, float] | None = None,
    parameter_set: str | None = None,
    linear: bool = False,
    step: float = 1e-3,
) -> list[Path]:
    """Write a vehicle's equations of motion for another program.

    Parameters
    ----------
    model, outputs, forces, values, parameter_set
        As in :func:`vehgen.state_space`.
    to
        The format, one of `vehgen.export.EXPORT_FORMATS`.
    out
        The file, or the folder of a format of several files (default: named as the vehicle, here).
    linear
        Leave force laws out where the format cannot carry them; else such a vehicle is refused.
    step
        Time step of exported programs [s].

    Returns
    -------
    The files written.

    Raises
    ------
    InputError
        For an unknown format, a force law that the format cannot carry, values that no vehicle has, and files that cannot be written.
    """
    if not isinstance(to, str) or to not in EXPORT_FORMATS:
        raise ArgumentError(f"`to`: unknown format {shown(to)}; {did_you_mean(str(to), EXPORT_FORMATS)}", "to")
    if not (isinstance(step, int | float) and math.isfinite(step) and SHORTEST_EXPORT_STEP <= step <= LONGEST_EXPORT_STEP):
        bounds = f"{SHORTEST_EXPORT_STEP:g} s to {LONGEST_EXPORT_STEP:g} s"
        raise ArgumentError(f"`step`: a time step is {bounds}, found {shown(step)}", "step")
    found = model_with_channels(model, outputs, forces)
    chosen = EXPORT_FORMATS[to]
    place = export_place(found.vehicle.name, to, out)
    stem = place.stem if chosen.suffix else chosen.stem(found.vehicle.name)
    check_results([place if chosen.suffix else place / stem])  # before the work; what is written is checked again
    numbers = finite(found.values(parameter_set, values))
    return _write(chosen, ExportSource(found, numbers, linear, float(step), stem), place)


def export_place(vehicle_name: str, to: str, out: str | os.PathLike[str] | None) -> Path:
    """Return the file (of a format of several files, the folder) that an export of a vehicle writes.

    Raises
    ------
    InputError
        For a file whose suffix is not that of the format.
    """
    chosen = EXPORT_FORMATS[to]
    suffix = chosen.suffix
    if out is None:
        return Path(f"{chosen.stem(vehicle_name)}{suffix or f'_{to}'}")
    place = Path(out)
    if suffix and place.suffix.lower() != suffix:
        raise ArgumentError(f"`out`: the name of a file of the format {to} ends in {suffix}; found {shown(place.name)}", "out")
    return place


def _write(chosen: Format, source: ExportSource, place: Path) -> list[Path]:
    written = {(place if chosen.suffix else place / name): data for name, data in chosen.write(source).items()}
    check_results(written)
    for path, data in written.items():
        write_bytes(path, data)
    return list(written)
