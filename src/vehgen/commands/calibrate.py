"""Calibrate a vehicle's parameters from what its sensors recorded over a hump."""

from __future__ import annotations

import argparse
import os
from pathlib import Path

from vehgen.commands.calibration_tables import show_calibration
from vehgen.commands.faults import STOPPED
from vehgen.commands.option_strings import read_band, split_list
from vehgen.commands.results import add_out, folder_named, tell_written
from vehgen.commands.terminal import add_json, print_json
from vehgen.files import check_results, note_read, write_text

EXAMPLE = "vehgen calibrate tractor5.yaml hump_2ms.yaml hump_3ms.yaml --method joint --out calibrated"


CALIBRATION_CURVES = ("psds", "histories", "steps", "band")
"""What calibration.json holds and --json leaves out."""
ARGUMENT_OPTIONS = {"runs": "RUN"}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the command's arguments."""
    parser.add_argument("vehicle", metavar="VEHICLE", help="a vehicle file whose `range`s say what to search")
    parser.add_argument("runs", metavar="RUN", nargs="+", help="run files with recordings")
    parser.add_argument("--method", default="joint", help="joint (all sensors at once, default), dhcm (two sensors, two steps), shcm (one)")
    parser.add_argument("--sensors", metavar="A,B", help="the sensors to use, in order (default: all of the runs)")
    parser.add_argument("--freeze", metavar="P,Q", help="dhcm: parameters kept from the first step (default: the nearest axle's)")
    parser.add_argument("--search", choices=("ga", "mpga"), help="one population, or three that exchange their best (default; shcm: ga)")
    parser.add_argument("--size", type=int, default=100, metavar="N", help="individuals of a population (default 100)")
    parser.add_argument("--generations", type=int, default=300, metavar="N", help="generations of a search at most (default 300)")
    parser.add_argument("--seed", type=int, default=1, metavar="N", help="seed of all random numbers (default 1)")
    parser.add_argument("--starts", type=int, default=6, metavar="N", help="starts of the gradient polish (default 6)")
    parser.add_argument("--no-polish", action="store_true", help="stop after the genetic search, as the paper does; gives no intervals")
    parser.add_argument("--band", metavar="LOW,HIGH", help="frequencies compared [Hz] (default 0.3,40)")
    stated = "(default: as the run file's `uncertainty` says, else"
    parser.add_argument("--height-error", type=float, metavar="R", help=f"relative uncertainty of the hump's height {stated} 0.03)")
    parser.add_argument("--speed-error", type=float, metavar="R", help=f"relative uncertainty of the speed {stated} 0.01)")
    parser.add_argument("--facts", metavar="FILE", type=Path, help="axle weights and other facts known from elsewhere")
    parser.add_argument("--combination", metavar="EXPR", action="append", default=[], help="estimate this too, e.g. 'k1/(mT + mS)'")
    parser.add_argument("--bootstrap", type=int, default=0, metavar="N", help="check the intervals with N refits to redrawn noise")
    parser.add_argument("--scheduler", metavar="ADDRESS", help="run polish and bootstrap on the Dask cluster at this address")
    add_out(parser, "DIR", "folder for results and figures (default: VEHICLE_calibrated)")
    parser.add_argument("--resume", action="store_true", help="go on with a search that was stopped")
    add_json(parser)


def run(options: argparse.Namespace) -> int | None:
    """Calibrate and write the vehicle file, the result and figures; returns an exit code where Ctrl-C ended it early."""
    from vehgen.calibrate.api import calibrate, check_numbers
    from vehgen.commands.progress import Bars
    from vehgen.files.names import joined_name
    from vehgen.files.results import json_text
    from vehgen.fit.band import CALIBRATION_BAND_HZ
    from vehgen.fit.trial import load_trials
    from vehgen.report.plots.calibration_plots import calibration_figure_files, save_calibration_figures
    from vehgen.vehicle import load_vehicle

    band = read_band(options.band) if options.band else CALIBRATION_BAND_HZ
    errors = options.height_error, options.speed_error
    check_numbers(options.size, options.generations, options.starts, options.bootstrap, options.seed, *errors, band)
    vehicle = load_vehicle(options.vehicle)
    trials = load_trials(options.runs, vehicle)
    if options.facts is not None:
        note_read(options.facts)
    folder = folder_named(options.out, f"{Path(options.vehicle).stem}_calibrated")
    name = joined_name(vehicle.name, "calibrated")
    files, checkpoint = [folder / f"{name}.yaml", folder / "calibration.json"], folder / "search.json"
    check_results([*files, checkpoint, *calibration_figure_files(folder)])
    with Bars(quiet=options.json) as progress:
        outcome = calibrate(
            vehicle,
            trials,
            method=options.method,
            sensors=split_list(options.sensors),
            freeze=split_list(options.freeze),
            search=options.search,
            size=options.size,
            generations=options.generations,
            starts=options.starts,
            polish=not options.no_polish,
            seed=options.seed,
            band=band,
            height_error=options.height_error,
            speed_error=options.speed_error,
            facts=options.facts,
            combinations=options.combination,
            bootstrap=options.bootstrap,
            scheduler=options.scheduler,
            workers=os.cpu_count() or 1,
            checkpoint=checkpoint,
            resume=options.resume,
            progress=lambda label, done, total, best: progress.tell(label, done, total, f"best {best:.5g}"),
        )
        if outcome.stopped:
            progress.say("stopped: the best so far is kept; --resume goes on")
    write_text(files[0], outcome.vehicle_text(folder, name))
    write_text(files[1], json_text(outcome))
    if not options.json:
        show_calibration(outcome)  # figures take seconds
    files += save_calibration_figures(outcome, folder)
    if options.json:
        data = {key: value for key, value in outcome.to_dict().items() if key not in CALIBRATION_CURVES}
        print_json({**data, "files": [str(path) for path in files]})
    else:
        tell_written(files)
    return STOPPED if outcome.stopped else None
