"""The run file and recording of an import as text; every assumption stands in the run file as a comment."""

from __future__ import annotations

import csv
import io
import math
import os
from pathlib import Path
from typing import Any

import numpy as np

from vehgen.errors import ArgumentError, shortened, shown
from vehgen.files import write_text
from vehgen.files.yaml_writer import Commented, OneLine, yaml_document
from vehgen.phones.gps import USUAL_SPEED_SHARE
from vehgen.phones.importing import Imported, ImportedPhone, clock_difference
from vehgen.phones.resampling import is_low_passed
from vehgen.simulate import load_run
from vehgen.vehicle import Vehicle, VehicleLike
from vehgen.vehicle.loading import find_vehicle_file, models_folder
from vehgen.vehicle.writing import base_reference

USUAL_CLOCK_S, DOUBTFUL_CLOCK_S = 0.01, 0.03
"""How well phones' clocks are known against one another [s], and where one of them is matched badly."""
WORTH_STATING = 1.5
"""So many times less well than usual clocks have to be known for a run file to say so."""
LOUD_SHARE = 0.25
"""A moment is loud with this share of the largest power: what a rough road shakes all the way tells nothing of the hump."""
WANDER_SHARE = 0.007
"""How far from its mean the speed between two phones' loudest moments may be, relative: they are laid over an answer at one speed. Four
clocks of a trailer 15 m behind were late by 0.2 to 1.2 % of that time, at a speed that wandered by 1 %.
"""


def write_import(imported: Imported, vehicle: VehicleLike, out: Path) -> tuple[Path, Path]:
    """Write the run file `out` and its recording beside it, and read the run file back.

    Parameters
    ----------
    imported
        What the phones recorded.
    vehicle
        The vehicle as it was given: a path, the name of a bundled model, or one that was read from a file.
    out
        The run file.

    Returns
    -------
    The run file and the recording.

    Raises
    ------
    InputError
        When the folder cannot be written to.
    """
    out, recording = import_files(out)
    write_text(recording, recording_text(imported))
    write_text(out, run_text(imported, vehicle, out))
    load_run(out)
    return out, recording


def import_files(out: Path) -> tuple[Path, Path]:
    """Return the run file of an import and its recording, which cannot bear the name of an export beside it: a.yaml, a_recording.csv.

    Raises
    ------
    InputError
        When `out` is not the name of a run file.
    """
    if out.suffix.lower() not in (".yaml", ".yml"):
        raise ArgumentError(f"`out` names the run file to write, e.g. run.yaml; found {shown(out.name)}", "out")
    return out, out.with_name(f"{out.stem}_recording.csv")


def recording_text(imported: Imported) -> str:
    """Return the recording as CSV: t [s] and one column per channel [m/s^2, rad/s]."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["t", *imported.channels])
    for t, row in zip(imported.time, imported.values, strict=True):
        writer.writerow([f"{t:.9g}", *(f"{value:.9g}" for value in row)])
    return text.getvalue()


def run_text(imported: Imported, vehicle: VehicleLike, out: Path) -> str:
    """Return the run file of an import."""
    plan, folder = imported.plan, out.parent
    comments = ["Made by `vehgen import`; what was found and assumed stands beside what it led to."]
    comments += [f"warning: {text}" for text in imported.warnings]
    fitted = "" if imported.fitted_speed is None else f"; the axles' marks fit {imported.fitted_speed:.3f} m/s best"
    where = "at: front wheel at t = 0 to the hump" if imported.at is not None else "the front wheel is at 0 m along it at t = 0"
    data: dict[str, Any] = {
        "vehicle": _vehicle(vehicle, folder),
        "set": plan.parameter_set,
        "speed": Commented(f"{imported.speed.value:.6g} m/s", f"{imported.speed.source}{fitted}"),
        "uncertainty": _uncertainty(imported),
        "duration": f"{imported.time[-1]:.6g} s",
        "sample": f"{1000 / plan.rate:.6g} ms",
        "road": Commented([{plan.road.kind: _road_entry(imported, folder)}], where),
        "footprint": f"{plan.footprint:.6g} m" if plan.footprint else None,
        "recording": import_files(out)[1].name,
        "sensors": {item.phone.sensor.name: _sensor(imported, item) for item in imported.phones},
    }
    return yaml_document({key: value for key, value in data.items() if value is not None}, comments)


def _uncertainty(imported: Imported) -> OneLine | None:
    """Return how well a GPS knows the speed, and the phones' clocks one another, where that is less well than runs are usually known."""
    deviation, stated = imported.speed.deviation, {}
    if deviation is not None and deviation > USUAL_SPEED_SHARE * imported.speed.value:
        stated["speed"] = f"{deviation:.2g} m/s"
    if (clock := _clock_deviation(imported)) > WORTH_STATING * USUAL_CLOCK_S:
        stated["clock"] = f"{1000 * clock:.0f} ms"
    return OneLine(**stated) if stated else None


def _clock_deviation(imported: Imported) -> float:
    """Return how well the phones' clocks are known against one another [s]: over a hump each was set by when that phone felt the axles."""
    if imported.at is None or len(imported.phones) < 2:
        return USUAL_CLOCK_S
    upward = [imported.channels.index(item.phone.sensor.outputs(False)[0].name) for item in imported.phones]
    energy = imported.values[:, upward] ** 2
    energy[energy < LOUD_SHARE * energy.max(axis=0)] = 0.0
    felt = imported.time @ energy / energy.sum(axis=0)
    by_speed = math.hypot(USUAL_CLOCK_S, WANDER_SHARE * float(np.ptp(felt)))
    return by_speed if all(item.match.is_trusted for item in imported.phones) else max(by_speed, DOUBTFUL_CLOCK_S)


def _road_entry(imported: Imported, folder: Path) -> dict[str, Any]:
    entry: dict[str, Any] = dict(imported.plan.road.entry)
    if "file" in entry:
        entry["file"] = _relative(Path(entry["file"]), folder)
    if imported.at is not None:
        entry["at"] = f"{imported.at:.6g} m"
    return entry


def _sensor(imported: Imported, item: ImportedPhone) -> Commented:
    sensor, outputs = item.phone.sensor, item.phone.sensor.outputs(item.pitch is not None)
    place = {"body": sensor.place.body}
    if sensor.place.x is not None:
        place["x"] = sensor.place.x.text
    if sensor.place.behind is not None:
        place |= {"behind": sensor.place.behind, "distance": f"{sensor.place.distance:.6g} m"}
    filtered = [is_low_passed(rate, imported.plan.rate) for rate in item.phone.rates[: len(outputs)]]
    channels: dict[str, Any] = {output.quantity: output.name for output in outputs}
    if any(filtered) and not all(filtered):
        recorders = zip(outputs, filtered, strict=True)
        channels = {output.quantity: OneLine(column=output.name, acquisition=_recorder(own)) for output, own in recorders}
    else:
        place["acquisition"] = _recorder(all(filtered))
    return Commented(OneLine(**place, channels=channels), above=tuple(phone_notes(imported, item)))


def _recorder(filtered: bool) -> str:
    """Return what acquired a channel: the low-pass that put it on the grid, or a chip's that nobody knows."""
    return "resampled" if filtered else "unknown"


def phone_notes(imported: Imported, item: ImportedPhone) -> list[str]:
    """Return what was found out and assumed about one phone, in words."""
    phone = item.phone
    rates = " and ".join(f"{rate:.2f} Hz" for rate in phone.rates)
    notes = [f"{phone.name} ({phone.export.app}): sampled at {rates}, put on {imported.plan.rate:g} Hz"]
    if phone.export.accelerometer is not None:
        notes.append(f"its accelerometer is {shortened(phone.export.accelerometer)}")
    if item.orientation is not None:
        sensor, orientation = phone.sensor, item.orientation
        up = " {:+.4f} {:+.4f} {:+.4f}".format(*orientation.up)
        notes.append(f"up is{up} in its axes, tilted {orientation.tilt:.2f} deg; forward: {sensor.forward or 'not said'}")
    notes.append(f"t = 0 is {item.zero:.4f} s on its clock, found by {item.found_by}")
    if item.event is not None:
        late = item.event.onset - item.arrival
        notes.append(f"energy sets in {late:+.3f} s after the front wheel's arrival, {item.event.contrast:.0f} times as loud")
    if item is not imported.phones[0]:
        difference = clock_difference(imported.phones[0], item)
        offset = item.arrival - imported.phones[0].arrival
        world = (
            "the apps' clocks cannot be compared"
            if difference is None
            else f"by the apps' own clocks it crossed {difference:+.3f} s after {first_name(imported)}"
        )
        notes.append(f"its clock is {offset:+.4f} s ahead of that of {first_name(imported)}; {world}")
    for channel, floor in item.noise:
        low, high = floor.band
        notes.append(
            f"{channel}: noise sigma {floor.sigma:.3g} in the quiet lead-in, {floor.band_sigma:.3g} by its {low:.0f}-{high:.0f} Hz band"
        )
    return [*notes, *item.notes]


def first_name(imported: Imported) -> str:
    """Return the name of the phone that the others' clocks are compared with."""
    return imported.phones[0].phone.name


def _vehicle(given: VehicleLike, folder: Path) -> str:
    if isinstance(given, Vehicle):
        return base_reference(given, folder)
    path = find_vehicle_file(Path(given))
    return Path(given).name if path.parent == models_folder() else _relative(path, folder)


def _relative(path: Path, folder: Path) -> str:
    return Path(os.path.relpath(path, folder)).as_posix()
