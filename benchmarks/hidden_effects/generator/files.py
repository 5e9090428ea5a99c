"""Write a trial as the experimenter sees it, one run file and CSV per run, and the truth in a folder of its own."""

from __future__ import annotations

import dataclasses
import io
import json
import os
from pathlib import Path

import numpy as np

from benchmarks.hidden_effects.generator.cases import Case, Hump, Recording
from benchmarks.hidden_effects.generator.simulate import sensors_of, simulate_case, true_parameters
from benchmarks.hidden_effects.generator.vehicles import nominal


def write_case(case: Case, folder: Path, truth_folder: Path | None = None) -> list[Path]:
    """Write NAME.yaml, NAME.csv and measured profiles of every run into `folder`, and truth.json into `truth_folder` (default:
    folder/truth).

    Returns the run files. Run names are made unique by a number where they repeat. Raises OSError where a file cannot be written.
    """
    truth_folder = folder / "truth" if truth_folder is None else truth_folder
    folder.mkdir(parents=True, exist_ok=True)
    truth_folder.mkdir(parents=True, exist_ok=True)
    names = [run.name for run in case.runs]
    paths = []
    for number, recording in enumerate(simulate_case(case), start=1):
        name = recording.run.name if names.count(recording.run.name) == 1 else f"{recording.run.name}{number}"
        _write_csv(folder / f"{name}.csv", {"t": recording.t, **recording.channels})
        paths.append(folder / f"{name}.yaml")
        _write(paths[-1], _run_file(case, recording, name, folder))
    _write(truth_folder / "truth.json", json.dumps(_truth(case), indent=1) + "\n")
    return paths


def _run_file(case: Case, recording: Recording, name: str, folder: Path) -> str:
    run = recording.run
    lines = [
        f"vehicle: {case.vehicle}.yaml",
        f"speed: {run.speed:g} m/s",
        f"duration: {run.duration:g} s",
        f"recording: {name}.csv",
        *(["acquisition: none"] if case.sampling == "point" else []),
        "road:",
    ]
    profiles = iter(recording.profiles)
    for i, part in enumerate(run.road, start=1):
        if isinstance(part, Hump):
            lines.append(f"  - hump: {{shape: half_sine, length: {part.length:g} m, height: {part.height:g} m, at: {part.at:g} m}}")
        else:
            distance, height = next(profiles)
            file = f"{name}_road{i}.csv"
            _write_csv(folder / file, {"s": distance, "h": height})
            lines.append(f"  - profile: {{file: {file}, distance: s, height: h}}")
    lines.append("sensors:")
    for sensor in sensors_of(case):
        channels = f"{{acceleration: {sensor.name}_az, pitch_rate: {sensor.name}_q}}"
        lines.append(
            f"  {sensor.name}: {{body: {sensor.body}, behind: {sensor.behind}, distance: {sensor.distance:g} m, channels: {channels}}}"
        )
    return "\n".join(lines) + "\n"


def _truth(case: Case) -> dict[str, object]:
    return {
        "vehicle": case.vehicle,
        "seed": case.seed,
        "parameters": true_parameters(case),
        "nominal": nominal(case.vehicle),
        "effects": [{"name": e.name, "place": e.place, "values": dict(e.values)} for e in case.effects],
        "runs": [dataclasses.asdict(run) for run in case.runs],
        "noise": dataclasses.asdict(case.noise),
        "sampling": case.sampling,
    }


def _write_csv(path: Path, columns: dict[str, np.ndarray]) -> None:
    text = io.StringIO()
    text.write(",".join(columns) + "\n")
    np.savetxt(text, np.column_stack(list(columns.values())), fmt="%.9g", delimiter=",")
    _write(path, text.getvalue())


def _write(path: Path, text: str) -> None:
    scratch = path.with_name(f".{path.name}.{os.getpid()}")
    scratch.write_text(text, encoding="utf-8")
    os.replace(scratch, path)
