"""What sensors read of what they should, as factors of spectral lines, and how that changes with their errors.

A sensor tilted nose-down by t reads a cos t - g pitch sin t, one that sits d further forward a - d pitch''; a late clock turns phases.
What a low-pass takes off more than supposed is exp(-r x^2 - s x^8 - i (d x^3 + e x^7)) at x times half the rate of the recording: the
first powers are a soft low-pass's, the others those of a steep one (see `LOW_PASS_POWERS`).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from vehgen.mechanics import GRAVITY

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
LOW_PASS_POWERS = {"roll_off": (2, 1.0), "edge": (8, 1.0), "dispersion": (3, 1j), "edge_dispersion": (7, 1j)}
"""By error, the power of x, and whether it takes off or turns the phase. Up to x = 0.8 they follow Butterworth and Bessel low-passes of
order 2 to 8, cut off at 0.41 to 0.46 of the rate, within 1.5 % below x = 0.5; the first and third alone within 4 %."""


@dataclass(frozen=True)
class Reading:
    """What every channel reads, line by line.

    Attributes
    ----------
    frequency, rate
        The lines' frequencies `shape (n_lines,)` and the recording's rate [Hz].
    channels
        Name, sensor and quantity of every channel.
    values
        The errors by name and place [their units].
    turned
        Each channel's factor but for its tilt, `shape (n_lines, n_channels)`.
    beside
        The pitch rate's column that an accelerometer's channel reads along, by that channel's.
    """

    frequency: Array
    rate: float
    channels: tuple[tuple[str, str, str], ...]
    values: Mapping[tuple[str, str], float]
    turned: Complex
    beside: Mapping[int, int]

    @classmethod
    def of(
        cls, frequency: Array, rate: float, channels: tuple[tuple[str, str, str], ...], values: Mapping[tuple[str, str], float], late: Array
    ) -> Reading:
        """Return what channels read whose clocks are `late shape (n_channels,)` [s]."""
        omega, x = 2 * np.pi * frequency, 2 * frequency / rate
        turned = np.ones((len(frequency), len(channels)), dtype=np.complex128)
        for i, (name, sensor, _) in enumerate(channels):
            passed = {error: values.get((error, sensor), 0.0) for error in LOW_PASS_POWERS}
            if late[i] or any(passed.values()):
                turned[:, i] = np.exp(-1j * late[i] * omega + sum(value * _exponent(error, x) for error, value in passed.items() if value))
            turned[:, i] *= 1 + values.get(("gain", name), 0.0)
        columns = {sensor: i for i, (_, sensor, quantity) in enumerate(channels) if quantity == "pitch_rate"}
        beside = {
            i: columns[sensor] for i, (_, sensor, quantity) in enumerate(channels) if quantity == "acceleration" and sensor in columns
        }
        return cls(frequency, rate, channels, values, turned, beside)

    def apply(self, lines: Complex) -> Complex:
        """Return what the channels read of spectral lines of motions `shape (..., n_lines, n_channels)`."""
        found = self.turned * lines
        for i, column in self.beside.items():
            tilt, shift = self._mounting(self.channels[i][1])
            if tilt or shift:
                along = self.turned[:, i] * 1j * (GRAVITY * math.sin(tilt) * self._pitch - shift * self._omega)
                found[..., i] = math.cos(tilt) * found[..., i] + along * lines[..., column]
        return np.asarray(found)

    def slope(self, name: str, place: str, lines: Complex, read: Complex) -> Complex:
        """Return the derivative of what is read by an error [per its unit], `shape (n_lines, n_channels)`; windows stand.

        Parameters
        ----------
        name, place
            The error.
        lines, read
            Lines of motions, and what the channels read of them, both `shape (n_lines, n_channels)`.
        """
        x = 2 * self.frequency / self.rate
        factor = -1j * self._omega if name in ("clock", "lag") else _exponent(name, x) if name in LOW_PASS_POWERS else None
        found = np.zeros_like(read)
        for i, (channel, sensor, quantity) in enumerate(self.channels):
            if factor is not None and sensor == place and (name != "lag" or quantity == "pitch_rate"):
                found[:, i] = factor * read[:, i]
            elif name == "gain" and channel == place:
                found[:, i] = read[:, i] / (1 + self.values.get(("gain", channel), 0.0))
            elif name in ("tilt", "position") and sensor == place and i in self.beside:
                found[:, i] = self.turned[:, i] * self._mounted(name, sensor, lines[:, i], lines[:, self.beside[i]])
        return found

    def _mounted(self, name: str, sensor: str, acceleration: Complex, pitch_rate: Complex) -> Complex:
        """Return the derivative by tilt or position of what an accelerometer reads."""
        if name == "position":
            return np.asarray(-1j * self._omega * pitch_rate)
        tilt, _ = self._mounting(sensor)
        return np.asarray(-math.sin(tilt) * acceleration + 1j * GRAVITY * math.cos(tilt) * self._pitch * pitch_rate)

    def _mounting(self, sensor: str) -> tuple[float, float]:
        return self.values.get(("tilt", sensor), 0.0), self.values.get(("position", sensor), 0.0)

    @cached_property
    def _omega(self) -> Array:
        return np.asarray(2 * np.pi * self.frequency)

    @cached_property
    def _pitch(self) -> Array:
        """A pitch over its rate, but for the phase; that at rest is taken off."""
        omega = self._omega
        return np.divide(1.0, omega, out=np.zeros_like(omega), where=omega > 0)


def _exponent(error: str, x: Array) -> Complex:
    """Return what an error of a low-pass adds to the exponent of a factor, per unit, at x `shape (n,)` times half the rate."""
    power, way = LOW_PASS_POWERS[error]
    return np.asarray(-way * x**power, dtype=np.complex128)
