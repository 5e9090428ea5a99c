"""Whether sensors have been exchanged or turned: the labels and signs with which a recording correlates best with a prediction.

Missing effects of full strength leave mean correlations of 0.33 to 1.0 with the vehicle file's prediction and never make another labelling
the better one; exchanged sensors raise it by 0.37 or more, turned channels by 0.24 or more.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations, permutations

import numpy as np
from numpy.typing import NDArray

from vehgen.diagnose.inputs.fault import Hypothesis, MeasurementFault, always, place_words
from vehgen.diagnose.inputs.refits import BaseRefits
from vehgen.fit.recording import RecordedChannel
from vehgen.fit.trial import Trial

Array = NDArray[np.float64]
LAG = 0.3
"""A run's clock may be off by this [s] where labels and axles are judged."""
CORRELATION_MARGIN = 0.15
"""Another labelling must raise the mean correlation by this, and turned signs by this once more."""
TURNED = -0.3
"""A channel is taken as turned below this correlation."""
RELABELLED = 0.5
"""Largest share of the excess that another labelling may leave: the true effect may still be in it."""
CHANNELS_ONLY = 0.02
"""Single channels exchanged must raise it by this more than whole sensors: the pitch rates of one body are alike."""
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
            score -= CHANNELS_ONLY * (not _whole_sensors(trial.recording.channels, source))
            if score > best:
                best, pattern = float(score), item
    return pattern


def _sources(trial: Trial) -> Iterator[tuple[int, ...]]:
    """Yield every way in which sensors, or two channels of one sensor or quantity, may have been exchanged, the labelled one first."""
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
    for i, j in combinations(range(len(channels)), 2):
        one_of_both = (channels[i].sensor == channels[j].sensor) != (channels[i].quantity == channels[j].quantity)
        if one_of_both:
            yield tuple(j if k == i else i if k == j else k for k in range(len(channels)))


def label_hypotheses(case: BaseRefits) -> Iterator[Hypothesis]:
    """Yield that sensors were exchanged or channels turned: as each run has it, as most runs have it, and as all have it together."""
    found = {trial.name: true_labels(trial, item.within(LAG)) for trial, item in zip(case.trials, case.comparisons, strict=True)}
    wrong = {name: pattern for name, pattern in found.items() if not pattern.trivial}
    hypotheses = [wrong]
    if len({trial.channels for trial in case.trials}) == 1:
        common, count = Counter(found.values()).most_common(1)[0]
        shared = [common] if count > len(case.trials) / 2 else []
        hypotheses += [dict.fromkeys(found, pattern) for pattern in (*shared, _turned_together(case)) if not pattern.trivial]
    for number, hypothesis in enumerate(hypotheses):
        if hypothesis and hypothesis not in hypotheses[:number]:
            trials = tuple(hypothesis[trial.name].undo(trial) if trial.name in hypothesis else trial for trial in case.trials)
            faults = tuple(_relabelled(case.trials, hypothesis))
            yield Hypothesis(trials, always(*faults), RELABELLED)


def _turned_together(case: BaseRefits) -> Labels:
    """Return the signs that runs have in the mean: parameters that are off spoil each one's correlation."""
    own = np.mean([item.own[item.best] for item in case.comparisons], axis=0)
    return Labels(tuple(range(len(own))), tuple(-1 if value < 0 else 1 for value in own))


def _whole_sensors(channels: Sequence[RecordedChannel], source: Sequence[int]) -> bool:
    """Return whether channels that were exchanged went with all others of their sensors."""
    taken = {(channel.sensor, channels[i].sensor) for channel, i in zip(channels, source, strict=True)}
    same = all(channel.quantity == channels[i].quantity for channel, i in zip(channels, source, strict=True))
    return same and len(taken) == len({sensor for sensor, _ in taken})


def _true_owners(channels: Sequence[RecordedChannel], source: Sequence[int]) -> dict[str, str]:
    """Return under which name each sensor was recorded, or each channel where channels went without the rest of their sensor."""
    if _whole_sensors(channels, source):
        return {channel.sensor: channels[i].sensor for channel, i in zip(channels, source, strict=True)}
    return {channel.name: channels[i].name for channel, i in zip(channels, source, strict=True)}


def _relabelled(trials: Sequence[Trial], hypothesis: Mapping[str, Labels]) -> Iterator[MeasurementFault]:
    """Yield what is wrong with the labels of runs, given their true ones by name."""
    named = {trial.name: trial for trial in trials}
    everyone = tuple(named)
    for pattern in dict.fromkeys(hypothesis.values()):
        runs = tuple(name for name, own in hypothesis.items() if own == pattern)
        channels = named[runs[0]].recording.channels
        where = place_words(runs, everyone)
        given = _true_owners(channels, pattern.source)
        moved = tuple(sorted(name for name, other in given.items() if name != other))
        if moved:
            words = " and ".join(moved) + " have been exchanged" if len(moved) == 2 else ", ".join(moved) + " are mixed up"
            what = ", ".join(f"what is labelled {name} is what {given[name]} would record" for name in moved)
            yield MeasurementFault("exchanged", runs, moved, f"{words} {where}: {what}", "put the columns right in the run file")
        turned = tuple(channel.name for channel, sign in zip(channels, pattern.signs, strict=True) if sign < 0)
        if turned:
            verb = "has its sign" if len(turned) == 1 else "have their signs"
            cure = "set `sign: -1` for it in the run file (z up, pitch nose-down positive)"
            yield MeasurementFault("turned", runs, turned, f"{' and '.join(turned)} {verb} turned {where}", cure)
