"""Tell what a rough road does to a vehicle at a speed: responses by frequency, and RMS values."""

from __future__ import annotations

import argparse

from vehgen.commands.option_strings import PLACE_KEYS, read_sensor, read_speed
from vehgen.commands.results import add_out, folder_named, tell_written
from vehgen.commands.terminal import add_vehicle, print_json, print_table, warn
from vehgen.files import check_results, write_text

EXAMPLE = "vehgen response tractor5.yaml --speed 20 --road B --out response"
ARGUMENT_OPTIONS = {"roughness": "--road", "speed": "--speed", "parameter_set": "--set", "sensors": "--at"}
ROAD_CURVES = ("frequency", "amplitude", "phase", "psd", "road_psd")
"""What response.json holds and --json leaves out."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the command's arguments."""
    add_vehicle(parser)
    parser.add_argument("--speed", type=read_speed, default=20.0, metavar="M/S", help="speed of the vehicle (default 20)")
    parser.add_argument("--road", default="B", metavar="CLASS", help="class of the road by ISO 8608, A to H (default B)")
    parser.add_argument(
        "--at", action="append", metavar="NAME:body=B,behind=P,distance=D", help="a further place whose vertical acceleration is told"
    )
    add_out(parser, "DIR", "folder for response.json, response.csv and the figure (default: VEHICLE_response)")


def run(options: argparse.Namespace) -> None:
    """Compute the responses, and write the result, its curves and its figure."""
    from vehgen.files.results import csv_text, json_text
    from vehgen.report.plots.road_response_plot import road_response_figure_files, save_road_response_figures
    from vehgen.simulate.road_response import road_response
    from vehgen.vehicle import load_vehicle

    vehicle = load_vehicle(options.file)
    sensors = [read_sensor(text, option="--at", keys=PLACE_KEYS) for text in options.at or ()]
    for sensor in sensors:
        sensor.check(vehicle)
    folder = folder_named(options.out, f"{vehicle.name}_response")
    files = [folder / "response.json", folder / "response.csv"]
    check_results([*files, *road_response_figure_files(folder)])
    found = road_response(
        vehicle,
        speed=options.speed,
        roughness=options.road,
        places=[sensor.place for sensor in sensors],
        parameter_set=options.parameter_set,
    )
    write_text(files[0], json_text(found))
    write_text(files[1], csv_text(found.curves()))
    files += save_road_response_figures(found, folder)
    if options.json:
        data = {key: value for key, value in found.to_dict().items() if key not in ROAD_CURVES}
        print_json({**data, "files": [str(path) for path in files]})
        return
    columns, rows = found.table()
    title = f"{found.title}: road of class {found.roughness} (ISO 8608) at {found.speed:g} m/s"
    cells = [[cell if isinstance(cell, str) else "" if cell is None else f"{cell:.4g}" for cell in row] for row in rows]
    print_table(title, columns, cells, right=range(2, len(columns)))
    warn(found.notes)
    tell_written(files)
