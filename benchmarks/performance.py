"""Time the kernels against what a user would pick instead, all in one run: `python -m benchmarks.performance [--write]`.

Prints one table; with --write also docs/performance.md's tables and its figure.
"""

from __future__ import annotations

import argparse
import os
import platform
import subprocess
import sys
import tempfile
import time
from functools import partial
from pathlib import Path

import numpy as np

from benchmarks.peers import cpp_avx, dense_numba, jax_scan, pyyeti_newmark, scipy_lsim
from benchmarks.peers.systems import hump_inputs, tractor5_population
from vehgen.codegen import Excitation, Kernel
from vehgen.mechanics import derive
from vehgen.simulate.benchmark import DECIMATION, DT, benchmark_model, best_time
from vehgen.vehicle import load_vehicle, parse_vehicle

N_STEPS = 10_000
ROOT = Path(__file__).parents[1]


def vehgen_parameters(kernel: Kernel, systems) -> np.ndarray:
    """Return the peers' population in the kernel's order."""
    model = kernel.model
    values = model.values()
    columns = [systems.parameters.get(name, np.full(len(systems.M), values[name])) for name in model.parameters]
    return np.column_stack(columns)


def drive(model, n_steps: int) -> Excitation:
    """Return the same hump for the kernels."""
    inputs = hump_inputs(n_steps, DT)
    return Excitation(DT, inputs, np.gradient(inputs, DT, axis=0), np.zeros((n_steps + 1, len(model.forces))))


def compare(n_individuals: int = 300, rounds: int = 7) -> list[tuple[str, int, float]]:
    """Return (name, threads, ns per step and individual); vehgen and the yardstick take turns, so that drift is fair to both."""
    systems = tractor5_population(n_individuals)
    inputs = hump_inputs(N_STEPS, DT)
    rows: list[tuple[str, int, float]] = []
    works = {}
    for name in ("linear", "dry friction on all suspensions", "unilateral tyres"):
        kernel = Kernel(benchmark_model(name))
        kernel.compile()
        parameters, ride = vehgen_parameters(kernel, systems), drive(kernel.model, N_STEPS)
        works[f"vehgen, {name}"] = partial(kernel.run, parameters, ride, DECIMATION, None)
    if cpp_avx.available() is None:
        cpp_avx.prepare()
        works["C++ by hand (the yardstick)"] = lambda threads: cpp_avx.run(systems, inputs, DT, DECIMATION, threads)
    for threads in sorted({1, os.cpu_count() or 1}):
        times: dict[str, list[float]] = {name: [] for name in works}
        for _ in range(rounds):
            for name, work in works.items():
                start = time.perf_counter()
                work(threads)
                times[name].append(time.perf_counter() - start)
        rows += [(name, threads, min(values) / n_individuals / N_STEPS * 1e9) for name, values in times.items()]
    if jax_scan.available() is None:
        jax_scan.run(systems, inputs, DT, DECIMATION)
        rows.append(
            (
                "JAX, vmap and scan, jit",
                os.cpu_count() or 1,
                best_time(lambda: jax_scan.run(systems, inputs, DT, DECIMATION), 2) / n_individuals / N_STEPS * 1e9,
            )
        )
    few = systems.part(4)
    dense_numba.run(few, inputs, DT, DECIMATION)
    for name, peer, count in (
        ("numba, dense loop", dense_numba, 4),
        ("scipy.signal.lsim", scipy_lsim, 2),
        ("pyyeti SolveNewmark", pyyeti_newmark, 2),
    ):
        if peer.available() is None:
            part = systems.part(count)
            rows.append(
                (name, 1, best_time(lambda peer=peer, part=part: peer.run(part, inputs, DT, DECIMATION), 2) / count / N_STEPS * 1e9)
            )
    return rows


def axle_scaling(counts: tuple[int, ...] = (2, 5, 10, 20, 40)) -> list[tuple[int, float]]:
    """Return (axles, ns per step, individual and axle) of one frame on many axles."""
    rows = []
    for count in counts:
        axles = "".join(
            f"  a{i}: {{body: frame, x: {6 - 12 * i / (count - 1)} m, mass: 500 kg, "
            "suspension: {k: 300 kN/m, c: 9 kN s/m}, tyre: {k: 2 MN/m}}\n"
            for i in range(count)
        )
        vehicle = parse_vehicle(f"bodies: {{frame: {{mass: {4 * count} t, pitch_inertia: {50 * count} t m^2}}}}\naxles:\n{axles}")
        model = derive(vehicle)
        kernel = Kernel(model)
        kernel.compile()
        parameters = np.zeros((320, len(model.parameters)))
        rest = np.zeros((2001, count))
        ride = Excitation(DT, rest, rest, np.zeros((2001, 0)))
        rows.append(
            (
                count,
                best_time(lambda kernel=kernel, parameters=parameters, ride=ride: kernel.run(parameters, ride, DECIMATION, threads=1))
                / 320
                / 2000
                / count
                * 1e9,
            )
        )
    return rows


def population_scaling(counts: tuple[int, ...] = (1, 8, 32, 100, 320, 1000, 3200)) -> list[tuple[int, int, float]]:
    """Return (individuals, threads, ns per step and individual) of the five-axle vehicle."""
    kernel = Kernel(benchmark_model("linear"))
    kernel.compile()
    rows = []
    for count in counts:
        parameters, ride = vehgen_parameters(kernel, tractor5_population(count)), drive(kernel.model, 2000)
        for threads in sorted({1, os.cpu_count() or 1}):
            duration = best_time(
                lambda parameters=parameters, ride=ride, threads=threads: kernel.run(parameters, ride, DECIMATION, threads=threads), 3
            )
            rows.append((count, threads, duration / count / 2000 * 1e9))
    return rows


def cold_starts() -> list[tuple[str, float]]:
    """Return (what, seconds) of whole processes: import, derive, generate and compile with an empty cache, and again with a full one."""
    laws = (
        "dry_friction: {force: 3 kN}}, {bump_stop: {k: 2 MN/m, clearance: 50 mm}}, "
        "{asymmetric_damping: {c: 8 kN s/m, ratio: 0.5}}, {cubic_stiffness: {k3: 1e8 N/m^3}"
    )
    axles = "".join(f"  axle{i}: {{suspension: {{laws: [{{{laws}}}]}}}}\n" for i in range(1, 6))
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "laws.yaml"
        path.write_text(f"extends: tractor5\naxles:\n{axles}")
        for name, vehicle in (("five axles, linear", "tractor5"), ("five axles, four laws on each suspension", str(path))):
            program = f"from vehgen import Kernel, derive, load_vehicle; k = Kernel(derive(load_vehicle({vehicle!r}))); k.compile()"
            for state in ("cold", "warm"):
                environment = {**os.environ, "VEHGEN_CACHE": str(Path(folder) / "cache")}
                start = time.perf_counter()
                subprocess.run([sys.executable, "-c", program], check=True, env=environment)
                rows.append((f"{name}, {state}", time.perf_counter() - start))
    model = derive(load_vehicle("road_train"), ())
    start = time.perf_counter()
    _ = Kernel(model).source
    rows.append((f"road_train ({model.n_dof} degrees of freedom), generating its kernel", time.perf_counter() - start))
    return rows


def tables(rows, axles, starts) -> str:
    """Return the tables as Markdown."""
    linear = {threads: ns for name, threads, ns in rows if name == "vehgen, linear"}
    lines = ["| kernel | threads | ns per step and individual | over vehgen, linear |", "|---|---|---|---|"]
    lines += [f"| {name} | {threads} | {ns:,.2f} | {ns / linear[threads]:,.2f} |" for name, threads, ns in rows]
    lines += [
        "",
        "| axles on one frame | ns per step, individual and axle |",
        "|---|---|",
        *(f"| {count} | {ns:.2f} |" for count, ns in axles),
    ]
    lines += ["", "| start of a process | seconds |", "|---|---|", *(f"| {name} | {seconds:.2f} |" for name, seconds in starts)]
    return "\n".join(lines)


def draw(axles, populations, path: Path) -> None:
    """Draw how the cost scales with axles, population and threads."""
    from matplotlib.figure import Figure
    from matplotlib.ticker import LogLocator, NullFormatter

    figure = Figure(figsize=(9, 3.4), layout="constrained")
    left, right = figure.subplots(1, 2)
    left.plot(*zip(*axles, strict=True), "o-", color="#0b5fa5")
    left.set_xlabel("axles")
    left.set_ylabel("ns per step, individual and axle")
    left.set_ylim(0, 1.1 * max(ns for _, ns in axles))
    left.set_title("An axle costs the same on a long vehicle", loc="left", fontsize=10)
    for threads, style, colour in ((1, "o-", "#0b5fa5"), (max(row[1] for row in populations), "s--", "#d55e00")):
        points = [(count, ns) for count, used, ns in populations if used == threads]
        right.loglog(*zip(*points, strict=True), style, color=colour, label=f"{threads} thread{'s' if threads > 1 else ''}")
    right.set_xlabel("individuals")
    right.set_ylabel("ns per step and individual")
    for axis in (right.xaxis, right.yaxis):
        axis.set_major_locator(LogLocator(subs=(1.0, 3.0)))
        axis.set_major_formatter("{x:,g}")
        axis.set_minor_formatter(NullFormatter())
    right.set_title("Full lanes, then full cores", loc="left", fontsize=10)
    right.legend(frameon=False)
    for axes in (left, right):
        axes.grid(color="#e3e7ea", lw=0.6)
        axes.spines[["top", "right"]].set_visible(False)
    figure.savefig(path, metadata={"Date": None} if path.suffix == ".svg" else None)


def main() -> None:
    """Run everything."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--write", action="store_true", help="write the tables and the figure into docs/")
    options = parser.parse_args()
    rows, axles, populations, starts = compare(), axle_scaling(), population_scaling(), cold_starts()
    text = tables(rows, axles, starts)
    print(text)
    if options.write:
        page = ROOT / "docs" / "performance.md"
        old = page.read_text(encoding="utf-8")
        head, tail = old.split("<!-- tables: start -->")[0], old.split("<!-- tables: end -->")[1]
        machine = f"Measured with Python {platform.python_version()} on {os.cpu_count()} cores of one {platform.machine()} machine."
        page.write_text(f"{head}<!-- tables: start -->\n\n{machine}\n\n{text}\n\n<!-- tables: end -->{tail}", encoding="utf-8")
        draw(axles, populations, ROOT / "docs" / "images" / "performance.svg")


if __name__ == "__main__":
    main()
