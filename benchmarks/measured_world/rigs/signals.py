"""What an actuator or a servo is told to do: smooth functions of time that begin at rest, with their derivatives."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import make_interp_spline

from benchmarks.measured_world.chain import RATE

Array = NDArray[np.float64]
FADE = 0.5
"""In which a signal grows from rest to its full size [s]."""


@dataclass(frozen=True, eq=False)
class Signal:
    """A function of time with two derivatives: polynomials between moments at RATE, `shape (intervals, degree + 1)`, highest power first,
    for each derivative; at rest without any."""

    pieces: tuple[Array, ...] = ()

    def value(self, t: Any) -> Any:
        """Return the signal at t [s]."""
        return self._at(0, t)

    def rate(self, t: Any) -> Any:
        """Return its first derivative."""
        return self._at(1, t)

    def acceleration(self, t: Any) -> Any:
        """Return its second derivative."""
        return self._at(2, t)

    def _at(self, order: int, t: Any) -> Any:
        if not self.pieces:
            return 0.0 * t
        pieces = self.pieces[order]
        if isinstance(t, float):
            i = min(int(t * RATE), len(pieces) - 1)
            powers, x = pieces[i].tolist(), t - i / RATE
        else:
            interval = np.minimum((t * RATE).astype(int), len(pieces) - 1)
            powers, x = pieces[interval].T, t - interval / RATE
        found = powers[0]
        for power in powers[1:]:
            found = found * x + power
        return found


REST = Signal()


def sampled(values: Array) -> Signal:
    """Return the smooth signal through values at RATE from t = 0 on."""
    spline = make_interp_spline(np.arange(len(values)) / RATE, values, k=5)
    knots = np.arange(len(values) - 1) / RATE
    derivatives = [spline(knots, order) / math.factorial(order) for order in range(6)]
    value = np.stack(derivatives[::-1], axis=1)
    rate = value[:, :-1] * np.arange(5.0, 0.0, -1.0)
    return Signal((value, rate, rate[:, :-1] * np.arange(4.0, 0.0, -1.0)))


def moments(duration: float) -> Array:
    """Return times at RATE [s], a little beyond a duration."""
    return np.arange(round((duration + 0.05) * RATE) + 1) / RATE


def faded(t: Array, values: Array) -> Array:
    """Return values that grow from rest over FADE, without a jump in their second derivative."""
    x = np.clip(t / FADE, 0.0, 1.0)
    return values * x**3 * (10.0 - 15.0 * x + 6.0 * x**2)


def sinusoid(duration: float, amplitude: float, frequency: float) -> Array:
    """Return amplitude*sin(2 pi frequency t), faded in."""
    t = moments(duration)
    return faded(t, amplitude * np.sin(2.0 * np.pi * frequency * t))


def sweep(duration: float, speed: float, low: float, high: float, most: float) -> Array:
    """Return a logarithmic sweep from `low` to `high` [Hz] whose rate has the amplitude `speed`, and its travel `most` at most."""
    t = moments(duration)
    ratio = np.log(high / low)
    frequency = low * np.exp(ratio * t / duration)
    phase = 2.0 * np.pi * low * duration / ratio * (np.exp(ratio * t / duration) - 1.0)
    amplitude = 1.0 / (1.0 / most + 2.0 * np.pi * frequency / speed)
    return faded(t, amplitude * np.sin(phase))


def random(duration: float, rms: float, low: float, high: float, fall: float, rng: np.random.Generator) -> Array:
    """Return a sum of sinusoids of random phase from `low` to `high` [Hz], amplitudes falling as frequency**-fall, of an rms."""
    t = moments(duration)
    frequencies = np.arange(low, high, 1.0 / duration)
    phases = rng.uniform(0.0, 2.0 * np.pi, len(frequencies))
    values = np.zeros_like(t)
    for frequency, phase in zip(frequencies, phases, strict=True):
        values += (frequency / low) ** -fall * np.sin(2.0 * np.pi * frequency * t + phase)
    return faded(t, rms * values / np.std(values))
