"""Many candidate laws: one kernel for all or one each, compiled here or in parallel: `python -m benchmarks.variants`."""

from __future__ import annotations

import os
import sys
import tempfile
import time
from itertools import islice, product
from pathlib import Path

import numpy as np

from vehgen.codegen import Excitation, Kernel, compile_all
from vehgen.mechanics import EquationsOfMotion, derive
from vehgen.mechanics.laws import LAWS
from vehgen.mechanics.superset import CandidateLaw, add_laws
from vehgen.simulate.benchmark import KEEP, OUTPUTS, best_time, hump_excitation
from vehgen.vehicle import load_vehicle

COUNTS = (1, 2, 5, 10, 20, 50, 100)


def candidates(count: int) -> list[CandidateLaw]:
    """Return laws on the five-axle vehicle's suspensions, then tyres: every axle has its first law before any has its second."""
    axles = [f"axle{i}" for i in range(1, 6)]
    suspensions = ((axle, "suspension", law.name) for law, axle in product(LAWS.values(), axles) if "suspension" in law.attaches_to)
    tyres = ((axle, "tyre", law.name) for law, axle in product(LAWS.values(), axles))
    return list(islice((*suspensions, *tyres), count))


def built(chosen: list[CandidateLaw]) -> EquationsOfMotion:
    """Return the five-axle vehicle with laws."""
    return derive(add_laws(load_vehicle("tractor5"), chosen).vehicle, OUTPUTS)


def compiled(chosen: list[CandidateLaw]) -> tuple[Kernel, float]:
    """Return a kernel of the vehicle with laws, and the seconds from the vehicle to compiled code, with an empty cache."""
    with tempfile.TemporaryDirectory() as folder:
        start = time.perf_counter()
        kernel = Kernel(built(chosen), Path(folder))
        forget(kernel)
        kernel.compile()
        return kernel, time.perf_counter() - start


def forget(kernel: Kernel) -> None:
    """Let a kernel that this process has loaded be compiled again."""
    sys.modules.pop(f"vehgen_{kernel.name}", None)


def step_time(kernel: Kernel, ride: Excitation, n: int = 160) -> float:
    """Return ns per step and individual on one thread."""
    parameters = np.repeat([list(kernel.model.values().values())], n, axis=0)
    return best_time(lambda: kernel.run(parameters, ride, KEEP, threads=1), 3) / n / ride.n_steps * 1e9


def supersets() -> None:
    """Print what one kernel for all candidates costs beside one each."""
    print("| candidates | one for all: start [s] | step [ns] | one each: start [s] | step [ns] | runs of 10 s each at break-even |")
    print("|---|---|---|---|---|---|")
    ride = hump_excitation(built(candidates(1)), 2.0)
    compiled(candidates(1))
    each: list[tuple[float, float]] = []
    for count in COUNTS:
        kernel, start = compiled(candidates(count))
        step = step_time(kernel, ride)
        for i in range(len(each), min(count, 10)):
            own, took = compiled([candidates(i + 1)[i]])
            each.append((took, step_time(own, ride)))
        start_each, step_each = np.mean(each, axis=0)
        runs = (count * start_each - start) / count / ((step - step_each) * 1e-9 * 10_000)
        even = f"{runs:,.0f}" if count > 1 else ""
        print(f"| {count} | {start:.1f} | {step:.1f} | {count * start_each:.1f} | {step_each:.1f} | {even} |", flush=True)


def processes(count: int = 12, laws: int = 10, rounds: int = 2) -> None:
    """Print how long kernels take to compile by one process and by one per core, taking turns."""
    print(f"\n| processes | seconds to compile {count} kernels of {laws} laws |\n|---|---|")
    models = [built(candidates(i + laws)[i:]) for i in range(count)]
    times: dict[int, list[float]] = {workers: [] for workers in sorted({1, os.cpu_count() or 1})}
    for _ in range(rounds):
        for workers, found in times.items():
            with tempfile.TemporaryDirectory() as folder:
                kernels = [Kernel(model, Path(folder)) for model in models]
                for kernel in kernels:
                    forget(kernel)
                start = time.perf_counter()
                compile_all(kernels, workers)
                found.append(time.perf_counter() - start)
    for workers, found in times.items():
        print(f"| {workers} | {min(found):.1f} |", flush=True)


if __name__ == "__main__":
    supersets()
    processes()
