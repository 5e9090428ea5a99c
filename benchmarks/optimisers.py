"""Ways to search compared at equal numbers of simulations: `python -m benchmarks.optimisers`; writes docs/accuracy.md's table and figure.

All minimise Eq. 5 over the unit cube except the polish, which fits whitened residuals by least squares; all are judged by Eq. 5 at
their result, and by the truth. Needs the extra `bench`.
"""

from __future__ import annotations

import argparse
import os
import tempfile
import time
import warnings
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, field
from multiprocessing import get_context
from pathlib import Path

import numpy as np
import scipy.optimize

from benchmarks.pages import ROOT, table
from benchmarks.paper_study.judging import errors
from benchmarks.paper_study.recordings import RIGS, hump_run
from benchmarks.paper_study.truth import drawn
from vehgen.calibrate.genetic import GeneticSearch
from vehgen.calibrate.objective import PsdObjective
from vehgen.fit.least_squares import fit_least_squares
from vehgen.fit.problem import Problem, make_problem
from vehgen.fit.trial import load_trials
from vehgen.report.figure_files import save_figure
from vehgen.report.plots.response_plot import COLOURS, STYLES

Array = np.ndarray
BUDGETS = (9_000, 90_000)
"""Simulations of a run."""
SEEDS = 5
WORKERS = 2
LANES = 32
"""Individuals of CMA-ES's first population: those that the kernel advances side by side."""


class BudgetSpentError(Exception):
    """The simulations are used up."""


@dataclass(frozen=True)
class Counted(Problem):
    """A problem that counts its simulations, each run of each individual as one."""

    spent: list[int] = field(default_factory=lambda: [0])

    def respond(self, values, trial, scenario=None):
        """Simulate, and count."""
        self.spent[0] += len(values)
        return super().respond(values, trial, scenario)


@dataclass
class Recorder:
    """An objective that keeps the best point after every call, and stops at the budget."""

    objective: PsdObjective
    limit: int
    trace: list[tuple[int, float]] = field(default_factory=list)
    best: dict[int, Array] = field(default_factory=dict)
    value: float = np.inf

    @property
    def count(self) -> int:
        """Simulations so far."""
        return self.objective.problem.spent[0]

    def __call__(self, unit: Array) -> Array:
        """Return Eq. 5 at points `shape (n, n_parameters)`; raises BudgetSpentError where the budget would be exceeded."""
        if self.count + len(unit) > self.limit:
            raise BudgetSpentError
        found = self.objective(unit)
        i = int(np.argmin(found))
        self.keep(unit[i], float(found[i]), better=found[i] < self.value)
        return found

    def keep(self, unit: Array, value: float, better: bool) -> None:
        """Note the best point so far."""
        last = self.best[max(self.best)] if self.best else unit
        if better:
            self.value, last = value, unit.copy()
        for budget in BUDGETS:
            if self.count <= budget or not self.best:
                self.best[budget] = last
        self.trace.append((self.count, self.value))


def genetic(populations: int, size: int) -> Callable[[Recorder, int], None]:
    """Return the genetic search of the package."""

    def run(recorder: Recorder, seed: int) -> None:
        search = GeneticSearch(populations, size, 10**6)
        state = search.start(recorder, recorder.objective.problem.space.size, seed)
        while True:
            state = search.advance(state, recorder)

    return run


def cma_es(recorder: Recorder, seed: int) -> None:
    """Run CMA-ES with restarts, each with twice the population (IPOP)."""
    import cma

    random = np.random.default_rng(seed)
    size = LANES
    while True:
        start = random.random(recorder.objective.problem.space.size)
        options = {"bounds": [0, 1], "popsize": size, "seed": int(random.integers(1, 2**31)), "verbose": -9}
        strategy = cma.CMAEvolutionStrategy(start, 0.3, options)
        while not strategy.stop():
            points = strategy.ask()
            strategy.tell(points, recorder(np.array(points)).tolist())
        size *= 2


def differential_evolution(recorder: Recorder, seed: int) -> None:
    """Run scipy's differential evolution, best1bin, 100 individuals."""
    n = recorder.objective.problem.space.size
    random = np.random.default_rng(seed)
    scipy.optimize.differential_evolution(
        lambda points: recorder(points.T.reshape(-1, n)), [(0.0, 1.0)] * n, init=random.random((100, n)), maxiter=10**6, tol=0.0,
        atol=-1.0, polish=False, vectorized=True, updating="deferred", rng=random,
    )  # fmt: skip


def polish_alone(recorder: Recorder, seed: int, first: bool = False) -> None:
    """Run the gradient polish from random points, or `first` once from the vehicle file's values; the likeliest fit counts."""
    problem = recorder.objective.problem
    random = np.random.default_rng(seed)
    loss = np.inf
    while recorder.count < recorder.limit:
        start = problem.space.unit(problem.space.start) if first else random.random(problem.space.size)
        fit = fit_least_squares(problem, start)
        unit = fit.misfit.split(fit.x)[0]
        if recorder.count > recorder.limit:
            return
        spent = recorder.count
        value = float(recorder.objective(unit[None])[0])
        problem.spent[0] = spent  # judging is free
        recorder.keep(unit, value, better=fit.loss < loss)
        loss = min(loss, fit.loss)
        if first:
            return


def polish_from_file(recorder: Recorder, seed: int) -> None:
    """Run the gradient polish once, from the vehicle file's values."""
    polish_alone(recorder, seed, first=True)


METHODS: dict[str, Callable[[Recorder, int], None]] = {
    "GA, 1 × 100": genetic(1, 100),
    "MPGA, 3 × 100": genetic(3, 100),
    "CMA-ES": cma_es,
    "differential evolution": differential_evolution,
    "polish, random starts": polish_alone,
    "polish, file's values": polish_from_file,
}


@dataclass(frozen=True)
class Outcome:
    """One run: Eq. 5 a channel along the way, at the truth, and at each budget; errors of what can be told; seconds."""

    trace: list[tuple[int, float]]
    truth: float
    value: dict[int, float]
    error: dict[int, float]
    seconds: float


def measure(kind: str, name: str, seed: int) -> Outcome:
    """Run one method once, on both sensors of one hump run of a true vehicle of its own for each seed."""
    rig = RIGS[kind]
    truth = drawn(kind, seed)
    sensors = ("L1", "L2") if kind == "truck" else ("F", "R")
    with tempfile.TemporaryDirectory() as folder:
        path = hump_run(Path(folder), "run", rig, truth, rig.humps[0], 50 + seed, sensors=sensors)
        plain = make_problem(load_trials([path]))
    objective = PsdObjective(Counted(plain.trials, plain.space))
    channels = len(plain.trials[0].channels)
    recorder = Recorder(objective, BUDGETS[-1])
    start = time.perf_counter()
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            METHODS[name](recorder, seed)
    except BudgetSpentError:
        pass
    seconds = time.perf_counter() - start
    right = np.array([[truth[key] for key in plain.space.names]])
    value, error = {}, {}
    for budget, unit in recorder.best.items():
        found = plain.space.values(unit)
        value[budget] = float(objective.terms(found[None]).sum()) / channels
        all_values = plain.trials[0].values | plain.best_values(found)
        error[budget] = float(np.median(np.abs(list(errors(rig, all_values, truth).values()))))
    trace = [(count, item / channels) for count, item in recorder.trace]
    return Outcome(trace, float(objective.terms(right).sum()) / channels, value, error, seconds)


def tables(found: dict[str, dict[str, list[Outcome]]]) -> str:
    """Return medians over the seeds, the worst in brackets."""
    header = ["search"]
    for budget in BUDGETS:
        header += [f"Eq. 5 over truth's, {budget:,}", f"error [%], {budget:,}"]
    parts = []
    for kind, methods in found.items():
        rows = []
        for name, outcomes in methods.items():
            cells = [name]
            for budget in BUDGETS:
                ratio = np.array([item.value[budget] / item.truth for item in outcomes])
                error = 100 * np.array([item.error[budget] for item in outcomes])
                cells += [f"{np.median(ratio):.2f} ({ratio.max():.2f})", f"{np.median(error):.1f} ({error.max():.1f})"]
            rows.append(
                (*cells, f"{np.median([item.trace[-1][0] for item in outcomes]):,.0f}", f"{np.median([i.seconds for i in outcomes]):.0f}")
            )
        parts.append(f"**{kind}**\n\n{table((*header, 'simulations', 'seconds'), rows)}")
    return "\n\n".join(parts)


def draw(found: dict[str, dict[str, list[Outcome]]], path: Path) -> None:
    """Draw Eq. 5 over that of the truth against simulations: medians of the seeds, and their range."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10, 3.9), layout="constrained")
    panels = figure.subplots(1, 2)
    grid = np.geomspace(300, BUDGETS[-1], 120)
    for axes, (kind, methods) in zip(panels, found.items(), strict=True):
        for j, (name, outcomes) in enumerate(methods.items()):
            curves = np.array([_at(item, grid) for item in outcomes])
            style = {"color": COLOURS[j], "linestyle": STYLES[j % len(STYLES)]}
            if name.endswith("values"):
                ends = [item.trace[-1] for item in outcomes]
                x, y = (
                    np.median([end[0] for end in ends]),
                    np.median([end[1] / item.truth for end, item in zip(ends, outcomes, strict=True)]),
                )
                axes.plot(x, y, "*", ms=11, color=COLOURS[j], label=name)
                continue
            axes.loglog(grid, np.median(curves, axis=0), lw=1.5, label=name, **style)
            axes.fill_between(grid, curves.min(axis=0), curves.max(axis=0), color=COLOURS[j], alpha=0.12, lw=0)
        axes.axhline(1.0, color="#1b2733", lw=0.8, ls=":")
        axes.set_title(kind, fontsize=10, loc="left")
        axes.set_xlabel("simulations")
        axes.set_ylabel("Eq. 5 over that of the truth")
        axes.set_yticks([0.8, 1, 1.5, 2, 3, 5], ["0.8", "1", "1.5", "2", "3", "5"])
        axes.set_yticks([], minor=True)
        axes.set_ylim(0.75, 6)
        axes.grid(color="#e3e7ea", lw=0.6)
        axes.spines[["top", "right"]].set_visible(False)
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=6, frameon=False, fontsize=8.5)
    save_figure(figure, path)


def _at(item: Outcome, grid: Array) -> Array:
    counts, values = np.array(item.trace).T
    index = np.searchsorted(counts, grid, side="right") - 1
    return np.where(index >= 0, values[np.maximum(index, 0)], np.nan) / item.truth


def main() -> None:
    """Run everything."""
    argparse.ArgumentParser(description=__doc__).parse_args()
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # for the processes: threads on small matrices only wait for each other
    found: dict[str, dict[str, list[Outcome]]] = {kind: {} for kind in RIGS}
    with ProcessPoolExecutor(WORKERS, mp_context=get_context("spawn")) as pool:
        for kind in RIGS:
            for name in METHODS:
                found[kind][name] = list(pool.map(measure, [kind] * SEEDS, [name] * SEEDS, range(1, SEEDS + 1)))
                values = [f"{item.value[BUDGETS[-1]] / item.truth:.3f}" for item in found[kind][name]]
                print(kind, name, *values, f"{np.median([item.seconds for item in found[kind][name]]):.0f} s", flush=True)
    text = tables(found)
    print(text)
    draw(found, ROOT / "build" / "optimisers.png")


if __name__ == "__main__":
    main()
