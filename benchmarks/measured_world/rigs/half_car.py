"""Half cars that are dropped, or released from a lift or a tilt: body with bounce and pitch, two axles, tyres that cannot pull."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from benchmarks.measured_world.rigs.cases import Channel, Quantity, Rig, Run, uncertain, weighed
from benchmarks.measured_world.rigs.mechanism import Joint, Mechanism, Motion
from benchmarks.measured_world.rigs.recorder import BEFORE, draw_chain, draw_recorder
from benchmarks.measured_world.rigs.signals import Signal

Array = NDArray[np.float64]
GRAVITY = 9.81
ENDS = ("front", "rear")
PLACES = ENDS
OPTIONS = (
    "dry_friction", "dry_friction in both", "bump_stop", "asymmetric_damping", "cubic_stiffness", "progressive_stiffness",
    "quadratic_damping", "nothing", "nothing",
)  # fmt: skip
"""What may be hidden in a suspension."""
TRIGGER = 4e-3
"""How much too early or late a recording may begin [s]."""


def draw(name: str, rng: np.random.Generator) -> Rig:
    """Return a half car, its drops and its sensors, with nothing hidden."""
    spread = float(rng.uniform(0.15, 0.30))
    quantities = _quantities(spread, rng)
    numbers = {"front": float(np.round(rng.uniform(1.0, 1.4), 2)), "rear": -float(np.round(rng.uniform(1.1, 1.6), 2))}
    recorder = draw_recorder((200.0, 250.0, 500.0), rng)
    runs = tuple(_run(kind, number, rng) for number, kind in enumerate(_kinds(rng)))
    return Rig(name, "half_car", quantities, numbers, (), _channels(numbers, rng), recorder, runs, int(rng.integers(2**31)))


def _quantities(spread: float, rng: np.random.Generator) -> dict[str, Quantity]:
    body = float(rng.uniform(300.0, 900.0))
    corner = 0.5 * body
    found = {
        "mB": weighed(body, 0.005, "kg", "sprung mass, weighed", rng),
        "IB": uncertain(body * float(rng.uniform(1.2, 1.9)), spread, "kg m^2", "pitch inertia, estimated", rng),
    }
    tyre = float(rng.uniform(150e3, 250e3))
    for i, end in enumerate(ENDS, start=1):
        stiffness = corner * (2.0 * math.pi * float(rng.uniform(1.1, 1.7))) ** 2
        damping = 2.0 * float(rng.uniform(0.15, 0.4)) * math.sqrt(stiffness * corner)
        found |= {
            f"m{i}": uncertain(float(rng.uniform(30.0, 60.0)), 0.1, "kg", f"{end} unsprung mass", rng),
            f"k{i}": uncertain(stiffness, spread, "N/m", f"stiffness of the {end} suspension", rng),
            f"c{i}": uncertain(damping, spread, "N s/m", f"damping of the {end} suspension", rng),
            f"kt{i}": uncertain(tyre, 0.15, "N/m", f"stiffness of the {end} tyre", rng),
        }
    return found


def _kinds(rng: np.random.Generator) -> list[str]:
    """Return three drops, all from the same kind of hold, and up to two releases more."""
    hold = str(rng.choice(["drop", "hung"]))
    more = rng.choice([hold, "lift", "tilt"], int(rng.integers(0, 3)))
    return [hold] * 3 + [str(kind) for kind in more]


def _run(kind: str, number: int, rng: np.random.Generator) -> Run:
    """Return a release: how high [m] and how tilted [deg] the car is, and how wrong a ruler and an inclinometer are about it."""
    height = float(np.exp(rng.uniform(math.log(0.005), math.log(0.08))))
    tilt = float(rng.uniform(-1.5, 1.5)) if kind == "tilt" or (kind == "drop" and rng.random() < 0.3) else 0.0
    if kind in ("lift", "tilt"):
        height = float(rng.uniform(0.015, 0.06)) if kind == "lift" else float(rng.uniform(-0.01, 0.03))
    elif kind == "drop":
        height += 1.5 * abs(math.radians(tilt))
    errors = {"displacement": float(rng.normal(0.0, 4e-4)), "pitch": float(rng.normal(0.0, 0.02))}
    late = float(rng.uniform(-TRIGGER, TRIGGER))
    plan = {"displacement": height, "pitch": tilt}
    return Run(f"{kind}_{number + 1}", kind, float(rng.uniform(3.0, 4.0)) + 2.0 * BEFORE, plan, errors, late, int(rng.integers(2**31)))


def _channels(numbers: dict[str, float], rng: np.random.Generator) -> tuple[Channel, ...]:
    """Return the sensors: accelerometers on the body, and on the axles, or travels, or scales beneath the tyres, or a gyroscope."""

    def body(label: str, x: float) -> Channel:
        chain = draw_chain(0.01, 0.02, 0.5e-3, 0.02, 0.005, rng)
        return Channel(f"{label}_az", f"az {x!r}", f"{label}: {{body: car, x: {x:g} m", "acceleration", "m/s^2", chain)

    front, rear = round(numbers["front"] - 0.1, 2), round(numbers["rear"] + 0.15, 2)
    found = [body("front_mount", front), body("rear_mount", rear)]
    more = str(rng.choice(["nothing", "axles", "travels", "scales", "gyroscope"]))
    if more == "gyroscope":
        chain = draw_chain(0.01, 0.002, 2e-3, 1e-3, 2e-4, rng)
        return (found[0], Channel("q", "pitch_rate", "gyroscope: {body: car", "pitch_rate", "rad/s", chain))
    sensors = {
        "axles": ("hub", "acceleration", "m/s^2", (0.01, 0.05, 0.5e-3, 0.06, 0.02)),
        "travels": ("pot", "suspension_travel", "m", (0.01, 1e-3, 2e-3, 6e-5, 3e-5)),
        "scales": ("scale", "tyre_load", "N", (0.01, 5.0, 2e-3, 5.0, 2.0)),
    }
    if more in sensors:
        label, quantity, unit, errors = sensors[more]
        for end in ENDS:
            sensor = f"{end}_{label}: {{axle: {end}"
            found.append(Channel(f"{label}_{end}", f"{quantity} {end}", sensor, quantity, unit, draw_chain(*errors, rng)))
    return tuple(found)


def static_loads(rig: Rig) -> tuple[float, float]:
    """Return what the front and rear tyre carry at rest [N]."""
    front, rear = rig.numbers["front"], -rig.numbers["rear"]
    weight = rig.true("mB") * GRAVITY
    return (
        weight * rear / (front + rear) + rig.true("m1") * GRAVITY,
        weight * front / (front + rear) + rig.true("m2") * GRAVITY,
    )


def mechanism(rig: Rig) -> Mechanism:
    """Return the half car: heave, pitch (nose-down), front and rear axle, from static equilibrium."""
    loads = static_loads(rig)
    places = [rig.numbers[end] for end in ENDS]
    rows = ((-1.0, places[0], 1.0, 0.0), (-1.0, places[1], 0.0, 1.0))
    joints = [
        Joint(row, rig.true(f"k{i}"), rig.true(f"c{i}"), **rig.law_at(end)) for i, (end, row) in enumerate(zip(ENDS, rows, strict=True), 1)
    ]

    def push(t: Any, q: Array, v: Array) -> Array:
        found = np.zeros_like(q)
        for i in (0, 1):
            found[2 + i] = tyre_force(rig, i, q[2 + i], loads[i])
        return found

    return Mechanism([rig.true(name) for name in ("mB", "IB", "m1", "m2")], joints, push)


def tyre_force(rig: Rig, i: int, height: Any, load: float) -> Any:
    """Return what a tyre pushes its axle up with beyond its load at rest [N]: the whole is never negative."""
    return np.maximum(-rig.true(f"kt{i + 1}") * height, -load)


def initial(rig: Rig, run: Run) -> list[float]:
    """Return the coordinates as a run begins.

    `drop`: held with the springs as they stand loaded, `hung`: hung up by the body; no tyre is nearer to the floor than the plan says.
    Otherwise on its wheels, which are in equilibrium below the lifted body.
    """
    height, pitch = run.plan["displacement"], math.radians(run.plan["pitch"])
    if run.kind in ("drop", "hung"):
        height += max(load / rig.true(f"kt{i}") for i, load in enumerate(static_loads(rig), start=1))
    places, loads, joints = [rig.numbers[end] for end in ENDS], static_loads(rig), mechanism(rig).joints
    if run.kind == "hung":
        corners = [height - _travel_at(joint, -load) for joint, load in zip(joints, loads, strict=True)]
        pitch = (corners[1] - corners[0]) / (places[0] - places[1])
        return [corners[0] + places[0] * pitch, pitch, height, height]
    corners = [height - place * pitch for place in places]
    if run.kind == "drop":
        return [height, pitch, *corners]
    return [height, pitch, *(_standing(rig, i, joint, corners[i]) for i, joint in enumerate(joints))]


def _travel_at(joint: Joint, force: float) -> float:
    """Return the travel at which a joint at rest has a force [N]."""
    none = np.zeros(())
    return float(brentq(lambda d: float(joint.force(np.asarray(d), none, none)) - force, -1.0, 1.0))


def _standing(rig: Rig, i: int, joint: Joint, corner: float) -> float:
    """Return the height of an axle in equilibrium between its tyre and a body whose corner is displaced."""
    none, load = np.zeros(()), static_loads(rig)[i]
    return float(brentq(lambda u: float(tyre_force(rig, i, u, load) - joint.force(np.asarray(u - corner), none, none)), -0.3, 0.3))


def drive(rig: Rig, run: Run) -> dict[str, Signal]:
    """Return what drives a run: nothing."""
    return {}


def respond(rig: Rig, run: Run, driven_by: dict[str, Signal]) -> tuple[dict[str, Array], Motion]:
    """Return the motions that sensors may read, at RATE, and the whole motion."""
    found = mechanism(rig).run(initial(rig, run), [0.0] * 4, run.duration)
    motions = {"pitch_rate": found.v[1]}
    for channel in rig.channels:
        if channel.motion.startswith("az "):
            motions[channel.motion] = found.a[0] - float(channel.motion[3:]) * found.a[1]
    for i, (end, load) in enumerate(zip(ENDS, static_loads(rig), strict=True)):
        motions |= {
            f"acceleration {end}": found.a[2 + i],
            f"suspension_travel {end}": found.travel[i],
            f"tyre_load {end}": tyre_force(rig, i, found.q[2 + i], load) + load,
        }
    return motions, found
