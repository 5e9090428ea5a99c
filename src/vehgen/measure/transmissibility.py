"""Ratios of channels over frequency from what they recorded alone: no input is measured.

A stationary record is cut into half-overlapping Hann segments (Welch's method). With S_xx, S_yy and S_xy the averaged spectra of a
reference x and a channel y, noise that the two do not share lies in S_xx and S_yy but not in S_xy. So |S_xy|/S_xx (H1) is too small and
S_yy/|S_xy| (H2) too large, and the ratio of the motions lies between them, wherever the noise is. The relative random error of either is
sqrt((1 - g)/(2 g n)), with the coherence g = |S_xy|^2/(S_xx S_yy) and n averages (Bendat & Piersol, Random Data, 4th ed., 2010, chapter 9);
one of them is spent on the ratio itself.
The interval about both is that of Imbens & Manski (Econometrica 72(6), 2004, doi:10.1111/j.1468-0262.2004.00555.x): it holds 95 % of true
ratios that lie at either end, more of those between.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

from vehgen.errors import InputError

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
HALF_OVERLAP_CORRELATION = 1 / 6
"""Of two Hann windows that overlap by half: the integral of their product over that of the square of one."""
NEIGHBOUR_INFLATION = 1 + 2 * ((2 / 3) ** 2 + (1 / 6) ** 2)
"""A mean over many lines of a Hann spectrum varies as one of so many times fewer: neighbours share noise, by 2/3 and 1/6 in amplitude."""
FEWEST_AVERAGES = 8
"""Fewer averages tell neither a coherence nor its error."""
CONFIDENCE = 0.95
"""Share of intervals that hold the true ratio, and of lines without any common motion that are seen to have none."""


@dataclass(frozen=True, eq=False)
class SegmentTransforms:
    """Fourier transforms of Hann segments, scaled so that the mean of their squared magnitudes is a one-sided PSD.

    `frequency shape (n,)` [Hz] without 0, `middle shape (k,)` [s] the segments' middles, `values shape (k, n, n_channels)`, complex
    [unit/sqrt(Hz)].
    """

    frequency: Array
    middle: Array
    values: Complex

    def kept(self, segments: NDArray[np.bool_]) -> SegmentTransforms:
        """Return some of the segments, `shape (k,)`."""
        return SegmentTransforms(self.frequency, self.middle[segments], self.values[segments])

    def between(self, low: float, high: float) -> SegmentTransforms:
        """Return the lines from `low` to `high` [Hz]."""
        inside = (self.frequency >= low - 1e-9) & (self.frequency <= high + 1e-9)
        return SegmentTransforms(self.frequency[inside], self.middle, self.values[:, inside])

    def spectra(self) -> Complex:
        """Return the spectral matrix of every line, `shape (n, n_channels, n_channels)`: entry (x, y) is the mean of conj(X) Y."""
        return np.asarray(np.einsum("kni,knj->nij", self.values.conj(), self.values) / len(self.values))

    def averages(self) -> float:
        """Return how many independent averages the segments are worth: overlapping and unequally loud ones count as fewer."""
        count = len(self.values)
        power = np.abs(self.values) ** 2
        share = (power.sum(axis=1) / np.maximum(power.sum(axis=(0, 1)), np.finfo(float).tiny)).mean(axis=1)
        alike = float(share.sum() ** 2 / (share**2).sum()) if share.any() else float(count)
        return alike / (1 + 2 * HALF_OVERLAP_CORRELATION**2 * (count - 1) / count)


def segment_transforms(values: Array, dt: float, segment: float) -> SegmentTransforms:
    """Cut channels into half-overlapping Hann segments, the mean of each removed, and transform them.

    Parameters
    ----------
    values
        Evenly spaced samples `shape (n, n_channels)`.
    dt
        Their spacing [s].
    segment
        Length of a segment [s].

    Raises
    ------
    InputError
        Where the samples do not fill one segment, or a segment holds fewer than 16.
    """
    length = round(segment / dt)
    if length < 16:
        raise InputError(f"a segment of {segment:g} s holds {length} samples; at least 16 are needed: lengthen it")
    if len(values) < length:
        raise InputError(f"the channels recorded {len(values) * dt:.4g} s together, less than one segment of {segment:g} s: record longer")
    starts = np.arange(0, len(values) - length + 1, max(length // 2, 1))
    window = scipy.signal.get_window("hann", length)
    cut = np.stack([values[start : start + length] for start in starts])
    cut -= cut.mean(axis=1, keepdims=True)
    lines = np.fft.rfft(cut * window[None, :, None], axis=1)[:, 1:] * np.sqrt(2 * dt / (window**2).sum())
    frequency = np.asarray(np.fft.rfftfreq(length, dt)[1:], dtype=np.float64)
    return SegmentTransforms(frequency, np.asarray((starts + length / 2) * dt, dtype=np.float64), np.asarray(lines))


@dataclass(frozen=True, eq=False)
class RatioEstimate:
    """The magnitude of a channel over the reference, line by line, all `shape (n,)`.

    Attributes
    ----------
    h1, h2
        The least and the largest ratio that the spectra allow, whatever the two do not share.
    lower, upper
        95 % limits about both.
    error
        Relative standard error of `h1` and of `h2`.
    coherence
        Share of the power that the two have in common.
    phase
        Of the channel over the reference [rad].
    common
        Whether the coherence is above what independent noise shows in 1 line of 20; where it is not, the line tells nothing.
    """

    h1: Array
    h2: Array
    lower: Array
    upper: Array
    error: Array
    coherence: Array
    phase: Array
    common: NDArray[np.bool_]

    @property
    def ratio(self) -> Array:
        """The middle of `h1` and `h2` on a logarithmic scale: the root of the ratio of the two PSDs."""
        return np.sqrt(self.h1 * self.h2)


def estimate_ratio(spectra: Complex, averages: float, reference: int, channel: int) -> RatioEstimate:
    """Estimate the ratio of a channel to the reference.

    Parameters
    ----------
    spectra
        `shape (n, n_channels, n_channels)`, see :meth:`SegmentTransforms.spectra`.
    averages
        How many independent averages they are worth.
    reference, channel
        Numbers of the two.

    Raises
    ------
    InputError
        For fewer averages than FEWEST_AVERAGES.
    """
    if averages < FEWEST_AVERAGES:
        raise InputError(
            f"the recordings are worth {averages:.1f} averages; at least {FEWEST_AVERAGES} are needed to tell a ratio from chance: record "
            "longer, or take shorter segments"
        )
    tiny = np.finfo(float).tiny
    own, other = (np.maximum(spectra[:, i, i].real, tiny) for i in (reference, channel))
    cross = spectra[:, reference, channel]
    magnitude = np.maximum(np.abs(cross), tiny)
    coherence = np.clip(magnitude**2 / (own * other), 0.0, 1.0)
    known = np.maximum(coherence, 1e-12)
    error = np.sqrt(np.maximum(1 - known, 1e-12) / (2 * known * (averages - 1)))
    h1, h2 = magnitude / own, other / magnitude
    quantile = _critical_value(-np.log(known) / error)
    reach = error * scipy.stats.t.isf(scipy.stats.norm.sf(quantile), 2 * averages - 2)  # as the error itself is estimated
    return RatioEstimate(
        h1,
        h2,
        lower=h1 * np.exp(-reach),
        upper=h2 * np.exp(np.minimum(reach, 300.0)),
        error=error,
        coherence=coherence,
        phase=np.angle(cross),
        common=coherence > 1 - (1 - CONFIDENCE) ** (1 / (averages - 1)),
    )


def model_ratio(spectra: Complex, reference: int, channel: int) -> tuple[Array, Array]:
    """Return H1 and H2 of spectra without any error, `shape (n,)` each: what speeds and segments leave of a model's coherence."""
    cross = np.abs(spectra[:, reference, channel])
    return cross / spectra[:, reference, reference].real, spectra[:, channel, channel].real / cross


def _critical_value(gap: Array) -> Array:
    """Return c of Phi(c + gap) - Phi(-c) = CONFIDENCE: from 1.96 where both ends are one to 1.645 where they are far apart."""
    low, high = np.full(gap.shape, scipy.stats.norm.ppf(CONFIDENCE)), np.full(gap.shape, scipy.stats.norm.ppf(0.5 + CONFIDENCE / 2))
    for _ in range(30):
        middle = (low + high) / 2
        short = scipy.stats.norm.cdf(middle + gap) - scipy.stats.norm.cdf(-middle) < CONFIDENCE
        low, high = np.where(short, middle, low), np.where(short, high, middle)
    return np.asarray((low + high) / 2)
