"""The runs of a calibration as it found them: what each was fitted to be, and what the vehicle does in it.

A fit finds the clock, speed and hump height of every run along with the parameters. What is scored, drawn or warned of is simulated at
these: at the stated speed a good fit would look like a bad one. All that reads them from a fit stands here.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from vehgen.calibrate.calibration import Calibration, StepResult
from vehgen.calibrate.objective import PsdObjective
from vehgen.calibrate.result import ConditionSummary
from vehgen.fit.trial import Trial
from vehgen.measure import record_psd
from vehgen.measure.curves import ChannelCurves
from vehgen.mechanics import static_loads
from vehgen.mechanics.outputs import ElementOutput
from vehgen.simulate import Scenario, Simulator

Array = NDArray[np.float64]
CONDITION_UNITS = {"delay": "s"}
"""Of what is fitted of a run; all else is relative."""


def run_conditions(calibration: Calibration) -> tuple[ConditionSummary, ...]:
    """Return what each polished step supposes of each run, beside what was known of it."""
    found = []
    for step in _polished(calibration):
        misfit = step.fits[0].misfit
        for trial in step.problem.trials:
            for name, value in zip(misfit.nuisances.names, _errors(step, trial), strict=True):
                prior = float(getattr(misfit.nuisances, name))
                unit = CONDITION_UNITS.get(name, "")
                found.append(ConditionSummary(trial.name, step.step.label, name, "run", float(value) * prior, unit, prior, float(value)))
    return tuple(found)


def fitted_responses(calibration: Calibration) -> list[Array]:
    """Return what the result's sensors read in every run as it was fitted, `shape (n_samples, n_channels)` each.

    A channel is simulated as the last step that used its sensor found the run, or else as the last step did; without a polish as the run
    file states it.
    """
    problem, found = calibration.problem, []
    polished = _polished(calibration)
    for trial in problem.trials:
        response = problem.respond(calibration.array[None], trial)[0][0]
        solved = replace(trial, values=problem.values_of(calibration.array, trial))
        for number, step in enumerate((*polished[-1:], *polished)):
            misfit = step.fits[0].misfit
            used = np.array([number == 0 or channel.sensor in step.step.sensors for channel in trial.recording.channels])
            own = np.array([calibration.values[name] for name in step.problem.space.names])
            answer = misfit.respond(solved, own[None], misfit.adjusted(step.fits[0].x), _errors(step, trial))[0]
            response = np.where(used, answer, response)
        found.append(response)
    return found


def objective_terms(calibration: Calibration, responses: list[Array]) -> dict[str, float]:
    """Return Eq. 5's term of every channel at responses of all runs."""
    terms = PsdObjective(calibration.problem, calibration.settings.band).compare(responses)
    names = [f"{trial.name}: {channel}" for trial in calibration.problem.trials for channel in trial.channels]
    return {name: float(value) for name, value in zip(names, terms, strict=True)}


def measured_and_simulated(calibration: Calibration, responses: list[Array]) -> tuple[tuple[ChannelCurves, ...], tuple[ChannelCurves, ...]]:
    """Return PSDs and histories, measured beside responses of all runs."""
    psds, histories = [], []
    for trial, simulated in zip(calibration.problem.trials, responses, strict=True):
        for i, channel in enumerate(trial.recording.channels):
            pair = (trial.recording.values[:, i], simulated[:, i])
            frequency = record_psd(pair[0], trial.recording.dt)[0]
            name = trial.name, channel.name, channel.quantity
            psds.append(ChannelCurves(*name, frequency, *(record_psd(item, trial.recording.dt)[1] for item in pair)))
            histories.append(ChannelCurves(*name, trial.recording.time, *pair))
    return tuple(psds), tuple(histories)


def least_tyre_loads(calibration: Calibration) -> dict[str, float]:
    """Return each axle's least tyre load over the runs as a share of its static load; below 0 a real tyre would have left the road."""
    found: dict[str, float] = {}
    for trial in calibration.problem.trials:
        vehicle = trial.run.vehicle
        simulator = Simulator(vehicle, [ElementOutput(f"load {name}", name, "tyre_force") for name in vehicle.axles], trial.run.forces())
        own = {name: value for name, value in calibration.values.items() if name not in trial.fixed}
        values = {name: (trial.values | own).get(name, 0.0) for name in simulator.model.parameters}
        response = simulator.run(np.array([list(values.values())]), _scenario(calibration, trial)).responses[0]
        for (name, load), force in zip(static_loads(simulator.model, values).axles.items(), response.T, strict=True):
            share = float((load + force.min()) / load) if load > 0 else float("nan")
            found[name] = min(share, found.get(name, share))
    return found


def _polished(calibration: Calibration) -> list[StepResult]:
    return [step for step in calibration.steps if step.fits]


def _errors(step: StepResult, trial: Trial) -> Array:
    """Return what a step fitted of a run, in units of its priors' standard deviations."""
    fit = step.fits[0]
    rows = fit.misfit.split(fit.x)[1]
    return np.asarray(rows[[item.name for item in step.problem.trials].index(trial.name)])


def _scenario(calibration: Calibration, trial: Trial) -> Scenario:
    """Return a run's scenario as the last polished step found it."""
    polished = _polished(calibration)
    return polished[-1].fits[0].misfit.nuisances.adjust(trial.scenario, _errors(polished[-1], trial)) if polished else trial.scenario
