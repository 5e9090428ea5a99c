"""Noise of a recording where the vehicle is at rest: noise floor, and acceleration clipped at the sensor's range."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.signal
from numpy.typing import NDArray

from vehgen.measure.spectra import welch_psd
from vehgen.phones.export import Stream

Array = NDArray[np.float64]
NOISE_BAND_WIDTH_HZ = 3.0
"""Width of the band at the top of the spectrum, where a vehicle does nothing [Hz]."""
NOISE_BAND_TOP_HZ = 50.0
"""Top of that band [Hz], where the sensor is fast enough."""
FLAT = 3
"""So many equal samples in a row at the extreme count as clipped ..."""
FAR = 4.0
"""... where the extreme is so many standard deviations from the mean."""


@dataclass(frozen=True)
class NoiseFloor:
    """Standard deviation `sigma` of a channel's quiet stretch, and `band_sigma`, that of white noise as strong as its `band` [Hz]."""

    sigma: float
    band_sigma: float
    band: tuple[float, float]


def noise_floor(values: Array, step: float, sensor_rate: float) -> NoiseFloor:
    """Return the noise floor of a channel's quiet stretch.

    Parameters
    ----------
    values
        Evenly spaced samples `shape (n,)`.
    step
        Their spacing [s].
    sensor_rate
        Rate at which the sensor sampled [Hz]; above half of it there is nothing.
    """
    level = scipy.signal.detrend(values)
    top = min(NOISE_BAND_TOP_HZ, 0.5 / step, 0.5 * sensor_rate)
    frequency, density = welch_psd(values, step, segment=1.0)
    inside = (frequency >= top - NOISE_BAND_WIDTH_HZ - 1e-9) & (frequency <= top + 1e-9)
    band_sigma = float(np.sqrt(density[inside].mean() * 0.5 / step))
    return NoiseFloor(float(level.std()), band_sigma, (top - NOISE_BAND_WIDTH_HZ, top))


def clipped(stream: Stream) -> list[tuple[str, float, float]]:
    """Return where axes are clipped, as (axis, extreme, time [s]): flat tops at an axis's largest or smallest value."""
    found = []
    for column, values in zip(stream.columns, stream.values.T, strict=True):
        middle, spread = float(np.median(values)), float(np.std(values))
        for extreme in (float(values.max()), float(values.min())):
            if abs(extreme - middle) <= FAR * spread or not spread:
                continue
            flat = np.convolve(values == extreme, np.ones(FLAT), mode="valid") > FLAT - 0.5
            if flat.any():
                found.append((column, extreme, float(stream.time[int(np.argmax(flat))])))
    return found
