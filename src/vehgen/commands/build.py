"""Derive, check, generate and compile a vehicle; show it and write its folder."""

from __future__ import annotations

import argparse
import time
from pathlib import Path
from typing import TYPE_CHECKING

from vehgen.commands.results import add_out, folder_named
from vehgen.commands.terminal import add_vehicle, force_text, load, print_json, print_table, say, warn
from vehgen.files.number_text import grouped, on_terminal

if TYPE_CHECKING:
    from collections.abc import Sequence

    from vehgen.mechanics import EquationsOfMotion, StaticLoads
    from vehgen.simulate import Mode
    from vehgen.simulate.build import Build

EXAMPLE = "vehgen build tractor5.yaml --out build/tractor5"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the command's arguments."""
    add_vehicle(parser)
    add_out(parser, "DIR", "where to write (default: build/NAME)")
    parser.add_argument("--no-plots", action="store_true", help="leave out drawing, mode shapes and the response to a road (faster)")


def run(options: argparse.Namespace) -> None:
    """Build a vehicle."""
    start = time.perf_counter()
    vehicle, _free = load(options)
    folder = folder_named(options.out, Path("build") / vehicle.name)
    from vehgen.report import build, build_files

    found = build(vehicle, folder, parameter_set=options.parameter_set, plots=not options.no_plots)
    seconds = time.perf_counter() - start
    model, kernel = found.model, found.kernel
    assert model is not None
    assert kernel is not None
    counts = kernel.source.operation_counts
    if options.json:
        print_json(_summary(model, found, counts, folder, build_files(folder, plots=not options.no_plots)))
        return
    _show(model, found.values, found.modes, found.loads)
    print_table("Kernel", ("phase", "operations"), [(phase, str(count)) for phase, count in counts.items()], right=(1,))
    warn(found.warnings)
    say(f"built in {seconds:.1f} s; open {folder / 'index.html'}")


def _show(model: EquationsOfMotion, values: dict[str, float], modes: Sequence[Mode], loads: StaticLoads) -> None:
    from vehgen.simulate.mode_groups import alike_modes, group_name

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
            on_terminal(grouped(everything[name])),
            str(dimensions[name]).replace("no unit", "-"),
            str(item.equals or ""),
            item.meaning,
        )
        for name, item in vehicle.parameters.items()
    ]
    print_table("Parameters", ("name", "value", "unit", "equals", "meaning"), parameter_rows, right=(1,))
    groups = [(group_name(group), group[0]) for group in alike_modes(modes)]
    mode_rows = [(name, f"{mode.undamped_hz:.3f}", f"{mode.damped_hz:.3f}", f"{mode.damping_ratio:.3f}") for name, mode in groups]
    print_table("Modes", ("mode", "undamped, Hz", "damped, Hz", "damping ratio"), mode_rows, right=(1, 2, 3))
    load_rows, owners = [*loads.axles.items(), *loads.hinges.items()], "axle or hinge"
    if not load_rows and vehicle.gravity:
        load_rows, owners = [(name, force) for (_, name), force in loads.elements.items()], "link"
    if load_rows:
        rows_of_loads = [(name, force_text(force)) for name, force in load_rows]
        print_table("Static loads", (owners, "force, kN"), rows_of_loads, right=(1,))


def _summary(model: EquationsOfMotion, found: Build, counts: dict[str, int], folder: Path, written: list[Path]) -> dict[str, object]:
    keys = ("name", "undamped_hz", "damped_hz", "damping_ratio")
    return {
        "vehicle": model.vehicle.name,
        "coordinates": [item.name for item in model.coordinates],
        "parameters": found.values,
        "modes": [{key: getattr(mode, key) for key in keys} for mode in found.modes],
        "axles": found.loads.axles,
        "hinges": found.loads.hinges,
        "operation_counts": {**counts, **found.operation_counts},
        "warnings": list(found.warnings),
        "folder": str(folder),
        "files": [path.name for path in written],
    }
