"""What the jobs read: the phones' recordings of docs/calibrate.md, and recordings of vehicles that are made here from a seed.

Run files say no more than versions since 20f566f understand: nothing of recorders.
"""

from __future__ import annotations

import contextlib
import csv
import io
import re
import shutil
from pathlib import Path

import numpy as np

import vehgen
from vehgen.commands import main as command

ROOT = Path(__file__).parents[2]
SEED = 20231017
NOISE = {"acceleration": 0.01, "pitch_rate": 0.0005}
"""Standard deviation of what the sensors add [m/s^2, rad/s]."""
OFF = 0.05
"""A recorded vehicle's parameters are off those of the file by this share, up or down."""
CROSSINGS = {"low_2": (2.0, 0.03), "high_3": (3.0, 0.05), "high_4": (4.0, 0.05)}
"""Speed [m/s] and height [m] of the hump."""
MANY_CROSSINGS = {
    f"{word}_{speed:g}": (speed, height) for speed in (2.0, 3.0, 4.0, 5.0) for word, height in (("low", 0.03), ("high", 0.05))
}
RUN = """vehicle: {vehicle}
speed: {speed} m/s
duration: {duration} s
recording: {name}.csv
road:
  - hump: {{shape: half_sine, length: 0.5 m, height: {height} m, at: 4 m}}
sensors:
{sensors}"""
SENSORS = {
    "sedan2": "  F: {body: body, behind: front, distance: 0 m, channels: {acceleration: F_az, pitch_rate: F_q}}\n"
    "  R: {body: body, behind: rear, distance: 0 m, channels: {acceleration: R_az, pitch_rate: R_q}}\n",
    "tractor5": "  L1: {body: tractor, behind: axle1, distance: -0.29 m, channels: {acceleration: L1_az, pitch_rate: L1_q}}\n"
    "  L2: {body: semitrailer, behind: fifth_wheel, distance: 9.115 m, channels: {acceleration: L2_az, pitch_rate: L2_q}}\n",
}
DURATIONS = {"sedan2": 6, "tractor5": 13}
"""Of each run [s]."""
LONG = 25
"""Duration of each of MANY_CROSSINGS [s]."""
FRICTION = {
    "sedan2": "  rear: {suspension: {laws: [{dry_friction: {force: 450 N}}]}}\n",
    "tractor5": "  axle1: {suspension: {laws: [{dry_friction: {force: 3 kN}}]}}\n",
}
HUMP = "half_sine,length=0.5,height=0.03"
PHONE_SENSORS = (
    "L1:body=tractor,behind=axle1,distance=-0.29,forward=y",
    "L2:body=semitrailer,behind=fifth_wheel,distance=9.115,forward=x",
)


def write_recordings(
    folder: Path, vehicle: str, friction: bool, crossings: dict[str, tuple[float, float]] = CROSSINGS, duration: float | None = None
) -> None:
    """Write run files and recordings of a bundled vehicle whose parameters are off, with or without friction that the file lacks.

    `crossings` as CROSSINGS; each lasts `duration` [s], or the vehicle's of DURATIONS.
    """
    random = np.random.default_rng(SEED)
    folder.mkdir()
    searched = [(name, item) for name, item in vehgen.load_vehicle(vehicle).parameters.items() if item.range]
    factors = {name: 1 + OFF * random.choice((-1, 1)) for name, _ in searched}
    off = "".join(f"  {name}: {{value: {factors[name]:.2f} * ({item.definition.text})}}\n" for name, item in searched)
    laws = f"axles:\n{FRICTION[vehicle]}" if friction else ""
    truth = folder / "truth.yaml"
    truth.write_text(f"extends: {vehicle}\nname: truth\nparameters:\n{off}{laws}", encoding="utf-8")
    for name, (speed, height) in crossings.items():
        run = folder / f"{name}.yaml"
        lasts = duration or DURATIONS[vehicle]
        text = RUN.format(vehicle=vehicle, speed=speed, duration=lasts, name=name, height=height, sensors=SENSORS[vehicle])
        run.write_text(text, encoding="utf-8")
        response = vehgen.simulate(run, vehicle=truth)
        noise = np.array([NOISE[channel.quantity] for channel in response.channels])
        write_columns(run.with_suffix(".csv"), response, response.values[0] + noise * random.standard_normal(response.values[0].shape))
    truth.unlink()


def write_columns(path: Path, response: vehgen.Response, values: np.ndarray) -> None:
    """Write a recording."""
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["t", *(channel.name for channel in response.channels)])
        writer.writerows([f"{number:.9g}" for number in row] for row in np.column_stack([response.time, values]))


def import_phones(folder: Path) -> None:
    """Write the runs of docs/calibrate.md, less what they say of recorders and of how well speeds are known."""
    shutil.copytree(ROOT / "docs" / "examples" / "phones", folder)
    asked = [part for sensor in PHONE_SENSORS for part in ("--sensor", sensor)]
    for name in ("hump_2ms", "hump_3ms"):
        exports = [str(folder / f"{name}_phone{number}.zip") for number in (1, 2)]
        run = folder / f"{name}.yaml"
        with contextlib.redirect_stdout(io.StringIO()):
            code = command(["import", *exports, "--vehicle", "tractor5", *asked, "--hump", HUMP, "--out", str(run)])
        if code:
            raise SystemExit(f"the phones' recordings of {name} were not imported")
        text = re.sub(r"^uncertainty:.*\n(?:[ ].*\n)*", "", run.read_text(encoding="utf-8"), flags=re.MULTILINE)
        run.write_text(text.replace("acquisition: unknown, ", ""), encoding="utf-8")
