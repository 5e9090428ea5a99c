"""Recordings of the true vehicles as phones would make them, with run files for vehgen."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from benchmarks.paper_study.roads import RandomRoad, half_sine
from benchmarks.paper_study.truth import DT, System, respond, sedan, truck

Array = np.ndarray
SHARE, FLOORS = 0.01, (0.01, 0.0005)
"""Noise of a phone: a share of each channel's rms, and floors of acceleration [m/s^2] and pitch rate [rad/s], added in quadrature."""
HUMP_AT = 3.0
"""The hump's start [m] ahead of the first wheel when the recording begins."""
SETTLED = 6.0
"""Driven before the recording begins [s]: the vehicle arrives in motion."""
RINGING = 3.0
"""Recorded after the last axle has left the hump [s]."""


@dataclass(frozen=True)
class Rig:
    """A kind of vehicle with its sensors: name of its model, body and distance [m] of each sensor, speeds and classes of the study."""

    kind: str
    model: str
    sensors: dict[str, tuple[str, float]]
    validation: dict[str, tuple[str, float]]
    humps: tuple[float, ...]
    cruise: float

    def system(self, values: dict[str, float]) -> System:
        """Return the true vehicle of parameters [SI]."""
        return truck(values) if self.kind == "truck" else sedan(values)


TRUCK = Rig(
    "truck",
    "tractor5",
    {"L1": ("tractor", -0.29), "L2": ("semitrailer", 9.32)},
    {"LT1": ("semitrailer", 5.76), "L1": ("tractor", -0.29), "L2": ("semitrailer", 9.32)},
    (2.0, 3.0),
    3.0,
)
SEDAN = Rig(
    "sedan",
    "sedan2",
    {"M": ("body", 1.34), "F": ("body", 0.53), "R": ("body", 2.61)},
    {"V": ("body", 1.70), "F": ("body", 0.53), "R": ("body", 2.61)},
    (2.5, 1.5),
    10.0,
)
RIGS = {"truck": TRUCK, "sedan": SEDAN}


def hump_run(
    folder: Path,
    name: str,
    rig: Rig,
    values: dict[str, float],
    speed: float,
    seed: int,
    road: RandomRoad | None = None,
    told: float | None = None,
    sensors: Sequence[str] | None = None,
) -> Path:
    """Write the run over the hump and a class A road; returns the run file's path.

    Parameters
    ----------
    seed
        Of the phones' noise, and of the road where none is given.
    told
        The speed that the run file says [m/s] (default: the true one).
    sensors
        Those recorded (default: all of the rig).
    """
    system = rig.system(values)
    length = float(system.offsets[-1])
    road = road or RandomRoad("A", seed, -40.0 - length, 60.0)
    level = road.height
    duration = (HUMP_AT + length + 0.5) / speed + RINGING
    lead = round(SETTLED / DT)
    times = np.arange(-lead, round(duration / DT) + 1) * DT
    chosen = {key: rig.sensors[key] for key in (sensors or rig.sensors)}
    clean = respond(system, lambda s: half_sine(s, HUMP_AT) + level(s), speed, times, chosen)[lead:]
    _write_recording(folder / f"{name}.csv", times[lead:], clean, chosen, seed)
    shape = f"{{shape: half_sine, length: 0.5 m, height: 0.03 m, at: {HUMP_AT} m}}"
    return _write_run(folder, name, rig, told or speed, f"[{{hump: {shape}}}]", chosen)


def cruise_run(folder: Path, name: str, rig: Rig, values: dict[str, float], roughness: str, duration: float, seed: int) -> Path:
    """Write the run over a random road whose profile the model is told; returns the run file's path."""
    system = rig.system(values)
    road = RandomRoad(roughness, seed, 0.0, rig.cruise * duration + 5.0)
    times = np.arange(round(duration / DT) + 1) * DT
    clean = respond(system, road.height, rig.cruise, times, rig.validation)
    _write_recording(folder / f"{name}.csv", times, clean, rig.validation, seed)
    _write_columns(folder / f"{name}_road.csv", "s,h", np.column_stack(road.points))
    return _write_run(folder, name, rig, rig.cruise, f"[{{profile: {{file: {name}_road.csv, distance: s, height: h}}}}]", rig.validation)


def noisy(clean: Array, random: np.random.Generator) -> Array:
    """Return channels `shape (n_samples, n_channels)`, accelerations and pitch rates in turn, with a phone's noise."""
    floors = np.tile(FLOORS, clean.shape[1] // 2)
    sigma = np.hypot(SHARE * np.sqrt(np.mean(clean**2, axis=0)), floors)
    return clean + sigma * random.standard_normal(clean.shape)


def _write_recording(path: Path, times: Array, clean: Array, sensors: dict[str, tuple[str, float]], seed: int) -> None:
    values = noisy(clean, np.random.default_rng([seed, 7]))
    header = ",".join(f"{name}_az,{name}_q" for name in sensors)
    _write_columns(path, f"t,{header}", np.column_stack([times, values]))


def _write_columns(path: Path, header: str, rows: Array) -> None:
    np.savetxt(path, rows, fmt="%.9g", delimiter=",", header=header, comments="", encoding="utf-8")


def _write_run(folder: Path, name: str, rig: Rig, speed: float, road: str, sensors: dict[str, tuple[str, float]]) -> Path:
    behind = {"tractor": "axle1", "semitrailer": "fifth_wheel", "body": "front"}
    lines = [f"vehicle: {rig.model}", f"speed: {speed!r} m/s", f"road: {road}", f"recording: {name}.csv", "sensors:"]
    lines += [
        f"  {key}: {{body: {body}, behind: {behind[body]}, distance: {d} m, channels: {{acceleration: {key}_az, pitch_rate: {key}_q}}}}"
        for key, (body, d) in sensors.items()
    ]
    path = folder / f"{name}.yaml"
    path.write_text("\n".join([*lines, ""]), encoding="utf-8")
    return path
