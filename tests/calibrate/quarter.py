"""A quarter car that carries known loads: what recordings tell of its masses."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from vehgen.fit.problem import Problem, make_problem
from vehgen.fit.trial import load_trials

QUARTER = """name: quarter
parameters:
  mB: {value: 400 kg, range: [200 kg, 800 kg]}
  mL: {value: 0 kg, meaning: load}
  mG: {value: 40 kg, range: [20 kg, 80 kg]}
  kS: {value: 20 kN/m, range: [10 kN/m, 40 kN/m]}
  cS: {value: 1.5 kN s/m, range: [0.5 kN s/m, 4 kN s/m]}
  kT: {value: 180 kN/m, range: [90 kN/m, 360 kN/m]}
bodies: {body: {mass: mB + mL, motions: [heave]}}
axles: {axle1: {body: body, mass: mG, suspension: {k: kS, c: cS}, tyre: {k: kT}}}
"""
KNOWN_BODY = QUARTER.replace("400 kg, range: [200 kg, 800 kg]", "400 kg")
"""The same, its body's mass without a range."""


def quarter_problem(folder: Path, loads: Sequence[float], vehicle: str = QUARTER) -> Problem:
    """Return the problem of a run with each load [kg], its recordings nothing but noise."""
    (folder / "quarter.yaml").write_text(vehicle, encoding="utf-8")
    table = np.column_stack([np.arange(800) * 0.01, np.random.default_rng(0).standard_normal(800)])
    np.savetxt(folder / "noise.csv", table, delimiter=",", header="t,az", comments="")
    runs = [folder / f"run{number}.yaml" for number in range(len(loads))]
    for run, load in zip(runs, loads, strict=True):
        run.write_text(
            f"vehicle: quarter.yaml\nspeed: 3 m/s\nparameters: {{mL: {load} kg}}\nrecording: noise.csv\n"
            "road: [{hump: {shape: half_sine, length: 0.5 m, height: 0.03 m, at: 4 m}}]\n"
            "sensors: {B: {body: body, channels: {acceleration: az}}}\n",
            encoding="utf-8",
        )
    return make_problem(load_trials(runs))
