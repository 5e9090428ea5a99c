"""List the bundled vehicles."""

from __future__ import annotations

import argparse

from vehgen.commands.terminal import add_json, print_json, print_table

EXAMPLE = "vehgen models"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the command's arguments."""
    add_json(parser)


def run(options: argparse.Namespace) -> None:
    """List the bundled vehicles with a line each."""
    from vehgen.vehicle import bundled_models, load_vehicle

    rows = []
    for name, path in bundled_models().items():
        vehicle = load_vehicle(path)
        rows.append((name, vehicle.title, list(vehicle.sets), vehicle.source))
    if options.json:
        keys = ("name", "title", "sets", "source")
        print_json({"models": [dict(zip(keys, row, strict=True)) for row in rows]})
        return
    print_table(
        "Bundled vehicles and rigs",
        ("name", "title", "parameter sets"),
        [(name, title, ", ".join(sets)) for name, title, sets, _ in rows],
    )
