"""When the front wheel reached the road's begin, on the clock of each phone, by what the vehicle should do at each phone's place.

The vehicle of the file drives over the road at several speeds; where its answer lies best over a recording, the clock is known. Every axle
that crosses is a mark, so the distance between the marks gives the speed too, and two phones far apart need not record the same motion to
be put on one clock. A vehicle whose parameters are a few percent wrong does well enough; how well they fit is reported.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

from vehgen.simulate import Scenario, Simulator

Array = NDArray[np.float64]
Answer = Callable[[float], Array]
Range = tuple[float, float]
COARSE_SCALES = np.arange(0.88, 1.1201, 0.01)
"""Speeds tried, over the one that was given or measured ..."""
FINE_SCALE_STEPS = np.arange(-0.01, 0.01001, 0.001)
"""... and then around the best of them."""
TRUSTED = 0.6
"""Least correlation of a match that tells clock and speed ..."""
STANDING_OUT, LEAST_TRUSTED = 3.0, 0.33
"""... but of a measured road, how many times that of the same answer run backwards, and the least then: a speed that wandered by 1.2 % left
0.6 of the true vehicle's own answer. Of 27 drives over rough roads in the measured world (0.35 to 0.65) it was 4.3 times as good at least,
in 14 fresh ones 4.9. Over other roads two of 110 phones are trusted (0.56 and 4.7 times, 0.34 and 3.0), beside another that is not.
"""
HIGHEST_FREQUENCY_HZ = 20.0
"""Above this frequency [Hz] the vehicle's answer is not compared."""


@dataclass(frozen=True)
class Match:
    """Where the answer's t = 0 lies on a recording's clock (`shift` [s]), their `correlation`, and the best `scale` of the speed.

    `backwards` is the best correlation of the answer run backwards in time, which no road gives: what chance does; 1 where not all shifts
    were tried. `loudness` says how many times as loud as the answer each channel was.
    """

    shift: float
    correlation: float
    scale: float
    backwards: float
    loudness: tuple[float, ...]

    @property
    def is_trusted(self) -> bool:
        """Whether the vehicle answers so much like the recording that the match tells clock and speed."""
        return self.correlation >= min(TRUSTED, max(LEAST_TRUSTED, STANDING_OUT * self.backwards))


def predictor(simulator: Simulator, parameters: Array, scenario: Scenario) -> Answer:
    """Return a function from a factor on the scenario's speed to the vehicle's answer `shape (n_samples, n_channels)`."""
    return lambda scale: simulator.run(parameters[None, :], scenario.adjusted(speed=scale)).responses[0]


def match(
    recordings: Sequence[tuple[Array, Array]], answer: Answer, columns: Sequence[slice], step: float, near: Sequence[Range | None]
) -> list[Match]:
    """Lay the vehicle's answer over recordings.

    Parameters
    ----------
    recordings
        For each phone evenly spaced times `shape (n,)` [s] and channels `shape (n, k)`.
    answer
        The vehicle's answer at a factor on its speed, all channels of all phones.
    columns
        For each phone which of them are its own.
    step
        Spacing of the samples of recordings and answer [s].
    near
        For each phone the earliest and latest shift allowed [s]; None of a road that the whole recording may hold.

    Returns
    -------
    One match a phone, all at the speed that suits them best together.
    """
    low_pass = scipy.signal.butter(4, HIGHEST_FREQUENCY_HZ, fs=1 / step, output="sos")
    smooth = [scipy.signal.sosfiltfilt(low_pass, values - values.mean(axis=0), axis=0) for _, values in recordings]

    def scan(scales: Array) -> Array:
        """Return shift, correlation and that of the answer backwards, `shape (n_scales, n_phones, 3)`."""
        table = np.empty((len(scales), len(recordings), 3))
        for i, scale in enumerate(scales):
            expected = scipy.signal.sosfiltfilt(low_pass, answer(float(scale)), axis=0)
            for j, (time, _) in enumerate(recordings):
                table[i, j] = _lay(smooth[j], expected[:, columns[j]], time, step, near[j])
        return table

    rough = float(COARSE_SCALES[np.argmax(scan(COARSE_SCALES)[:, :, 1].mean(axis=1))])
    scales = rough + FINE_SCALE_STEPS
    table = scan(scales)
    together = table[:, :, 1].mean(axis=1)
    best = int(np.argmax(together))
    expected = scipy.signal.sosfiltfilt(low_pass, answer(float(scales[best])), axis=0)
    found = []
    for (time, _), values, own, (shift, correlation, backwards) in zip(recordings, smooth, columns, table[best].tolist(), strict=True):
        loudness = _loudness(values, expected[:, own], round((shift - float(time[0])) / step))
        found.append(Match(shift, correlation, float(scales[best]), backwards, loudness))
    return found


def _lay(values: Array, template: Array, time: Array, step: float, near: Range | None) -> tuple[float, float, float]:
    """Return the shift at which a prediction correlates best with a recording, that correlation, and the best of it run backwards."""
    total = _correlations(values, template)
    shifts = time[0] + step * (np.arange(len(total)) - len(template))
    low, high = near or (time[0], time[-1])
    inside = np.flatnonzero((shifts >= low) & (shifts <= high))
    if not len(inside):
        return float(low + high) / 2, 0.0, 1.0
    best = int(inside[np.argmax(total[inside])])
    backwards = float(_correlations(values, template[::-1])[inside].max()) if near is None else 1.0
    bend = _vertex(total[best - 1 : best + 2]) if 0 < best < len(total) - 1 else 0.0
    return float(shifts[best] + bend * step), float(total[best]), backwards


def _correlations(values: Array, template: Array) -> Array:
    """Return the mean correlation of all channels at every shift, from the template's end to its begin at the recording's begin and end."""
    n = len(template)
    pad = np.zeros((n, values.shape[1]))
    longer = np.vstack([pad, values, pad])
    total = np.zeros(len(longer) - n + 1)
    for channel, expected in zip(longer.T, template.T, strict=True):
        dot = scipy.signal.oaconvolve(channel, expected[::-1], mode="valid")
        energy = np.concatenate([[0.0], np.cumsum(channel**2)])
        local = energy[n:] - energy[:-n]
        total += dot / np.sqrt(np.maximum(local, 1e-3 * local.max() + 1e-30) * max(float((expected**2).sum()), 1e-30))
    return np.asarray(total / values.shape[1])


def _loudness(values: Array, template: Array, first: int) -> tuple[float, ...]:
    """Return the root mean square of each channel over that of its prediction, which begins at the channel's sample `first`.

    1 for a channel that is predicted to rest, as the pitch rate of a body that only heaves.
    """
    laid = values[max(first, 0) : max(first + len(template), 0)]
    told, expected = (np.sqrt(np.sum(item**2, axis=0)) for item in (laid, template[max(-first, 0) :][: len(laid)]))
    return tuple(np.divide(told, expected, out=np.ones_like(told), where=expected > 0).tolist())


def _vertex(three: Array) -> float:
    """Return where a parabola through three samples has its top, in steps from the middle one."""
    curve = three[0] - 2 * three[1] + three[2]
    return float(np.clip(0.5 * (three[0] - three[2]) / curve, -0.5, 0.5)) if curve < 0 else 0.0
