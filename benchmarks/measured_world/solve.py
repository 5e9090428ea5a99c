"""One case from the experimenter's folder to vehgen's answer: `python -m benchmarks.measured_world.solve FOLDER KIND OUT.json`.

Only public names of vehgen are used, and nothing of the truth. Each case runs in a process of its own, so that a crash is a result.
"""

from __future__ import annotations

import argparse
import contextlib
import json
import os
import shutil
import tempfile
import time
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import signal

Array = NDArray[np.float64]
VEHICLES = ("sedan2.yaml", "tractor5.yaml", "rig.yaml")
COMBINATIONS = {
    "sedan2": (),
    "tractor5": (*(f"{kind}{i}/(mT + mS)" for kind in ("m", "k", "c", "kt") for i in range(1, 6)), "b7/(mT + mS)", "b6*mS/(mT + mS)"),
}
"""What is asked of a calibration besides the parameters."""
BANDS = ((0.5, 2.0), (2.0, 5.0), (5.0, 10.0), (10.0, 20.0))
"""In which unseen roads are compared [Hz]."""
TRANSIENT = 4.0
"""Left out at the start of an unseen road [s]: the simulation begins at rest."""


@contextlib.contextmanager
def workplace(folder: Path) -> Iterator[Path]:
    """Yield a copy of a case's folder."""
    with tempfile.TemporaryDirectory() as name:
        copy = Path(name) / "case"
        shutil.copytree(folder, copy)
        yield copy


def vehicle_file(folder: Path) -> Path:
    """Return the case's vehicle file."""
    return next(folder / name for name in VEHICLES if (folder / name).is_file())


def imported(folder: Path) -> tuple[list[Path], dict[str, str]]:
    """Return a case's run files, made of phone exports where there are any, and why exports were refused, by run."""
    import vehgen

    arguments = folder / "import.json"
    if not arguments.is_file():
        return sorted(path for path in folder.glob("*.yaml") if path.name not in VEHICLES), {}
    runs, refused = [], {}
    for name, told in json.loads(arguments.read_text(encoding="utf-8")).items():
        exports = [folder / export for export in told.pop("exports")]
        sensors = [vehgen.PhoneSensor(**sensor) for sensor in told.pop("sensors")]
        out = folder / told.pop("out")
        if "profile" in told:
            told["profile"]["file"] = str(folder / told["profile"]["file"])
        try:
            vehgen.import_phones(exports, sensors=sensors, out=out, **{**told, "vehicle": folder / told["vehicle"]})
            runs.append(out)
        except vehgen.InputError as error:
            refused[name] = str(error)
    return runs, refused


def diagnosed(folder: Path) -> dict[str, Any]:
    """Return what a diagnosis says of a case; `refused` as its verdict where its input is."""
    import vehgen

    runs, refused = imported(folder)
    if len(runs) < 3:
        return {"verdict": "import_refused", "reason": "; ".join(refused.values()), "effects": [], "imports_refused": refused}
    try:
        data = vehgen.diagnose(vehicle_file(folder), runs).to_dict()
    except vehgen.InputError as error:
        return {"verdict": "refused", "reason": str(error), "effects": [], "imports_refused": refused}
    kept = ("verdict", "reason", "effects", "gap", "places", "notes", "faults")
    return {key: data[key] for key in kept if key in data} | {"imports_refused": refused}


def calibrated(folder: Path, unseen: Path | None, settings: dict[str, Any]) -> dict[str, Any]:
    """Return what a calibration finds of a case, and how well the vehicle found does on unseen roads."""
    import vehgen

    runs, refused = imported(folder)
    vehicle = vehicle_file(folder)
    if not runs:
        return {"outcome": "import_refused", "reason": "; ".join(refused.values())}
    try:
        data = vehgen.calibrate(vehicle, runs, combinations=COMBINATIONS[vehicle.stem], **settings).to_dict()
    except vehgen.InputError as error:
        return {"outcome": "refused", "reason": str(error), "imports_refused": refused}
    kept = ("parameters", "combinations", "modes", "chi2", "nuisances")
    found = {"outcome": "calibrated", "imports_refused": refused, **{key: data[key] for key in kept if key in data}}
    if unseen is not None:
        lines = [f"extends: {vehicle.name}", "parameters:"]
        lines += [f"  {name}: {{value: {item['value']!r} {item['unit']}}}" for name, item in data["parameters"].items()]
        better = folder / "calibrated.yaml"
        better.write_text("\n".join(lines) + "\n", encoding="utf-8")
        found["unseen"] = {path.stem: bands(path, better) for path in sorted(unseen.glob("unseen_*.yaml"))}
    return found


def bands(run: Path, vehicle: Path) -> dict[str, list[float]]:
    """Return by channel the relative error of the simulated rms in each of BANDS."""
    import vehgen

    response = vehgen.simulate(run, vehicle=vehicle)
    recorded = np.genfromtxt(run.with_suffix(".csv"), delimiter=",", names=True)
    times = np.asarray(response.time)
    found = {}
    for name in recorded.dtype.names[1:]:
        simulated = np.interp(recorded["t"], times, np.asarray(response.channel(name)).ravel())
        late = recorded["t"] >= TRANSIENT
        step = float(recorded["t"][1] - recorded["t"][0])
        pair = zip(band_rms(simulated[late], step), band_rms(recorded[name][late], step), strict=True)
        found[name] = [one / other - 1.0 for one, other in pair]
    return found


def band_rms(values: Array, step: float) -> list[float]:
    """Return the rms of values `step` [s] apart in each of BANDS, by Welch's method."""
    frequency, density = signal.welch(values, 1.0 / step, nperseg=min(len(values), round(4.0 / step)))
    width = frequency[1] - frequency[0]
    return [float(np.sqrt(np.sum(density[(frequency >= low) & (frequency < high)]) * width)) for low, high in BANDS]


def main() -> None:
    """Solve one case and write the answer."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("kind")
    parser.add_argument("out", type=Path)
    parser.add_argument("--unseen", type=Path)
    parser.add_argument("--settings", type=json.loads, default={}, help="more arguments of a calibration, as JSON")
    options = parser.parse_args()
    warnings.simplefilter("ignore")
    wall = time.perf_counter()
    with workplace(options.folder) as folder:
        answer = calibrated(folder, options.unseen, options.settings) if options.kind == "coverage" else diagnosed(folder)
    answer |= {"seconds": time.perf_counter() - wall, "cpu_seconds": sum(os.times()[:4])}
    options.out.write_text(json.dumps(answer), encoding="utf-8")


if __name__ == "__main__":
    main()
