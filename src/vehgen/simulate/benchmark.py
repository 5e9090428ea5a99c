"""How fast the kernels run on this machine, beside peers of the scientific Python world that are installed."""

from __future__ import annotations

import importlib.util
import os
import time
from collections.abc import Callable
from functools import partial
from typing import Any

import numba
import numpy as np
import scipy
from numpy.typing import NDArray

from vehgen.codegen import Excitation, Kernel
from vehgen.mechanics import EquationsOfMotion, NumericModel, Place, PointOutput, derive
from vehgen.road import ConstantSpeed, Hump, Track, wheel_inputs
from vehgen.vehicle import load_vehicle, parse_vehicle

Array = NDArray[np.float64]
DT, DECIMATION = 1e-3, 10
OUTPUTS = (
    PointOutput("L1", Place("L1", "tractor", behind="axle1", distance=-0.29), "acceleration"),
    PointOutput("L2", Place("L2", "semitrailer", behind="fifth_wheel", distance=9.32), "acceleration"),
)
BENCHMARKED_LAWS = {
    "linear": None,
    "dry friction on all suspensions": ("suspension", "{dry_friction: {force: 5 kN}}"),
    "unilateral tyres": ("tyre", "{tyre_liftoff: {}}"),
}


def benchmark_model(name: str) -> EquationsOfMotion:
    """Return the five-axle vehicle with one of BENCHMARKED_LAWS on every axle."""
    law = BENCHMARKED_LAWS[name]
    if law is None:
        return derive(load_vehicle("tractor5"), OUTPUTS)
    axles = "".join(f"  axle{i}: {{{law[0]}: {{laws: [{law[1]}]}}}}\n" for i in range(1, 6))
    return derive(parse_vehicle(f"extends: tractor5\naxles:\n{axles}"), OUTPUTS)


def hump_excitation(model: EquationsOfMotion, seconds: float) -> Excitation:
    """Return the inputs of a half-sine hump of 0.5 m x 0.03 m at 2 m/s."""
    steps = np.arange(round(seconds / (DT * DECIMATION)) * DECIMATION + 1, dtype=np.float64) * DT
    wheels = wheel_inputs(Track((Hump.from_shape("half_sine", 1.0, 0.5, 0.03),)), ConstantSpeed(2.0), model.wheel_offsets(), steps)
    return Excitation(DT, wheels.heights, wheels.rates, np.zeros((len(steps), 0)))


def population(model: EquationsOfMotion, n_individuals: int, seed: int = 0) -> Array:
    """Return individuals whose searched parameters vary by +-10 %, `shape (n_individuals, n_parameters)`."""
    values = model.values()
    searched = np.array([name in model.vehicle.ranges() for name in model.parameters])
    factors = np.random.default_rng(seed).uniform(0.9, 1.1, (n_individuals, len(values)))
    return np.array(list(values.values())) * np.where(searched, factors, 1.0)


def best_time(work: Callable[[], object], repeats: int = 5) -> float:
    """Return the shortest of some timings [s]."""
    times = []
    for _ in range(repeats):
        start = time.perf_counter()
        work()
        times.append(time.perf_counter() - start)
    return min(times)


def measure(n_individuals: int = 300, seconds: float = 10.0) -> dict[str, Any]:
    """Time all cases on one thread and on all, and the installed peers on a few individuals.

    Returns
    -------
    {"cases": [{name, threads, ns_per_step_individual, individuals_per_second, operations_per_step, peak_share}],
    "ratios": {peer: times slower}, "vector_peak_gflops"}; the peak is that of fused multiply-adds measured on one core.
    """
    peak = vector_peak()
    cases: list[dict[str, Any]] = []
    for name in BENCHMARKED_LAWS:
        model = benchmark_model(name)
        kernel = Kernel(model)
        kernel.compile()
        excitation, individuals = hump_excitation(model, seconds), population(model, n_individuals)
        for threads in sorted({1, os.cpu_count() or 1}):
            duration = best_time(partial(kernel.run, individuals, excitation, DECIMATION, threads=threads))
            per_step = duration / n_individuals / excitation.n_steps
            operations = kernel.source.operation_counts["step"] + kernel.source.operation_counts["sample"] / DECIMATION
            cases.append(
                {
                    "name": name,
                    "threads": threads,
                    "ns_per_step_individual": per_step * 1e9,
                    "individuals_per_second": n_individuals / duration,
                    "operations_per_step": operations,
                    "peak_share": operations / per_step / (peak * 1e9) / threads,
                }
            )
    model = benchmark_model("linear")
    excitation = hump_excitation(model, min(seconds, 2.0))
    reference = cases[0]["ns_per_step_individual"] * 1e-9
    ratios = {peer: work(model.numeric(), excitation) / excitation.n_steps / reference for peer, work in _peers().items()}
    return {"cases": cases, "ratios": ratios, "vector_peak_gflops": peak}


def _peers() -> dict[str, Callable[[NumericModel, Excitation], float]]:
    found: dict[str, Callable[[NumericModel, Excitation], float]] = {"dense numba loop": _time_dense, "scipy.signal.lsim": _time_lsim}
    if importlib.util.find_spec("pyyeti"):
        found["pyyeti SolveNewmark"] = _time_pyyeti
    return found


def _time_dense(model: NumericModel, excitation: Excitation) -> float:
    compiled: Any = numba.njit(_dense_newmark)
    compiled(model.M, model.C, model.K, model.P, excitation.inputs[:2], excitation.dt)
    return best_time(lambda: compiled(model.M, model.C, model.K, model.P, excitation.inputs, excitation.dt))


def _dense_newmark(M: Array, C: Array, K: Array, P: Array, inputs: Array, dt: float) -> Array:
    """Textbook average-acceleration Newmark with dense matrices, one individual."""
    n = M.shape[0]
    inverse = np.linalg.inv(M + dt / 2 * C + dt * dt / 4 * K)
    u, v, a = np.zeros(n), np.zeros(n), np.zeros(n)
    peak, force = np.zeros(n), np.zeros(n)
    for step in range(1, inputs.shape[0]):
        for i in range(n):
            u[i] += dt * v[i] + dt * dt / 4 * a[i]
            v[i] += dt / 2 * a[i]
        for i in range(n):
            total = 0.0
            for j in range(inputs.shape[1]):
                total += P[i, j] * inputs[step, j]
            for j in range(n):
                total -= C[i, j] * v[j] + K[i, j] * u[j]
            force[i] = total
        for i in range(n):
            total = 0.0
            for j in range(n):
                total += inverse[i, j] * force[j]
            a[i] = total
            u[i] += dt * dt / 4 * total
            v[i] += dt / 2 * total
            peak[i] = max(peak[i], abs(total))
    return peak


def _time_lsim(model: NumericModel, excitation: Excitation) -> float:
    n = len(model.M)
    inverse = np.linalg.inv(model.M)
    A = np.block([[np.zeros((n, n)), np.eye(n)], [-inverse @ model.K, -inverse @ model.C]])
    B = np.vstack([np.zeros((n, model.P.shape[1])), inverse @ model.P])
    system = (A, B, A[n:], B[n:])
    return best_time(lambda: scipy.signal.lsim(system, excitation.inputs, excitation.time), 2)


def _time_pyyeti(model: NumericModel, excitation: Excitation) -> float:
    from pyyeti import ode

    return best_time(lambda: ode.SolveNewmark(model.M, model.C, model.K, excitation.dt).tsolve(model.P @ excitation.inputs.T), 2)


def _multiply_add(x: Array, factor: float, rounds: int) -> float:
    """Run 96 independent chains of multiply-adds: twelve vectors of eight lanes, enough to hide the latency of one."""
    for _ in range(rounds):
        for i in range(96):
            x[i] = x[i] * factor + factor
    return float(x[0])


def vector_peak() -> float:
    """Return the rate of multiply-adds that one core reaches on data in its first cache, in 10^9 operations per second."""
    raw = np.ones(104)
    start = (-raw.ctypes.data // 8) % 8
    x, rounds = raw[start : start + 96], 1_000_000
    compiled: Any = numba.njit(_multiply_add, fastmath={"contract"})
    compiled(x, 0.5, 10)
    return 2 * 96 * rounds / best_time(lambda: compiled(x, 0.5, rounds), 5) / 1e9
