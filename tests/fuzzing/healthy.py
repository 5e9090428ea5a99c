"""Healthy files of every format, taken from models/ and from what docs/ shows: fuzzing starts from these."""

from __future__ import annotations

import io
import math
import zipfile
from dataclasses import replace
from functools import cache, reduce
from operator import xor
from pathlib import Path

from tests.fuzzing.cases import Case

ROOT = Path(__file__).parents[2]

LAWS = """\
name: lawful
title: A truck with laws, a walking beam, a bending body and a box
parameters:
  mB: {value: 6 t, range: [4 t, 8 t], meaning: sprung mass}
  a: {value: 2.1 m, range: [1.6 m, 2.4 m]}
  b: {equals: 3.8 m - a}
  kf: {value: 300 kN/m, range: [100 kN/m, 600 kN/m]}
bodies:
  body: {mass: mB, pitch_inertia: 20 t m^2, bending: {length: 6 m, frequency: 9 Hz, damping_ratio: 0.02}}
  beam: {mass: 300 kg, pitch_inertia: 60 kg m^2, title: walking beam}
  box: {mass: 500 kg, size: {length: 2 m, height: 1 m}, motions: [], carried_by: {body: body, x: -1 m, z: 0.8 m}}
hinges:
  pivot: {body: {x: -b, z: -0.3 m}, beam: {x: 0 m, z: 0.1 m}, k: 1 kN m/rad, c: 10 N m s/rad}
axles:
  front:
    body: body
    x: a
    mass: 400 kg
    suspension: {k: kf, c: 12 kN s/m, laws: [{dry_friction: {force: 3 kN}}, {bump_stop: {k: 2 MN/m, clearance: 60 mm, from: unloaded}}]}
    tyre: {k: 1.6 MN/m, laws: [{tyre_liftoff: {}}]}
  middle: {body: beam, x: 0.6 m, tyre: {k: 3 MN/m, laws: [{law: {force: k3*d**3, parameters: {k3: 5e7 N/m^3}}}]}}
  rear: {body: beam, x: -0.6 m, tyre: {k: 3 MN/m, c: 2 kN s/m}, title: last axle}
links:
  seat: {body: {x: 1 m}, box: {x: 0 m}, k: 10 kN/m, c: 100 N s/m}
sets:
  light: {mB: 5 t}
"""

RUN = """\
vehicle: my_truck.yaml
title: everything that a run may say
parameters: {kf: 310 kN/m}
speed: 2 m/s
duration: 4 s
step: 1 ms
sample: 10 ms
road:
  - hump: {shape: half_sine, length: 0.5 m, height: 0.03 m, at: 2 m}
footprint: 0.24 m
forces:
  shaker: {body: body, x: 0.5 m, harmonic: {amplitude: 2 kN, frequency: 5 Hz, phase: 90 deg}}
  ram: {body: body, behind: front, distance: 1 m, file: force.csv, time: t, force: F, unit: N, noise: 5 N}
sensors:
  L1:
    body: body
    behind: front
    distance: -0.29 m
    channels: {acceleration: L1_az, pitch_rate: {column: L1_q, unit: deg/s, sign: -1, noise: 0.1 deg/s}}
    acquisition: {filter: butterworth, order: 4, cut_off: 45 Hz, delay: 5 ms, range: 100 m/s^2, rate: 200 Hz}
acquisition: unknown
recording: recording.csv
band: [0.5 Hz, 40 Hz]
outputs:
  travel1: {axle: front, quantity: suspension_travel}
  load1: {axle: rear, quantity: tyre_force}
"""

ROADS = (
    "  - hump: {shape: trapezoid, length: 0.9 m, height: 20 mm, ramp: 0.3, at: 3 m}\n",
    "  - hump: {shape: rectangle, length: 0.4 m, height: 20 mm, radius: 0.05 m, at: 4.5 m}\n  - iso8608: {class: B, seed: 1}\n",
    "  - hump: {shape: points, file: points.csv, distance: s, height_column: h, at: 5 m}\n"
    "  - profile: {file: road.csv, distance: s, height: h}\n",
)

FACTS = """\
kerb_mass: {value: 62.6 t, uncertainty: 0.3 t}
axle_weights: {axle1: {value: 104 kN, uncertainty: 0.5 kN}}
uncoupled: {tractor: {axle1: {value: 55 kN, uncertainty: 0.5 kN}}}
parameters: {a1: {value: 1.0 m, uncertainty: 2 cm}}
"""

EFFECTS = """\
effects:
  soft_damper:
    title: Damper with a soft centre
    meaning: a damper whose valves close as it moves faster
    signature: damping that grows with the hump's height and the speed
    attaches: suspension
    force: c3*v^3 + k3*d^3
    parameters:
      c3: {unit: N s^3/m^3, low: 0.01, high: 100, starts: [0.3, 3], times: c/(0.1 m/s)^2, meaning: cubic damping}
      k3: {unit: N/m^3, low: 1e4, high: 1e9, starts: [1e7], meaning: cubic stiffness}
  symmetric_stop:
    title: Stops of equal clearance
    meaning: bump and rebound stops that are met after the same travel
    attaches: suspension
    law: {bump_stop: {k: 2 * k, clearance: gap, rebound: gap}}
    parameters:
      k: {unit: N/m, low: 0.25, high: 15, starts: [3], times: k, meaning: half the stiffness of the stops}
      gap: {unit: mm, low: 1, high: 60, starts: [8, 15, 25], meaning: clearance}
"""


def table(names: str, rows: int, step: float, columns: int) -> bytes:
    """Return a CSV file: an even first column, and harmonics."""
    lines = [names]
    for i in range(rows):
        values = (0.01 * math.sin(0.07 * (k + 1) * i + k) for k in range(columns))
        lines.append(",".join([f"{i * step:.6g}", *(f"{value:.6g}" for value in values)]))
    return ("\n".join(lines) + "\n").encode()


def read(name: str) -> bytes:
    """Return a file of the repository."""
    return (ROOT / name).read_bytes()


def shortened(name: str, rows: int) -> bytes:
    """Return a phone export of docs/examples with the first lines of each of its files only."""
    data = io.BytesIO()
    with zipfile.ZipFile(ROOT / name) as source, zipfile.ZipFile(data, "w", zipfile.ZIP_DEFLATED) as archive:
        for entry in source.namelist():
            archive.writestr(zipfile.ZipInfo(entry), b"\n".join(source.read(entry).splitlines()[:rows]) + b"\n")
    return data.getvalue()


TABLES = {
    "recording.csv": table("t,L1_az,L1_q", 401, 0.01, 2),
    "road.csv": table("s,h", 300, 0.05, 1),
    "points.csv": table("s,h", 9, 0.1, 1),
    "force.csv": table("t,F", 500, 0.01, 1),
    "speed.csv": b"t,v\n0,2\n2,2.2\n5,2.1\n",
}


def dialect(data: bytes) -> bytes:
    """Return a CSV table with semicolons and decimal commas, and a row of units where its columns are a distance and a height."""
    text = data.decode().replace(",", ";").replace(".", ",")
    return text.replace("s;h\n", "s;h\nm;mm\n", 1).encode()


def gpx() -> bytes:
    """Return a track of six points, a second apart, at 2 m/s."""
    points = (f'<trkpt lat="48.0" lon="11.0"><time>2024-05-01T12:00:0{i}Z</time><speed>2.0</speed></trkpt>\n' for i in range(6))
    return f'<?xml version="1.0"?>\n<gpx version="1.0"><trk><trkseg>\n{"".join(points)}</trkseg></trk></gpx>\n'.encode()


def nmea() -> bytes:
    """Return a log of six fixes, a second apart, at four knots."""
    bodies = (f"GPRMC,12000{i}.00,A,4807.038,N,01131.000,E,4.0,084.4,010524,," for i in range(6))
    return "".join(f"${body}*{reduce(xor, body.encode()):02X}\r\n" for body in bodies).encode()


def tables(run: Case, history: str) -> tuple[Case, ...]:
    """Return runs with a speed history whose tables are of several formats."""
    plain = replace(run.with_text(history, ()), format="table")
    others = {name: dialect(data) for name, data in TABLES.items()}
    found = [plain, replace(plain, files={**plain.files, **others})]
    for name, data in (("drive.gpx", gpx()), ("drive.nmea", nmea())):
        text = history.replace("{file: speed.csv, time: t, speed: v}", f"{{file: {name}, start: 0.5 s}}")
        track = run.with_text(text, ())
        found.append(replace(track, format="table", files={**track.files, name: data}))
    return tuple(found)


@cache
def healthy() -> dict[str, tuple[Case, ...]]:
    """Return healthy cases by format."""
    truck = {"my_truck.yaml": read("docs/examples/my_truck.yaml")}
    names = ("quarter_car", "sedan2", "tractor5", "tractor5_cab", "truck_walking_beam")
    vehicles = [Case("vehicle", {f"{name}.yaml": read(f"models/{name}.yaml")}, f"{name}.yaml") for name in names]
    vehicles += [Case("vehicle", {"lawful.yaml": LAWS.encode()}, "lawful.yaml"), Case("vehicle", truck, "my_truck.yaml")]
    vehicles.append(
        Case(
            "vehicle",
            {
                **truck,
                "longer.yaml": b"extends: my_truck.yaml\nname: longer\nparameters: {a: null, b: {value: 1.6 m}}\n"
                b"axles: {front: {x: 2.2 m}}\n",
            },
            "longer.yaml",
        )
    )
    run = Case("run", {**truck, **TABLES, "run.yaml": RUN.encode()}, "run.yaml")
    hump = RUN[RUN.index("  - hump") : RUN.index("footprint")]
    history = RUN.replace("speed: 2 m/s", "speed: {file: speed.csv, time: t, speed: v}").replace(hump, ROADS[2])
    rig = (
        b"vehicle: silverbox.yaml\nduration: 2 s\ndisplacements:\n  spring: {harmonic: {amplitude: 5 mm, frequency: 3 Hz}}\n"
        b"sensors:\n  S: {body: block, channels: {displacement: y}}\n"
    )
    runs = [run, *(run.with_text(RUN.replace(hump, road), ()) for road in ROADS), run.with_text(history, ())]
    runs.append(
        run.with_text(
            "vehicle: sedan2.yaml\nspeed: 36 km/h\nroad:\n- hump: "
            "{shape: versine, length: 2 m, height: 5 cm, at: 3 m}\nsensors: {F: {body: body, channels: {acceleration: F_az}}}\n",
            (),
        )
    )
    runs.append(Case("run", {"silverbox.yaml": read("docs/examples/silverbox/silverbox.yaml"), "rig.yaml": rig}, "rig.yaml"))
    cargoes = [Case("cargo", {name: read(f"docs/examples/cargo/{name}")}, name) for name in ("pallets.yaml", "building_module.yaml")]
    frame = read("docs/examples/cargo/steel_module.yaml").replace(b"{size: 0.2 m}", b"{size: 0.7 m}")
    exports = [
        Case("export", {f"phone{i}.zip": shortened(f"docs/examples/phones/hump_2ms_phone{i}.zip", 300)}, f"phone{i}.zip") for i in (1, 2)
    ]
    return {
        "vehicle": tuple(vehicles),
        "run": tuple(runs),
        "cargo": tuple(cargoes),
        "frame": (Case("frame", {"frame.yaml": frame}, "frame.yaml"),),
        "facts": (Case("facts", {"facts.yaml": FACTS.encode()}, "facts.yaml"),),
        "effects": (Case("effects", {"effects.yaml": EFFECTS.encode()}, "effects.yaml"),),
        "table": tables(run, history),
        "export": tuple(exports),
    }
