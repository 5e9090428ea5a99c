"""A trial: one run, what was measured in it, and the scenario that the model drives through in its place."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from vehgen.errors import ArgumentError, InputError, did_you_mean, shown
from vehgen.measure import Recording, read_recording
from vehgen.simulate import Run, RunLike, Scenario, Simulator, SimulatorPool, as_run, make_scenario
from vehgen.vehicle import Vehicle, VehicleLike, as_vehicle

Array = NDArray[np.float64]
LONGEST_STEP_S = 1e-3
"""Longest internal step [s]: through 10 ms steps a stiffness comes out 17 % wrong at 15 Hz (Newmark's period error)."""


@dataclass(frozen=True)
class Trial:
    """One run with its measurement, ready to be simulated.

    `values` are the vehicle's free parameters in this run before anything is searched [SI]; `fixed` names those that the run file sets
    itself, which no search changes. `jumps` tells of a response that jumps, as one with dry friction does (see
    :mod:`vehgen.fit.resolution`).
    """

    name: str
    run: Run
    recording: Recording
    simulator: Simulator
    scenario: Scenario
    values: dict[str, float]
    fixed: tuple[str, ...]
    jumps: bool = False

    @property
    def channels(self) -> tuple[str, ...]:
        """Names of the measured channels."""
        return tuple(channel.name for channel in self.recording.channels)

    def of_sensors(self, sensors: Sequence[str], simulators: SimulatorPool) -> Trial:
        """Return the trial with some of its sensors only.

        Raises
        ------
        InputError
            For a sensor that the run does not have.
        """
        for sensor in sensors:
            if sensor not in self.run.file.sensors:
                raise InputError(f"{self.name} has no sensor {shown(sensor)}; {did_you_mean(sensor, self.run.file.sensors)}")
        measurement = self.recording.of_sensors(tuple(sensors))
        return replace(self, recording=measurement, simulator=_simulator(self.run, measurement, simulators))

    def with_vehicle(self, vehicle: Vehicle, simulators: SimulatorPool) -> Trial:
        """Return the trial with another vehicle that has at least its parameters; `simulators` are shared."""
        run = replace(self.run, vehicle=vehicle)
        simulator = _simulator(run, self.recording, simulators)
        values = simulator.model.values(overrides=run.values())
        return replace(self, run=run, simulator=simulator, values=values)


TrialLike = Trial | RunLike
"""A trial, a run with a recording, or its file."""


def load_trials(runs: TrialLike | Sequence[TrialLike], vehicle: VehicleLike | None = None) -> list[Trial]:
    """Return runs with their recordings, ready to be simulated.

    Parameters
    ----------
    runs
        Run files, runs, or trials that stay as they are; a single one is taken for a list of one.
    vehicle
        In place of the one that the runs name: itself, its file, or the name of a bundled model.

    Raises
    ------
    InputError
        For a run that cannot be used, with its place.
    """
    own = None if vehicle is None else as_vehicle(vehicle)
    simulators = SimulatorPool()
    trials: list[Trial] = []
    for item in [runs] if isinstance(runs, Trial | Run | str | os.PathLike) else runs:
        trial, path = _trial(item, own, simulators)
        taken = {other.name for other in trials}
        trials.append(replace(trial, name=trial.name if trial.name not in taken else path))
    if not trials:
        raise ArgumentError("`runs`: at least one run was expected", "runs")
    return trials


def _trial(item: TrialLike, vehicle: Vehicle | None, simulators: SimulatorPool) -> tuple[Trial, str]:
    """Return the trial that an argument means, and its path."""
    if isinstance(item, Trial):
        return (item if vehicle is None or item.run.vehicle is vehicle else item.with_vehicle(vehicle, simulators)), item.name
    if not isinstance(item, Run | str | os.PathLike):
        raise ArgumentError(f"`runs`: run files, runs or trials were expected, found {type(item).__name__}", "runs")
    run = as_run(item, vehicle)
    path = run.document.position.file if isinstance(item, Run) and run.document.position else item
    return make_trial(run, Path(str(path)).stem, simulators), str(path)


def make_trial(run: Run, name: str, simulators: SimulatorPool | None = None) -> Trial:
    """Read a run's recording and lay out its scenario on the recording's clock.

    Parameters
    ----------
    run
        A run with a recording.
    name
        What to call it.
    simulators
        Simulators that trials with the same vehicle and channels share.
    """
    measurement = read_recording(run)
    dt = measurement.dt
    decimation = samples_kept(run, dt)
    step = dt / decimation
    length = float(measurement.time[-1] - measurement.time[0])
    simulator = _simulator(run, measurement, simulators or SimulatorPool())
    values = simulator.model.values(overrides=run.values())
    timed = replace(run, file=run.file.model_copy(update={"duration": float(measurement.time[-1])}))
    scenario = replace(
        make_scenario(timed, simulator.model, values), duration=length, dt=step, decimation=decimation, start=float(measurement.time[0])
    )
    _check_length(run, scenario, simulator, values, name)
    return Trial(name, run, measurement, simulator, scenario, values, tuple(run.file.parameters))


def samples_kept(run: Run, dt: float) -> int:
    """Return every how many steps a recording sampled at `dt` [s] is kept, where nothing asks for shorter steps."""
    return max(1, round(dt / min(run.file.step, LONGEST_STEP_S)))


def _simulator(run: Run, measurement: Recording, simulators: SimulatorPool) -> Simulator:
    outputs = tuple(channel.output for channel in measurement.channels)
    return simulators.simulator(run.vehicle, outputs, run.forces())


def _check_length(run: Run, scenario: Scenario, simulator: Simulator, values: dict[str, float], name: str) -> None:
    """Refuse a recording that ends before the last axle has met the hump."""
    humps = [entry.hump for entry in run.file.road if entry.hump is not None]
    offsets = simulator.model.wheel_offsets(values)
    travelled = float(scenario.speed.distance(np.array([scenario.start + scenario.duration]))[0])
    if humps and travelled < max(hump.at for hump in humps) + float(offsets.max(initial=0.0)):
        raise InputError(
            f"{name}: the recording ends after {travelled:.1f} m, before the last axle ({offsets.max(initial=0.0):.1f} m behind the first) "
            f"has met the hump at {max(hump.at for hump in humps):.1f} m: record until the vehicle has left it",
            run.document.find(("recording",)),
        )
