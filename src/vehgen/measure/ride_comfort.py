"""Whole-body vibration as ISO 2631-1:1997 weighs it: frequency weightings, weighted RMS, MTVV and VDV.

A weighting is the product of the analogue transfer functions of the standard's Annex A: a two-pole Butterworth band limit, the transition
from acceleration to velocity, and an upward step. It is applied in the frequency domain, so that no sampling rate bends it. Wb is that of
ISO 2631-4:2001 (BS 6841:1987 gives it 0.4 times a like gain); the numbers of all weightings stand together in ISO 8041-1:2017.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
RUNNING_TIME = 1.0
"""Integration time of the running RMS [s] (ISO 2631-1, 6.3.1)."""
SETTLING = 10.0
"""In so many seconds the slowest pole, 0.4 Hz of the band limit, falls to 2e-8: so long a record is followed by zeros."""
MOST_CREST, MOST_MTVV, MOST_VDV = 9.0, 1.5, 1.75
"""Crest factor, MTVV over RMS and VDV over RMS T^(1/4) above which ISO 2631-1 (6.2.1, 6.3.3) holds the RMS for too little."""
REACTIONS = (
    (0.0, 0.315, "not uncomfortable"),
    (0.315, 0.63, "a little uncomfortable"),
    (0.5, 1.0, "fairly uncomfortable"),
    (0.8, 1.6, "uncomfortable"),
    (1.25, 2.5, "very uncomfortable"),
    (2.0, float("inf"), "extremely uncomfortable"),
)
"""From and to which weighted RMS [m/s^2] people react how (ISO 2631-1, C.2.3)."""


@dataclass(frozen=True)
class Weighting:
    """A frequency weighting: corner frequencies [Hz] and quality factors of the standard's Annex A, and a gain.

    The band limit is from `f1` to `f2`, the transition has `f3`, `f4` and `q4`, the upward step `f5`, `q5`, `f6`, `q6` (0: it has none).
    """

    name: str
    f3: float
    f4: float
    q4: float
    f5: float = 0.0
    q5: float = 1.0
    f6: float = 0.0
    q6: float = 1.0
    gain: float = 1.0
    f1: float = 0.4
    f2: float = 100.0

    def response(self, frequency: Array) -> Complex:
        """Return the weighting's transfer function at frequencies [Hz], complex."""
        s = 2j * np.pi * np.asarray(frequency, dtype=np.float64)
        w1, w2, w3, w4, w5, w6 = (2 * np.pi * f for f in (self.f1, self.f2, self.f3, self.f4, self.f5, self.f6))
        found = self.gain * s**2 / (s**2 + np.sqrt(2) * w1 * s + w1**2) * w2**2 / (s**2 + np.sqrt(2) * w2 * s + w2**2)
        found = found * (1 + s / w3) * w4**2 / (s**2 + w4 * s / self.q4 + w4**2)
        if self.f5:
            found = found * (s**2 + w5 * s / self.q5 + w5**2) / (s**2 + w6 * s / self.q6 + w6**2)
        return np.asarray(found, dtype=np.complex128)


WEIGHTINGS = {
    "Wk": Weighting("Wk", 12.5, 12.5, 0.63, 2.37, 0.91, 3.35, 0.91),
    "Wd": Weighting("Wd", 2.0, 2.0, 0.63),
    "Wb": Weighting("Wb", 16.0, 16.0, 0.55, 2.5, 0.9, 4.0, 0.95, gain=1.024),
}
"""By name: Wk for vertical, Wd for horizontal motion of a seat, Wb for vertical motion in rail vehicles and BS 6841."""


@dataclass(frozen=True)
class WeightedVibration:
    """What a weighted acceleration amounts to.

    `rms` [m/s^2] of the whole record; `mtvv` [m/s^2], the largest running RMS over 1 s; `vdv` [m/s^1.75]; `crest` factor, its largest
    magnitude over its RMS (0 where it rests).
    """

    rms: float
    mtvv: float
    vdv: float
    crest: float


def weighted(acceleration: Array, dt: float, weighting: Weighting) -> Array:
    """Return a weighted acceleration.

    Parameters
    ----------
    acceleration
        `shape (n,)` [m/s^2]; its mean, which no weighting lets pass, is taken off first.
    dt
        Spacing of the samples [s].
    weighting
        One of WEIGHTINGS.

    Returns
    -------
    `shape (n,)` [m/s^2].
    """
    n = len(acceleration)
    size = scipy.fft.next_fast_len(n + round(SETTLING / dt), real=True)
    lines = scipy.fft.rfft(acceleration - acceleration.mean(), size)
    return np.asarray(scipy.fft.irfft(lines * weighting.response(scipy.fft.rfftfreq(size, dt)), size)[:n])


def evaluate_vibration(acceleration: Array, dt: float, weighting: Weighting) -> WeightedVibration:
    """Return weighted RMS, MTVV, VDV and crest factor of an acceleration `shape (n,)` [m/s^2], its samples `dt` [s] apart."""
    found = weighted(acceleration, dt, weighting)
    rms = float(np.sqrt(np.mean(found**2)))
    return WeightedVibration(
        rms,
        float(running_rms(found, dt).max()),
        float((np.sum(found**4) * dt) ** 0.25),
        float(np.abs(found).max()) / rms if rms else 0.0,
    )


def running_rms(values: Array, dt: float, time: float = RUNNING_TIME) -> Array:
    """Return the RMS of the last `time` seconds at every sample, `shape (n,)`; before its beginning the signal is zero."""
    count = max(1, round(time / dt))
    total = np.concatenate([np.zeros(count), np.cumsum(values**2)])
    return np.asarray(np.sqrt(np.maximum(total[count:] - total[:-count], 0.0) / count))


def likely_reaction(rms: float) -> str:
    """Return how ISO 2631-1, C.2.3, says that people in public transport call a weighted RMS [m/s^2]; its ranges overlap."""
    return " or ".join(words for low, high, words in REACTIONS if low <= rms < high)


def reasons_to_doubt_rms(found: WeightedVibration, duration: float) -> list[str]:
    """Return why the RMS alone may underestimate a vibration that lasted `duration` [s] (ISO 2631-1, 6.2.1 and 6.3.3)."""
    if not found.rms:
        return []
    measures = (
        ("weighted crest factor", found.crest, MOST_CREST),
        ("MTVV over RMS", found.mtvv / found.rms, MOST_MTVV),
        ("VDV over RMS T^(1/4)", found.vdv / (found.rms * duration**0.25), MOST_VDV),
    )
    over = [f"{name} {value:.3g} (above {most:g})" for name, value, most in measures if value > most]
    return [f"{', '.join(over)}: its RMS alone says too little, ISO 2631-1 wants MTVV or VDV beside it"] if over else []
