"""A step in residual form against one in displacements and velocities, in turns: `python -m benchmarks.step_forms`."""

from __future__ import annotations

import time

import numpy as np

from vehgen.codegen import Excitation, Kernel, write_kernel
from vehgen.mechanics import EquationsOfMotion, Place, PointOutput, derive
from vehgen.road import ConstantSpeed, Hump, Track, wheel_inputs
from vehgen.simulate.benchmark import DECIMATION, population
from vehgen.vehicle import bundled_models, load_vehicle

N, DT, STEPS = 304, 1e-3, 10_000


def observed(name: str) -> EquationsOfMotion:
    """Return a bundled vehicle with the channels of a phone on its first body."""
    vehicle = load_vehicle(name)
    body = next(iter(vehicle.bodies))
    pitches = vehicle.bodies[body].motions is None or "pitch" in vehicle.bodies[body].motions
    kinds = ("acceleration", "pitch_rate") if pitches else ("acceleration",)
    return derive(vehicle, [PointOutput(kind, Place("s", body), kind) for kind in kinds])


def over_a_hump(model: EquationsOfMotion) -> Excitation:
    """Return 10 s over a hump at 2 m/s."""
    track = Track((Hump.from_shape("half_sine", 1.0, 0.4, 0.03),))
    wheels = wheel_inputs(track, ConstantSpeed(2.0), model.wheel_offsets(), np.arange(STEPS + 1) * DT)
    inputs, rates = np.zeros((2, STEPS + 1, len(model.inputs)))
    inputs[:, : wheels.heights.shape[1]], rates[:, : wheels.heights.shape[1]] = wheels.heights, wheels.rates
    return Excitation(DT, inputs, rates, np.zeros((STEPS + 1, len(model.forces))))


def main(rounds: int = 15) -> None:
    """Print operations and times of both forms, and the largest difference of a channel relative to its largest value."""
    print("| vehicle | degrees of freedom | operations | 304 individuals [ns] | ratio | one individual [ns] | ratio | difference |")
    print("|---|---|---|---|---|---|---|---|")
    for name in bundled_models():
        model = observed(name)
        kernel, ride, everyone = Kernel(model), over_a_hump(model), population(model, N)
        counts = [write_kernel(model, from_rest=value).operation_counts["step"] for value in (False, True)]
        texts, gap = [], 0.0
        for n in (N, 1):
            best = [np.inf, np.inf]
            found = [np.empty(0), np.empty(0)]
            for _ in range(rounds):
                for form, initial in enumerate((np.zeros((n, 2 * model.n_dof)), None)):
                    start = time.process_time()
                    found[form] = kernel.run(everyone[:n], ride, DECIMATION, initial, threads=1).responses
                    best[form] = min(best[form], (time.process_time() - start) / n / STEPS * 1e9)
            gap = max(gap, float((np.abs(found[1] - found[0]).max(axis=1) / np.abs(found[0]).max(axis=1)).max()))
            texts.append(f"{best[0]:.2f} → {best[1]:.2f} | {best[1] / best[0]:.2f}")
        print(f"| {name} | {model.n_dof} | {counts[0]} → {counts[1]} | {texts[0]} | {texts[1]} | {gap:.0e} |", flush=True)


if __name__ == "__main__":
    main()
