"""From what moves to numbers: low-pass filters at a fine rate, sampling at a clock's moments, noise and quantisation."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import interpolate, signal

Array = NDArray[np.float64]
RATE = 4000.0
"""At which motions are known and filters work [Hz]: far above every sampling rate, so that aliasing is real."""


@dataclass(frozen=True)
class Filter:
    """A causal low-pass: `kind` butterworth, bessel or none; order; -3 dB frequency [Hz]."""

    kind: str
    order: int
    cutoff: float

    def apply(self, values: Array) -> Array:
        """Return values `shape (n, ...)` at RATE, filtered along the first axis from a steady start."""
        if self.kind == "none":
            return values
        if self.kind == "butterworth":
            sections = signal.butter(self.order, self.cutoff, output="sos", fs=RATE)
        elif self.kind == "bessel":
            sections = signal.bessel(self.order, self.cutoff, norm="mag", output="sos", fs=RATE)
        else:
            raise ValueError(f"unknown filter {self.kind!r}; one of butterworth, bessel, none")
        steady = signal.sosfilt_zi(sections).reshape(len(sections), 2, *([1] * (values.ndim - 1))) * values[0]
        filtered, _ = signal.sosfilt(sections, values, axis=0, zi=np.broadcast_to(steady, (len(sections), 2, *values.shape[1:])))
        return np.asarray(filtered)


def sample(values: Array, start: float, moments: Array) -> Array:
    """Return values `shape (n, ...)`, at RATE from the time `start` [s] on, at other moments [s] by cubic interpolation.

    Raises ValueError where a moment lies outside of what is known.
    """
    end = start + (len(values) - 1) / RATE
    if np.min(moments) < start or np.max(moments) > end:
        raise ValueError(f"asked for {np.min(moments):.3f} to {np.max(moments):.3f} s, known from {start:.3f} to {end:.3f} s")
    times = start + np.arange(len(values)) / RATE
    return np.asarray(interpolate.CubicSpline(times, values, axis=0)(moments))


@dataclass(frozen=True)
class Noise:
    """A sensor's own noise: density [unit/sqrt(Hz)] of its white part, and the corner [Hz] below which it rises as 1/f."""

    density: float
    corner: float = 0.0

    def draw(self, shape: tuple[int, ...], rng: np.random.Generator) -> Array:
        """Return noise at RATE, `shape (n, ...)`, before any filter."""
        white = rng.standard_normal(shape) * self.density * np.sqrt(RATE / 2.0)
        if self.corner == 0.0:
            return np.asarray(white)
        lines = np.fft.rfft(white, axis=0)
        frequency = np.maximum(np.fft.rfftfreq(shape[0], 1.0 / RATE), RATE / shape[0])
        gain = np.sqrt(1.0 + self.corner / frequency)
        return np.asarray(np.fft.irfft(lines * gain.reshape(-1, *([1] * (len(shape) - 1))), shape[0], axis=0))


def quantised(values: Array, step: float, limit: float) -> Array:
    """Return values cut at +-limit and rounded to multiples of `step`."""
    return np.asarray(np.round(np.clip(values, -limit, limit) / step) * step)
