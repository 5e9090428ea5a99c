"""Turn phone exports of one pass into a run file with its recording."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING, Any

from vehgen.commands.results import add_out, file_named, tell_written
from vehgen.commands.terminal import add_json, print_json, print_table, say, warn
from vehgen.errors import InputError
from vehgen.files import check_results, note_read

if TYPE_CHECKING:
    from vehgen.phones.importing import Imported
    from vehgen.phones.options import Plan
    from vehgen.report.plots.import_plot import ImportPanel

NAME = "import"
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
    road = parser.add_mutually_exclusive_group(required=True)
    road.add_argument("--hump", metavar="SHAPE,length=L,height=H", help="the hump, as in a run file; metres")
    road.add_argument("--profile", metavar="CSV[,distance=C,height=C]", help="a measured road instead of a hump")
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
    parser.add_argument("--columns", metavar="time=T,...", help="columns of a plain CSV; also time_unit=, pitch_rate=, ...")
    add_out(parser, "RUN", "the run file to write; its recording (RUN_recording.csv) and a plot go beside it", required=True)
    add_json(parser)


def run(options: argparse.Namespace) -> None:
    """Import phone exports."""
    from vehgen.phones.importing import import_phones
    from vehgen.phones.run_text import import_files, write_import
    from vehgen.report import save_figure
    from vehgen.report.plots.import_plot import plot_import

    plan = _plan(options)
    out = file_named(options.out)
    written = [*import_files(out), out.with_suffix(".png")]
    for export in options.exports:
        note_read(export)
    check_results(written)
    imported = import_phones(options.exports, plan)
    write_import(imported, options.vehicle, out)
    arrival = imported.phones[0].arrival - imported.phones[0].zero
    title = f"{plan.vehicle.title or plan.vehicle.name}, {imported.speed:.3g} m/s"
    save_figure(plot_import(_panels(imported), arrival if imported.at is not None else None, _crossings(imported), title), written[-1])
    if options.json:
        print_json({**_summary(imported), "files": [str(path) for path in written]})
        return
    _tell(imported, title)
    tell_written(written)


def _plan(options: argparse.Namespace) -> Plan:
    """Read the plan of an import from the command line."""
    from vehgen.commands.option_strings import quantity, read_column_map, read_hump, read_profile, read_sensor
    from vehgen.files.limits import FOOTPRINT, ROAD_POSITION, SPEED_LIMIT
    from vehgen.files.units import SPEED
    from vehgen.phones.importing import with_forward
    from vehgen.phones.options import Plan
    from vehgen.vehicle import load_vehicle

    by_axles = options.speed == "axles"
    speed = None if options.speed is None or by_axles else quantity(options.speed, SPEED, "--speed")
    for name, value, limit in (
        ("speed", speed, SPEED_LIMIT),
        ("lead", options.lead, ROAD_POSITION),
        ("footprint", options.footprint, FOOTPRINT),
    ):
        if value is not None and not (value > 0 or (value == 0 and name == "footprint")):
            raise InputError(f"--{name} must be a positive number, found {value}")
        limit.check(value or 0.0, f"--{name}")
    vehicle = load_vehicle(options.vehicle)
    return Plan(
        vehicle,
        read_hump(options.hump) if options.hump is not None else read_profile(options.profile),
        with_forward([read_sensor(text, vehicle) for text in options.sensor], options.forward),
        options.parameter_set,
        speed,
        by_axles,
        options.lead,
        options.rate,
        options.top,
        footprint=options.footprint,
        columns=read_column_map(options.columns) if options.columns else None,
    )


def _summary(imported: Imported) -> dict[str, Any]:
    """Return an import as JSON holds it."""
    from vehgen.phones.run_text import phone_notes

    return {
        "speed": imported.speed,
        "speed_source": imported.speed_source,
        "fitted_speed": imported.fitted_speed,
        "at": imported.at,
        "duration": float(imported.time[-1]),
        "phones": [
            {
                "export": item.phone.name,
                "app": item.phone.export.app,
                "sensor": item.phone.sensor.name,
                "rates": list(item.phone.rates),
                "tilt": item.orientation.tilt if item.orientation else None,
                "zero": item.zero,
                "correlation": item.match.correlation,
                "noise": {name: {"sigma": floor.sigma, "band_sigma": floor.band_sigma} for name, floor in item.noise},
                "notes": phone_notes(imported, item),
            }
            for item in imported.phones
        ],
        "warnings": list(imported.warnings),
    }


def _tell(imported: Imported, title: str) -> None:
    """Print an import for people."""
    from vehgen.phones.run_text import phone_notes

    peaks = abs(imported.values).max(axis=0)
    floors = {name: floor for item in imported.phones for name, floor in item.noise}
    print_table(
        title,
        ("channel", "largest magnitude", "noise sigma", "by its top band"),
        [
            (name, f"{peak:.4g}", *((f"{floors[name].sigma:.2g}", f"{floors[name].band_sigma:.2g}") if name in floors else ("", "")))
            for name, peak in zip(imported.channels, peaks, strict=True)
        ],
        right=(1, 2, 3),
    )
    say(f"speed: {imported.speed_source}")
    for item in imported.phones:
        for note in phone_notes(imported, item):
            say(note)
    warn(imported.warnings)


def _panels(imported: Imported) -> list[ImportPanel]:
    from vehgen.report.plots.import_plot import ImportPanel

    panels = []
    column = 0
    for item in imported.phones:
        floors = dict(item.noise)
        for stream in (item.upward, item.pitch):
            if stream is None:
                continue
            name = imported.channels[column]
            part = stream.between(item.zero, item.zero + float(imported.time[-1]))
            quiet = (max(item.quiet[0] - item.zero, 0.0), item.quiet[1] - item.zero)
            onset = item.event.onset - item.zero if item.event else None
            sigma = floors[name].sigma if name in floors else None
            values = imported.values[:, column]
            panels.append(
                ImportPanel(name, stream.unit, part.time - item.zero, part.values[:, 0], imported.time, values, quiet, onset, sigma)
            )
            column += 1
    return panels


def _crossings(imported: Imported) -> list[tuple[str, float]]:
    if imported.at is None:
        return []
    return [(name, (imported.at + offset) / imported.speed) for name, offset in imported.wheels.items()]
