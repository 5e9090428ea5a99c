"""Uneven clocks put on an even one without adding or losing anything within the band.

A phone's samples come when its scheduler lets them. Between uneven samples the signal is predicted by the best linear estimate from the
ones around (simple kriging; Rasmussen & Williams, Gaussian Processes for Machine Learning, 2006, Eq. 2.25), whose prior is a band-limited
spectrum: most of the power below 0.4 of the sampling rate, a little up to the Nyquist frequency, none above. The prediction meets every
sample, is exact for band-limited signals up to the number of samples around, and keeps the noise's level close to the Nyquist frequency.
A sensor faster than the grid wants is predicted on a finer grid first, then filtered by a zero-phase FIR low-pass and decimated.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import scipy
from numpy.typing import NDArray

from vehgen.errors import InputError
from vehgen.phones.export import Stream

Array = NDArray[np.float64]
MARGIN_SAMPLES = 40
"""Samples beyond a block of values, on either side, that it is predicted from."""
BLOCK_SAMPLES = 40
"""Values predicted together."""
INNER = 0.4
"""Share of the sampling rate below which the prior has its power."""
OUTER_POWER = 1e-4
"""Power density of the prior from there to the Nyquist frequency, over that below."""
NUGGET = 1e-9
"""Share of the power added to the diagonal, for samples that nearly coincide."""
LONGEST_CLOCK_S = 20_000.0
"""No recording is longer [s]: five and a half hours."""
MAX_SENSOR_RATE_HZ = 20_000.0
"""No phone records faster [Hz]."""
MAX_DISORDER = 0.01
"""Share of samples that may be out of order or repeated."""
LATE_S, BEGUN_AGAIN = 1.0, 0.1
"""Where a clock goes back by more than this [s], over more than this share of all samples, another recording begins."""
MOST_BEGINNINGS = 10
"""So often may a clock go back that each time is looked at."""
TRANSITION = 4.0
"""Width of the low-pass's transition [Hz] per 100 Hz of the grid, centred on the grid's Nyquist frequency."""
STOP_BAND = 60.0
"""Attenuation beyond it [dB]."""


def clean(stream: Stream, name: str) -> tuple[Stream, tuple[str, ...]]:
    """Return a stream without missing samples and with ascending times, and what was done, in words.

    Raises
    ------
    InputError
        For fewer than 2 samples, values beyond all reason, and a clock that runs backwards too often.
    """
    notes = []
    finite = np.isfinite(stream.time) & np.isfinite(stream.values).all(axis=1)
    last = int(np.flatnonzero(finite)[-1]) + 1 if finite.any() else 0
    missing = int((~finite[:last]).sum())
    if missing:
        notes.append(f"{name}: {missing} missing samples were dropped")
    time, values = stream.time[finite], stream.values[finite]
    if len(time) < 2:
        raise InputError(f"{name} holds {len(time)} samples; a recording has thousands")
    if np.abs(values).max() > 1e6 or np.abs(time).max() > 1e12:
        raise InputError(f"{name} holds values up to {np.abs(values).max():.3g} at times up to {np.abs(time).max():.3g} s: not a recording")
    begins_again = _begins_again(time)
    order = np.argsort(time, kind="stable")
    disorder = int((np.diff(time) < 0).sum())
    time, values = time[order], values[order]
    fresh = np.concatenate([[True], np.diff(time) > 0])
    repeated = int((~fresh).sum())
    if disorder + repeated:
        if disorder + repeated > max(2, MAX_DISORDER * len(time)):
            raise InputError(f"{name}: {disorder} times run backwards and {repeated} are repeated, of {len(time)}: is it the time column?")
        if begins_again is not None:
            raise InputError(
                f"{name}: at its sample {begins_again + 1} the clock goes back, and on from there: two recordings in one file? "
                "Give each a file of its own"
            )
        notes.append(f"{name}: {disorder} samples were out of order and {repeated} repeated; sorted, the first of each kept")
    if fresh.sum() < 2:
        raise InputError(f"{name}: all samples have one time")
    span, rate = float(time[-1] - time[0]), sampling_rate(time[fresh])
    if span > LONGEST_CLOCK_S or rate > MAX_SENSOR_RATE_HZ:
        raise InputError(
            f"{name} spans {span:.4g} s at {rate:.4g} Hz; at most {LONGEST_CLOCK_S:g} s at {MAX_SENSOR_RATE_HZ:g} Hz were expected: "
            "is time in s?"
        )
    return replace(stream, time=time[fresh], values=values[fresh]), tuple(notes)


def _begins_again(time: Array) -> int | None:
    """Return the sample at which the clock goes back over a good part of a recording, and on from there; None where it does not."""
    for place in np.flatnonzero(np.diff(time) < -LATE_S)[:MOST_BEGINNINGS] + 1:
        before, after = time[:place] > time[place], time[place:] < time[:place].max()
        if min(before.sum(), after.sum()) > BEGUN_AGAIN * len(time):
            return int(place)
    return None


SLOWEST_LOGGER = 1.0
"""What seems to be logged at less [Hz] has its times in another unit."""


def sampling_rate(time: Array) -> float:
    """Return the median rate of samples at ascending times `shape (n,)` [s], in Hz."""
    return float(1 / np.median(np.diff(time)))


def check_rate(time: Array, top: float, name: str) -> float:
    """Return the sampling rate [Hz], refusing one below twice the top of the band [Hz]."""
    rate = sampling_rate(time)
    if rate < 2 * top * 0.99:
        if 1000 * rate >= 2 * top and rate < SLOWEST_LOGGER:
            raise InputError(f"{name} was logged at {rate:.3g} Hz, if its times are in s; state `time_unit=ms` if they are in ms")
        raise InputError(
            f"{name} was logged at {rate:.3g} Hz; at least {2 * top:g} Hz is needed to see up to {top:g} Hz (100 Hz is usual): set the app "
            "to its fastest rate and record again"
        )
    return rate


def gaps(time: Array, longest: float = 3.5) -> list[tuple[float, float]]:
    """Return where samples at ascending times lack for more than `longest` periods, as (start [s], length [s])."""
    steps = np.diff(time)
    wide = np.flatnonzero(steps > longest * np.median(steps))
    return [(float(time[i]), float(steps[i])) for i in wide]


def resample(time: Array, values: Array, grid: Array) -> Array:
    """Return the values on an even grid.

    Parameters
    ----------
    time
        Ascending times of the samples `shape (n,)` [s].
    values
        `shape (n, k)`.
    grid
        Evenly spaced times `shape (m,)` [s] within the samples' (a step beyond either end is allowed).

    Returns
    -------
    `shape (m, k)`, band-limited to the lower of the two Nyquist frequencies.

    Raises
    ------
    InputError
        For a grid that reaches beyond the samples.
    """
    rate, step = sampling_rate(time), float(grid[1] - grid[0])
    if grid[0] < time[0] - 1 / rate or grid[-1] > time[-1] + 1 / rate:
        raise InputError(
            f"samples from {time[0]:.3f} to {time[-1]:.3f} s were asked for values from {grid[0]:.3f} to {grid[-1]:.3f} s; "
            "a longer recording is needed"
        )
    finer = _finer(rate, 1 / step)
    if finer < 2:
        return _predict(time, values, grid, rate)
    taps = _low_pass(1 / step, finer)
    half = len(taps) // 2
    inner = grid[0] + step / finer * np.arange(-half, (len(grid) - 1) * finer + half + 1)
    inside = np.clip(inner, time[0], time[-1])  # beyond its ends the signal is held
    fine = _predict(time, values, inside, rate)
    return np.asarray(scipy.signal.oaconvolve(fine, taps[:, None], mode="valid", axes=0)[::finer])


def is_low_passed(rate: float, grid_rate: float) -> bool:
    """Whether samples at a median rate [Hz] pass the low-pass at half of `grid_rate` [Hz] on their way to an even grid."""
    return _finer(rate, grid_rate) >= 2


def _finer(rate: float, grid_rate: float) -> int:
    """Return how many times finer than the grid samples are predicted."""
    return int(np.ceil(rate / grid_rate / 1.04))


def _low_pass(grid_rate: float, finer: int) -> Array:
    """Return the symmetric taps of a low-pass at half of `grid_rate` for a grid `finer` times as fine (Kaiser's window)."""
    width = TRANSITION / 100 * grid_rate
    count, beta = scipy.signal.kaiserord(STOP_BAND, width / (0.5 * finer * grid_rate))
    return np.asarray(scipy.signal.firwin(count | 1, 0.5 * grid_rate, window=("kaiser", beta), fs=finer * grid_rate))


def _predict(time: Array, values: Array, at: Array, rate: float) -> Array:
    """Return the best linear estimate at ascending times `at`, block by block, each from its own samples and MARGIN on either side."""
    found = np.empty((len(at), values.shape[1]))
    level = values.mean(axis=0)
    for begin in range(0, len(at), BLOCK_SAMPLES):
        wanted = at[begin : begin + BLOCK_SAMPLES]
        first = max(int(np.searchsorted(time, wanted[0])) - MARGIN_SAMPLES, 0)
        last = min(int(np.searchsorted(time, wanted[-1])) + MARGIN_SAMPLES, len(time))
        near = (time[first:last] - wanted[0]) * rate
        matrix = _covariance(near[:, None] - near[None, :])
        matrix[np.arange(len(near)), np.arange(len(near))] *= 1 + NUGGET
        weights = scipy.linalg.solve(matrix, values[first:last] - level, assume_a="pos")
        found[begin : begin + BLOCK_SAMPLES] = level + _covariance((wanted[:, None] - wanted[0]) * rate - near[None, :]) @ weights
    return found


def _covariance(lag: Array) -> Array:
    """Return the prior's covariance at lags in sampling periods: the Fourier transform of its two-level spectrum."""
    outer = np.sinc(lag)
    return np.asarray((1 - OUTER_POWER) * 2 * INNER * np.sinc(2 * INNER * lag) + OUTER_POWER * outer)
