"""The calibrations of the study: the paper's methods and the joint fit, timed."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from benchmarks.paper_study.recordings import Rig
from vehgen.calibrate.calibration import Settings, calibrate_problem
from vehgen.calibrate.genetic import GeneticSearch
from vehgen.calibrate.objective import PsdObjective
from vehgen.fit.problem import Problem, make_problem
from vehgen.fit.trial import load_trials
from vehgen.measure import record_psd

Array = np.ndarray
GENERATIONS = 300
"""Of every genetic search; the paper's number."""


@dataclass(frozen=True)
class Method:
    """One way to calibrate: its name in tables, the method and sensors, how many populations, whether polished, and how many runs."""

    name: str
    method: str
    sensors: tuple[str, ...]
    populations: int
    polish: bool = False
    runs: int = 1


METHODS = {
    "truck": (
        Method("SHCM-1", "shcm", ("L1",), 1),
        Method("SHCM-2", "shcm", ("L2",), 1),
        Method("DHCM", "dhcm", ("L1", "L2"), 3),
        Method("DHCM, polished", "dhcm", ("L1", "L2"), 3, polish=True),
        Method("joint", "joint", ("L1", "L2"), 3, polish=True),
        Method("joint, 2 speeds", "joint", ("L1", "L2"), 3, polish=True, runs=2),
    ),
    "sedan": (
        Method("SHCM-M", "shcm", ("M",), 1),
        Method("SHCM-F", "shcm", ("F",), 1),
        Method("SHCM-R", "shcm", ("R",), 1),
        Method("DHCM-F&R", "dhcm", ("F", "R"), 3),
        Method("DHCM-F&R, polished", "dhcm", ("F", "R"), 3, polish=True),
        Method("joint", "joint", ("F", "R"), 3, polish=True),
        Method("joint, 2 speeds", "joint", ("F", "R"), 3, polish=True, runs=2),
    ),
}


@dataclass(frozen=True)
class Fit:
    """A calibrated vehicle: `values` of all free parameters [SI], how long search and polish took [s], how much was evaluated.

    `eq5` is the mean of Eq. 5's terms over the sensors and runs that the method used, at the result; `eq5_truth` the same at the truth.
    `psd` holds frequency, measured and simulated PSD of its first run's channels.
    """

    method: Method
    values: dict[str, float]
    search_s: float
    polish_s: float
    evaluations: int
    eq5: float
    eq5_truth: float
    psd: dict[str, tuple[Array, Array, Array]]


def fit_all(rig: Rig, runs: Sequence[Path], truth: dict[str, float], generations: int, seed: int, only: Sequence[str] = ()) -> list[Fit]:
    """Calibrate by every method (or those named `only`) and return the fits."""
    trials = load_trials(runs)
    chosen = [item for item in METHODS[rig.kind] if not only or item.name in only]
    return [fit(make_problem(trials[: item.runs]), item, truth, generations, seed) for item in chosen]


def fit(problem: Problem, method: Method, truth: dict[str, float], generations: int, seed: int) -> Fit:
    """Calibrate by one method; kernels are compiled before the clock starts."""
    search = GeneticSearch(method.populations, 100, generations)
    settings = Settings(method.method, method.sensors, search=search, seed=seed, polish=method.polish)
    calibrate_problem(problem, replace(settings, search=replace(search, generations=0), polish=False))
    last, spent = [time.perf_counter()], {"search": 0.0, "polish": 0.0}

    def clock(label: str, done: int, total: int, best: float) -> None:
        now = time.perf_counter()
        spent["polish" if label.endswith("polish") else "search"] += now - last[0]
        last[0] = now

    found = calibrate_problem(problem, settings, progress=clock)
    used = problem.of_sensors(method.sensors)
    objective = PsdObjective(used)
    points = np.array([[source[name] for name in problem.space.names] for source in (found.values, truth)])
    terms = objective.terms(points).mean(axis=1)
    return Fit(
        method,
        problem.trials[0].values | found.values,
        spent["search"],
        spent["polish"],
        sum(replace(search, generations=step.state.generation).evaluations for step in found.steps),
        float(terms[0]),
        float(terms[1]),
        spectra(used, found.values),
    )


def spectra(problem: Problem, values: dict[str, float]) -> dict[str, tuple[Array, Array, Array]]:
    """Return frequency, measured and simulated PSD of the first run's channels."""
    trial = problem.trials[0]
    row = np.array([[values[name] for name in problem.space.names]])
    simulated = problem.respond(row, trial)[0][0]
    found = {}
    for i, channel in enumerate(trial.channels):
        frequency, measured = record_psd(trial.recording.values[:, i], trial.recording.dt)
        found[channel] = (frequency, measured, record_psd(simulated[:, i], trial.recording.dt)[1])
    return found
