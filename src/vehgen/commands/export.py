"""Write a vehicle's equations of motion for another program: data, MATLAB, state space, C, FMU."""

from __future__ import annotations

import argparse

from vehgen.commands.results import add_out, file_named, folder_named, tell_written
from vehgen.commands.terminal import add_vehicle, print_json, warn

EXAMPLE = "vehgen export tractor5.yaml --to json --out tractor5.json"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the command's arguments."""
    add_vehicle(parser)
    parser.add_argument(
        "--to", metavar="FORMAT", required=True, help="json, npz, mat, m, c, state-space, vbi2d, fmu, fmu3, latex, markdown"
    )
    add_out(parser, "PATH", "the file, or the folder of a format of several files (default: NAME.FORMAT here)")
    parser.add_argument("--run", metavar="RUN", dest="run_file", help="a run file whose sensors, outputs and forces are exported")
    parser.add_argument("--linear", action="store_true", help="leave force laws out where the format cannot carry them")
    parser.add_argument("--step", metavar="SECONDS", type=float, default=1e-3, help="time step of exported programs (default: 0.001)")


def run(options: argparse.Namespace) -> None:
    """Export a vehicle."""
    from vehgen.export import EXPORT_FORMATS, export
    from vehgen.simulate import load_run
    from vehgen.vehicle import load_vehicle

    vehicle = load_vehicle(options.file)
    measured = load_run(options.run_file, vehicle) if options.run_file else None
    chosen = EXPORT_FORMATS.get(options.to)
    named = file_named if chosen is not None and chosen.suffix else lambda text: folder_named(text, "")
    files = export(
        vehicle,
        options.to,
        None if options.out is None else named(options.out),
        outputs=measured.outputs() if measured else (),
        forces=measured.forces() if measured else (),
        parameter_set=options.parameter_set,
        linear=options.linear,
        step=options.step,
    )
    if options.linear and vehicle.has_laws and not EXPORT_FORMATS[options.to].keeps_laws:
        warn([f"the force laws of {vehicle.name} are left out: what only they hold, nothing holds in this export"])
    if options.json:
        print_json({"files": [str(path) for path in files]})
        return
    tell_written(files)
