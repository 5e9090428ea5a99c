"""Derive, check, generate and compile a vehicle; show it and write its folder."""

from __future__ import annotations

import argparse
import time
from pathlib import Path
from typing import TYPE_CHECKING

from vehgen.commands.results import add_out, folder_named
from vehgen.commands.terminal import add_vehicle, console, load, print_json, print_table, warn
from vehgen.files import check_results

if TYPE_CHECKING:
    from collections.abc import Sequence

    from vehgen.mechanics import EquationsOfMotion, StaticLoads
    from vehgen.simulate import Mode

EXAMPLE = "vehgen build tractor5.yaml --out build/tractor5"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the command's arguments."""
    add_vehicle(parser)
    add_out(parser, "DIR", "where to write (default: build/NAME)")
    parser.add_argument("--no-plots", action="store_true", help="leave out drawing and mode shapes (faster)")


def run(options: argparse.Namespace) -> None:
    """Build a vehicle."""
    start = time.perf_counter()
    vehicle, _free = load(options)
    folder = folder_named(options.out, Path("build") / vehicle.name)
    from vehgen.report import build_files, write_build_folder

    check_results(build_files(folder, plots=not options.no_plots))
    from vehgen.codegen import Kernel
    from vehgen.mechanics import derive, static_loads
    from vehgen.simulate import natural_modes
    from vehgen.simulate.build import body_channels
    from vehgen.simulate.lint import lint

    model = derive(vehicle, body_channels(vehicle))
    values = model.values(options.parameter_set)
    modes = natural_modes(model, values)
    loads = static_loads(model, values)
    findings = lint(model, values)
    kernel = Kernel(model)
    kernel.compile()
    written = write_build_folder(folder, model, values, modes, loads, kernel.source, findings, plots=not options.no_plots)
    seconds = time.perf_counter() - start
    if options.json:
        print_json(_summary(model, values, modes, loads, findings, kernel.source.operation_counts, folder, written))
        return
    _show(model, values, modes, loads)
    counts = kernel.source.operation_counts
    print_table("Kernel", ("phase", "operations"), [(phase, str(count)) for phase, count in counts.items()], right=(1,))
    warn(findings)
    console().print(f"built in {seconds:.1f} s; open {folder / 'index.html'}", highlight=False, markup=False)


def _show(model: EquationsOfMotion, values: dict[str, float], modes: Sequence[Mode], loads: StaticLoads) -> None:
    vehicle = model.vehicle
    title = vehicle.title or vehicle.name
    counts = (
        ("bodies", vehicle.bodies),
        ("hinges", vehicle.hinges),
        ("axles", vehicle.axles),
        ("links", vehicle.links),
    )
    print_table(
        f"{title}: layout",
        ("", "number", "names"),
        [(key, str(len(items)), ", ".join(items)) for key, items in counts],
        right=(1,),
    )
    rows = [(str(i), item.name, item.unit, item.meaning) for i, item in enumerate(model.coordinates)]
    print_table("Coordinates", ("", "name", "unit", "meaning"), rows)
    everything = vehicle.all_values({name: values[name] for name in vehicle.free_parameters})
    dimensions = vehicle.dimensions
    parameter_rows = [
        (
            name,
            f"{everything[name]:.6g}",
            str(dimensions[name]).replace("no unit", "-"),
            str(item.equals or ""),
            item.meaning,
        )
        for name, item in vehicle.parameters.items()
    ]
    print_table("Parameters", ("name", "value", "unit", "equals", "meaning"), parameter_rows, right=(1,))
    mode_rows = [(mode.name, f"{mode.undamped_hz:.3f}", f"{mode.damped_hz:.3f}", f"{mode.damping_ratio:.3f}") for mode in modes]
    print_table("Modes", ("mode", "undamped, Hz", "damped, Hz", "damping ratio"), mode_rows, right=(1, 2, 3))
    load_rows = [*loads.axles.items(), *loads.hinges.items()]
    print_table(
        "Static loads",
        ("axle or hinge", "force, N"),
        [(name, f"{force:,.0f}") for name, force in load_rows],
        right=(1,),
    )


def _summary(
    model: EquationsOfMotion,
    values: dict[str, float],
    modes: Sequence[Mode],
    loads: StaticLoads,
    findings: list[str],
    counts: dict[str, int],
    folder: Path,
    written: list[Path],
) -> dict[str, object]:
    keys = ("name", "undamped_hz", "damped_hz", "damping_ratio")
    return {
        "vehicle": model.vehicle.name,
        "coordinates": [item.name for item in model.coordinates],
        "parameters": values,
        "modes": [{key: getattr(mode, key) for key in keys} for mode in modes],
        "axles": loads.axles,
        "hinges": loads.hinges,
        "operation_counts": {**counts, **model.operation_counts()},
        "warnings": findings,
        "folder": str(folder),
        "files": [path.name for path in written],
    }
