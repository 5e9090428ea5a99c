"""A run file that uses every key, and its vehicle."""

from __future__ import annotations

from pathlib import Path

from vehgen.simulate.run_file import Run, load_run

GOOD = """\
vehicle: rig.yaml
title: a test
set: soft
parameters: {kF: 1.2 MN/m}
speed: 7.2 km/h
duration: 10 s
step: 2 ms
sample: 10 ms
road:
  - hump: {shape: half_sine, length: 50 cm, height: 30 mm, at: 6 m}
  - hump: {shape: trapezoid, length: 1 m, height: -20 mm, at: 12 m, ramp: 0.3}
  - hump: {shape: rectangle, length: 1 m, height: 20 mm, at: 14 m, radius: 10 mm}
  - hump: {shape: points, file: hump.csv, at: 20 m, height_column: h}
  - iso8608: {class: B, seed: 1}
  - profile: {file: road.csv, distance: s, height: h}
footprint: 0.24 m
forces:
  shaker: {body: frame, x: 0.5 m, harmonic: {amplitude: 2 kN, frequency: 5 Hz, phase: 90 deg}}
  ram: {body: frame, behind: front, distance: 1 m, file: force.csv, time: t, force: F, unit: N}
displacements:
  post: {harmonic: {amplitude: 5 mm, frequency: 3 Hz}}
sensors:
  L1: {body: frame, behind: front, distance: -0.29 m, channels: {acceleration: L1_az, pitch_rate: L1_q}}
  L2: {body: frame, x: b1 - 1 m, channels: {velocity: {column: v2, unit: mm/s, sign: -1}}}
  L3: {body: frame}
outputs:
  travel1: {axle: front, quantity: suspension_travel}
  load1: {axle: rear, quantity: tyre_load}
  post_force: {link: post, quantity: link_force}
recording: measured.csv
"""

RIG = """\
parameters:
  mB: {value: 900 kg}
  kF: {value: 60 kN/m}
  b1: {value: 1.4 m}
  b2: {equals: 2.8 m - b1}
bodies:
  frame: {mass: mB, pitch_inertia: 1200 kg m^2}
axles:
  front: {body: frame, x: b1, mass: 40 kg, suspension: {k: kF, c: 2 kN s/m}, tyre: {k: 200 kN/m}}
  rear: {body: frame, x: -b2, tyre: {k: 100 kN/m}}
links:
  post: {ground: {}, frame: {x: 1 m}, k: 10 kN/m}
sets:
  soft: {kF: 40 kN/m, mB: 800 kg}
"""

SHORT = "vehicle: rig.yaml\nspeed: 2 m/s\n"


def write(folder: Path, text: str) -> Path:
    (folder / "rig.yaml").write_text(RIG)
    (folder / "run.yaml").write_text(text)
    return folder / "run.yaml"


def load(folder: Path, text: str) -> Run:
    return load_run(write(folder, text))
