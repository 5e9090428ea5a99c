"""Work out what a calibration tells: intervals, what cannot be told, how well it fits, tyre loads, and where it all came from."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import asdict
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vehgen.calibrate.bootstrap import bootstrap_intervals
from vehgen.calibrate.calibration import Calibration, StepResult
from vehgen.calibrate.combinations import combination_unit, identifiable_ratios
from vehgen.calibrate.fitted_runs import (
    fitted_responses,
    least_tyre_loads,
    measured_and_simulated,
    objective_terms,
    run_conditions,
)
from vehgen.calibrate.held_masses import find_held_masses
from vehgen.calibrate.identifiability import find_structure
from vehgen.calibrate.intervals import LEVEL, Estimate, Uncertainty, run_chi2
from vehgen.calibrate.prior_data_advice import advise_prior_data
from vehgen.calibrate.result import (
    CalibrationSummary,
    CombinationSummary,
    ConditionSummary,
    FitSummary,
    Interval,
    ModeSummary,
    NoiseSummary,
    ParameterSummary,
    RecorderSummary,
)
from vehgen.calibrate.step_intervals import step_uncertainties
from vehgen.effects.locator import undamped_tyres
from vehgen.files.provenance import file_hashes, versions
from vehgen.fit.parallel import Runner
from vehgen.fit.prior_data import PriorData
from vehgen.simulate.run_file.files_read import files_read
from vehgen.vehicle import Vehicle
from vehgen.vehicle.writing import quantity

Array = NDArray[np.float64]
WEAK_WIDTH = 0.5
"""An interval that is wider than this share of the search range says little: the parameter counts as weak."""


def summarise(
    calibration: Calibration,
    prior_data: PriorData | None = None,
    combinations: Sequence[str] = (),
    replicates: int = 0,
    runner: Runner | None = None,
) -> CalibrationSummary:
    """Work out what a calibration, finished or stopped, tells.

    Parameters
    ----------
    calibration, prior_data
        The calibration; what was known from elsewhere.
    combinations
        Expressions of the vehicle's parameters to estimate beside those found automatically.
    replicates, runner
        Size of a bootstrap that checks the intervals of the combinations and frequencies (0 leaves it out), and where it runs.
    """
    problem = calibration.problem
    structure = find_structure(problem, calibration.array)
    found: dict[str, ParameterSummary] = {}
    last, known = calibration.steps[-1], step_uncertainties(problem, calibration.steps, prior_data)
    uncertainty = known[-1]
    for result, own in zip(calibration.steps, known, strict=True):
        found |= _parameters(result, uncertainty or own)
    asked = () if uncertainty is None else tuple(uncertainty.combination(text) for text in combinations)
    ratios = () if uncertainty is None else (*asked, *identifiable_ratios(uncertainty))
    boot: list[Estimate] = []
    if uncertainty is not None and replicates:
        boot = bootstrap_intervals(calibration, uncertainty, prior_data, ratios, replicates, runner or Runner())
    conditions, responses = run_conditions(calibration), fitted_responses(calibration)
    psds, histories = measured_and_simulated(calibration, responses)
    return CalibrationSummary(
        vehicle=problem.trials[0].run.vehicle.name,
        method=calibration.settings.method,
        stopped=calibration.stopped,
        parameters={name: found[name] for name in problem.space.names if name in found},
        confidence=LEVEL,
        rank=structure.rank,
        searched=structure.space.size,
        pivots=tuple(structure.space.names[i] for i in structure.fixed_parameters),
        null_directions=tuple(structure.directions(calibration.array)),
        combinations=_combinations(ratios, problem.trials[0].run.vehicle),
        modes=() if uncertainty is None else _modes(uncertainty),
        bootstrap=_combinations(boot),
        objective=objective_terms(calibration, responses),
        chi2=last.fits[0].chi2 if last.fits else None,
        fits=tuple(FitSummary(fit.loss, fit.chi2, tuple(fit.on_bound)) for fit in last.fits),
        spread=_spread(last),
        nuisances=_nuisances(conditions, last.step.label),
        noise=_noise(last),
        tyre_load_minimum=least_tyre_loads(calibration),
        history=tuple(tuple(step.state.history) for step in calibration.steps),
        steps=tuple(step.step.label for step in calibration.steps),
        band=calibration.settings.band,
        psds=psds,
        histories=histories,
        provenance=provenance(calibration, prior_data),
        calibration=calibration,
        conditions=conditions,
        run_chi2=run_chi2(last.fits[0]) if last.fits else {},
        interval_inflation=1.0 if uncertainty is None else uncertainty.inflation,
        prior_data_advice=() if uncertainty is None else advise_prior_data(uncertainty, prior_data),
        recorder=tuple(_recorders(calibration)),
        undamped_tyres=undamped_tyres(problem.trials[0].run.vehicle, problem.space.names),
        held_masses=find_held_masses(problem, structure, calibration.array),
    )


def _parameters(result: StepResult, uncertainty: Uncertainty | None) -> dict[str, ParameterSummary]:
    vehicle = result.problem.trials[0].run.vehicle
    space = result.problem.space if uncertainty is None else uncertainty.structure.space
    bounds = result.fits[0].on_bound if result.fits else ()
    estimates = uncertainty.parameters() if uncertainty else [Estimate(name, value) for name, value in result.values.items()]
    given = uncertainty.given_fixed_parameters() if uncertainty else [None] * space.size
    found: dict[str, ParameterSummary] = {}
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
        found[estimate.name] = ParameterSummary(
            estimate.value, _interval(estimate), unit, limits, status, result.step.label, _interval(closed)
        )
    return found


def _spread(result: StepResult) -> dict[str, tuple[float, float]]:
    """Return each parameter's least and largest value among the starts that fit as well as the best (-2 ln L within 4)."""
    good = [fit.values for fit in result.fits if fit.loss < result.fits[0].loss + 4.0]
    if len(good) < 2:
        return {}
    rows = np.array(good)
    return {name: (float(rows[:, i].min()), float(rows[:, i].max())) for i, name in enumerate(result.problem.space.names)}


def _nuisances(conditions: Sequence[ConditionSummary], step: str) -> dict[str, dict[str, float]]:
    """Return what a step supposes of each run as a whole, by name."""
    own = [item for item in conditions if item.step == step and item.place == "run"]
    return {run: {item.name: item.value for item in own if item.run == run} for run in dict.fromkeys(item.run for item in own)}


def _noise(result: StepResult) -> tuple[NoiseSummary, ...]:
    noises = result.fits[0].misfit.noises if result.fits else {}
    return tuple(NoiseSummary(name, noise.sigma, noise.levels) for name, noise in noises.items())


def _recorders(calibration: Calibration) -> Iterator[RecorderSummary]:
    for step in calibration.steps:
        if (found := step.recorder) is None:
            continue
        for channels, known in found.parts:
            low_pass = known.best.chain.filter, known.best.chain.order, known.best.chain.cut_off
            yield RecorderSummary(step.step.label, channels, *low_pass, known.is_clear, found.band[1], found.describe())


def provenance(calibration: Calibration, prior_data: PriorData | None) -> dict[str, Any]:
    """Return versions, inputs' hashes and settings: what it takes to make the result again."""
    also = () if prior_data is None or prior_data.file is None else (prior_data.file,)
    files = files_read([trial.run for trial in calibration.problem.trials], also=also)
    settings = asdict(calibration.settings)
    return {**versions(), "seed": calibration.settings.seed, "settings": settings, "inputs": file_hashes(files)}


def _modes(uncertainty: Uncertainty) -> tuple[ModeSummary, ...]:
    pairs = uncertainty.frequencies()
    return tuple(ModeSummary(hz.name, hz.value, _interval(hz), zeta.value, _interval(zeta)) for hz, zeta in pairs)


def _combinations(estimates: Sequence[Estimate], vehicle: Vehicle | None = None) -> dict[str, CombinationSummary]:
    """Return estimates by name, those that are named by an expression of the vehicle's parameters with its unit."""
    units = {item.name: "" if vehicle is None else combination_unit(vehicle, item.name) for item in estimates}
    return {item.name: CombinationSummary(item.value, _interval(item), units[item.name]) for item in estimates}


def _interval(estimate: Estimate | None) -> Interval | None:
    return None if estimate is None or estimate.low is None or estimate.high is None else (estimate.low, estimate.high)
