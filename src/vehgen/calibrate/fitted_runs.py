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
from vehgen.fit.resolution import as_fine
from vehgen.fit.run_errors import RunErrors
from vehgen.fit.trial import Trial
from vehgen.measure import record_psd
from vehgen.measure.curves import ChannelCurves
from vehgen.mechanics import static_loads
from vehgen.mechanics.outputs import ElementOutput
from vehgen.simulate import Scenario, Simulator

Array = NDArray[np.float64]
IN_ALL_RUNS = "all runs"
"""What errors of sensors that are the same in all runs are listed under."""


def run_conditions(calibration: Calibration) -> tuple[ConditionSummary, ...]:
    """Return what each polished step supposes of each run, beside what was known of it."""
    found = []
    for step in _polished(calibration):
        for item in step.fits[0].conditions():
            run, place = item.run or IN_ALL_RUNS, item.place or "run"
            found.append(ConditionSummary(run, step.step.label, item.name, place, item.value, item.unit, item.sigma, item.sigmas))
    return tuple(found)


def fitted_responses(calibration: Calibration) -> list[Array]:
    """Return what the result's sensors read in every run as it was fitted, `shape (n_samples, n_channels)` each.

    A channel is simulated as the last step that used its sensor found the run, in that step's own steps of time, or else as the last step
    did; without a polish as the run file states it.
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
            x, t = step.fits[0].x, _number(step, trial)
            errors, fine = misfit.errors[t], as_fine(solved, misfit.problem.trials[t])
            motion = misfit.respond(t, own[None], misfit.adjusted(x), misfit.errors_of(x, t), fine)[0]
            every = RunErrors.of(solved, errors.common, errors.own, errors.known)
            response = np.where(used, every.read(motion, trial.recording.dt, misfit.errors_of(x, t)), response)
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


def _number(step: StepResult, trial: Trial) -> int:
    """Return the number of a run among those of a step."""
    return [item.name for item in step.problem.trials].index(trial.name)


def _scenario(calibration: Calibration, trial: Trial) -> Scenario:
    """Return a run's scenario as the last polished step found it, in its steps of time."""
    polished = _polished(calibration)
    if not polished:
        return trial.scenario
    fit, t = polished[-1].fits[0], _number(polished[-1], trial)
    fine = as_fine(trial, fit.misfit.problem.trials[t])
    return fit.misfit.errors[t].scenario(fine.scenario, fit.misfit.errors_of(fit.x, t))
