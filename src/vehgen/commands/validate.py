"""Compare a vehicle with recordings that took no part in its calibration."""

from __future__ import annotations

import argparse
from pathlib import Path

from vehgen.commands.option_strings import read_bands
from vehgen.commands.results import add_out, folder_named, tell_written
from vehgen.commands.terminal import add_json, print_json, print_table, warn
from vehgen.files import check_results, write_text

EXAMPLE = "vehgen validate calibrated/tractor5_calibrated.yaml road_b.yaml --out validation"
ARGUMENT_OPTIONS = {"reference": "--astm"}


VALIDATION_CURVES = ("frequency", "measured_psd", "simulated_psd", "time", "measured", "simulated")
"""What validation.json holds and --json leaves out."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the command's arguments."""
    parser.add_argument("vehicle", metavar="VEHICLE", help="a vehicle file, for example one that `calibrate` wrote")
    parser.add_argument("runs", metavar="RUN", nargs="+", help="run files with recordings")
    parser.add_argument("--bands", metavar="A,B,C", help="edges of the frequency bands [Hz] (default: the paper's)")
    parser.add_argument("--astm", metavar="NAME", help="draw an ASTM D4169 truck spectrum beside the accelerations, e.g. 'level II'")
    add_out(parser, "DIR", "folder for results and figures (default: VEHICLE_validation)")
    add_json(parser)


def run(options: argparse.Namespace) -> None:
    """Validate and write the table and figures."""
    from vehgen.calibrate import validate
    from vehgen.calibrate.validation import reference_spectrum
    from vehgen.files.results import json_text
    from vehgen.fit.trial import load_trials
    from vehgen.report.plots.validation_plots import save_validation_figures, validation_figure_files
    from vehgen.vehicle import load_vehicle

    if options.astm is not None:
        reference_spectrum(options.astm)
    bands = read_bands(options.bands) if options.bands else None
    vehicle = load_vehicle(options.vehicle)
    trials = load_trials(options.runs, vehicle)
    folder = folder_named(options.out, f"{Path(options.vehicle).stem}_validation")
    files = [folder / "validation.json"]
    check_results([*files, *validation_figure_files(folder)])
    found = validate(vehicle, trials, bands=bands, reference=options.astm)
    write_text(files[0], json_text(found))
    files += save_validation_figures(found, folder)
    doubts = found.doubtful_channels()
    if options.json:
        data = found.to_dict()
        del data["reference"]
        data["channels"] = [{key: value for key, value in channel.items() if key not in VALIDATION_CURVES} for channel in data["channels"]]
        print_json({**data, "warnings": list(doubts), "files": [str(path) for path in files]})
        return
    for item in found.channels:
        rows = [
            (f"{low:g}-{high:g}", f"{measured:.4g}", f"{simulated:.4g}", f"{100 * error:+.1f}" if audible else "noise")
            for (low, high), measured, simulated, error, audible in zip(
                found.bands, item.measured_rms, item.simulated_rms, item.errors, item.audible, strict=True
            )
        ]
        print_table(f"{item.run}: {item.channel}", ("band [Hz]", "measured rms", "simulated rms", "error [%]"), rows, right=(1, 2, 3))
    warn(doubts)
    tell_written(files)
