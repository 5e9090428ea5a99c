"""Single against double precision, in turns: `python -m benchmarks.precision`."""

from __future__ import annotations

import time

import numpy as np

from vehgen.codegen import Excitation, Kernel
from vehgen.mechanics import EquationsOfMotion, Place, PointOutput, derive
from vehgen.road import ConstantSpeed, Hump, Iso8608Road, Track, wheel_inputs
from vehgen.simulate.benchmark import BENCHMARKED_LAWS, DECIMATION, benchmark_model, population
from vehgen.vehicle import load_vehicle

N, DT, STEPS = 320, 1e-3, 10_000


def models() -> dict[str, EquationsOfMotion]:
    """Return what is compared."""

    def bundled(name: str) -> EquationsOfMotion:
        vehicle = load_vehicle(name)
        place = Place("s", next(iter(vehicle.bodies)))
        return derive(vehicle, [PointOutput(kind, place, kind) for kind in ("acceleration", "pitch_rate", "displacement")])

    nonlinear = {f"tractor5, {name}": benchmark_model(name) for name in BENCHMARKED_LAWS if name != "linear"}
    return {name: bundled(name) for name in ("tractor5", "sedan2", "road_train")} | nonlinear


def drive(model: EquationsOfMotion, road: str) -> Excitation:
    """Return 10 s over a hump or a rough road."""
    part = Hump.from_shape("half_sine", 1.0, 0.5, 0.03) if road == "hump" else Iso8608Road("B", 1, 200.0)
    wheels = wheel_inputs(Track((part,)), ConstantSpeed(2.0 if road == "hump" else 15.0), model.wheel_offsets(), np.arange(STEPS + 1) * DT)
    return Excitation(DT, wheels.heights, wheels.rates, np.zeros((STEPS + 1, 0)))


def main(rounds: int = 7) -> None:
    """Print how much faster single precision is, and the largest relative L2 error of a channel and individual."""
    print("| model | double [ns] | single [ns] | times faster | error, hump | error, class B road |\n|---|---|---|---|---|---|")
    for name, model in models().items():
        kernels = {"double": Kernel(model), "single": Kernel(model, precision="single")}
        parameters = population(model, N)
        errors = []
        for road in ("hump", "rough"):
            ride = drive(model, road)
            found = {key: kernel.run(parameters, ride, DECIMATION).responses for key, kernel in kernels.items()}
            gap = np.linalg.norm(found["single"] - found["double"], axis=1) / np.linalg.norm(found["double"], axis=1)
            errors.append(gap.max())
        best = dict.fromkeys(kernels, np.inf)
        for _ in range(rounds):
            for key, kernel in kernels.items():
                start = time.process_time()
                kernel.run(parameters, ride, DECIMATION, threads=1)
                best[key] = min(best[key], time.process_time() - start)
        double, single = (best[key] / N / STEPS * 1e9 for key in ("double", "single"))
        print(f"| {name} | {double:.2f} | {single:.2f} | {double / single:.2f} | {errors[0]:.1e} | {errors[1]:.1e} |", flush=True)


if __name__ == "__main__":
    main()
