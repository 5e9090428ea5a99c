"""Shock response spectra: how far an acceleration drives oscillators of every frequency, by Smallwood's ramp-invariant filter.

D. O. Smallwood, An improved recursive formula for calculating shock response spectra, Shock and Vibration Bulletin 51(2), 1981, 211-217;
the method of ISO 18431-4:2007. It is exact for accelerations that are straight between samples.
"""

from __future__ import annotations

import numpy as np
import scipy
from numpy.typing import NDArray

Array = NDArray[np.float64]
USUAL_QUALITY = 10.0
"""Amplification at resonance of the oscillators: 5 % of critical damping."""
SAMPLES_A_PERIOD = 10.0
"""An oscillator's peak is found to 5 % where so many samples lie in its period."""
LINES_PER_OCTAVE = 6


def spectrum_frequencies(rate: float, low: float = 1.0, high: float = 200.0) -> Array:
    """Return natural frequencies [Hz], a sixth of an octave apart, from `low` to what a sampling rate [Hz] allows, at most `high`."""
    top = min(high, rate / SAMPLES_A_PERIOD)
    count = max(0, int(np.floor(LINES_PER_OCTAVE * np.log2(max(top / low, 1.0)) + 1e-9)))
    return np.asarray(low * 2.0 ** (np.arange(count + 1) / LINES_PER_OCTAVE))


def shock_response(acceleration: Array, dt: float, frequency: Array, quality: float = USUAL_QUALITY) -> Array:
    """Return the largest magnitude of the absolute acceleration of oscillators on a moving base (maximax), while it moves and after.

    Parameters
    ----------
    acceleration
        Of the base `shape (n,)` [m/s^2]; it rests before and after.
    dt
        Spacing of the samples [s].
    frequency
        Undamped natural frequencies `shape (m,)` [Hz], above 0.
    quality
        Q of the oscillators, above 0.5.

    Returns
    -------
    `shape (m,)` [m/s^2].
    """
    found = np.empty(len(frequency))
    for i, natural in enumerate(frequency):
        rest = np.zeros(int(np.ceil(1.0 / (natural * dt))) + 1)  # the largest swing after the end comes within one period
        numerator, denominator = ramp_invariant_filter(float(natural), dt, quality)
        found[i] = np.abs(scipy.signal.lfilter(numerator, denominator, np.concatenate([acceleration, rest]))).max()
    return found


def ramp_invariant_filter(natural: float, dt: float, quality: float) -> tuple[Array, Array]:
    """Return numerator and denominator, `shape (3,)` each, of the filter from a base's acceleration to that of an oscillator."""
    damping = 1.0 / (2.0 * quality)
    angle = 2.0 * np.pi * natural * dt
    turn = angle * np.sqrt(1.0 - damping**2)
    decay = np.exp(-damping * angle)
    cosine, sine = decay * np.cos(turn), decay * np.sin(turn)
    slope = sine / turn
    return np.array([1.0 - slope, 2.0 * (slope - cosine), decay**2 - slope]), np.array([1.0, -2.0 * cosine, decay**2])
