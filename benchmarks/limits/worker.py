"""Times kernels of the vehgen that is found first on the path, and prints nanoseconds per step and individual by name as JSON.

A script of its own, so that another checkout can be timed: it says no more than versions since 20f566f understand.
"""

from __future__ import annotations

import json
import time

import numpy as np

from vehgen import codegen
from vehgen.mechanics import Place, PointOutput, derive
from vehgen.road import ConstantSpeed, Hump, Track, wheel_inputs
from vehgen.simulate.benchmark import benchmark_model, population
from vehgen.vehicle import load_vehicle

N, STEPS, DT, KEEP, ROUNDS = 304, 5000, 1e-3, 10, 5
VEHICLES = (
    "quarter_car",
    "sedan2",
    "truck_walking_beam",
    "tractor5",
    "vbi2d_2A3",
    "tractor5_module",
    "tractor5_cab",
    "truck_dolly_trailer",
    "b_double",
    "road_train",
)
FRICTION = "dry friction on all suspensions"
Drive = getattr(codegen, "Excitation", None) or codegen.Drive


def observed(name: str):
    """Return a bundled vehicle with the channels of a phone on its first body."""
    vehicle = load_vehicle(name)
    body = next(iter(vehicle.bodies))
    pitches = vehicle.bodies[body].motions is None or "pitch" in vehicle.bodies[body].motions
    kinds = ("acceleration", "pitch_rate") if pitches else ("acceleration",)
    return derive(vehicle, [PointOutput(kind, Place("s", body), kind) for kind in kinds])


def models() -> dict:
    """Return the vehicles, and the five-axle one with friction."""
    return {**{name: observed(name) for name in VEHICLES}, f"tractor5, {FRICTION}": benchmark_model(FRICTION)}


def over_a_hump(model, steps: int):
    """Return what drives a vehicle over a hump at 2 m/s."""
    track = Track((Hump.from_shape("half_sine", 1.0, 0.4, 0.03),))
    wheels = wheel_inputs(track, ConstantSpeed(2.0), model.wheel_offsets(), np.arange(steps + 1) * DT)
    inputs, rates = np.zeros((2, steps + 1, len(model.inputs)))
    inputs[:, : wheels.heights.shape[1]], rates[:, : wheels.heights.shape[1]] = wheels.heights, wheels.rates
    return Drive(DT, inputs, rates, np.zeros((steps + 1, len(model.forces))))


def nanoseconds(model) -> float:
    """Return what a step of one individual takes, over a hump, on one thread: the shortest of some rounds of CPU time."""
    drive, individuals = over_a_hump(model, STEPS), population(model, N)
    kernel, taken = codegen.Kernel(model), []
    for _ in range(ROUNDS):
        start = time.process_time()
        kernel.run(individuals, drive, KEEP, threads=1)
        taken.append(time.process_time() - start)
    return min(taken) / N / STEPS * 1e9


if __name__ == "__main__":
    print(json.dumps({name: nanoseconds(model) for name, model in models().items()}))
