"""How good is a recorded channel? Its noise floor where nothing happens, and where its sensor's range clipped it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

from vehgen.measure.spectra import welch_psd

Array = NDArray[np.float64]
NOISE_BAND_WIDTH_HZ = 3.0
"""Width of the band at the top of the spectrum, where a vehicle does nothing [Hz]."""
NOISE_BAND_TOP_HZ = 50.0
"""Top of that band [Hz], where the sensor is fast enough."""
CUT_NOISES = 8.0
"""A flat top has cut something off where its flanks lead higher by so many times the noise, or resolution, of the channel ..."""
BY_CHANCE = 1e-6
"""... or where a round top would hold so many of its samples with this probability."""

FOREIGN_UNIT = 4.0
"""A channel so many times louder or quieter than the vehicle's answer is not in the unit that it is read in."""


def in_foreign_unit(loudness: float) -> bool:
    """Whether a channel that is `loudness` times as loud as the vehicle's answer is hardly in the unit that it is read in."""
    return max(loudness, 1 / max(loudness, 1e-30)) > FOREIGN_UNIT


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


@dataclass(frozen=True)
class Clipping:
    """A flat top: the extreme `level` of a channel, how many samples have it, and the number of the first of those in a row."""

    level: float
    n_samples: int
    first: int


def find_clipping(
    values: Array, in_a_row: int, *, min_deviation: float = 0.0, min_pile_up: float = 0.0, rest: float | None = 0.0
) -> tuple[Clipping, ...]:
    """Return the flat tops at a channel's largest and smallest value; a channel that never changes has none.

    Parameters
    ----------
    values
        Samples `shape (n,)` as the sensor gave them, neither filtered nor resampled.
    in_a_row
        So many equal samples in a row at the extreme are a flat top.
    min_deviation
        The extreme must be more than so many standard deviations from the median: rules out a channel that is merely coarse.
    min_pile_up
        So many times as many samples must be at the extreme as at the next value inwards: rules out a quantised channel, whose
        extremes are rarer than what lies inside them.
    rest
        The level of rest, which is no clipping (None: no level is).

    Returns
    -------
    The flat top at the largest value, then that at the smallest, where there is one.
    """
    spread = float(np.std(values))
    if np.ptp(values) == 0:
        return ()
    found = []
    for extreme, upwards in ((float(values.max()), values), (float(values.min()), -values)):
        at = values == extreme
        rows = np.flatnonzero(np.convolve(at, np.ones(in_a_row), mode="valid") > in_a_row - 0.5)
        inner = upwards[~at]
        at_next = int((inner == inner.max()).sum())
        far = not min_deviation or abs(extreme - float(np.median(values))) > min_deviation * spread
        if rows.size and extreme != rest and far and at.sum() >= min_pile_up * at_next:
            found.append(Clipping(extreme, int(at.sum()), int(rows[0])))
    return tuple(found)


def has_cut(values: Array, top: Clipping) -> bool:
    """Return whether a flat top has cut a channel off, where equal samples are no chance of a round, noisy or coarse peak.

    Two signs: parabolas through its flanks lead well above it, or it holds so many samples that a round top would not. Of the samples
    within five steps of a channel's resolution below a round top 45 % lie in the first step, as the root of the depth grows.
    """
    signed = values if top.level > float(np.median(values)) else -values
    level, distinct = float(signed.max()), np.unique(values)
    step = float(np.diff(distinct).min())
    # the third difference of white noise has 20 times its variance; the median forgives peaks
    noise = float(np.median(np.abs(np.diff(values, 3)))) / 0.6745 / np.sqrt(20)
    at = signed == level
    below = int(((signed < level) & (signed >= level - 4.5 * step)).sum())
    count = int(at.sum())
    if scipy.special.bdtrc(count - 1, count + below, 5**-0.5) < BY_CHANCE:
        return True
    edges = np.flatnonzero(np.diff(np.concatenate([[0], at, [0]])))
    rises = [_rise(signed, int(first), int(end)) - level for first, end in zip(edges[::2], edges[1::2], strict=True) if end - first > 1]
    return bool(max(rises, default=0.0) > CUT_NOISES * max(noise, step))


def _rise(values: Array, first: int, end: int) -> float:
    """Return how high a parabola through two samples on either side of values[first:end] leads; their level where it has no top."""
    if first < 2 or end > len(values) - 2:
        return float(values[first])
    place = np.array([first - 2, first - 1, end, end + 1]) - (first + end - 1) / 2
    a, b, c = np.polyfit(place, values[[first - 2, first - 1, end, end + 1]], 2)
    return float(c - b**2 / (4 * a)) if a < 0 else float(values[first])
