"""Print static axle loads and hinge forces, and warn of what looks wrong."""

from __future__ import annotations

import argparse
from collections.abc import Mapping

from vehgen.commands.terminal import add_vehicle, load, print_json, print_table, warn

EXAMPLE = "vehgen static tractor5.yaml"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the command's arguments."""
    add_vehicle(parser)


def run(options: argparse.Namespace) -> None:
    """Print the static loads of a vehicle."""
    vehicle, values = load(options)
    from vehgen.mechanics import derive, static_loads
    from vehgen.simulate.lint import lint

    model = derive(vehicle)
    loads = static_loads(model, values)
    findings = lint(model, values)
    if options.json:
        print_json({"axles": loads.axles, "hinges": loads.hinges, "warnings": findings})
        return
    title = vehicle.title or vehicle.name
    if loads.axles:
        total = sum(loads.axles.values())
        rows = [(name, f"{force:,.1f}", f"{force / total:.1%}" if total else "") for name, force in loads.axles.items()]
        print_table(f"{title}: static axle loads", ("axle", "load, N", "share"), [*rows, ("all", f"{total:,.1f}", "")], right=(1, 2))
    else:
        links = [(name, f"{force:,.1f}") for (_, name), force in loads.elements.items()]
        print_table(f"{title}: static forces in its links", ("link", "force, N"), links, right=(1,))
    if loads.hinges:
        hinge_rows = [(name, f"{force:,.1f}", _who(vehicle.hinges[name].points)) for name, force in loads.hinges.items()]
        print_table("Hinge forces", ("hinge", "force, N", ""), hinge_rows, right=(1,))
    warn(findings)


def _who(points: Mapping[str, object]) -> str:
    lower, upper = points
    return f"{lower} carries {upper}"
