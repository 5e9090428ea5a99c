"""A vehicle built in one call: derived, checked, compiled, and written as a folder with one page."""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path

from vehgen.codegen import Kernel
from vehgen.files import check_results
from vehgen.mechanics import derive, static_loads
from vehgen.report.pages.build_page import build_files, write_build
from vehgen.simulate import lint, natural_modes
from vehgen.simulate.build import Build, body_channels, summarise_build
from vehgen.vehicle import VehicleLike, as_vehicle


def build(
    vehicle: VehicleLike, folder: str | os.PathLike[str] | None = None, *, parameter_set: str | None = None, plots: bool = True
) -> Build:
    """Derive, check, generate and compile a vehicle, and write its folder.

    Parameters
    ----------
    vehicle
        Itself, its file, or the name of a bundled model.
    folder
        Where equations, kernel, drawings, the result and one page with all of it go (default: nothing is written).
    parameter_set
        One of the vehicle's sets.
    plots
        Whether the folder has drawings.

    Returns
    -------
    Parameters, modes, static loads, warnings, with the equations (`model`) and the `kernel`, whose channels are acceleration and pitch rate
    of every body.

    Raises
    ------
    InputError
        For a vehicle that cannot be used, and a folder that cannot be written to.
    """
    own = as_vehicle(vehicle)
    if folder is not None:
        check_results(build_files(Path(folder), plots))
    model = derive(own, body_channels(own))
    values = model.values(parameter_set)
    modes, loads = natural_modes(model, values), static_loads(model, values)
    findings = lint(model, values)
    kernel = Kernel(model)
    if not kernel.is_compiled:
        kernel.compile()
    found = replace(summarise_build(model, values, modes, loads, findings, plots), kernel=kernel)
    if folder is not None:
        write_build(found, Path(folder), model, kernel.source)
    return found
