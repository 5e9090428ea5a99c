"""Whether sensors have been exchanged or turned: the labels and signs with which a recording correlates best with a prediction.

Missing effects of full strength leave mean correlations of 0.33 to 1.0 with the vehicle file's prediction and never make another labelling
the better one; exchanged sensors raise it by 0.37 or more, turned channels by 0.24 or more.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations, permutations

import numpy as np
from numpy.typing import NDArray

from vehgen.diagnose.inputs.finding import Finding
from vehgen.fit.trial import Trial

Array = NDArray[np.float64]
LAG = 0.3
"""A run's clock may be off by this [s] where labels and axles are judged."""
CORRELATION_MARGIN = 0.15
"""Another labelling must raise the mean correlation by this, and turned signs by this once more."""
TURNED = -0.3
"""A channel is taken as turned below this correlation."""
MANY = 4
"""Beyond so many sensors only pairs of them are exchanged."""


@dataclass(frozen=True)
class Labels:
    """What was recorded as channel i is channel `source[i]`, times `signs[i]`."""

    source: tuple[int, ...]
    signs: tuple[int, ...]

    @property
    def trivial(self) -> bool:
        """Whether the file's labels are the true ones."""
        return self.source == tuple(range(len(self.source))) and min(self.signs) > 0

    def undo(self, trial: Trial) -> Trial:
        """Return the trial with every channel where it belongs."""
        values = np.empty_like(trial.recording.values)
        values[:, list(self.source)] = trial.recording.values * np.array(self.signs)
        return replace(trial, recording=replace(trial.recording, values=values))


def correlate(trial: Trial, simulated: Array, band: tuple[float, float]) -> Array:
    """Return the correlation of every measured channel (second axis) with every simulated one within a band, at lags up to LAG.

    `shape (n_lags, n_channels, n_channels)`, from -LAG, the recording early, to LAG.
    """
    dt, n = trial.recording.dt, len(simulated)
    frequency = np.fft.rfftfreq(2 * n, dt)
    inside = ((frequency >= band[0]) & (frequency <= band[1]))[:, None]
    measured, model = (np.fft.rfft(item, 2 * n, axis=0) * inside for item in (trial.recording.values, simulated))
    cross = np.fft.irfft(measured[:, :, None] * model[:, None, :].conj(), 2 * n, axis=0)
    own, other = (np.sqrt((np.fft.irfft(item, 2 * n, axis=0) ** 2).sum(axis=0)) for item in (measured, model))
    reach = min(int(LAG / dt), n - 1)
    return np.asarray(cross[np.arange(-reach, reach + 1)] / np.maximum(np.outer(own, other), 1e-300))


def true_labels(trial: Trial, correlation: Array) -> Labels:
    """Return the labelling that correlates best, each kind of mistake handicapped by MARGIN."""
    n = correlation.shape[1]
    best, pattern = -np.inf, Labels(tuple(range(n)), (1,) * n)
    for source in _sources(trial):
        chosen = correlation[:, np.arange(n), list(source)]
        for turned in (False, True):
            signs = np.where(turned & (chosen < TURNED), -1, 1)
            mean = (chosen * signs).mean(axis=1)
            at = int(mean.argmax())
            item = Labels(source, tuple(int(sign) for sign in signs[at]))
            score = mean[at] - CORRELATION_MARGIN * ((source != tuple(range(n))) + (min(item.signs) < 0))
            if score > best:
                best, pattern = float(score), item
    return pattern


def _sources(trial: Trial) -> Iterator[tuple[int, ...]]:
    """Yield every way in which sensors of the same quantities may have been exchanged, as channel numbers; the labelled one first."""
    channels = trial.recording.channels
    sensors = list(dict.fromkeys(channel.sensor for channel in channels))
    number = {(channel.sensor, channel.quantity): i for i, channel in enumerate(channels)}
    if len(sensors) <= MANY:
        orders: list[Sequence[str]] = list(permutations(sensors))
    else:
        pairs = [{a: b, b: a} for a, b in combinations(sensors, 2)]
        orders = [sensors, *([pair.get(name, name) for name in sensors] for pair in pairs)]
    for order in orders:
        given = dict(zip(sensors, order, strict=True))
        source = [number.get((given[channel.sensor], channel.quantity), -1) for channel in channels]
        if sorted(source) == list(range(len(channels))):
            yield tuple(source)


def relabelled(trials: Sequence[Trial], hypothesis: Mapping[str, Labels]) -> Iterator[Finding]:
    """Yield what is wrong with the labels of runs, given their true ones by name."""
    named = {trial.name: trial for trial in trials}
    everywhere = len(hypothesis) == len(trials) and len(set(hypothesis.values())) == 1
    for run, pattern in list(hypothesis.items())[: 1 if everywhere else None]:
        channels = named[run].recording.channels
        where = "in all runs" if everywhere else f"in {run}"
        given = {channel.sensor: channels[i].sensor for channel, i in zip(channels, pattern.source, strict=True)}
        moved = sorted(name for name, other in given.items() if name != other)
        if moved:
            words = " and ".join(moved) + " have been exchanged" if len(moved) == 2 else "the sensors " + ", ".join(moved) + " are mixed up"
            what = ", ".join(f"what is labelled {name} is what {given[name]} would record" for name in moved)
            message = f"{words} {where}: {what}; put the columns right in the run file"
            yield Finding("exchanged", None if everywhere else run, ", ".join(moved), message, True)
        turned = [channel.name for channel, sign in zip(channels, pattern.signs, strict=True) if sign < 0]
        if turned:
            verb = "has its sign" if len(turned) == 1 else "have their signs"
            message = (
                f"{' and '.join(turned)} {verb} turned {where}: set `sign: -1` for it in the run file (z up, pitch nose-down positive)"
            )
            yield Finding("turned", None if everywhere else run, ", ".join(turned), message, True)
