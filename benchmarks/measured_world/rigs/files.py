"""A rig as an engineer hands it over: a vehicle file, run files with recordings and measured inputs; the truth goes elsewhere."""

from __future__ import annotations

import dataclasses
import math
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.measured_world.files import write_json, write_table, write_text
from benchmarks.measured_world.rigs.cases import RANGE, Channel, Rig, Run
from benchmarks.measured_world.rigs.dyno import CELL
from benchmarks.measured_world.rigs.half_car import ENDS
from benchmarks.measured_world.rigs.recorder import BEFORE, Recording, record
from benchmarks.measured_world.rigs.sets import FAMILIES, KIND
from benchmarks.measured_world.rigs.strength import strength

VEHICLE = "rig.yaml"
RULER_MM, INCLINOMETER_DEG = 0.5, 0.03
"""Standard deviations that an engineer states of what is read off before a release."""
TITLES = {
    "half_car": "Half a car, dropped and released",
    "dyno": "A damper between an actuator and a load cell",
    "carriage": "A carriage on a rail, pushed by a measured force",
}


def vehicle_text(rig: Rig) -> str:
    """Return the vehicle file."""
    lines = [f"name: {rig.family}", f"title: {TITLES[rig.family]}"]
    if rig.family != "half_car":
        lines.append("gravity: false")
    lines.append("parameters:")
    for name, item in rig.quantities.items():
        low, high = (f"{_decimal(item.stated * share, 3)} {item.unit}" for share in RANGE)
        limits = f", range: [{low}, {high}]" if item.uncertain else ""
        lines.append(f"  {name}: {{value: {_decimal(item.stated, 12)} {item.unit}{limits}, meaning: '{item.meaning}'}}")
    return "\n".join([*lines, *_parts(rig)]) + "\n"


def _decimal(value: float, digits: int) -> str:
    return str(np.format_float_positional(float(f"{value:.{digits}g}"), trim="-"))


def _parts(rig: Rig) -> list[str]:
    if rig.family == "carriage":
        return ["bodies:", "  carriage: {mass: M, motions: [heave]}", "links:", "  rail: {ground: {}, carriage: {}, c: c}"]
    if rig.family == "dyno":
        spring = "k: k, " if "k" in rig.quantities else ""
        return [
            "bodies:",
            "  crosshead: {mass: mB, motions: [heave]}",
            "links:",
            f"  damper: {{ground: {{}}, crosshead: {{}}, {spring}c: c}}",
            f"  load_cell: {{crosshead: {{}}, ground: {{}}, k: kL, c: {CELL:g} N s/m}}",
        ]
    lines = ["bodies:", "  car: {mass: mB, pitch_inertia: IB}", "axles:"]
    for i, end in enumerate(ENDS, start=1):
        spring = f"suspension: {{k: k{i}, c: c{i}}}, tyre: {{k: kt{i}, laws: [{{tyre_liftoff: {{}}}}]}}"
        lines.append(f"  {end}: {{body: car, x: {rig.numbers[end]:g} m, mass: m{i}, {spring}}}")
    return lines


def run_text(rig: Rig, run: Run) -> str:
    """Return a run file."""
    recorder = rig.recorder
    lines = [f"vehicle: {VEHICLE}", f"title: '{run.kind} {run.name}'", "step: 0.5 ms", f"sample: {1e3 / recorder.rate:g} ms"]
    lines.append(f"duration: {run.duration - 2.0 * BEFORE:.3f} s")
    if rig.family == "half_car":
        lines += ["speed: 1 m/s", *_release(rig, run)]
    elif rig.family == "dyno":
        lines += ["displacements:", f"  damper: {{file: {run.name}_input.csv, time: t, displacement: x, unit: m}}"]
    else:
        lines += ["forces:", f"  motor: {{body: carriage, file: {run.name}_input.csv, time: t, force: F, unit: N}}"]
    if recorder.declared:
        lines.append(f"acquisition: {{filter: {recorder.kind}, order: {recorder.order}, cut_off: {recorder.cutoff:.4g} Hz}}")
    elif recorder.kind == "none":
        lines.append("acquisition: none")
    return "\n".join([*lines, "sensors:", *map(_sensor, rig.channels), f"recording: {run.name}.csv"]) + "\n"


def _release(rig: Rig, run: Run) -> list[str]:
    """Return how a release begins, as read: the body off a ruler and an inclinometer; dropped axles follow from it, those of a hung car
    and of one on its wheels are read off dial gauges."""
    height, pitch, *axles = FAMILIES["half_car"].initial(rig, run)
    height = round(height + run.errors["displacement"], 4)
    degrees = round(math.degrees(pitch) + run.errors["pitch"], 2)
    if run.kind == "drop":
        axles = [height - rig.numbers[end] * math.radians(degrees) for end in ENDS]
    pitched = _read(degrees, "deg", INCLINOMETER_DEG)
    lines = ["initial:", f"  car: {{displacement: {_read(1e3 * height, 'mm', RULER_MM)}, pitch: {pitched}}}"]
    return lines + [f"  {end}: {{displacement: {_read(1e3 * value, 'mm', RULER_MM)}}}" for end, value in zip(ENDS, axles, strict=True)]


def _read(value: float, unit: str, spread: float) -> str:
    """Return what an instrument of such a standard deviation reads, as a run file says it."""
    return f"{{value: {value:.4g} {unit}, tolerance: {spread:g} {unit}}}"


def _sensor(channel: Channel) -> str:
    """Return a sensor; a load cell counts the ground as its lower end, and reads a push upwards as positive unless its sign is turned."""
    sign = f", sign: {-channel.sign}" if channel.quantity == "link_force" else ""
    column = f"{{column: {channel.name}, unit: {channel.unit}{sign}}}"
    return f"  {channel.sensor}, channels: {{{channel.quantity}: {column}}}}}"


def write_run(rig: Rig, run: Run, recording: Recording, folder: Path) -> None:
    """Write NAME.yaml, NAME.csv and, of a driven rig, NAME_input.csv."""
    write_table(folder / f"{run.name}.csv", {"t": recording.t, **recording.channels}, "%.7g")
    if recording.inputs:
        write_table(folder / f"{run.name}_input.csv", {"t": recording.input_t, **recording.inputs}, "%.9g")
    write_text(folder / f"{run.name}.yaml", run_text(rig, run))


def write_rig(rig: Rig, folder: Path) -> dict[str, dict[str, float]]:
    """Write the vehicle file and all runs, and return the standard deviations of the channels' noise by run."""
    family = FAMILIES[rig.family]
    sigma = {}
    write_text(folder / VEHICLE, vehicle_text(rig))
    for run in rig.runs:
        motions, _ = family.respond(rig, run, family.drive(rig, run))
        recording = record(rig, run, motions)
        write_run(rig, run, recording, folder)
        sigma[run.name] = recording.sigma
    return sigma


def write_case(rig: Rig, out: Path) -> None:
    """Write out/cases/NAME and out/truth/NAME, the truth last."""
    sigma = write_rig(rig, out / "cases" / rig.name)
    truth: dict[str, Any] = {
        "case": rig.name,
        "kind": KIND,
        "vehicle": rig.family,
        "recorder": "declared" if rig.recorder.declared else "undeclared",
        "fault": None,
        "effects": [
            {"name": item.law, "place": item.place, "values": dict(item.values), "listed": item.listed, "accepted": dict(item.accepted)}
            for item in rig.hidden
        ],
        "strength": strength(rig, FAMILIES[rig.family]) if rig.hidden else None,
        "noise": sigma,
        "rig": dataclasses.asdict(rig),
    }
    write_json(out / "truth" / rig.name / "truth.json", truth)
