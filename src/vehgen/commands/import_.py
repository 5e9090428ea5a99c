"""Turn phone exports of one pass into a run file with its recording."""

from __future__ import annotations

import argparse
from dataclasses import asdict
from typing import TYPE_CHECKING

from vehgen.commands.option_strings import read_column_map, read_hump, read_profile, read_sensor
from vehgen.commands.results import add_out, file_named, tell_written
from vehgen.commands.terminal import add_json, print_json, print_table, say, warn
from vehgen.files import check_results, note_read

if TYPE_CHECKING:
    from vehgen.phones import PhoneImport

NAME = "import"
ARGUMENT_OPTIONS = {"sensors": "--sensor", "parameter_set": "--set"}
EXAMPLE = (
    "vehgen import phone1.zip phone2.zip --vehicle tractor5.yaml --sensor L1:body=tractor,behind=axle1,distance=-0.29 "
    "--sensor L2:body=semitrailer,behind=fifth_wheel,distance=9.115 --hump half_sine,length=0.5,height=0.03 --forward y --out run.yaml"
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the command's arguments."""
    parser.add_argument("exports", metavar="EXPORT", nargs="+", help="exports of phyphox, Sensor Logger, MATLAB Mobile, or a CSV file")
    parser.add_argument("--vehicle", required=True, metavar="FILE", help="a vehicle file, or the name of a bundled model")
    parser.add_argument("--set", metavar="NAME", dest="parameter_set", help="use a named parameter set of the vehicle")
    parser.add_argument(
        "--sensor",
        action="append",
        required=True,
        metavar="NAME:body=B,behind=P,distance=D",
        help="where a phone lay, one for each export in order; also x=, forward=, up=, acceleration_sign=, from=, to= (its seconds)",
    )
    road = parser.add_mutually_exclusive_group()
    road.add_argument("--hump", metavar="SHAPE,length=L,height=H", help="the hump, as in a run file; metres")
    road.add_argument("--profile", metavar="TABLE[,distance=C,height=C,unit=U,start=S]", help="a measured road instead of a hump")
    parser.add_argument(
        "--speed", metavar="M/S", help="speed of the pass (default: the median of the GPS), or `axles`: by when the axles crossed"
    )
    parser.add_argument("--forward", metavar="AXIS", help="the phones' axis that pointed forward: x, y (top edge), -x, -y, z or -z")
    parser.add_argument("--lead", type=float, metavar="METRES", help="front wheel at t = 0 to the hump (default: 3 s of driving)")
    parser.add_argument("--footprint", type=float, default=0.0, metavar="METRES", help="length of the tyres' contact (default: a point)")
    parser.add_argument("--rate", type=float, default=100.0, metavar="HZ", help="rate of the recording (default 100)")
    parser.add_argument(
        "--top", type=float, default=25.0, metavar="HZ", help="top of the band that matters; phones need twice that (default 25)"
    )
    parser.add_argument(
        "--columns",
        action="append",
        metavar="time=T,...",
        help="columns of plain CSVs, once for all or for each export in order; also time_unit=, pitch_rate=, ...",
    )
    add_out(parser, "RUN", "the run file to write; its recording (RUN_recording.csv) and a plot go beside it", required=True)
    add_json(parser)


def run(options: argparse.Namespace) -> None:
    """Import phone exports."""
    from vehgen.phones import import_phones
    from vehgen.phones.run_text import import_files
    from vehgen.report import save_figure
    from vehgen.vehicle import load_vehicle

    load_vehicle(options.vehicle)  # so that no result may replace what it was read from
    profile = read_profile(options.profile) if options.profile is not None else None
    out = file_named(options.out)
    written = [*import_files(out), out.with_suffix(".png")]
    for path in (*options.exports, *([profile["file"]] if profile else [])):
        note_read(path)
    check_results(written)
    found = import_phones(
        options.exports,
        vehicle=options.vehicle,
        sensors=[read_sensor(text) for text in options.sensor],
        hump=read_hump(options.hump) if options.hump is not None else None,
        profile=profile,
        out=out,
        parameter_set=options.parameter_set,
        speed=options.speed,
        forward=options.forward,
        lead=options.lead,
        footprint=options.footprint,
        rate=options.rate,
        top=options.top,
        columns=[read_column_map(text) for text in options.columns] if options.columns else None,
    )
    save_figure(found.plot(), written[-1])
    if options.json:
        print_json(_summary(found, [str(path) for path in written]))
    else:
        _show(found)
        tell_written(written)


def _summary(found: PhoneImport, files: list[str]) -> dict[str, object]:
    return {
        "speed": found.speed,
        "speed_source": found.speed_source,
        "speed_deviation": found.speed_deviation,
        "fitted_speed": found.fitted_speed,
        "at": found.at,
        "duration": float(found.time[-1]),
        "phones": [asdict(phone) for phone in found.phones],
        "warnings": list(found.warnings),
        "files": files,
    }


def _show(found: PhoneImport) -> None:
    columns, rows = found.table()
    cells = [(str(name), f"{peak:.4g}", *("" if noise is None else f"{noise:.2g}" for noise in noises)) for name, peak, *noises in rows]
    print_table(found.title, columns, cells, right=(1, 2, 3))
    say(f"speed: {found.speed_source}")
    for phone in found.phones:
        for note in phone.notes:
            say(note)
    warn(found.warnings)
