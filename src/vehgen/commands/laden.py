"""Put a cargo on a vehicle: write the laden vehicle and show what the cargo changes."""

from __future__ import annotations

import argparse
from pathlib import Path

from vehgen.commands.results import add_out, file_named, tell_written
from vehgen.commands.terminal import add_json, force_text, number_text, print_json, print_table

EXAMPLE = "vehgen laden tractor5.yaml bananas.yaml --out laden.yaml"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the command's arguments."""
    parser.add_argument("vehicle", metavar="VEHICLE", help="the unladen vehicle: a file, for example a calibrated one, or a bundled model")
    parser.add_argument("cargo", metavar="CARGO", help="a cargo file")
    add_out(parser, "FILE", "where to write the laden vehicle (default: VEHICLE_laden.yaml here)")
    parser.add_argument("--set", metavar="NAME", dest="parameter_set", help="compare at a named parameter set of the vehicle")
    add_json(parser)


def run(options: argparse.Namespace) -> None:
    """Write the laden vehicle and print the comparison."""
    from vehgen.cargo import compare_laden, laden, load_cargo
    from vehgen.vehicle import load_vehicle

    vehicle, cargo = load_vehicle(options.vehicle), load_cargo(options.cargo)
    vehicle.values(options.parameter_set)
    path = Path(f"{vehicle.name}_laden.yaml") if options.out is None else file_named(options.out)
    found = compare_laden(vehicle, laden(vehicle, cargo, out=path), cargo.file.on, options.parameter_set)
    (before, after), (forward, up) = found.carrier, found.cog_shift
    if options.json:
        data = {
            "cargo_mass": after.mass - before.mass,
            "carrier": cargo.file.on,
            "carrier_mass": [before.mass, after.mass],
            "cog_shift": {"forward": forward, "up": up},
            "axles": {name: list(loads) for name, loads in found.axles.items()},
            "modes": [{"name": name, "unladen_hz": light, "laden_hz": heavy} for name, light, heavy in found.modes],
        }
        print_json({**data, "files": [str(path)]})
        return
    rows = [
        (
            "mass",
            f"{number_text(before.mass)} kg",
            f"{number_text(after.mass)} kg",
            f"{number_text(after.mass - before.mass, sign='+')} kg",
        ),
        ("COG ahead of the empty body's", f"{before.x:.4f} m", f"{after.x:.4f} m", f"{forward:+.4f} m"),
        ("COG above the empty body's", f"{before.z:.4f} m", f"{after.z:.4f} m", f"{up:+.4f} m"),
    ]
    print_table(f"{cargo.file.on} with what it carries", ("", "unladen", "laden", "change"), rows, right=(1, 2, 3))
    loads = [(name, *pair) for name, pair in found.axles.items()]
    loads.append(("all", sum(item[1] for item in loads), sum(item[2] for item in loads)))
    axle_rows = [(name, force_text(light), force_text(heavy), number_text((heavy - light) / 1e3, 3, "+")) for name, light, heavy in loads]
    print_table("Static axle loads, kN", ("axle", "unladen", "laden", "change"), axle_rows, right=(1, 2, 3))
    mode_rows = [(name, "" if light is None else f"{light:.4f}", f"{heavy:.4f}") for name, light, heavy in found.modes]
    print_table("Undamped natural frequencies, Hz", ("mode", "unladen", "laden"), mode_rows, right=(1, 2))
    tell_written([path])
