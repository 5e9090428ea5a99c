"""A step in residual form against one in displacements and velocities, in turns: `python -m benchmarks.step_forms`."""

from __future__ import annotations

import time

import numpy as np

from benchmarks.limits.worker import FRICTION, N, observed, over_a_hump
from vehgen.codegen import Kernel, write_kernel
from vehgen.simulate.benchmark import DECIMATION, benchmark_model, population
from vehgen.vehicle import bundled_models

STEPS = 10_000


def main(rounds: int = 15) -> None:
    """Print operations and times of both forms, and the largest difference of a channel relative to its largest value."""
    print("| vehicle | degrees of freedom | operations | 304 individuals [ns] | ratio | one individual [ns] | ratio | difference |")
    print("|---|---|---|---|---|---|---|---|")
    models = {**{name: observed(name) for name in bundled_models()}, f"tractor5, {FRICTION}": benchmark_model(FRICTION)}
    for name, model in models.items():
        kernel, ride, everyone = Kernel(model), over_a_hump(model, STEPS), population(model, N)
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
