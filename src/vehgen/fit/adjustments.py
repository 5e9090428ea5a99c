"""What may be wrong with a run or a sensor rather than with the vehicle: one number each, the same in all runs.

A fit carries an adjustment's number along with the vehicle's parameters, in units of `scale` and without a prior.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
import scipy
from numpy.typing import NDArray

from vehgen.fit.trial import Trial
from vehgen.mechanics import GRAVITY, PointOutput
from vehgen.mechanics.outputs import fore_aft_row
from vehgen.simulate import Scenario

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]


@dataclass(frozen=True)
class RunState:
    """What a fit supposes of a run beside its adjustments: the `scenario` that it drives through, clocks, vehicles.

    `late` is how late every channel's clock is [s], `shape (n_channels,)`, by which the recording is, and the response not yet (default:
    none is); `vehicles` are the parameters [SI] behind each response (default: those of the vehicle file).
    """

    scenario: Scenario
    late: Array | None = None
    vehicles: tuple[Mapping[str, float], ...] = ()


@dataclass(frozen=True)
class Adjustment:
    """Something about all runs or one sensor that a single number changes; this one changes nothing.

    `place` is a sensor, a channel, or the runs; `scale` the size of a typical change, 0 for a number that stands; `neutral` the number
    that changes nothing; `low` and `high` bound it.
    """

    place: str
    scale: float = 1.0
    neutral: float = 0.0
    low: float = -math.inf
    high: float = math.inf

    @property
    def bounds(self) -> tuple[float, float]:
        """Its bounds in units of its scale, about its neutral number."""
        if self.scale == 0:
            return -math.inf, math.inf
        return (self.low - self.neutral) / self.scale, (self.high - self.neutral) / self.scale

    def scenario(self, scenario: Scenario, value: float) -> Scenario:
        """Return the scenario as it was, at the number `value`."""
        return scenario

    def response(self, trial: Trial, response: Array, numbers: Array, state: RunState | None = None) -> Array:
        """Return what the sensors would have read, `shape (n, n_samples, n_channels)`.

        `numbers` holds its own number, then those of the adjustments after it: one that needs two is followed by a plain one. `state` is
        what is supposed of the run besides (default: that it went as stated).
        """
        return response

    def read_lines(self, trial: Trial, frequency: Array, numbers: Array, lines: Complex) -> Complex:
        """Return what the sensors would have read of spectral lines `shape (..., n, n_channels)` at frequencies `shape (n,)` [Hz].

        `numbers` as for :meth:`response`. What reaches sensors without being simulated, as roughness does, is read so, too.
        """
        return lines


def adjust(items: Sequence[Adjustment], trial: Trial, response: Array, numbers: Array, state: RunState | None = None) -> Array:
    """Return what the sensors would have read with all of some adjustments, one after the other, at `numbers shape (len(items),)`."""
    for i, item in enumerate(items):
        response = item.response(trial, response, numbers[i:], state)
    return response


class SpeedScale(Adjustment):
    """The true speed over that of the run files."""

    def scenario(self, scenario: Scenario, value: float) -> Scenario:
        """Return the scenario at `value` times its speed."""
        return scenario.adjusted(speed=value, anchor=scenario.first_arrival)


class Footprint(Adjustment):
    """The tyres' contact length [m]."""

    def scenario(self, scenario: Scenario, value: float) -> Scenario:
        """Return the scenario with the road averaged over `value` [m]."""
        return replace(scenario, track=replace(scenario.track, footprint=abs(value)))


class Gain(Adjustment):
    """A channel's reading over the truth."""

    def response(self, trial: Trial, response: Array, numbers: Array, state: RunState | None = None) -> Array:
        """Return the readings with the channel times its number."""
        return np.asarray(response * self._gains(trial, numbers[0]))

    def read_lines(self, trial: Trial, frequency: Array, numbers: Array, lines: Complex) -> Complex:
        """Return the lines with the channel's times its number."""
        return np.asarray(lines * self._gains(trial, numbers[0]))

    def _gains(self, trial: Trial, number: float) -> Array:
        return np.array([number if name == self.place else 1.0 for name in trial.channels])


class SensorDelay(Adjustment):
    """How late all channels of a sensor are [s]."""

    def response(self, trial: Trial, response: Array, numbers: Array, state: RunState | None = None) -> Array:
        """Return the readings with the sensor's channels `numbers[0]` [s] later, by the phase of their Fourier transform."""
        n, dt = response.shape[-2], trial.recording.dt
        pad = np.zeros((*response.shape[:-2], n, response.shape[-1]))
        phases = self._phases(trial, np.asarray(np.fft.rfftfreq(2 * n, dt), dtype=np.float64), numbers[0])
        shifted = np.fft.irfft(np.fft.rfft(np.concatenate([response, pad], axis=-2), axis=-2) * phases, 2 * n, axis=-2)[..., :n, :]
        return np.where(self._late(trial), shifted, response)

    def read_lines(self, trial: Trial, frequency: Array, numbers: Array, lines: Complex) -> Complex:
        """Return the lines with the phases by which the sensor's channels are late."""
        return np.asarray(lines * self._phases(trial, frequency, numbers[0]))

    def _phases(self, trial: Trial, frequency: Array, number: float) -> Complex:
        return np.asarray(np.where(self._late(trial), np.exp(-2j * np.pi * frequency * number)[:, None], 1.0))

    def _late(self, trial: Trial) -> NDArray[np.bool_]:
        return np.array([channel.sensor == self.place for channel in trial.recording.channels])


@dataclass(frozen=True)
class Tilt(Adjustment):
    """The nose-down angle of a sensor on its body [rad]; the next number is its height above where the run file has it [m].

    Its acceleration then reads a_z cos(tilt) + (a_x - g pitch) sin(tilt), what it reads at rest taken off. The pitch is the integral of the
    sensor's own pitch rate; the fore-aft acceleration a_x follows from the pitch accelerations of the bodies that are hinged to its own,
    as far as pitch rates of them are recorded, at the file's masses and lengths.
    """

    _known: dict[int, tuple[Trial, Array]] = field(default_factory=dict, repr=False, compare=False)

    def response(self, trial: Trial, response: Array, numbers: Array, state: RunState | None = None) -> Array:
        """Return the readings with the sensor tilted by `numbers[0]` [rad] and `numbers[1]` [m] higher."""
        if (columns := self._columns(trial)) is None:
            return response
        (column, own), dt = columns, trial.recording.dt
        pitch = scipy.integrate.cumulative_trapezoid(response[..., own], dx=dt, axis=-1, initial=0.0)
        forward = _derivative(response @ self._shares(trial, own, numbers[1]), dt)
        changed = response.copy()
        changed[..., column] = response[..., column] * np.cos(numbers[0]) + (forward - GRAVITY * pitch) * np.sin(numbers[0])
        return changed

    def read_lines(self, trial: Trial, frequency: Array, numbers: Array, lines: Complex) -> Complex:
        """Return the lines as a sensor that is tilted so reads them."""
        if (columns := self._columns(trial)) is None:
            return lines
        (column, own), turning = columns, 2j * np.pi * frequency
        pitch = np.divide(lines[..., own], turning, out=np.zeros_like(lines[..., own]), where=frequency > 0)
        forward = turning * (lines @ self._shares(trial, own, numbers[1]))
        changed = lines.copy()
        changed[..., column] = lines[..., column] * np.cos(numbers[0]) + (forward - GRAVITY * pitch) * np.sin(numbers[0])
        return changed

    def _columns(self, trial: Trial) -> tuple[int, int] | None:
        """Return the columns of the sensor's acceleration and pitch rate; None where it has not both."""
        found = {channel.quantity: i for i, channel in enumerate(trial.recording.channels) if channel.sensor == self.place}
        return (found["acceleration"], found["pitch_rate"]) if {"acceleration", "pitch_rate"} <= set(found) else None

    def _shares(self, trial: Trial, own: int, higher: float) -> Array:
        """Return the fore-aft acceleration of a sensor so much higher [m] per rate of every channel's change, `shape (n_channels,)` [m]."""
        if id(trial) not in self._known:
            self._known[id(trial)] = trial, fore_aft_shares(trial, self.place)  # with the trial, whose number no other one then takes
        shares = self._known[id(trial)][1].copy()
        shares[own] += higher
        return shares


def fore_aft_shares(trial: Trial, sensor: str) -> Array:
    """Return a sensor's fore-aft velocity per unit of each channel, `shape (n_channels,)` [m]: 0 for all but pitch rates of bodies."""
    model, shares = trial.simulator.model, np.zeros(len(trial.channels))
    place = next(item.output.place for item in trial.recording.channels if item.sensor == sensor and isinstance(item.output, PointOutput))
    row = fore_aft_row(place, place.locate(model.vehicle, model.layout), model.motion, model.energies)
    values = dict(zip(row, model.evaluate_list(row.values(), trial.values), strict=True))
    for i, channel in enumerate(model.channels):
        if channel.quantity == "pitch_rate":
            shares[i] = sum(values.pop(j, 0.0) for j in channel.velocity if model.coordinates[j].motion == "pitch")
    return shares


def _derivative(signal: Array, dt: float) -> Array:
    """Return the rate of change of signals `shape (..., n_samples)`."""
    return _turned(signal, np.asarray(2j * np.pi * np.fft.rfftfreq(2 * signal.shape[-1], dt)))


def shifted(signals: Array, dt: float, later: Array) -> Array:
    """Return signals `shape (n_samples, n_channels)`, each so much later [s], `shape (n_channels,)`."""
    frequency = np.fft.rfftfreq(2 * len(signals), dt)
    return _turned(signals.T, np.exp(-2j * np.pi * later[:, None] * frequency)).T


def _turned(signal: Array, factors: NDArray[np.complexfloating]) -> Array:
    """Return signals `shape (..., n_samples)` with their spectral lines times factors; mirrored, so that their ends meet."""
    n = signal.shape[-1]
    both = np.concatenate([signal, signal[..., ::-1]], axis=-1)
    return np.asarray(np.fft.irfft(factors * np.fft.rfft(both), 2 * n)[..., :n])
