"""A trial: one run, what was measured in it, and the scenario that the model drives through in its place."""

from __future__ import annotations

import math
import os
import warnings
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from vehgen.errors import ArgumentError, InputError, ModelWarning, did_you_mean, shown
from vehgen.fit.recording import Recording, read_recording
from vehgen.fit.run_checks import check_hump_reached, check_initial, check_inputs_last
from vehgen.fit.window import AFTER_RELEASE, RAMP, Window
from vehgen.road import Hump
from vehgen.simulate import Run, RunLike, Scenario, Simulator, SimulatorPool, as_run, make_scenario, natural_modes
from vehgen.simulate.acquired import assumed_chains, channel_factors
from vehgen.simulate.initial_state import initial_state
from vehgen.simulate.profile_warnings import profiles_that_end
from vehgen.simulate.run_file.acquisition import channel_chains
from vehgen.simulate.warnings import far_places
from vehgen.vehicle import Vehicle, VehicleLike, as_vehicle

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
AT_REST_SAMPLES, AT_REST_SHARE = 3, 0.2
"""A vehicle rests at the begin of a recording whose first samples are all below this share of what it does later."""
FORGOTTEN = 4.0
"""After so many decay times 2 % of a motion are left."""
EARLIER_S = 0.5
"""A run that was recorded from its humps on is simulated from so long before the first: its clock may be wrong."""
MOST_LEFT_OUT = 0.01
"""No more than this share of a recording is left out at its end for quicker transforms: its last moments count little anyway."""
QUICK_PRIME = 13
"""Transforms of numbers without larger prime factors take up to 1.6 times as long as the quickest; of a prime near 1500, nine times."""
MOST_SKIPPED = 0.5
"""No more than this share of a recording is left out."""
LINE_WIDTH, LINE_LEAKS = 0.03, 2.5
"""A line that is no noise reaches this share of its frequency to both sides, or else so many lines."""
LONGEST_STEP_S = 1e-3
"""Longest internal step [s]: through 10 ms steps a stiffness comes out 17 % wrong at 15 Hz (Newmark's period error)."""
SLOW_PERIOD_ERROR = 1e-3
"""Where only slow motions are compared, to begin a fit, steps may be so long that Newmark's scheme errs by this share of their period."""
WORTH_LONGER = 1.5
"""They are made longer by this factor at least, or not at all."""


@dataclass(frozen=True)
class Trial:
    """One run with its measurement, ready to be simulated.

    `values` are the vehicle's free parameters in this run before anything is searched [SI]; `fixed` names those that the run file sets
    itself, which no search changes. `jumps` tells of a response that jumps, as one with dry friction does (see
    :mod:`vehgen.fit.resolution`); `lines` are frequencies [Hz] of what shakes the vehicle all the time and is no noise.
    """

    name: str
    run: Run
    recording: Recording
    simulator: Simulator
    scenario: Scenario
    values: dict[str, float]
    fixed: tuple[str, ...]
    jumps: bool = False
    lines: tuple[float, ...] = ()

    @property
    def channels(self) -> tuple[str, ...]:
        """Names of the measured channels."""
        return tuple(channel.name for channel in self.recording.channels)

    @property
    def fade_in(self) -> float:
        """How long the record fades in [s]: where the run file states how it begins, its first moments are known."""
        scenario = self.scenario
        if scenario.initial is None or scenario.skipped:
            return RAMP
        chains = assumed_chains(scenario, self.channels)
        return 0.0 if all(chain.filtering().is_point_sample for chain in chains) else AFTER_RELEASE

    @property
    def window(self) -> Window:
        """How the record is seen: of what drives no road the sensors' zeros count for nothing."""
        return Window(self.fade_in, not self.scenario.track.parts or self.fade_in < RAMP)

    def channel_factors(self, frequency: Array) -> Complex:
        """Return what the recorders make of spectral lines of the channels: factors `shape (n, n_channels)` at frequencies [Hz]."""
        return channel_factors(self.scenario, self.channels, frequency)

    def beside_lines(self, frequency: Array) -> NDArray[np.bool_]:
        """Return which of the spectral lines of a record, at evenly spaced frequencies [Hz], none of the trial's `lines` reaches."""
        beside = np.ones(len(frequency), dtype=np.bool_)
        for line in self.lines:
            beside &= np.abs(frequency - line) > max(LINE_WIDTH * line, LINE_LEAKS * float(frequency[1] - frequency[0]))
        return beside

    def for_slow_motions(self, highest: float) -> Trial:
        """Return the trial as it serves for motions up to a frequency [Hz]: with the longest step, and no filter that leaves them as is.

        Its samples are at the same times. The period error of the scheme is (omega dt)^2 / 12 to the first order; see SLOW_PERIOD_ERROR.
        A run with forces, or over anything but humps, stays as it is: what shakes it fast folds onto slow motions.
        """
        scenario, dt = self.scenario, self.recording.dt
        longest = math.sqrt(12 * SLOW_PERIOD_ERROR) / (2 * math.pi * highest)
        decimation = math.ceil(dt / longest * (1 - 1e-9))
        driven = bool(scenario.forces) or any(item is not None for item in scenario.ground)
        if driven or not scenario.over_humps_alone or decimation * WORTH_LONGER > scenario.decimation:
            return self
        chains = {name: scenario.chain(name).for_slow_motions(highest, 1 / dt) for name in self.channels}
        step = scenario.dt * scenario.decimation / decimation
        return replace(self, scenario=replace(scenario, dt=step, decimation=decimation, chains=chains))

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
        scenario = self.scenario
        if scenario.initial is not None:  # another vehicle may have other coordinates
            scenario = replace(scenario, initial=initial_state(run, simulator.model))
        return replace(self, run=run, simulator=simulator, values=values, scenario=scenario)


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
    count = _quick_count(len(measurement.time))
    measurement = replace(measurement, time=measurement.time[:count], values=measurement.values[:count])
    dt = measurement.dt
    decimation = samples_kept(run, dt)
    step = dt / decimation
    length = float(measurement.time[-1] - measurement.time[0])
    simulator = _simulator(run, measurement, simulators or SimulatorPool())
    values = simulator.model.values(overrides=run.values())
    timed = replace(run, file=run.file.model_copy(update={"duration": float(measurement.time[-1])}))
    begin = float(measurement.time[0])
    scenario = make_scenario(timed, simulator.model, values, min(begin, 0.0))  # a late clock's vehicle may still be at 0 m as it begins
    scenario = replace(scenario, duration=length, dt=step, decimation=decimation, start=begin)
    scenario = replace(scenario, chains=channel_chains(run, 1 / dt))
    check_hump_reached(run, scenario, simulator.model.wheel_offsets(values), name)
    check_inputs_last(run, scenario, measurement, simulator.model)
    check_initial(run, measurement, simulator, scenario, values)
    for message in (*far_places(simulator.model, values, run.places()), *profiles_that_end(scenario)):
        warnings.warn(ModelWarning(f"{name}: {message}"), stacklevel=3)
    scenario = _from_the_first_hump(scenario)
    return _from_known_road(Trial(name, run, measurement, simulator, scenario, values, tuple(run.file.parameters)))


def _from_the_first_hump(scenario: Scenario) -> Scenario:
    """Return the scenario of a recording that begins on humps, or between them, from before the first: the vehicle moves as it begins.

    What is simulated before the recording is not kept. Runs that something else drives, too, stay as they are.
    """
    driven = bool(scenario.forces) or any(signal is not None for signal in scenario.ground)
    if not scenario.over_humps_alone or driven or scenario.initial is not None or scenario.start <= 0:
        return scenario
    dt, reach = scenario.dt * scenario.decimation, scenario.track.footprint / 2
    before = np.asarray(scenario.start - dt * np.arange(1, math.floor(scenario.start / dt) + 1), dtype=np.float64)
    met = scenario.speed.distance(before) > min(hump.at for hump in scenario.humps) - reach
    ahead = min(int(met.sum()) + math.ceil(EARLIER_S / dt), len(before)) if met.any() else 0
    return replace(scenario, start=scenario.start - ahead * dt, duration=scenario.duration + ahead * dt, skipped=ahead)


def _from_known_road(trial: Trial) -> Trial:
    """Return a run over a road that continues one that nobody measured from when the vehicle has forgotten that one.

    That is so many decay times of its slowest motion after its last axle has come to the known road. A recording that begins at rest is
    left as it is, and so is one over humps alone: they stand on a road that is even but for what the noise holds.
    """
    scenario, recording = trial.scenario, trial.recording
    rough = [part for part in scenario.track.parts if not isinstance(part, Hump)]
    size = np.sqrt(np.mean(recording.values**2, axis=0))
    if not rough or np.all(np.sqrt(np.mean(recording.values[:AT_REST_SAMPLES] ** 2, axis=0)) < AT_REST_SHARE * size):
        return trial
    offsets = trial.simulator.model.wheel_offsets(trial.values)
    known = float(scenario.speed.distance(np.array([scenario.first_arrival]))[0]) + float(offsets.max(initial=0.0))
    arrived = float(np.interp(known, scenario.speed.distance(scenario.time), scenario.time))
    rates = [2 * np.pi * mode.pole_hz * mode.damping_ratio for mode in natural_modes(trial.simulator.model, trial.values)]
    settled = arrived - float(recording.time[0]) + FORGOTTEN * max((1 / rate for rate in rates if rate > 0), default=0.0)
    skipped = min(round(settled / recording.dt), round(MOST_SKIPPED * len(recording.time)))
    skipped = len(recording.time) - _quick_count(len(recording.time) - skipped)
    kept = replace(recording, time=recording.time[skipped:], values=recording.values[skipped:])
    return replace(trial, recording=kept, scenario=replace(scenario, skipped=skipped))


def _quick_count(count: int) -> int:
    """Return how many of so many samples are kept: a few less where their number has large prime factors, and Fourier transforms dawdle."""
    least = math.ceil((1 - MOST_LEFT_OUT) * count)
    largest = {kept: _largest_prime_factor(kept) for kept in range(count, least - 1, -1)}
    return next((kept for kept, prime in largest.items() if prime <= QUICK_PRIME), min(largest, key=largest.__getitem__, default=count))


def _largest_prime_factor(number: int) -> int:
    factor, left, found = 2, number, 1
    while factor * factor <= left:
        while left % factor == 0:
            left, found = left // factor, factor
        factor += 1
    return max(left, found)


def samples_kept(run: Run, dt: float) -> int:
    """Return every how many steps a recording sampled at `dt` [s] is kept, where nothing asks for shorter steps."""
    return max(1, round(dt / min(run.file.step, LONGEST_STEP_S)))


def _simulator(run: Run, measurement: Recording, simulators: SimulatorPool) -> Simulator:
    outputs = tuple(channel.output for channel in measurement.channels)
    return simulators.simulator(run.vehicle, outputs, run.forces())
