"""What a mistake of one run or of a recorder does to the readings: a number each, fitted along with the base model."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy
from numpy.typing import NDArray

from vehgen.fit.adjustments import Adjustment, Gain, RunState, SensorDelay
from vehgen.fit.trial import Trial
from vehgen.road import Hump
from vehgen.road.track import Profile
from vehgen.simulate import Scenario

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
FILTER_ORDER = 4


@dataclass(frozen=True)
class RunGain(Gain):
    """A channel's reading over the truth in the run `run` only."""

    run: str = ""

    def response(self, trial: Trial, response: Array, numbers: Array, state: RunState | None = None) -> Array:
        """Return the readings with the channel times its number, in its run."""
        return super().response(trial, response, numbers, state) if trial.name == self.run else response

    def read_lines(self, trial: Trial, frequency: Array, numbers: Array, lines: Complex) -> Complex:
        """Return the lines with the channel's times its number, in its run."""
        return super().read_lines(trial, frequency, numbers, lines) if trial.name == self.run else lines


@dataclass(frozen=True)
class RunLevel(Adjustment):
    """What all channels read in the run `run` over what its file lets expect: a higher road does the same."""

    run: str = ""

    def response(self, trial: Trial, response: Array, numbers: Array, state: RunState | None = None) -> Array:
        """Return the readings times its number, in its run."""
        return np.asarray(response * numbers[0]) if trial.name == self.run else response

    def read_lines(self, trial: Trial, frequency: Array, numbers: Array, lines: Complex) -> Complex:
        """Return the lines times its number, in its run."""
        return np.asarray(lines * numbers[0]) if trial.name == self.run else lines


@dataclass(frozen=True)
class RunDelay(SensorDelay):
    """How late all channels of a sensor are in the run `run` only [s]."""

    run: str = ""

    def response(self, trial: Trial, response: Array, numbers: Array, state: RunState | None = None) -> Array:
        """Return the readings with the sensor's channels later, in its run."""
        return super().response(trial, response, numbers, state) if trial.name == self.run else response

    def read_lines(self, trial: Trial, frequency: Array, numbers: Array, lines: Complex) -> Complex:
        """Return the lines with the phases by which the sensor's channels are late, in its run."""
        return super().read_lines(trial, frequency, numbers, lines) if trial.name == self.run else lines


@dataclass(frozen=True)
class RecorderFilter(Adjustment):
    """The logarithm of the cut-off [Hz] of a Butterworth low-pass in `channels` of `runs`."""

    runs: tuple[str, ...] = ()
    channels: tuple[str, ...] = ()

    def response(self, trial: Trial, response: Array, numbers: Array, state: RunState | None = None) -> Array:
        """Return the readings filtered, in its runs and channels."""
        if trial.name not in self.runs:
            return response
        return np.where(self._slow(trial), scipy.signal.sosfilt(_sections(trial, numbers[0]), response, axis=-2), response)

    def read_lines(self, trial: Trial, frequency: Array, numbers: Array, lines: Complex) -> Complex:
        """Return the lines filtered, in its runs and channels."""
        if trial.name not in self.runs:
            return lines
        passed = scipy.signal.sosfreqz(_sections(trial, numbers[0]), frequency, fs=1 / trial.recording.dt)[1]
        return np.asarray(lines * np.where(self._slow(trial), passed[:, None], 1.0))

    def _slow(self, trial: Trial) -> NDArray[np.bool_]:
        return np.array([name in self.channels for name in trial.channels])


def _sections(trial: Trial, number: float) -> Array:
    """Return the second-order sections of the low-pass of a logarithmic cut-off."""
    cutoff = float(np.clip(np.exp(number), 0.5, 0.49 / trial.recording.dt))
    return np.asarray(scipy.signal.butter(FILTER_ORDER, cutoff, fs=1 / trial.recording.dt, output="sos"))


@dataclass(frozen=True)
class ClockRate(Adjustment):
    """How many seconds of a recorder's clock a second takes, in all runs."""

    def scenario(self, scenario: Scenario, value: float) -> Scenario:
        """Return the scenario with steps, and samples, that are as short as the clock is fast."""
        return replace(scenario, dt=scenario.dt / value, duration=scenario.duration / value)


@dataclass(frozen=True)
class AxleShift(Adjustment):
    """How much farther behind the first axle some axles run than the vehicle file says [m], by when the road comes to them.

    `moved` says of every axle, in the layout's order, whether it is one of them: 1, else 0.
    """

    moved: tuple[float, ...] = ()

    def scenario(self, scenario: Scenario, value: float) -> Scenario:
        """Return the scenario in which the road comes later to these axles."""
        return scenario.adjusted(farther=tuple(value * share for share in self.moved))


@dataclass(frozen=True)
class RoadBump(Adjustment):
    """The height of a bump that is on some roads, beside what the run files have [m]; below 0 it is a dip.

    `roads` holds the parts of each track that it is on, and where it begins there [m]; it is `length` [m] long, and a versine.
    """

    length: float = 1.0
    roads: tuple[tuple[tuple[Profile, ...], float], ...] = ()

    def scenario(self, scenario: Scenario, value: float) -> Scenario:
        """Return the scenario over the bump, where its road has it."""
        at = next((at for parts, at in self.roads if _begins_with(scenario.track.parts, parts)), None)
        return scenario if at is None or value == 0 else over_bump(scenario, at, self.length, value)


def over_bump(scenario: Scenario, at: float, length: float, height: float) -> Scenario:
    """Return a scenario over a versine, too, that begins at a place along the road, all in m."""
    hump = Hump.from_shape("versine", at, length, height)
    return replace(scenario, track=replace(scenario.track, parts=(*scenario.track.parts, hump)))


def _begins_with(parts: Sequence[Profile], first: Sequence[Profile]) -> bool:
    """Return whether parts of a road begin with these very ones; bumps that were added come behind."""
    return len(parts) >= len(first) and all(one is other for one, other in zip(parts, first, strict=False))
