"""A run as an argument: itself or its file."""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path

from vehgen.errors import ArgumentError
from vehgen.simulate.run_file import Run, load_run
from vehgen.vehicle import VehicleLike, as_vehicle

RunLike = Run | str | os.PathLike[str]
"""A run or its file."""


def as_run(run: RunLike, vehicle: VehicleLike | None = None) -> Run:
    """Return the run that an argument means; `vehicle` takes the place of the one that it names.

    Raises
    ------
    InputError
        For a file that cannot be used, and for anything else than a run or a file.
    """
    own = None if vehicle is None else as_vehicle(vehicle)
    if isinstance(run, Run):
        return run if own is None else replace(run, vehicle=own)
    if isinstance(run, str | os.PathLike):
        return load_run(Path(run), own)
    raise ArgumentError(f"`run`: a Run or a run file was expected, found {type(run).__name__}", "run")
