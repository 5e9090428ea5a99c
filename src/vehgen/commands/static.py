"""Print static axle loads, hinge forces, preloads and deflections of springs, and warn of what looks wrong."""

from __future__ import annotations

import argparse
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from vehgen.commands.terminal import add_vehicle, force_text, load, print_json, print_table, say, warn
from vehgen.files.number_text import millimetres, on_terminal

if TYPE_CHECKING:
    from vehgen.mechanics import StaticLoads
    from vehgen.vehicle import Vehicle

EXAMPLE = "vehgen static tractor5.yaml"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the command's arguments."""
    add_vehicle(parser)


def run(options: argparse.Namespace) -> None:
    """Print the static loads of a vehicle."""
    vehicle, values = load(options)
    from vehgen.mechanics import derive, static_loads
    from vehgen.mechanics.static_loads import static_deflections
    from vehgen.simulate.lint import lint

    model = derive(vehicle)
    loads = static_loads(model, values)
    deflections = static_deflections(model, values, loads)
    findings = lint(model, values)
    springs = [(*key, loads.elements[key], deflection) for key, deflection in deflections.items()]
    if options.json:
        keys = ("kind", "name", "force", "deflection")
        found = [dict(zip(keys, item, strict=True)) for item in springs]
        print_json({"axles": loads.axles, "hinges": loads.hinges, "springs": found, "warnings": findings})
        return
    _show(vehicle, loads, springs)
    warn(findings)


def _show(vehicle: Vehicle, loads: StaticLoads, springs: Sequence[tuple[str, str, float, float]]) -> None:
    title = vehicle.title or vehicle.name
    if loads.axles:
        total = sum(loads.axles.values())
        rows = [(name, force_text(force), f"{force / total:.1%}" if total else "") for name, force in loads.axles.items()]
        print_table(f"{title}: static axle loads", ("axle", "load, kN", "share"), [*rows, ("all", force_text(total), "")], right=(1, 2))
    if loads.hinges:
        hinge_rows = [(name, force_text(force), _who(vehicle.hinges[name].points)) for name, force in loads.hinges.items()]
        print_table("Hinge forces", ("hinge", "force, kN", ""), hinge_rows, right=(1,))
    if springs:
        cells = [(kind, name, force_text(force), on_terminal(millimetres(travel))) for kind, name, force, travel in springs]
        heading = "Springs at rest" if loads.axles else f"{title}: springs at rest"
        print_table(f"{heading}, compression positive", ("", "spring", "force, kN", "deflection, mm"), cells, right=(2, 3))
    if not (loads.axles or loads.hinges or springs):
        say("no axle, hinge or spring carries anything", heading=f"{title}: ")


def _who(points: Mapping[str, object]) -> str:
    lower, upper = points
    return f"{lower} carries {upper}"
