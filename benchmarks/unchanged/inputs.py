"""Vehicles and runs that the recorder writes: every bundled vehicle, every force law, every kind of input."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

HEAVE = ("acceleration", "velocity", "displacement")
PITCH = ("pitch_acceleration", "pitch_rate", "pitch")
ON_SUSPENSION = ("suspension_travel", "suspension_force")
ON_TYRE = ("tyre_force", "tyre_load")
LINK = ("link_travel", "link_force")
BODIES = {
    "b_double": ("prime_mover", "trailer_a", "trailer_b"),
    "quarter_car": ("body",),
    "road_train": ("frame", "cab", "driver", "engine", "trailer_1", "dolly_1", "trailer_2", "dolly_2", "trailer_3"),
    "sedan2": ("body",),
    "tractor5": ("tractor", "semitrailer"),
    "tractor5_cab": ("tractor", "semitrailer", "cab", "driver"),
    "tractor5_cargo": ("tractor", "semitrailer", "cargo"),
    "tractor5_module": ("tractor", "semitrailer", "module"),
    "tractor5_module_paper": ("tractor", "semitrailer", "module"),
    "truck_dolly_trailer": ("truck", "dolly", "trailer"),
    "truck_walking_beam": ("truck", "beam"),
    "vbi2d_2A3": ("tractor", "semitrailer"),
}
"""The bodies of the bundled vehicles; rigs came later and have runs of their own."""
LINKS = {
    "road_train": ("cab_front", "cab_rear", "seat", "engine_front", "engine_rear"),
    "tractor5_cab": ("cab_front", "cab_rear", "seat"),
    "tractor5_module": ("mount",),
    "tractor5_module_paper": ("mount",),
    "truck_walking_beam": ("block",),
}
WITHOUT_PITCH = {("quarter_car", "body"), ("tractor5_module_paper", "module")}
WITHOUT_SUSPENSION = {("truck_walking_beam", "axle2"), ("truck_walking_beam", "axle3")}
ROAD = """road:
  - hump: {shape: half_sine, length: 0.5 m, height: 0.03 m, at: 5 m}
  - iso8608: {class: B, seed: 1}
"""
LAWS = {
    "dry_friction": "dry_friction: {force: 300 N}",
    "elasto_plastic": "elasto_plastic: {force: 300 N, k: 500 kN/m}",
    "cubic_stiffness": "cubic_stiffness: {k3: 1e8 N/m^3}",
    "quadratic_stiffness": "quadratic_stiffness: {k2: 3e5 N/m^2}",
    "progressive_stiffness": "progressive_stiffness: {k: 80 kN/m, start: 4 mm}",
    "bump_stop": "bump_stop: {k: 1 MN/m, clearance: 8 mm, rebound: 12 mm}",
    "bump_stop_unloaded": "bump_stop: {k: 400 kN/m, clearance: 130 mm, from: unloaded}",
    "asymmetric_damping": "asymmetric_damping: {c: 2 kN s/m, ratio: 0.4, blow_off: 0.1 m/s, relief: 0.5}",
    "quadratic_damping": "quadratic_damping: {c2: 2000 N s^2/m^2}",
    "relaxation": "relaxation: {k: 40 kN/m, time: 0.05 s}",
    "hysteresis": "hysteresis: {force: 400 N, travel: 2 mm, beta: 0.7}",
    "own_law": "law: {force: k3*d**3 + c2*v*abs(v), parameters: {k3: 5e7 N/m^3, c2: 500 N s^2/m^2}}",
}
"""One vehicle for each law: the sedan with it in both suspensions."""
COMBINED = """extends: tractor5
name: combined
hinges:
  fifth_wheel: {laws: [{dry_friction: {force: 500 N m}}]}
axles:
  axle1:
    suspension: {laws: [{dry_friction: {force: 3 kN}}, {bump_stop: {k: 2 MN/m, clearance: 30 mm}}]}
    tyre: {laws: [{tyre_liftoff: {}}]}
  axle3: {suspension: {laws: [{elasto_plastic: {force: 2 kN, k: 5 MN/m}}]}, tyre: {laws: [{tyre_liftoff: {}}]}}
  axle5: {suspension: {laws: [{hysteresis: {force: 2 kN, travel: 2 mm}}]}, tyre: {laws: [{tyre_liftoff: {}}]}}
"""
BENDING = """extends: tractor5
name: bending
bodies:
  semitrailer: {bending: {length: 12 m, frequency: 4 Hz, damping_ratio: 0.02}}
"""
RIG = """name: rig
parameters:
  mB: {value: 900 kg}
  kF: {value: 60 kN/m}
  b1: {value: 1.4 m}
  b2: {equals: 2.8 m - b1}
bodies:
  frame: {mass: mB, size: {length: 4 m, height: 0.5 m}}
axles:
  axle1: {body: frame, x: b1, mass: 40 kg, suspension: {k: kF, c: 2 kN s/m}, tyre: {k: 200 kN/m}}
  axle2: {body: frame, x: -b2, tyre: {k: 100 kN/m}}
links:
  post: {ground: {}, frame: {x: 1 m}, k: 10 kN/m, c: 300 N s/m}
sets:
  soft: {kF: 40 kN/m, mB: 800 kg}
"""
SPEED = "t,v\n0,2\n2,2.5\n5,1.5\n9,2\n"
PROFILE = "s,h\n" + "".join(f"{0.5 * i},{0.004 * (i * 7 % 11 - 5) / 5:.4f}\n" for i in range(61))
HUMP = "s,h\n0,0\n0.2,0.02\n0.5,0.025\n0.8,0\n"
FORCE = "t,F\n" + "".join(f"{0.02 * i:.2f},{100 * (i * 5 % 13 - 6)}\n" for i in range(400))
EVERY_INPUT = """vehicle: rig.yaml
set: soft
parameters: {kF: 55 kN/m}
speed: {file: speed.csv, time: t, speed: v}
duration: 8 s
step: 0.5 ms
sample: 5 ms
road:
  - hump: {shape: versine, length: 50 cm, height: 30 mm, at: 1 m}
  - hump: {shape: trapezoid, length: 1 m, height: -20 mm, at: 3 m, ramp: 0.3}
  - hump: {shape: rectangle, length: 1 m, height: 20 mm, at: 5 m, radius: 10 mm}
  - hump: {shape: points, file: hump.csv, at: 8 m, distance: s, height_column: h}
  - profile: {file: road.csv, distance: s, height: h}
footprint: 0.24 m
forces:
  shaker: {body: frame, x: 0.5 m, harmonic: {amplitude: 200 N, frequency: 5 Hz, phase: 90 deg}}
  ram: {body: frame, behind: axle1, distance: 1 m, file: force.csv, time: t, force: F}
displacements:
  post: {harmonic: {amplitude: 5 mm, frequency: 3 Hz}}
"""
PASS = "vehicle: rig.yaml\nspeed: 18 km/h\nroad:\n  - hump: {shape: half_sine, length: 0.5 m, height: 0.03 m, at: 3 m}\n"
HARMONIC_FORCE = """vehicle: tractor5
speed: 1 m/s
duration: 4 s
forces:
  engine: {body: tractor, x: 0.5 m, harmonic: {amplitude: 2 kN, frequency: 25 Hz, phase: 30 deg}}
"""
SURVEY = """vehicle: tractor5
speed: 2 m/s
road:
  - hump: {shape: half_sine, length: 0.5 m, height: 0.03 m, at: 6 m}
sensors:
  L1: {body: tractor, behind: axle1, distance: -0.29 m, channels: {acceleration: L1_az, pitch_rate: L1_q}}
  L2: {body: semitrailer, behind: fifth_wheel, distance: 9.115 m, channels: {acceleration: L2_az, pitch_rate: L2_q}}
"""
"""The run of the advice on sensors and of the sensitivity."""


def channels(model: str, bodies: Sequence[str], axles: Sequence[str], links: Sequence[str]) -> str:
    """Return the part of a run file that asks for every quantity of every body, axle and link."""
    lines = ["sensors:"]
    for body in bodies:
        kinds = HEAVE if (model, body) in WITHOUT_PITCH else HEAVE + PITCH
        columns = ", ".join(f"{kind}: {body}_{kind}" for kind in kinds)
        lines.append(f"  {body}: {{body: {body}, x: {'0 m' if kinds == HEAVE else '0.3 m'}, channels: {{{columns}}}}}")
    lines.append("outputs:")
    for axle in axles:
        kinds = ON_TYRE if (model, axle) in WITHOUT_SUSPENSION else ON_SUSPENSION + ON_TYRE
        lines += [f"  {axle}_{kind}: {{axle: {axle}, quantity: {kind}}}" for kind in kinds]
    lines += [f"  {link}_{kind}: {{link: {link}, quantity: {kind}}}" for link in links for kind in LINK]
    return "\n".join(lines) + "\n"


def write_runs(folder: Path, axles: dict[str, Sequence[str]]) -> list[Path]:
    """Write vehicles, tables and run files into a folder; return the run files.

    Parameters
    ----------
    folder
        An empty folder.
    axles
        The axles of every bundled vehicle.
    """
    files = {"combined.yaml": COMBINED, "bending.yaml": BENDING, "rig.yaml": RIG, "speed.csv": SPEED, "road.csv": PROFILE}
    files |= {"hump.csv": HUMP, "force.csv": FORCE}
    runs = {}
    for model, bodies in BODIES.items():
        asked = channels(model, bodies, axles[model], LINKS.get(model, ()))
        runs[model] = f"vehicle: {model}\nspeed: 10 m/s\nduration: 8 s\n{ROAD}{asked}"
    truck = channels("tractor5", BODIES["tractor5"], axles["tractor5"], ())
    sedan = channels("sedan2", BODIES["sedan2"], axles["sedan2"], ())
    for name, law in LAWS.items():
        suspensions = "".join(f"  {axle}: {{suspension: {{laws: [{{{law}}}]}}}}\n" for axle in axles["sedan2"])
        files[f"with_{name}.yaml"] = f"extends: sedan2\nname: with_{name}\naxles:\n{suspensions}"
        runs[f"law {name}"] = f"vehicle: with_{name}.yaml\nspeed: 4 m/s\nduration: 5 s\n{ROAD}{sedan}"
    for name in ("combined", "bending"):
        runs[name] = f"vehicle: {name}.yaml\nspeed: 5 m/s\nduration: 6 s\n{ROAD}{truck}"
    rig = channels("rig", ("frame",), ("axle1",), ("post",)) + "  axle2_load: {axle: axle2, quantity: tyre_load}\n"
    runs |= {"every input": EVERY_INPUT + rig, "end of the run found": PASS + rig, "harmonic force": HARMONIC_FORCE + truck}
    for file, text in files.items():
        (folder / file).write_text(text, encoding="utf-8")
    written = []
    for name, text in runs.items():
        written.append(folder / f"run {name}.yaml")
        written[-1].write_text(text, encoding="utf-8")
    return written
