"""What a recorder does to a motion before it is a number in a file: an anti-alias low-pass, a delay, a range and a resolution.

The chain is described in continuous time, so that it holds at any internal step: as taps at the spacing of a simulation, and as a complex
factor at a spectral line. Low-passes are those of scipy.signal's analog prototypes; `ideal` is a windowed sinc of zero phase, as resampling
in software does it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Literal, get_args

import numpy as np
import scipy
from numpy.typing import NDArray

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
FilterKind = Literal["none", "butterworth", "bessel", "chebyshev1", "ideal", "unknown"]
FILTER_KINDS: tuple[str, ...] = get_args(FilterKind)
RECURSIVE_KINDS = ("butterworth", "bessel", "chebyshev1")
"""Kinds that have an order; what comes later in them cannot be seen before."""
MAX_ORDER = 12
RIPPLE_DB = 0.5
"""Ripple of a Chebyshev low-pass in its pass band [dB]."""
IDEAL_TRANSITION = 0.08
"""Width of an ideal low-pass's transition over its cut-off, on which it is centred; a sinc has none, but no end either."""
IDEAL_STOP_BAND_DB = 60.0
"""Attenuation of an ideal low-pass beyond its transition [dB]."""
UNKNOWN_CUT_OFF = 0.48
"""Cut-off that stands for an unknown low-pass, over the rate of the recording: its transition ends at half of that rate."""
DECAYED = 1e-6
"""An impulse response ends where it stays below this share of its peak."""
FLAT_SHARE = 0.6
"""Share of the Nyquist frequency of the taps up to which they follow a recursive low-pass exactly; above, they fade to nothing."""
FOLDS_FROM = 9.0
"""So many times as fast as slow motions is what may fold onto them, at least, without a low-pass."""
_TABLE_LINES = 64
"""An ideal low-pass is tabulated at so many frequencies over the inverse of its length."""


@dataclass(frozen=True)
class AcquisitionChain:
    """What stands between a motion and the numbers of its recording.

    Attributes
    ----------
    filter
        Kind of the anti-alias low-pass; `unknown` where nobody knows, `none` for point samples.
    order
        Of a Butterworth, Bessel or Chebyshev low-pass.
    cut_off
        [Hz]: -3 dB of a Butterworth or Bessel low-pass, end of a Chebyshev pass band (-RIPPLE_DB), -6 dB of an ideal one.
    delay
        How late the recorder is besides [s].
    range
        Largest magnitude that it records [SI].
    resolution
        Its smallest step [SI].
    rate
        At which its chip samples before it filters [Hz]; a cut-off lies below half of it.
    """

    filter: FilterKind = "none"
    order: int = 4
    cut_off: float | None = None
    delay: float = 0.0
    range: float | None = None
    resolution: float | None = None
    rate: float | None = None

    def __post_init__(self) -> None:
        if self.filter not in FILTER_KINDS:
            raise ValueError(f"a filter is one of {', '.join(FILTER_KINDS)}, found {self.filter!r}")
        if (self.cut_off is None) != (self.filter in ("none", "unknown")):
            raise ValueError(f"a filter has a cut-off unless it is none or unknown, found {self.cut_off} with {self.filter!r}")
        if not 1 <= self.order <= MAX_ORDER or not 0 < (self.cut_off or 1.0) < math.inf or not math.isfinite(self.delay):
            raise ValueError(f"an order of 1 to {MAX_ORDER}, a cut-off above 0 and a finite delay were expected")

    @property
    def is_known(self) -> bool:
        """Whether its low-pass is known."""
        return self.filter != "unknown"

    @property
    def is_point_sample(self) -> bool:
        """Whether it leaves samples as they are."""
        return self.filter == "none" and self.delay == 0

    def assumed(self, rate: float) -> AcquisitionChain:
        """Return the chain of a recording at `rate` [Hz]: itself, or where it is unknown the ideal low-pass just below half the rate."""
        if self.is_known:
            return self
        return AcquisitionChain("ideal", 1, UNKNOWN_CUT_OFF * rate, self.delay, self.range, self.resolution, self.rate)

    def for_slow_motions(self, highest: float, rate: float) -> AcquisitionChain:
        """Return the chain of a recording at `rate` [Hz] where only motions up to a frequency [Hz] matter, to begin a fit.

        An ideal low-pass leaves them as they are, and has the most taps of all; without it what folds onto them comes from above
        `rate` less that frequency, where vehicles move little (FOLDS_FROM).
        """
        assumed = self.assumed(rate)
        passes = assumed.filter == "ideal" and highest <= (1 - IDEAL_TRANSITION) * (assumed.cut_off or 0.0)
        return replace(assumed, filter="none", cut_off=None) if passes and rate - highest >= FOLDS_FROM * highest else self

    def filtering(self) -> AcquisitionChain:
        """Return the chain without its range and resolution: what two chains must share to make the same of a motion."""
        return AcquisitionChain(self.filter, self.order if self.filter in RECURSIVE_KINDS else 4, self.cut_off, self.delay)

    def taps(self, dt: float) -> tuple[int, Array]:
        """Return the impulse response at a spacing `dt` [s] as a FIR filter of gain 1 at 0 Hz.

        Taps follow :meth:`response` up to FLAT_SHARE of their Nyquist frequency.

        Returns
        -------
        number of the first tap (its time over dt; below 0 the chain looks ahead), and the taps `shape (n,)`, not to be written to.

        Raises
        ------
        ValueError
            For an unknown chain: ask for the one :meth:`assumed`.
        """
        return _taps(self.filtering(), dt)

    def response(self, frequency: Array) -> Complex:
        """Return the complex factor at frequencies `shape (n,)` [Hz]; raises ValueError for an unknown chain."""
        late = np.exp(-2j * np.pi * frequency * self.delay)
        return np.asarray(_low_pass_response(self, frequency) * late, dtype=np.complex128)


POINT_SAMPLES = AcquisitionChain()
"""Samples of the motion at their instants."""
UNKNOWN = AcquisitionChain("unknown")
"""A recorder of which nothing is known."""


def _low_pass_response(chain: AcquisitionChain, frequency: Array) -> Complex:
    if chain.filter == "none":
        return np.ones(frequency.shape, dtype=np.complex128)
    if chain.filter == "ideal":
        assert chain.cut_off is not None
        known, gain = _ideal_table()
        return np.asarray(np.interp(np.abs(frequency) / chain.cut_off, known, gain, right=0.0), dtype=np.complex128)
    zeros, poles, scale = _prototype(chain.filtering())
    s = 2j * np.pi * frequency[..., None]
    return np.asarray(scale * np.prod(s - zeros, axis=-1) / np.prod(s - poles, axis=-1), dtype=np.complex128)


@lru_cache(maxsize=256)
def _prototype(chain: AcquisitionChain) -> tuple[Complex, Complex, float]:
    """Return zeros, poles [rad/s] and gain of a recursive low-pass, 1 at 0 Hz."""
    if chain.filter not in RECURSIVE_KINDS or chain.cut_off is None:
        raise ValueError(f"a filter that is {chain.filter} has no response; what recording is it of?")
    edge = 2 * np.pi * chain.cut_off
    if chain.filter == "butterworth":
        zeros, poles, gain = scipy.signal.butter(chain.order, edge, analog=True, output="zpk")
    elif chain.filter == "bessel":
        zeros, poles, gain = scipy.signal.bessel(chain.order, edge, analog=True, output="zpk", norm="mag")
    else:
        zeros, poles, gain = scipy.signal.cheby1(chain.order, RIPPLE_DB, edge, analog=True, output="zpk")
    at_rest = float((gain * np.prod(-zeros) / np.prod(-poles)).real)
    return np.asarray(zeros, dtype=np.complex128), np.asarray(poles, dtype=np.complex128), float(gain) / at_rest


@lru_cache(maxsize=256)
def _taps(chain: AcquisitionChain, dt: float) -> tuple[int, Array]:
    if chain.is_point_sample:
        first, taps = 0, np.ones(1)
    elif chain.filter == "ideal":
        assert chain.cut_off is not None
        first, taps = _ideal_taps(chain.cut_off, chain.delay, dt)
    else:
        first, taps = _sampled_taps(chain, dt)
    taps /= taps.sum()
    taps.flags.writeable = False
    return first, taps


def _ideal_taps(cut_off: float, delay: float, dt: float) -> tuple[int, Array]:
    """Return a sinc under Kaiser's window about `delay` [s]: that of scipy.signal.firwin, at any place between samples."""
    beta = scipy.signal.kaiser_beta(IDEAL_STOP_BAND_DB)
    half = (IDEAL_STOP_BAND_DB - 7.95) / (4 * 2.285 * math.pi * IDEAL_TRANSITION * cut_off * dt)  # Kaiser's estimate of the length
    first, last = math.ceil(delay / dt - half), math.floor(delay / dt + half)
    place = np.arange(first, last + 1) - delay / dt
    window = np.i0(beta * np.sqrt(np.maximum(1 - (place / half) ** 2, 0.0)))
    return first, np.asarray(np.sinc(2 * cut_off * dt * place) * window)


@lru_cache(maxsize=1)
def _ideal_table() -> tuple[Array, Array]:
    """Return the gain of the ideal low-pass at frequencies over its cut-off, the windowed sinc transformed."""
    per_period = 1 / 16
    first, taps = _ideal_taps(1.0, 0.0, per_period)
    taps = taps / taps.sum()
    n = 1 << math.ceil(math.log2(_TABLE_LINES * len(taps)))
    padded = np.zeros(n)
    padded[: len(taps)] = taps
    frequency = np.fft.rfftfreq(n, per_period)
    gain = (np.fft.rfft(padded) * np.exp(-2j * np.pi * frequency * first * per_period)).real
    return np.asarray(frequency), np.asarray(gain)


def _sampled_taps(chain: AcquisitionChain, dt: float) -> tuple[int, Array]:
    """Return the impulse response of what is no windowed sinc, from its response at lines so close that it has decayed between repeats."""
    slowest = float(-_prototype(chain)[1].real.max()) if chain.filter in RECURSIVE_KINDS else math.inf
    length = 2 * (-math.log(DECAYED) / slowest + abs(chain.delay)) + 400 * dt
    n = 1 << math.ceil(math.log2(length / dt))
    frequency = np.asarray(np.fft.rfftfreq(n, dt), dtype=np.float64)
    share = (frequency * 2 * dt - FLAT_SHARE) / (1 - FLAT_SHARE)
    impulse = np.fft.fftshift(np.fft.irfft(chain.response(frequency) * _smooth_step(1 - share), n))
    loud = np.flatnonzero(np.abs(impulse) > DECAYED * np.abs(impulse).max())
    return int(loud[0]) - n // 2, np.array(impulse[loud[0] : loud[-1] + 1])


def _smooth_step(x: Array) -> Array:
    """Return 0 up to x = 0 and 1 from x = 1, with all derivatives continuous: what it makes of a spectrum has a short impulse response."""
    inside = np.clip(x, 5e-3, 1 - 5e-3)
    rising = 1 / (1 + np.exp(1 / inside - 1 / (1 - inside)))
    return np.asarray(np.where(x <= 0, 0.0, np.where(x >= 1, 1.0, rising)))
