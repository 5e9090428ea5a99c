"""Two phones' clocks against each other, by what both recorded of one rough road: no hump and no vehicle is needed.

The shift between the clocks is where the two correlate best. Places far apart need not move at once, so the shift holds the time that the
road takes from one axle to the next: phases between phones are known up to a delay, magnitudes are not touched by it. The drift between the
clocks, some millionths, is where the two are most coherent: over ten minutes it turns phases by whole cycles.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

from vehgen.errors import InputError
from vehgen.measure.transmissibility import segment_transforms
from vehgen.phones.export import PhoneExport

Array = NDArray[np.float64]
CORRELATED_BAND_HZ = (0.5, 20.0)
"""Motions that are compared [Hz]: below, phones drift; above, clocks that are a little off tell nothing."""
LOUDNESS_WINDOW_S = 2.0
"""Recordings are divided by their running RMS of this length, so that one pothole does not outweigh the drive."""
LEAST_SIGNIFICANCE = 8.0
"""The best correlation must be so many times the usual one; of chance alone the best of 100 000 shifts is about 4.5 times."""
MAX_DRIFT = 1e-3
"""Of two clocks: phones' oscillators are within some 50 millionths, times that a logger makes of a nominal rate may be off by more."""
SHORTEST_FOR_DRIFT_S = 60.0
"""In less time two clocks drift apart by some milliseconds, which is too little to be found and to matter."""
DRIFT_STEP_CYCLES = 0.1
"""Drifts are tried so finely that the phase at the end of the drive and the top of the band moves by so much."""


@dataclass(frozen=True)
class ClockMap:
    """Which moment of another phone's clock belongs to a moment of the first's: about `middle` [s], `shift` later, `drift` faster."""

    shift: float = 0.0
    drift: float = 0.0
    middle: float = 0.0

    def at(self, time: Array) -> Array:
        """Return moments on the other's clock [s] of moments on the first's [s]."""
        return np.asarray(time + self.shift + self.drift * (time - self.middle))

    def inverse(self, time: Array) -> Array:
        """Return moments on the first's clock [s] of moments on the other's [s]."""
        return np.asarray((time - self.shift + self.drift * self.middle) / (1 + self.drift))


def find_shift(first: tuple[Array, Array], other: tuple[Array, Array], least: float, names: tuple[str, str]) -> float:
    """Return how much later the other's clock reads at one moment [s].

    Parameters
    ----------
    first, other
        Times `shape (n,)` [s], both by the same even step, and accelerations `shape (n,)`.
    least
        The two must overlap by this much [s].
    names
        What errors call the two.

    Raises
    ------
    InputError
        Where they nowhere overlap so long, or have nothing in common.
    """
    step = float(first[0][1] - first[0][0])
    a, b = (_levelled(values, step) for _, values in (first, other))
    lags = np.arange(-(len(a) - 1), len(b))
    overlap = np.minimum(len(a), len(b) - lags) - np.maximum(0, -lags)
    allowed = overlap * step >= least
    if not allowed.any():
        raise InputError(
            f"{names[0]} and {names[1]} recorded {len(a) * step:.4g} and {len(b) * step:.4g} s; at least {least:.4g} s together are "
            "needed: record longer"
        )
    size = scipy.fft.next_fast_len(len(a) + len(b) - 1, real=True)
    product = scipy.fft.irfft(scipy.fft.rfft(a, size).conj() * scipy.fft.rfft(b, size), size)
    score = np.where(allowed, np.abs(product[lags]) / np.sqrt(np.maximum(overlap, 1)), 0.0)
    best = int(np.argmax(score))
    usual = float(np.median(score[allowed])) / 0.6745
    if score[best] < LEAST_SIGNIFICANCE * usual:
        raise InputError(
            f"{names[0]} and {names[1]} have nothing in common at any shift of their clocks (best correlation {score[best] / usual:.1f} "
            f"times the usual one, at least {LEAST_SIGNIFICANCE:g} were expected): were both in one vehicle, on one drive, and are the "
            "times of both measured, not made of a nominal rate?"
        )
    return float(other[0][0] - first[0][0] + step * lags[best])


def find_drift(time: Array, first: Array, other: Array, segment: float) -> float:
    """Return how much faster the other's clock runs, relative, by the coherence of what both recorded.

    Parameters
    ----------
    time
        Evenly spaced `shape (n,)` [s].
    first, other
        Accelerations at these times, the shift between the clocks taken away, `shape (n,)`.
    segment
        Length of the segments [s] that are held to be free of drift.

    Returns
    -------
    The drift; 0 for less than SHORTEST_FOR_DRIFT_S.
    """
    if time[-1] - time[0] < SHORTEST_FOR_DRIFT_S:
        return 0.0
    step = float(time[1] - time[0])
    lines = segment_transforms(np.column_stack([first, other]), step, segment).between(*CORRELATED_BAND_HZ)
    middle = lines.middle - (time[-1] - time[0]) / 2
    cross = lines.values[:, :, 0].conj() * lines.values[:, :, 1]
    power = (np.abs(lines.values) ** 2).sum(axis=0)
    scale = np.maximum(power[:, 0] * power[:, 1], np.finfo(float).tiny)

    def coherence(drift: float) -> float:
        turned = (cross * np.exp(2j * np.pi * drift * middle[:, None] * lines.frequency)).sum(axis=0)
        return float((np.abs(turned) ** 2 / scale).mean())

    fine = DRIFT_STEP_CYCLES / (CORRELATED_BAND_HZ[1] * float(time[-1] - time[0]))
    drifts = fine * np.arange(-int(MAX_DRIFT / fine), int(MAX_DRIFT / fine) + 1)
    best = float(drifts[np.argmax([coherence(drift) for drift in drifts])])
    closer = best + fine * np.linspace(-1, 1, 21)
    return float(closer[np.argmax([coherence(drift) for drift in closer])])


def check_epochs(first: PhoneExport, span: tuple[float, float], other: PhoneExport, other_span: tuple[float, float], names: str) -> None:
    """Refuse two phones whose world clocks say that they recorded at different times; `span` is begin and end on the own clock [s].

    Raises
    ------
    InputError
        Where the two have no moment in common.
    """
    if first.epoch is None or other.epoch is None:
        return
    begins = first.epoch.at(span[0]), other.epoch.at(other_span[0])
    ends = first.epoch.at(span[1]), other.epoch.at(other_span[1])
    pause = max(begins) - min(ends)
    if pause >= 0:
        raise InputError(
            f"{names}: by their world clocks the later began {pause:.4g} s after the other had ended; recordings of one drive, at one "
            "time, were expected"
        )


def epoch_shift(first: PhoneExport, other: PhoneExport, moment: float, other_moment: float) -> float | None:
    """Return how much later [s] the other's clock reads by the apps' world clocks, None where either has none; by one moment of each."""
    if first.epoch is None or other.epoch is None:
        return None
    return other_moment - moment - (other.epoch.at(other_moment) - first.epoch.at(moment))


def _levelled(values: Array, step: float) -> Array:
    """Return the band that is compared, everywhere equally loud."""
    low, high = CORRELATED_BAND_HZ
    band = scipy.signal.butter(2, (low, min(high, 0.4 / step)), btype="bandpass", fs=1 / step, output="sos")
    level = scipy.signal.sosfiltfilt(band, values - values.mean())
    loudness = np.sqrt(scipy.ndimage.uniform_filter1d(level**2, max(round(LOUDNESS_WINDOW_S / step), 1)))
    return np.asarray(level / np.maximum(loudness, 0.05 * float(np.median(loudness)) + np.finfo(float).tiny))
