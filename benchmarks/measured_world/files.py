"""Write a case as the experimenter has it: the base vehicle file, run files with recordings; the truth goes elsewhere."""

from __future__ import annotations

import dataclasses
import io
import json
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.hidden_effects.generator.cases import SensorSpec
from benchmarks.measured_world.cases import Case, Recording, Run
from benchmarks.measured_world.hump import Hump

Array = NDArray[np.float64]
MODELS = Path(__file__).parents[2] / "models"


def copy_vehicle(case: Case, folder: Path) -> None:
    """Write the base vehicle file: as it is bundled, but for distances that the case states otherwise."""
    name = f"{case.vehicle}.yaml"
    text = (MODELS / name).read_text(encoding="utf-8")
    for parameter, value in case.stated.items():
        text, count = re.subn(rf"(?m)^(  {parameter}: {{value: )[^,]*,", rf"\g<1>{value:g} m,", text)
        if count != 1:
            raise ValueError(f"{name} does not state {parameter} once")
    write_text(folder / name, text)


def write_recording(case: Case, recording: Recording, folder: Path) -> None:
    """Write NAME.yaml, NAME.csv and, of a measured road, NAME_road.csv."""
    run = recording.run
    write_table(folder / f"{run.name}.csv", {"t": recording.t, **recording.channels}, "%.7g")
    lines = [
        f"vehicle: {case.vehicle}.yaml",
        f"speed: {run.speed:.6g} m/s",
        f"recording: {run.name}.csv",
        *_road(recording, folder),
        "sensors:",
    ]
    lines += [_sensor(sensor) for sensor in case.sensors]
    write_text(folder / f"{run.name}.yaml", "\n".join(lines) + "\n")


def _road(recording: Recording, folder: Path) -> list[str]:
    run = recording.run
    if recording.profile is not None:
        name = f"{run.name}_road.csv"
        write_table(folder / name, {"s": recording.profile.distance + recording.at, "h": recording.profile.height}, "%.6g")
        span = recording.t[-1] - recording.t[0]
        return [f"duration: {span:.6g} s", f"road: [{{profile: {{file: {name}, distance: s, height: h}}}}]"]
    assert run.stated_hump is not None
    return [f"road: [{{hump: {hump_text(run.stated_hump)[:-1]}, at: {recording.at:.6g} m}}}}]"]


def hump_text(hump: Hump) -> str:
    """Return a hump as a run file states it."""
    return f"{{shape: {hump.shape}, length: {hump.length:g} m, height: {hump.height:g} m}}"


def _sensor(sensor: SensorSpec) -> str:
    channels = f"{{acceleration: {sensor.name}_az, pitch_rate: {sensor.name}_q}}"
    return f"  {sensor.name}: {{body: {sensor.body}, behind: {sensor.behind}, distance: {sensor.distance:g} m, channels: {channels}}}"


def truth(case: Case, facts: Mapping[str, Mapping[str, float]], more: Mapping[str, Any]) -> dict[str, Any]:
    """Return the truth of a case as plain data: what is hidden or wrong, the true parameters, every run, and `more`."""
    return {
        "case": case.name,
        "kind": case.kind,
        "vehicle": case.vehicle,
        "recorder": "phones" if case.phones else "logger",
        "seed": case.seed,
        "effects": [{"name": e.name, "place": e.place, "values": dict(e.values)} for e in case.effects],
        "fault": None if case.fault is None else dataclasses.asdict(case.fault),
        "parameters": dict(case.parameters),
        "stated": dict(case.stated),
        "runs": [{**_plain(run), "facts": dict(facts.get(run.name, {}))} for run in case.runs],
        "instruments": dataclasses.asdict(case.logger) if case.logger else [dataclasses.asdict(phone) for phone in case.phones],
        **more,
    }


def _plain(run: Run) -> dict[str, Any]:
    return dataclasses.asdict(run)


def write_table(path: Path, columns: Mapping[str, Array], form: str) -> None:
    """Write columns as CSV; time and distance with seven digits after the point, so that their steps stay even."""
    text = io.StringIO()
    text.write(",".join(columns) + "\n")
    forms = ["%.7f" if name in ("t", "s") else form for name in columns]
    np.savetxt(text, np.column_stack(list(columns.values())), fmt=forms, delimiter=",")
    write_text(path, text.getvalue())


def write_json(path: Path, data: Any) -> None:
    """Write plain data as JSON."""
    write_text(path, json.dumps(data, indent=1) + "\n")


def write_text(path: Path, text: str) -> None:
    """Write a text file, its folder too."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
