"""Compare phones in one vehicle with each other on a rough road that nobody measured, and a model with both."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from vehgen.commands.option_strings import read_bands, read_column_map, read_sensor, read_speed
from vehgen.commands.results import add_out, folder_named, tell_written
from vehgen.commands.terminal import add_json, print_json, print_table, say, warn
from vehgen.files import check_results, note_read, write_text

if TYPE_CHECKING:
    from vehgen.fit.transmissibility_result import Transmissibility

EXAMPLE = (
    "vehgen transmissibility front.zip rear.zip --vehicle sedan2 --sensor F:body=body,behind=front,distance=0.1 "
    "--sensor R:body=body,behind=rear,distance=-0.1 --out rough"
)
ARGUMENT_OPTIONS = {"sensors": "--sensor", "parameter_set": "--set", "recordings": "RECORDING"}
LINES = ("frequency", "densities")
RATIO_LINES = ("h1", "h2", "lower", "upper", "phase", "coherence", "common", "model_h1", "model_h2")
"""What transmissibility.json holds and --json leaves out."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the command's arguments."""
    parser.add_argument(
        "recordings", metavar="RECORDING", nargs="+", help="exports of the phones on one drive, as `import` reads them; or one run file"
    )
    parser.add_argument("--vehicle", metavar="FILE", help="a vehicle to compare with: a file, or the name of a bundled model")
    parser.add_argument("--set", metavar="NAME", dest="parameter_set", help="use a named parameter set of the vehicle")
    parser.add_argument(
        "--sensor",
        action="append",
        metavar="NAME:body=B,behind=P,distance=D",
        help="where a phone lay, one for each export in order; without --vehicle only forward=, up=, acceleration_sign=, from=, to=",
    )
    parser.add_argument("--reference", metavar="NAME", help="the channel or sensor that all others are divided by (default: the first)")
    parser.add_argument("--speed", type=read_speed, metavar="M/S", help="speed of the drive (default: the GPS, or the run's)")
    parser.add_argument("--forward", metavar="AXIS", help="the phones' axis that pointed forward, x, y (top edge), ...: adds pitch rates")
    parser.add_argument("--bands", metavar="A,B,C", help="edges of the bands [Hz] (default: 0.5,2,5,8,12,15,20)")
    parser.add_argument("--segment", type=float, default=8.0, metavar="S", help="length of the averaged segments (default 8)")
    parser.add_argument(
        "--columns",
        action="append",
        metavar="time=T,...",
        help="columns of plain CSVs, once for all or for each export in order; also time_unit=, pitch_rate=, ...",
    )
    add_out(parser, "DIR", "folder for transmissibility.json and its figure (default: transmissibility)")
    add_json(parser)


def run(options: argparse.Namespace) -> None:
    """Compare the sensors, and write the result and its figure."""
    from vehgen.files.results import json_text
    from vehgen.fit.transmissibility import transmissibility
    from vehgen.report.plots.transmissibility_plot import save_transmissibility_figures, transmissibility_figure_files

    folder = folder_named(options.out, "transmissibility")
    files = [folder / "transmissibility.json"]
    for path in options.recordings:
        note_read(path)
    check_results([*files, *transmissibility_figure_files(folder)])
    found = transmissibility(
        options.recordings,
        vehicle=options.vehicle,
        sensors=[read_sensor(text, needs_body=options.vehicle is not None) for text in options.sensor or ()],
        reference=options.reference,
        parameter_set=options.parameter_set,
        speed=options.speed,
        forward=options.forward,
        bands=read_bands(options.bands) if options.bands else None,
        segment=options.segment,
        columns=[read_column_map(text) for text in options.columns] if options.columns else None,
    )
    write_text(files[0], json_text(found))
    files += save_transmissibility_figures(found, folder)
    if options.json:
        print_json({**_summary(found), "files": [str(path) for path in files]})
    else:
        _show(found)
        tell_written(files)


def _summary(found: Transmissibility) -> dict[str, object]:
    data = {key: value for key, value in found.to_dict().items() if key not in LINES}
    data["ratios"] = [{key: value for key, value in ratio.items() if key not in RATIO_LINES} for ratio in data["ratios"]]
    return data


def _show(found: Transmissibility) -> None:
    has_model = found.vehicle is not None
    for item in found.ratios:
        rows = []
        for band in item.bands:
            row = [f"{band.low:g}-{band.high:g}", f"{band.coherence:.3f}"]
            row += [f"{band.ratio:.4g}", f"{band.lower:.4g} to {band.upper:.4g}"] if band.lines else ["no common motion", ""]
            if has_model and band.model is not None:
                row += [f"{100 * (band.model - 1):+.1f} %", f"{band.distance:.1f}", "apart" if band.is_apart else "within"]
            rows.append([*row, *[""] * (3 if has_model else 0)][: 7 if has_model else 4])
        columns = ("band [Hz]", "coherence", "ratio", "95 % limits", *(("model off", "distance [s.e.]", "model") if has_model else ()))
        print_table(f"{item.channel} over {found.reference} [{item.unit}]", columns, rows, right=(1, 2, 3, 4, 5))
    say(f"{found.duration:.0f} s, worth {found.averages:.0f} averages of {found.segment:g} s" + _speeds(found))
    for peak in found.resonances:
        mode = f"; the model's nearest mode is {peak.mode} at {peak.mode_hz:.2f} Hz" if peak.mode is not None else ""
        say(f"all channels show a peak at {peak.frequency:.2f} Hz, coherence there up to {peak.coherence:.2f}{mode}")
    for text in found.tells:
        say(f"this can tell {text}")
    for text in found.cannot_tell:
        say(f"this cannot tell {text}")
    for text in found.notes:
        say(text)
    warn(found.warnings)


def _speeds(found: Transmissibility) -> str:
    if found.speeds is None:
        return ""
    low, median, high = found.speeds
    best = f"; the model fits best at {found.speed_scale:.4g} times that" if found.speed_scale not in (None, 1.0) else ""
    return f", at {low:.3g} to {high:.3g} m/s (median {median:.3g}){best}"
