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
from vehgen.vehicle import load_vehicle, parse_vehicle

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
FRICTION = "tractor5, dry friction on all suspensions"
Drive = getattr(codegen, "Excitation", None) or codegen.Drive


def models() -> dict:
    """Return vehicles with the channels of a phone on their first body."""
    laws = "".join(f"  axle{i}: {{suspension: {{laws: [{{dry_friction: {{force: 5 kN}}}}]}}}}\n" for i in range(1, 6))
    vehicles = {name: load_vehicle(name) for name in VEHICLES}
    vehicles[FRICTION] = parse_vehicle(f"name: friction\nextends: tractor5\naxles:\n{laws}")
    found = {}
    for name, vehicle in vehicles.items():
        body = next(iter(vehicle.bodies))
        pitches = vehicle.bodies[body].motions is None or "pitch" in vehicle.bodies[body].motions
        kinds = ("acceleration", "pitch_rate") if pitches else ("acceleration",)
        found[name] = derive(vehicle, [PointOutput(kind, Place("s", body), kind) for kind in kinds])
    return found


def nanoseconds(model) -> float:
    """Return what a step of one individual takes, over a hump at 2 m/s, on one thread: the shortest of some rounds of CPU time."""
    track = Track((Hump.from_shape("half_sine", 1.0, 0.5, 0.03),))
    wheels = wheel_inputs(track, ConstantSpeed(2.0), model.wheel_offsets(), np.arange(STEPS + 1) * DT)
    inputs, rates = np.zeros((2, STEPS + 1, len(model.inputs)))
    inputs[:, : wheels.heights.shape[1]], rates[:, : wheels.heights.shape[1]] = wheels.heights, wheels.rates
    drive = Drive(DT, inputs, rates, np.zeros((STEPS + 1, 0)))
    searched = np.array([name in model.vehicle.ranges() for name in model.parameters])
    factors = np.random.default_rng(0).uniform(0.9, 1.1, (N, len(searched)))
    individuals = np.array(list(model.values().values())) * np.where(searched, factors, 1.0)
    kernel, taken = codegen.Kernel(model), []
    for _ in range(ROUNDS):
        start = time.process_time()
        kernel.run(individuals, drive, KEEP, threads=1)
        taken.append(time.process_time() - start)
    return min(taken) / N / STEPS * 1e9


if __name__ == "__main__":
    print(json.dumps({name: nanoseconds(model) for name, model in models().items()}))
