"""What a calibration tells its user: values, intervals, what cannot be told, how well it fits; as JSON and as a vehicle file."""

from __future__ import annotations

import hashlib
import platform
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vehgen.calibrate.calibration import Calibration, Settings, StepResult
from vehgen.calibrate.identifiability import Structure, find_structure
from vehgen.calibrate.intervals import LEVEL, Estimate, Uncertainty, refit
from vehgen.calibrate.objective import PsdObjective
from vehgen.files.reading import read_bytes
from vehgen.files.tables import MAX_TABLE_BYTES
from vehgen.fit.parallel import Runner
from vehgen.fit.prior_data import PriorData
from vehgen.mechanics import static_loads
from vehgen.mechanics.outputs import ElementOutput
from vehgen.simulate import Simulator
from vehgen.vehicle.writing import quantity, variant_text

Array = NDArray[np.float64]
WEAK_WIDTH = 0.5
"""An interval that is wider than this share of the search range says little: the parameter counts as weak."""


@dataclass(frozen=True)
class ParameterSummary:
    """One parameter: its estimate, and what stands behind it.

    `status` is `identified`, `weak` (its interval spans most of its range), `unidentifiable` (no recording of this kind
    determines it: see the null directions) or `bound` (its range, not the data, set it). `given` is its estimate with the fixed parameters
    known exactly.
    """

    estimate: Estimate
    unit: str
    range: tuple[float, float]
    status: str
    step: str
    given: Estimate | None = None


@dataclass(frozen=True)
class CalibrationSummary:
    """Everything a calibration tells, ready for JSON, tables and figures."""

    calibration: Calibration
    parameters: tuple[ParameterSummary, ...]
    structure: Structure
    null_directions: tuple[dict[str, float], ...]
    combinations: tuple[Estimate, ...]
    modes: tuple[tuple[Estimate, Estimate], ...]
    bootstrap: tuple[Estimate, ...]
    objective: dict[str, float]
    least_tyre_loads: dict[str, float]
    spread: dict[str, tuple[float, float]]
    provenance: dict[str, Any]

    def to_dict(self) -> dict[str, Any]:
        """Return plain data for JSON (SI units)."""
        calibration = self.calibration
        last = calibration.steps[-1]
        pivots = [self.structure.space.names[i] for i in self.structure.fixed_parameters]
        return {
            "vehicle": calibration.problem.trials[0].run.vehicle.name,
            "method": calibration.settings.method,
            "stopped": calibration.stopped,
            "parameters": {
                item.estimate.name: {
                    "value": item.estimate.value,
                    "interval": _pair(item.estimate),
                    "unit": item.unit,
                    "range": list(item.range),
                    "status": item.status,
                    "step": item.step,
                    "interval_given_pivots": _pair(item.given),
                }
                for item in self.parameters
            },
            "confidence": LEVEL,
            "rank": self.structure.rank,
            "searched": self.structure.space.size,
            "pivots": pivots,
            "null_directions": list(self.null_directions),
            "combinations": {item.name: {"value": item.value, "interval": _pair(item)} for item in self.combinations},
            "modes": [
                {
                    "name": hz.name,
                    "undamped_hz": hz.value,
                    "interval": _pair(hz),
                    "damping_ratio": zeta.value,
                    "damping_interval": _pair(zeta),
                }
                for hz, zeta in self.modes
            ],
            "bootstrap": {item.name: {"value": item.value, "interval": _pair(item)} for item in self.bootstrap},
            "objective": self.objective,
            "chi2": last.fits[0].chi2 if last.fits else None,
            "fits": [{"loss": fit.loss, "chi2": fit.chi2, "on_bound": list(fit.on_bound)} for fit in last.fits],
            "spread": {name: list(pair) for name, pair in self.spread.items()},
            "nuisances": _nuisances(last),
            "noise": _noise(last),
            "tyre_load_minimum": self.least_tyre_loads,
            "history": [list(step.state.history) for step in calibration.steps],
            "provenance": self.provenance,
        }

    def vehicle_text(self, folder: Path, name: str) -> str:
        """Return the calibrated vehicle file, which extends the vehicle that was calibrated."""
        calibration = self.calibration
        vehicle = calibration.problem.trials[0].run.vehicle
        runs = ", ".join(trial.name for trial in calibration.problem.trials)
        comments = [
            f"calibrated by vehgen {self.provenance['vehgen']}: {calibration.settings.method} from {runs}, seed {self.provenance['seed']}",
            f"comments give {LEVEL:.0%} intervals; 'unidentifiable' marks what recordings of this kind cannot determine one by one",
        ]
        notes = {}
        for item in self.parameters:
            pair = _pair(item.estimate)
            known = "" if pair is None else f" {pair[0]:.4g} to {pair[1]:.4g}"
            notes[item.estimate.name] = f"{item.status}{known}"
        title = f"{vehicle.title or vehicle.name}, calibrated"
        return variant_text(vehicle, folder, name, title, calibration.values, comments, notes)


def summarise(
    calibration: Calibration,
    prior_data: PriorData | None = None,
    combinations: Sequence[str] = (),
    replicates: int = 0,
    runner: Runner | None = None,
) -> CalibrationSummary:
    """Work out what a calibration tells.

    Parameters
    ----------
    calibration
        Finished or stopped.
    facts
        What was known from elsewhere.
    combinations
        Expressions of the vehicle's parameters to estimate beside those found automatically.
    replicates
        Size of a bootstrap that checks the intervals of the combinations and frequencies; 0 leaves it out.
    runner
        Where the bootstrap runs.
    """
    problem = calibration.problem
    structure = find_structure(problem, calibration.array)
    outcomes: list[ParameterSummary] = []
    ratios: list[Estimate] = []
    modes: tuple[tuple[Estimate, Estimate], ...] = ()
    boot: list[Estimate] = []
    for result in calibration.steps:
        own = None if prior_data is None else PriorData(result.problem, prior_data.facts)
        uncertainty = None
        if result.fits:
            uncertainty = Uncertainty(result.fits[0], find_structure(result.problem, result.fits[0].values), own)
        outcomes += _parameters(result, uncertainty, structure)
        if uncertainty is not None and result is calibration.steps[-1]:
            ratios = [*uncertainty.ratios(), *(uncertainty.combination(text) for text in combinations)]
            modes = tuple(uncertainty.frequencies())
            if replicates:
                boot = _bootstrap(result, uncertainty, own, ratios, replicates, calibration.settings.seed, runner or Runner())
    order = {name: i for i, name in enumerate(problem.space.names)}
    outcomes.sort(key=lambda item: order[item.estimate.name])
    return CalibrationSummary(
        calibration=calibration,
        parameters=tuple(outcomes),
        structure=structure,
        null_directions=tuple(structure.directions(calibration.array)),
        combinations=tuple(ratios),
        modes=modes,
        bootstrap=tuple(boot),
        objective=_objective(calibration),
        least_tyre_loads=least_tyre_loads(calibration),
        spread=_spread(calibration.steps[-1]),
        provenance=provenance(calibration),
    )


def _parameters(result: StepResult, uncertainty: Uncertainty | None, structure: Structure) -> list[ParameterSummary]:
    vehicle = result.problem.trials[0].run.vehicle
    space = result.problem.space
    bounds = result.fits[0].on_bound if result.fits else ()
    estimates = uncertainty.parameters() if uncertainty else [Estimate(name, value) for name, value in result.values.items()]
    given = uncertainty.given_fixed_parameters() if uncertainty else [None] * space.size
    found = []
    for i, (estimate, closed) in enumerate(zip(estimates, given, strict=True)):
        if estimate.name not in result.step.kept:
            continue
        if estimate.name in bounds:
            status = "bound"
        elif estimate.low is None or estimate.high is None:
            status = "unidentifiable" if uncertainty else "not assessed"
        else:
            low, high = (
                float(space.unit(np.where(np.arange(space.size) == i, end, space.start))[i]) for end in (estimate.low, estimate.high)
            )
            status = "weak" if high - low > WEAK_WIDTH else "identified"
        unit = quantity(vehicle, estimate.name, 1.0).partition(" ")[2]
        limits = (float(space.lower[i]), float(space.upper[i]))
        found.append(ParameterSummary(estimate, unit, limits, status, result.step.label, closed))
    return found


def _bootstrap(
    result: StepResult,
    uncertainty: Uncertainty,
    facts: PriorData | None,
    ratios: Sequence[Estimate],
    replicates: int,
    seed: int,
    runner: Runner,
) -> list[Estimate]:
    seeds = [int(item) for item in np.random.SeedSequence([seed, 3]).generate_state(replicates)]
    rows = np.array(list(runner.map(partial(refit, result.fits[0], facts=facts), seeds)))
    tail = 50 * (1 - LEVEL)
    found = []
    for estimate in ratios:
        spread = np.array([uncertainty.expression(estimate.name)(row) for row in rows])
        low, high = np.percentile(spread, [tail, 100 - tail])
        found.append(Estimate(estimate.name, estimate.value, float(low), float(high)))
    spread = np.array([uncertainty.mode_table(row)[0] for row in rows])
    for j, (hz, _) in enumerate(uncertainty.frequencies()):
        low, high = np.percentile(spread[:, j], [tail, 100 - tail])
        found.append(Estimate(f"{hz.name} [Hz]", hz.value, float(low), float(high)))
    return found


def _objective(calibration: Calibration) -> dict[str, float]:
    """Return Eq. 5's term of every channel at the result."""
    objective = PsdObjective(calibration.problem, calibration.settings.band)
    terms = objective.terms(calibration.array[None])[0]
    names = [f"{trial.name}: {channel}" for trial in calibration.problem.trials for channel in trial.channels]
    return {name: float(value) for name, value in zip(names, terms, strict=True)}


def least_tyre_loads(calibration: Calibration) -> dict[str, float]:
    """Return each axle's least tyre load over the runs as a share of its static load; below 0 a real tyre would have left the road."""
    found: dict[str, float] = {}
    for trial in calibration.problem.trials:
        vehicle = trial.run.vehicle
        simulator = Simulator(vehicle, [ElementOutput(f"load {name}", name, "tyre_force") for name in vehicle.axles], trial.run.forces())
        own = {name: value for name, value in calibration.values.items() if name not in trial.fixed}
        values = {name: (trial.values | own).get(name, 0.0) for name in simulator.model.parameters}
        response = simulator.run(np.array([list(values.values())]), trial.scenario).responses[0]
        for (name, load), force in zip(static_loads(simulator.model, values).axles.items(), response.T, strict=True):
            share = float((load + force.min()) / load) if load > 0 else float("nan")
            found[name] = min(share, found.get(name, share))
    return found


def _spread(result: StepResult) -> dict[str, tuple[float, float]]:
    """Return each parameter's least and largest value among the starts that fit as well as the best (-2 ln L within 4)."""
    good = [fit.values for fit in result.fits if fit.loss < result.fits[0].loss + 4.0]
    if len(good) < 2:
        return {}
    rows = np.array(good)
    return {name: (float(rows[:, i].min()), float(rows[:, i].max())) for i, name in enumerate(result.problem.space.names)}


def _nuisances(result: StepResult) -> dict[str, dict[str, float]]:
    if not result.fits:
        return {}
    fit = result.fits[0]
    names = fit.misfit.nuisances.names
    rows = fit.misfit.split(fit.x)[1]
    return {
        trial.name: {name: float(value) * getattr(fit.misfit.nuisances, name) for name, value in zip(names, row, strict=True)}
        for trial, row in zip(result.problem.trials, rows, strict=True)
    }


def _noise(result: StepResult) -> list[dict[str, Any]]:
    if not result.fits:
        return []
    return [
        {"run": name, "sigma": noise.sigma.tolist(), "road_level_m3": noise.levels.tolist()}
        for name, noise in result.fits[0].misfit.noises.items()
    ]


def provenance(calibration: Calibration) -> dict[str, Any]:
    """Return versions, inputs' hashes and settings: what it takes to make the result again."""
    import numba
    import scipy

    from vehgen import __version__

    files: dict[str, str] = {}
    for trial in calibration.problem.trials:
        run = trial.run
        for path in (
            run.document.position.file if run.document.position else None,
            run.folder / (run.file.recording or ""),
            *run.vehicle.files,
        ):
            if isinstance(path, Path) and path.is_file():
                files[path.name] = hashlib.sha256(read_bytes(path, MAX_TABLE_BYTES)).hexdigest()
    return {
        "vehgen": __version__,
        "python": platform.python_version(),
        "numpy": np.__version__,
        "scipy": scipy.__version__,
        "numba": numba.__version__,
        "seed": calibration.settings.seed,
        "settings": _plain(calibration.settings),
        "inputs": files,
    }


def _plain(settings: Settings) -> dict[str, Any]:
    found: Mapping[str, Any] = asdict(settings)
    return dict(found)


def _pair(estimate: Estimate | None) -> list[float] | None:
    return None if estimate is None or estimate.low is None or estimate.high is None else [estimate.low, estimate.high]
