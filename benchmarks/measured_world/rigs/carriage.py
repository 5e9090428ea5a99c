"""A carriage on a rail that nothing holds, pushed by a measured force: a servo that follows a course, or a shaker."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.measured_world.rigs import signals
from benchmarks.measured_world.rigs.cases import Channel, Rig, Run, uncertain
from benchmarks.measured_world.rigs.mechanism import Joint, Mechanism, Motion
from benchmarks.measured_world.rigs.recorder import BEFORE, draw_chain, draw_recorder
from benchmarks.measured_world.rigs.signals import Signal

Array = NDArray[np.float64]
PLACES = ("rail",)
OPTIONS = ("dry_friction", "directional_friction", "quadratic_damping", "hidden_spring", "nothing", "nothing")
"""What may be hidden in the rail."""
SENSORS = {
    "encoder": ("displacement", "m", (0.002, 0.0, 0.0, 2e-6, 2e-6)),
    "tachometer": ("velocity", "m/s", (0.01, 2e-3, 1e-3, 1e-3, 3e-4)),
    "accelerometer": ("acceleration", "m/s^2", (0.01, 0.02, 0.5e-3, 0.01, 0.004)),
}


def draw(name: str, rng: np.random.Generator) -> Rig:
    """Return a carriage, what it is made to do and what measures it, with nothing hidden."""
    spread = float(rng.uniform(0.15, 0.30))
    mass = float(np.exp(rng.uniform(np.log(15.0), np.log(200.0))))
    quantities = {
        "M": uncertain(mass, spread, "kg", "mass that moves", rng),
        "c": uncertain(mass / float(rng.uniform(0.3, 1.2)), spread, "N s/m", "viscous friction", rng),
    }
    servo = bool(rng.random() < 0.6)
    size = mass * float(rng.uniform(1.0, 3.0))
    numbers = {"servo": float(servo), "size": size, "bandwidth": float(rng.uniform(15.0, 40.0))}
    chain = draw_chain(0.03, 0.02 * size, 5e-3, 0.004 * size, 0.001 * size, rng)
    inputs = (Channel("F", "push", "", "force", "N", chain),)
    label = str(rng.choice(list(SENSORS)))
    quantity, unit, errors = SENSORS[label]
    channels = [Channel(quantity, quantity, f"{label}: {{body: carriage", quantity, unit, draw_chain(*errors, rng))]
    if label != "encoder" and rng.random() < 0.5:
        quantity, unit, errors = SENSORS["encoder"]
        channels.append(Channel(quantity, quantity, "encoder: {body: carriage", quantity, unit, draw_chain(*errors, rng)))
    recorder = draw_recorder((100.0, 200.0, 250.0), rng)
    runs = tuple(_run(number, rng) for number in range(int(rng.integers(3, 5))))
    return Rig(name, "carriage", quantities, numbers, inputs, tuple(channels), recorder, runs, int(rng.integers(2**31)))


def _run(number: int, rng: np.random.Generator) -> Run:
    plan = {"low": float(rng.uniform(0.2, 0.5)), "high": float(rng.uniform(3.0, 10.0)), "scale": float(rng.uniform(0.4, 1.0))}
    return Run(f"run_{number + 1}", "push", float(rng.uniform(8.0, 12.0)) + 2.0 * BEFORE, plan, seed=int(rng.integers(2**31)))


def drive(rig: Rig, run: Run) -> dict[str, Signal]:
    """Return the true force: a shaker's own, or what a servo needed to let the true carriage follow its course."""
    plan, rng = run.plan, np.random.default_rng([run.seed, 1])
    size = rig.numbers["size"] * plan["scale"]
    if not rig.numbers["servo"]:
        return {"push": signals.sampled(signals.random(run.duration, size, plan["low"], plan["high"], 0.5, rng))}
    pace = 2.0 * np.pi * plan["low"]
    course = signals.sampled(signals.random(run.duration, size / rig.true("M") / (2.0 * pace**2), plan["low"], 8.0 * plan["low"], 2.0, rng))
    found = _mechanism(rig, _servo(rig, course)).run([0.0], [0.0], run.duration)
    pushed = _servo(rig, course)(found.t, found.q, found.v)[0]
    more = np.repeat(pushed[-1:], len(signals.moments(run.duration)) - len(pushed))
    return {"push": signals.sampled(np.concatenate([pushed, more]))}


def _servo(rig: Rig, course: Signal) -> Any:
    """Return the force that follows a course: proportional to how far the carriage is behind, and how much too slow."""
    pace, mass = rig.numbers["bandwidth"], rig.quantities["M"].stated

    def force(t: Any, q: Array, v: Array) -> Array:
        return mass * (pace**2 * (course.value(t) - q) + 1.4 * pace * (course.rate(t) - v))

    return force


def _mechanism(rig: Rig, push: Any) -> Mechanism:
    return Mechanism([rig.true("M")], [Joint((-1.0,), 0.0, rig.true("c"), **rig.law_at("rail"))], push)


def respond(rig: Rig, run: Run, driven_by: dict[str, Signal]) -> tuple[dict[str, Array], Motion]:
    """Return the motions that sensors may read, at RATE, and the whole motion."""
    push = driven_by["push"]

    def force(t: Any, q: Array, v: Array) -> Array:
        return push.value(t) + np.zeros_like(q)

    found = _mechanism(rig, force).run([0.0], [0.0], run.duration)
    return {"push": push.value(found.t), "displacement": found.q[0], "velocity": found.v[0], "acceleration": found.a[0]}, found
