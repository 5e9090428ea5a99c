"""Raw exports of phones, as two usual apps write them, and what is to be said when they are imported."""

from __future__ import annotations

import io
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.measured_world import gps
from benchmarks.measured_world.cases import Case, Run
from benchmarks.measured_world.files import write_json, write_table
from benchmarks.measured_world.phone import Phone, Samples
from benchmarks.measured_world.world import Pass, record_phones

Array = NDArray[np.float64]
EPOCH = 1_790_000_000.0
"""World time of the first run [s]; an hour passes between runs."""


def write_exports(case: Case, folder: Path) -> tuple[dict[str, dict[str, float]], dict[str, dict[str, float]]]:
    """Write RUN_SENSOR.zip of every run and phone, measured roads, and import.json; return facts of the runs and the sensors' noise.

    import.json holds, for every run, the keyword arguments of vehgen.import_phones with `exports` and `out` as names of files. In half
    of the cases the speed is that of the satellite fixes, in the others that at which the axles' marks fit.
    """
    facts, noise, arguments = {}, {}, {}
    for number, run in enumerate(case.runs):
        true, samples, facts[run.name] = record_phones(case, number)
        noise[run.name] = {}
        for i, phone in enumerate(case.phones):
            force, turn = samples[phone.sensor]
            begins = true.start - phone.starts[number]
            epoch = EPOCH + 3600.0 * number + begins + phone.world_errors[number]
            rng = np.random.default_rng([run.seed, 7, i])
            fixes = gps.fixes(true.drive, begins, true.end, rng)
            write_zip(folder / f"{run.name}_{phone.sensor}.zip", export(phone, force, turn, fixes, epoch, true.end - begins))
            noise[run.name] |= {f"{phone.sensor}_az": force.noise, f"{phone.sensor}_q": turn.noise}
        arguments[run.name] = _arguments(case, run, true, folder)
    write_json(folder / "import.json", arguments)
    return facts, noise


def _arguments(case: Case, run: Run, true: Pass, folder: Path) -> dict[str, Any]:
    sensors = [
        {"name": place.name, "body": place.body, "behind": place.behind, "distance": place.distance, "forward": phone.forward}
        | ({"acceleration_sign": -1} if phone.device.reversed else {})
        for place, phone in zip(case.sensors, case.phones, strict=True)
    ]
    found: dict[str, Any] = {
        "exports": [f"{run.name}_{phone.sensor}.zip" for phone in case.phones],
        "vehicle": f"{case.vehicle}.yaml",
        "sensors": sensors,
        "out": f"{run.name}.yaml",
    }
    if case.seed % 2:
        found["speed"] = "axles"
    if true.profile is not None:
        name = f"{run.name}_road.csv"
        write_table(folder / name, {"s": true.profile.distance, "h": true.profile.height}, "%.6g")
        return found | {"profile": {"file": name, "distance": "s", "height": "h"}}
    hump = run.stated_hump
    assert hump is not None
    return found | {"hump": {"shape": hump.shape, "length": hump.length, "height": hump.height}}


def export(phone: Phone, force: Samples, turn: Samples, fixes: Array, epoch: float, duration: float) -> dict[str, str]:
    """Return the files of an export: a phyphox or a Sensor Logger archive, by the phone's app; `fixes` are times [s] and speeds [m/s]."""
    sign = -1.0 if phone.device.reversed else 1.0
    files = _phyphox if phone.device.app == "phyphox" else _sensor_logger
    return files(phone, (force.t, sign * force.xyz), (turn.t, turn.xyz), fixes, epoch, duration)


def _phyphox(
    phone: Phone, force: tuple[Array, Array], turn: tuple[Array, Array], fixes: Array, epoch: float, duration: float
) -> dict[str, str]:
    still = np.ones(len(fixes))
    places = np.column_stack([fixes[:, 0], 48.1 * still, 11.5 * still, 500.0 * still, fixes[:, 1], 90.0 * still])
    names = ["Latitude (°)", "Longitude (°)", "Height (m)", "Velocity (m/s)", "Direction (°)"]
    return {
        "Accelerometer.csv": _quoted([f"{axis} (m/s^2)" for axis in "XYZ"], np.column_stack(force)),
        "Gyroscope.csv": _quoted([f"{axis} (rad/s)" for axis in "XYZ"], np.column_stack(turn)),
        "Location.csv": _quoted(names, places),
        "meta/time.csv": '"event","experiment time","system time","system time text"\n'
        f'"START",0.000000000E0,{epoch:.3f},""\n"PAUSE",{duration:.9E},{epoch + duration:.3f},""\n',
    }


def _quoted(names: list[str], rows: Array) -> str:
    text = io.StringIO()
    text.write(",".join(f'"{name}"' for name in ["Time (s)", *names]) + "\n")
    np.savetxt(text, rows, fmt="%.9E", delimiter=",")
    return text.getvalue()


def _sensor_logger(
    phone: Phone, force: tuple[Array, Array], turn: tuple[Array, Array], fixes: Array, epoch: float, duration: float
) -> dict[str, str]:
    def nanoseconds(t: float) -> int:
        return round((epoch + t) * 1e6) * 1000

    def sensor(samples: tuple[Array, Array]) -> str:
        lines = ["time,seconds_elapsed,z,y,x"]
        for t, (x, y, z) in zip(*samples, strict=True):
            lines.append(f"{nanoseconds(t)},{t:.9f},{z:.6f},{y:.6f},{x:.6f}")
        return "\n".join(lines) + "\n"

    places = [f"{nanoseconds(t)},{t:.6f},90,{v:.3f},500,11.5,48.1" for t, v in fixes]
    standard = "false" if phone.device.reversed else "true"
    return {
        "TotalAcceleration.csv": sensor(force),
        "Gyroscope.csv": sensor(turn),
        "Location.csv": "\n".join(["time,seconds_elapsed,bearing,speed,altitude,longitude,latitude", *places]) + "\n",
        "Metadata.csv": "version,device name,recording epoch time,platform,standardisation\n"
        f"3,phone,{round(epoch * 1e3)},{phone.device.platform},{standard}\n",
    }


def write_zip(path: Path, files: dict[str, str]) -> None:
    """Write an archive that is the same every time."""
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, text in files.items():
            archive.writestr(zipfile.ZipInfo(name, (2026, 1, 1, 0, 0, 0)), text, zipfile.ZIP_DEFLATED)
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(data.getvalue())
