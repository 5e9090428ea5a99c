"""Simulate a run: the response of its vehicle over its road."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from vehgen.commands.option_strings import read_speed
from vehgen.commands.results import add_out, file_named, tell_written
from vehgen.commands.terminal import add_json, print_json, print_table, warn
from vehgen.errors import InputError, shown
from vehgen.files import check_results, write_bytes
from vehgen.files.number_text import five_digits

if TYPE_CHECKING:
    from vehgen.simulate import Response

RESPONSE_ENDINGS = (".csv", ".mat", ".txt", "")
"""A MAT-file for MATLAB and Octave, else columns of text."""
ARGUMENT_OPTIONS = {"speed": "--speed", "parameter_set": "--set"}
EXAMPLE = "vehgen simulate run.yaml --out response.csv --plot"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the command's arguments."""
    parser.add_argument("run_file", metavar="RUN", help="a run file")
    parser.add_argument("--speed", type=read_speed, metavar="M/S", help="constant speed in place of the run's")
    parser.add_argument("--set", metavar="NAME", dest="parameter_set", help="a named parameter set of the vehicle in place of the run's")
    add_out(parser, "FILE", "where to write the response: text such as .csv, or .mat for MATLAB (default: RUN_response.csv beside it)")
    parser.add_argument("--plot", action="store_true", help="draw the response too, beside the CSV file")
    add_json(parser)


def run(options: argparse.Namespace) -> None:
    """Simulate a run and write its response."""
    from vehgen.simulate import load_run, simulate

    run_ = load_run(options.run_file).changed(speed=options.speed, parameter_set=options.parameter_set)
    run_file = Path(options.run_file)
    path = run_file.with_name(f"{run_file.stem}_response.csv") if options.out is None else file_named(options.out)
    written = [path, path.with_suffix(".png")] if options.plot else [path]
    check_results(written)
    if path.suffix.lower() not in RESPONSE_ENDINGS:
        raise InputError(
            f"--out: a response is written as {' or '.join(name for name in RESPONSE_ENDINGS if name)}; found {shown(path.name)}"
        )
    response = simulate(run_)
    _write(path, response)
    if options.plot:
        from vehgen.report import save_figure
        from vehgen.report.plots.response_plot import plot_response

        channels = [(item.name, item.quantity, item.unit) for item in response.channels]
        figure = plot_response(response.time, channels, response.values[0])
        save_figure(figure, written[-1])
    peaks = [(item.name, item.unit, float(abs(response.values[0, :, i]).max())) for i, item in enumerate(response.channels)]
    if options.json:
        data = {"channels": [{"name": name, "unit": unit, "peak": peak} for name, unit, peak in peaks]}
        print_json({**data, "warnings": list(response.warnings), "files": [str(item) for item in written]})
        return
    title = run_.file.title or f"{run_.vehicle.title or run_.vehicle.name}, {response.time[-1]:.2f} s"
    print_table(
        title,
        ("channel", "unit", "largest magnitude"),
        [(name, unit, five_digits(peak)) for name, unit, peak in peaks],
        right=(2,),
    )
    warn(response.warnings)
    tell_written(written)


def _write(path: Path, response: Response) -> None:
    """Write the first individual's response as its file's ending says."""
    if path.suffix.lower() != ".mat":
        from vehgen.simulate import write_csv

        write_csv(path, response)
        return
    import numpy as np

    from vehgen.export.matlab import mat_bytes

    names, units = (np.array([getattr(item, key) for item in response.channels]) for key in ("name", "unit"))
    write_bytes(path, mat_bytes({"t": response.time, "values": response.values[0], "channels": names, "units": units}))
