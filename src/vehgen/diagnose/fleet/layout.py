"""Where the vehicles of a fleet are: one subfolder each, with its run files and, if it has one of its own, its vehicle file."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

from vehgen.errors import InputError, shown
from vehgen.files import collecting_reads
from vehgen.files.document import Located, read_document
from vehgen.files.provenance import file_hash
from vehgen.fit.trial import Trial, load_trials
from vehgen.vehicle import Vehicle, load_vehicle
from vehgen.vehicle.loading import find_vehicle_file

OWN_VEHICLE = "vehicle.yaml"
"""The file of a subfolder that holds its vehicle; without it, it is the vehicle that the run files name."""
YAML_ENDINGS = (".yaml", ".yml")
LEFT_OUT = (".", "_")
"""Subfolders whose names begin so are no vehicles: roads or base vehicles that several share, say."""


@dataclass(frozen=True)
class LoadedVehicle:
    """A vehicle of a fleet, ready to be diagnosed.

    `inputs` are the files read, each with its SHA-256: inside the fleet's folder by their path there, others by their name.
    """

    vehicle: Vehicle
    trials: tuple[Trial, ...]
    inputs: tuple[tuple[str, str], ...]


def vehicle_folders(fleet: Path) -> list[Path]:
    """Return the subfolders that hold a vehicle each, by name.

    Raises
    ------
    InputError
        For what is no folder, cannot be read or holds none.
    """
    found = [path for path in _listed(fleet) if path.is_dir() and not path.name.startswith(LEFT_OUT)]
    if not found:
        raise InputError(f"{shown(str(fleet))} holds no vehicle; one subfolder for each was expected, with its run files")
    return found


def load_fleet_vehicle(folder: Path) -> LoadedVehicle:
    """Read a vehicle of a fleet and its runs.

    Parameters
    ----------
    folder
        Its subfolder. Every YAML file in it with an entry `vehicle` is a run.

    Raises
    ------
    InputError
        For a folder without runs, runs of different vehicles, names that are not UTF-8, and every file that cannot be used, with its place.
    """
    files = [path for path in _listed(folder) if path.suffix in YAML_ENDINGS]
    for path in (folder, *files):
        if writable(path.name) != path.name:
            raise InputError(f"the name {shown(path.name)} is not UTF-8, and no result can tell it; rename it")
    with collecting_reads() as read:
        documents = {path: read_document(path) for path in files}
        runs = {path: entry for path, document in documents.items() if path.name != OWN_VEHICLE and (entry := document.child("vehicle"))}
        if not runs:
            raise InputError(f"{folder} holds no run file: a YAML file with the entry `vehicle` was expected")
        vehicle = load_vehicle(folder / OWN_VEHICLE if folder / OWN_VEHICLE in documents else _named(runs, folder))
        trials = tuple(load_trials(list(runs), vehicle))
    inputs = sorted((_label(Path(path), folder.parent), file_hash(Path(path))) for path in read if os.path.isfile(path))
    return LoadedVehicle(vehicle, trials, tuple(inputs))


def writable(text: str) -> str:
    """Return a text as UTF-8 can hold it: bytes of a file name that are not UTF-8 are written out in hexadecimal."""
    return text.encode(errors="backslashreplace").decode()


def _named(runs: dict[Path, Located], folder: Path) -> Path:
    """Return the file of the vehicle that all runs name."""
    files: dict[Path, str] = {}
    for entry in runs.values():
        if not isinstance(entry.value, str):
            raise InputError("the name of a vehicle file was expected", entry.position)
        try:
            files.setdefault(find_vehicle_file(entry.value, folder).resolve(), entry.value)
        except InputError as error:
            raise InputError(error.message, entry.position) from error
    if len(files) > 1:
        names = ", ".join(shown(name) for name in files.values())
        raise InputError(f"the runs in {folder} name different vehicles: {names}; put the one to diagnose there as {OWN_VEHICLE}")
    return next(iter(files))


def _listed(folder: Path) -> list[Path]:
    try:
        return sorted(folder.iterdir())
    except OSError as error:
        raise InputError(f"cannot read the folder {shown(str(folder))}: {error.strerror}") from error


def _label(path: Path, fleet: Path) -> str:
    inside = fleet.resolve()
    return path.relative_to(inside).as_posix() if path.is_relative_to(inside) else path.name
