"""Show which parameters a run's sensors feel, at which frequencies."""

from __future__ import annotations

import argparse
from pathlib import Path

from vehgen.commands.option_strings import split_list
from vehgen.commands.results import add_out, folder_named, tell_written
from vehgen.commands.terminal import add_json, print_json, print_table
from vehgen.files import check_results, write_text

EXAMPLE = "vehgen sensitivity tractor5.yaml hump_2ms.yaml --out sensitivity"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the command's arguments."""
    parser.add_argument("vehicle", metavar="VEHICLE", help="a vehicle file")
    parser.add_argument("run_file", metavar="RUN", help="a run file; it needs no recording")
    parser.add_argument("--parameters", metavar="P,Q", help="parameters to differentiate by (default: all with a range)")
    add_out(parser, "DIR", "folder for the figures (default: VEHICLE_sensitivity)")
    add_json(parser)


def run(options: argparse.Namespace) -> None:
    """Compute sensitivity indices, print their ranking and draw them."""
    from vehgen.calibrate import sensitivity
    from vehgen.commands.progress import Bars
    from vehgen.files.results import json_text
    from vehgen.report.plots.sensitivity_plots import save_sensitivity_figures, sensitivity_figure_files
    from vehgen.simulate import load_run
    from vehgen.vehicle import load_vehicle

    run_ = load_run(options.run_file, load_vehicle(options.vehicle))
    folder = folder_named(options.out, f"{Path(options.vehicle).stem}_sensitivity")
    check_results([folder / "sensitivity.json", *sensitivity_figure_files([output.name for output in run_.outputs()], folder)])
    with Bars(quiet=options.json) as bars:
        found = sensitivity(run_, split_list(options.parameters), progress=bars.tell)
    files = [folder / "sensitivity.json"]
    write_text(files[0], json_text(found))
    files += save_sensitivity_figures(found, folder)
    if options.json:
        channels = {
            channel: {
                name: {"relative": float(found.relative[i, j]), "index": found.index[i, j].tolist()} for i, name in enumerate(found.names)
            }
            for j, channel in enumerate(found.channels)
        }
        print_json({"frequency_hz": found.frequency.tolist(), "channels": channels, "files": [str(path) for path in files]})
        return
    rows = [(name, *(f"{100 * value:.3f}" for value in found.relative[i])) for i, name in enumerate(found.names)]
    right = tuple(range(1, len(found.channels) + 1))
    print_table("change of each channel [% of its rms] for 1 % of a parameter", ("parameter", *found.channels), rows, right=right)
    tell_written(files)
