"""What may be wrong with a run or a sensor rather than with the vehicle: one number each, the same in all runs.

A fit carries an adjustment's number along with the vehicle's parameters, in units of `scale` and without a prior.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
import scipy.integrate
from numpy.typing import NDArray

from vehgen.fit.trial import Trial
from vehgen.mechanics import GRAVITY
from vehgen.simulate import Scenario

Array = NDArray[np.float64]


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

    def response(self, trial: Trial, response: Array, numbers: Array) -> Array:
        """Return what the sensors would have read, `shape (n, n_samples, n_channels)`.

        `numbers` holds its own number, then those of the adjustments after it: one that needs two is followed by a plain one.
        """
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

    def response(self, trial: Trial, response: Array, numbers: Array) -> Array:
        """Return the readings with the channel times its number."""
        factors = np.array([numbers[0] if name == self.place else 1.0 for name in trial.channels])
        return np.asarray(response * factors)


class SensorDelay(Adjustment):
    """How late all channels of a sensor are [s]."""

    def response(self, trial: Trial, response: Array, numbers: Array) -> Array:
        """Return the readings with the sensor's channels `numbers[0]` [s] later, by the phase of their Fourier transform."""
        late = np.array([channel.sensor == self.place for channel in trial.recording.channels])
        n, dt = response.shape[-2], trial.recording.dt
        pad = np.zeros((*response.shape[:-2], n, response.shape[-1]))
        frequency = np.fft.rfftfreq(2 * n, dt)
        turned = np.fft.rfft(np.concatenate([response, pad], axis=-2), axis=-2) * np.exp(-2j * np.pi * frequency * numbers[0])[:, None]
        shifted = np.fft.irfft(turned, 2 * n, axis=-2)[..., :n, :]
        return np.where(late, shifted, response)


class Tilt(Adjustment):
    """The nose-down angle of a sensor on its body [rad].

    Its acceleration then reads a_z cos(tilt) - g sin(tilt) pitch, what it reads at rest taken off; the body's fore-aft acceleration is
    left out. The pitch is the integral of the sensor's own pitch rate.
    """

    def response(self, trial: Trial, response: Array, numbers: Array) -> Array:
        """Return the readings with the sensor tilted by `numbers[0]` [rad]."""
        columns = {channel.quantity: i for i, channel in enumerate(trial.recording.channels) if channel.sensor == self.place}
        if "acceleration" not in columns or "pitch_rate" not in columns:
            return response
        pitch = scipy.integrate.cumulative_trapezoid(response[..., columns["pitch_rate"]], dx=trial.recording.dt, axis=-1, initial=0.0)
        changed = response.copy()
        column = columns["acceleration"]
        changed[..., column] = response[..., column] * np.cos(numbers[0]) - GRAVITY * np.sin(numbers[0]) * pitch
        return changed
