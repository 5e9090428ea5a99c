"""A damper, or a strut with its spring, between an actuator that moves and a load cell that holds it."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.measured_world.rigs import signals
from benchmarks.measured_world.rigs.cases import Channel, Rig, Run, uncertain, weighed
from benchmarks.measured_world.rigs.mechanism import Joint, Mechanism, Motion
from benchmarks.measured_world.rigs.recorder import BEFORE, draw_chain, draw_recorder
from benchmarks.measured_world.rigs.signals import Signal

Array = NDArray[np.float64]
PLACES = ("damper",)
OPTIONS = ("dry_friction", "hysteresis", "asymmetric_damping", "damper_mount", "free_play", "nothing", "nothing")
"""What may be hidden in the damper."""
CELL = 3e3
"""Damping of a load cell and its frame [N s/m]."""


def draw(name: str, rng: np.random.Generator) -> Rig:
    """Return a damper with or without a spring, how it is moved, and what measures it, with nothing hidden."""
    spread = float(rng.uniform(0.15, 0.30))
    quantities = {
        "mB": weighed(float(rng.uniform(4.0, 10.0)), 0.01, "kg", "crosshead between damper and load cell", rng),
        "c": uncertain(float(rng.uniform(1e3, 4e3)), spread, "N s/m", "damping", rng),
        "kL": weighed(float(rng.uniform(15e6, 25e6)), 0.02, "N/m", "stiffness of the load cell, by its data sheet", rng),
    }
    if rng.random() < 0.4:
        quantities["k"] = uncertain(float(rng.uniform(15e3, 40e3)), spread, "N/m", "stiffness of the spring", rng)
    inputs = (Channel("x", "stroke", "", "displacement", "m", draw_chain(0.03, 5e-4, 4e-3, 1.5e-6, 1e-6, rng)),)
    sign = int(rng.choice([-1, 1]))
    chain = draw_chain(0.015, 8.0, 1e-3, 1.5, 0.6, rng)
    channels = (Channel("F", "cell", "load_cell: {link: load_cell", "link_force", "N", chain, sign),)
    recorder = draw_recorder((250.0, 500.0), rng)
    kinds = ["sine", *rng.permutation(["sine", "sweep", "random"]).tolist()[: int(rng.integers(2, 4))]]
    runs = tuple(_run(str(kind), number, rng) for number, kind in enumerate(kinds))
    return Rig(name, "dyno", quantities, {}, inputs, channels, recorder, runs, int(rng.integers(2**31)))


def _run(kind: str, number: int, rng: np.random.Generator) -> Run:
    """Return a test; its plan holds the amplitude [m] and frequency [Hz], or the speed [m/s] and largest travel, or the rms [m]."""
    if kind == "sine":
        frequency = float(np.exp(rng.uniform(np.log(0.6), np.log(4.0))))
        plan = {"frequency": frequency, "amplitude": min(0.04, float(rng.uniform(0.06, 0.6)) / (2.0 * np.pi * frequency))}
    elif kind == "sweep":
        plan = {"speed": float(rng.uniform(0.15, 0.5)), "most": float(rng.uniform(0.01, 0.03)), "high": float(rng.uniform(8.0, 15.0))}
    else:
        plan = {"rms": float(rng.uniform(0.003, 0.01)), "high": float(rng.uniform(6.0, 12.0))}
    duration = float(rng.uniform(5.0, 8.0)) + 2.0 * BEFORE
    return Run(f"{kind}_{number + 1}", kind, duration, plan, seed=int(rng.integers(2**31)))


def drive(rig: Rig, run: Run) -> dict[str, Signal]:
    """Return the actuator's true stroke."""
    plan = run.plan
    if run.kind == "sine":
        values = signals.sinusoid(run.duration, plan["amplitude"], plan["frequency"])
    elif run.kind == "sweep":
        values = signals.sweep(run.duration, plan["speed"], 0.5, plan["high"], plan["most"])
    else:
        values = signals.random(run.duration, plan["rms"], 0.4, plan["high"], 1.5, np.random.default_rng([run.seed, 1]))
    return {"stroke": signals.sampled(values)}


def mechanism(rig: Rig, stroke: Signal) -> Mechanism:
    """Return the crosshead between the damper, compressed as the actuator rises, and the load cell."""
    stiffness = rig.quantities["k"].true if "k" in rig.quantities else 0.0
    damper = Joint((-1.0,), stiffness, rig.true("c"), base=stroke, **rig.law_at("damper"))
    cell = Joint((-1.0,), rig.true("kL"), CELL)

    def push(t: Any, q: Array, v: Array) -> Array:
        return np.zeros_like(q)

    return Mechanism([rig.true("mB")], [damper, cell], push)


def respond(rig: Rig, run: Run, driven_by: dict[str, Signal]) -> tuple[dict[str, Array], Motion]:
    """Return the motions that sensors may read, at RATE, and the whole motion; the cell reads a push upwards as positive."""
    stroke = driven_by["stroke"]
    found = mechanism(rig, stroke).run([0.0], [0.0], run.duration)
    return {"stroke": stroke.value(found.t), "cell": -found.force[1]}, found
