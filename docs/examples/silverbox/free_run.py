"""Fit the Silverbox on its training part and simulate its test splits freely, as the benchmark asks.

`python free_run.py SNLS80mV.csv` prints the root mean square errors of the linear vehicle, of the one with a cubic spring, and with a
quadratic spring beside that.
"""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from prepare import DISPLACEMENT, FINER, HERE, RUNS, STEP, TESTS, read_silverbox, upsample, write_runs

from vehgen.codegen import Excitation
from vehgen.effects import EFFECTS, EffectLocator
from vehgen.fit.least_squares import FitOptions, fit_least_squares
from vehgen.fit.misfit import Nuisances
from vehgen.fit.noise import EVEN, Noise
from vehgen.fit.problem import make_problem
from vehgen.fit.trial import load_trials
from vehgen.mechanics import Place, PointOutput
from vehgen.simulate import Simulator
from vehgen.vehicle import Vehicle, load_vehicle

Array = NDArray[np.float64]
FIRST = 50
"""Samples of a test split that tell its initial state, and no more."""
WHOLE_BAND = (0.5, 300.0)


def with_cubic_spring(vehicle: Vehicle) -> Vehicle:
    """Return the vehicle with the library's cubic spring beside its linear one."""
    return vehicle.with_changes(EFFECTS["cubic_stiffness"].change(EffectLocator(vehicle, vehicle.values()).site("spring")))


def with_quadratic_spring(vehicle: Vehicle) -> Vehicle:
    """Return the vehicle with a quadratic spring beside what it has, of either sign."""
    k2 = {"value": "0 N/m^2", "range": ["-10 MN/m^2", "10 MN/m^2"]}
    laws = [*vehicle.links["spring"].laws, {"quadratic_stiffness": {"k2": "k2"}}]
    return vehicle.with_changes({"parameters": {"k2": k2}, "links": {"spring": {"laws": laws}}})


def fit(vehicle: Vehicle, runs: list[Path]) -> dict[str, float]:
    """Return the parameters [SI] with the least mean square error on runs, each error of a displacement counting alike."""
    trials = []
    for trial in load_trials(runs, vehicle):
        forces = {name: entry.model_copy(update={"noise": None}) for name, entry in trial.run.file.forces.items()}
        trials.append(replace(trial, run=replace(trial.run, file=trial.run.file.model_copy(update={"forces": forces}))))
    problem = make_problem(trials)
    noises = {trial.name: Noise(EVEN, np.array([3e-4 * DISPLACEMENT])) for trial in trials}
    options = FitOptions(Nuisances(0.0, 0.0, 0.0, force_offset=0.0), WHOLE_BAND)
    found = fit_least_squares(problem, problem.space.unit(problem.space.start), options, noises=noises)
    return problem.best_values(found.values)


def free_run(
    vehicle: Vehicle, values: Mapping[str, float], fine: Array, displacement: Array, split: tuple[int, int]
) -> tuple[Array, Array]:
    """Simulate a split from the state that its FIRST samples tell.

    Parameters
    ----------
    vehicle, values
        What to simulate; its parameters [SI].
    fine
        The force at FINER times the rate [N].
    displacement
        What was measured, `shape (n,)` [m].
    split
        First sample, last + 1.

    Returns
    -------
    Simulated and measured displacement after the first FIRST samples [m].
    """
    simulator = Simulator(vehicle, [PointOutput("y", Place("V2", "block"), "displacement")], [Place("V1", "block")])
    parameters = simulator.parameters(values)
    measured = displacement[split[0] : split[1]]

    def simulate(initial: Array, count: int) -> Array:
        force = fine[split[0] * FINER : (split[0] + count - 1) * FINER + 1]
        still = np.zeros((len(force), len(simulator.model.inputs)))
        drive = Excitation(STEP / FINER, still, still, force[:, None])
        return simulator.kernel.run(np.repeat(parameters, len(initial), axis=0), drive, FINER, initial).responses[:, :, 0]

    scale = np.array([1e-3, 1e-3 * np.sqrt(values["k1"] / values["m1"])])
    state = np.zeros(2)
    for _ in range(6):
        tried = simulate(state + np.vstack([np.zeros(2), 1e-3 * np.diag(scale)]), FIRST)
        slopes = (tried[1:] - tried[0]).T / 1e-3
        state = state + scale * np.linalg.lstsq(slopes, measured[:FIRST] - tried[0])[0]
    return simulate(state[None], len(measured))[0, FIRST:], measured[FIRST:]


def errors(vehicle: Vehicle, values: Mapping[str, float], fine: Array, displacement: Array) -> dict[str, float]:
    """Return the root mean square error of every test split [mV]."""
    found = {}
    for name, split in TESTS.items():
        simulated, measured = free_run(vehicle, values, fine, displacement, split)
        found[name] = float(np.sqrt(np.mean((simulated - measured) ** 2)) / DISPLACEMENT * 1e3)
    return found


def main(path: Path) -> None:
    """Fit, simulate and print."""
    force, displacement = read_silverbox(path)
    fine = upsample(force)
    linear = load_vehicle(HERE / "silverbox.yaml")
    cubic = with_cubic_spring(linear)
    every = {"linear": linear, "with a cubic spring": cubic, "with a quadratic spring beside": with_quadratic_spring(cubic)}
    with tempfile.TemporaryDirectory() as folder:
        runs = write_runs(path, Path(folder), RUNS)
        for title, vehicle in every.items():
            values = fit(vehicle, runs)
            print(title, ", ".join(f"{name} {value:.6g}" for name, value in values.items()))
            print("   RMSE [mV]:", ", ".join(f"{name} {value:.3f}" for name, value in errors(vehicle, values, fine, displacement).items()))


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: python free_run.py SNLS80mV.csv")
    main(Path(sys.argv[1]))
