"""Amplitudes that are wrong: channels in other units, dead channels, another gain in one run, an offset or a drift."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from vehgen.diagnose.inputs.adjustments import RunGain
from vehgen.diagnose.inputs.comparison import Comparison, compare
from vehgen.diagnose.inputs.fault import Hypothesis, MeasurementFault, always, place_words
from vehgen.diagnose.inputs.refits import BaseRefits
from vehgen.files.units import STANDARD_GRAVITY, factor_to_si, parse_unit
from vehgen.fit.trial import Trial
from vehgen.mechanics import is_held

Array = NDArray[np.float64]
ACCELERATION_UNITS = {"m/s^2": 1.0, "g": STANDARD_GRAVITY, "mm/s^2": 1e-3, "mg": STANDARD_GRAVITY / 1000}
RATE_UNITS = {"rad/s": 1.0, "deg/s": np.pi / 180, "mrad/s": 1e-3}
UNITS_OF = {"acceleration": ACCELERATION_UNITS, "pitch_rate": RATE_UNITS}
"""What a channel's units are worth in SI, by quantity."""
NEAR_FACTOR = 0.45
"""A level within this of a factor's logarithm suggests it: the file's parameters and a missing effect move levels too."""
LIKE_PREDICTED = 1.0
"""Channels whose levels, as logarithms, are below this are in their units; what they have in common is a rough road's doing."""
COHERENT = 0.4
"""A channel's unit is judged where it correlates this well with its prediction."""
ALIVE, DEAD = 0.6, 0.35
"""A dead channel correlates below the one while its like correlate above the other: channels of its quantity, or else all others."""
SLOW_MOTIONS_HZ, FOLLOWS = 10.0, 0.3
"""Channels of one vehicle follow one another in motions up to the one; noise, over ten seconds, correlates by 0.2 at most."""
BURST_S, BURST = 0.25, 3.0
"""Noise is even: in no stretch of the one [s] is it so many times as loud as in half of them."""
NEIGHBOURS = 0.05
"""A dead channel's correlation is looked at within this of the others' lag [s]."""
OTHER_UNIT = 0.5
"""Largest share of the excess that another unit may leave: the true effect may still be in it."""
ONE_CHANNEL = 0.25
"""The same for a dead channel, for another gain in one run, and for a drift."""
GAIN_NOTICED, GAIN_FAR = 0.08, 1.5
"""A channel's level off by more than the one and less than the other in one run, as a logarithm, is fitted; a gain as near to 1 as the one
is no mistake that explains a gap: its refit found another way."""
DRIFT_NOTICED = 0.1
"""An offset and drift of this share of a channel's RMS is taken out."""


def unit_hypotheses(case: BaseRefits) -> Iterator[Hypothesis]:
    """Yield that channels are stated in other units than they were recorded in, all of them together."""
    found = _other_units(case.trials, case.comparisons)
    if not found:
        return
    trials = []
    for trial in case.trials:
        factors = np.ones(len(trial.channels))
        for (name, _, factor), runs in found.items():
            if trial.name in runs:
                factors[trial.channels.index(name)] = 1 / factor
        trials.append(scaled(trial, factors))
    faults = tuple(_unit_fault(case.runs, *key, tuple(runs)) for key, runs in found.items())
    yield Hypothesis(tuple(trials), always(*faults), OTHER_UNIT)


def hidden_mistakes(trials: Sequence[Trial], band: tuple[float, float]) -> tuple[MeasurementFault, ...]:
    """Return channels in other units than stated, and dead ones, in all of their runs, by the vehicle file's predictions alone.

    A loud lead-in makes noise of a channel that reads 57 times too much, and a base may bend until it hardly moves where one is dead.
    """
    predictions = [np.asarray(item.simulator.run(item.simulator.parameters(item.values), item.scenario).responses[0]) for item in trials]
    comparisons = [compare(trial, own, band) for trial, own in zip(trials, predictions, strict=True)]
    names, count = tuple(trial.name for trial in trials), Counter(name for trial in trials for name in trial.channels)
    units, dead = _other_units(trials, comparisons), _dead(trials, comparisons)
    return (
        *(_unit_fault(names, *key, tuple(runs)) for key, runs in units.items() if len(runs) == count[key[0]]),
        *(_dead_fault(names, name, tuple(runs)) for name, runs in dead.items() if len(runs) == count[name]),
    )


def _other_units(trials: Sequence[Trial], comparisons: Sequence[Comparison]) -> dict[tuple[str, str, float], list[str]]:
    """Return channels whose levels differ from their predictions' by what one unit is worth in another, and the runs in which they do.

    A channel must follow its prediction in one of the runs; over a measured road few do. A road that is rougher than its hump is high
    raises all channels alike.
    """
    found: dict[tuple[str, str, float], list[str]] = {}
    followed = set()
    for trial, item in zip(trials, comparisons, strict=True):
        usual = item.levels[np.abs(item.levels) < LIKE_PREDICTED]
        rough = max(float(np.median(usual)), 0.0) if len(usual) else 0.0
        for i, channel in enumerate(trial.recording.channels):
            factor = _nearest_factor(float(item.levels[i]) - rough, UNITS_OF.get(channel.quantity, {}))
            if factor != 1.0:
                key = channel.name, channel.quantity, factor
                found.setdefault(key, []).append(trial.name)
                if abs(item.own[item.best, i]) >= COHERENT:
                    followed.add(key)
    return {key: runs for key, runs in found.items() if key in followed}


def dead_hypotheses(case: BaseRefits) -> Iterator[Hypothesis]:
    """Yield that channels recorded noise only, those of all runs together."""
    found = _dead(case.trials, case.comparisons)
    if found:
        faults = tuple(_dead_fault(case.runs, name, tuple(runs)) for name, runs in found.items())
        blind = frozenset((run, name) for name, runs in found.items() for run in runs)
        yield Hypothesis(case.trials, always(*faults), ONE_CHANNEL, blind=blind)


def silent_hypotheses(case: BaseRefits) -> Iterator[Hypothesis]:
    """Yield that a channel recorded noise only in all of its runs: without it the base fits the others, and foretells none of it.

    The vehicle file may foretell too little for :func:`dead_hypotheses`.
    """
    names = dict.fromkeys(name for trial in case.trials for name in trial.channels)
    for name in names if len(names) > 1 else ():
        trials = [trial for trial in case.trials if name in trial.channels]
        runs = tuple(trial.name for trial in trials)
        silent = always(_dead_fault(case.runs, name, runs))
        hypothesis = Hypothesis(case.trials, silent, ONE_CHANNEL, blind=frozenset((run, name) for run in runs))
        fit, left = case.judge(hypothesis)
        if left <= ONE_CHANNEL:
            by_others = case.of_vehicle(fit.values)
            comparisons = (compare(trial, by_others.predict(trial), case.band) for trial in trials)
            if all(_around(item)[trial.channels.index(name)] < DEAD for trial, item in zip(trials, comparisons, strict=True)):
                yield hypothesis


def _around(item: Comparison) -> Array:
    """Return how well each channel follows its prediction at about the lag of all, `shape (n_channels,)`."""
    reach = round(NEIGHBOURS / item.dt)
    return np.asarray(np.abs(item.own[max(item.best - reach, 0) : item.best + reach + 1]).max(axis=0))


def _dead(trials: Sequence[Trial], comparisons: Sequence[Comparison]) -> dict[str, list[str]]:
    """Return channels that follow neither their prediction nor another channel, and the runs in which they do not."""
    found: dict[str, list[str]] = {}
    for trial, item in zip(trials, comparisons, strict=True):
        reach, around = round(NEIGHBOURS / item.dt), _around(item)
        channels = trial.recording.channels
        for i, channel in enumerate(channels):
            others = [j for j in range(len(channels)) if j != i]
            like = [j for j in others if channels[j].quantity == channel.quantity] or others
            late = np.abs(item.own[:, i]).max() > ALIVE  # it follows at another lag: a clock is wrong
            unlike = around[i] < DEAD and not late and like and around[like].min() > ALIVE
            if unlike and not _follows_another(trial, i, reach) and not _bursts(trial.recording.values[:, i], item.dt):
                found.setdefault(channel.name, []).append(trial.name)
    return found


def _dead_fault(names: tuple[str, ...], channel: str, runs: tuple[str, ...]) -> MeasurementFault:
    message = f"{channel} holds nothing but noise {place_words(runs, names)}: it does not follow what the other channels felt"
    cure = "leave this channel out of the run file, or record again with a sensor that works"
    return MeasurementFault("dead", runs, (channel,), message, cure)


def _follows_another(trial: Trial, channel: int, reach: int) -> bool:
    """Return whether a channel's slow motions follow those of another one, up to `reach` samples apart.

    A missing effect may spoil the prediction of a channel, but not what its sensor feels.
    """
    values = trial.recording.values - trial.recording.values.mean(axis=0)
    frequency = np.fft.rfftfreq(2 * len(values), trial.recording.dt)
    lines = np.fft.rfft(values, 2 * len(values), axis=0) * (frequency <= SLOW_MOTIONS_HZ)[:, None]
    power = np.sqrt(np.sum(np.abs(lines) ** 2, axis=0))
    both = np.fft.irfft(lines * lines[:, [channel]].conj(), axis=0) * len(values) / np.maximum(power * power[channel], 1e-300)
    near = np.abs(np.concatenate([both[-reach:], both[: reach + 1]])).max(axis=0)
    return bool(np.delete(near, channel).max(initial=0.0) > FOLLOWS)


def _bursts(values: Array, dt: float) -> bool:
    """Return whether a channel `shape (n_samples,)` is loud for a moment, as one that feels a hump is, whatever model and clock say."""
    length = max(round(BURST_S / dt), 2)
    stretches = values[: len(values) // length * length].reshape(-1, length)
    loudness = stretches.std(axis=1)  # about its own mean each: a zero may wander
    return bool(loudness.max(initial=0.0) > BURST * np.median(loudness))


def gain_hypotheses(case: BaseRefits) -> Iterator[Hypothesis]:
    """Yield that one channel has another gain in one run than in the others, where it stands out most."""
    if len(case.trials) < 3 or len({trial.channels for trial in case.trials}) > 1:
        return
    levels = np.array([item.levels for item in case.comparisons])
    apart = levels - np.median(levels, axis=0)
    apart -= np.median(apart, axis=1, keepdims=True)
    run, channel = np.unravel_index(np.abs(apart).argmax(), apart.shape)
    begin = float(np.exp(apart[run, channel]))
    if not GAIN_NOTICED < abs(np.log(begin)) < GAIN_FAR:
        return
    trial = case.trials[int(run)]
    name = trial.channels[int(channel)]

    def describe(numbers: Array) -> tuple[MeasurementFault, ...]:
        gain = float(numbers[-1])
        return (other_gain(trial.name, name, gain),) if abs(np.log(gain)) > GAIN_NOTICED else ()

    adjustment = RunGain(name, 0.05, 1.0, run=trial.name)
    yield Hypothesis(case.trials, describe, ONE_CHANNEL, (adjustment,), (begin,))


def other_gain(run: str, channel: str, gain: float) -> MeasurementFault:
    """Return that a channel reads `gain` times as much in one run as in the others."""
    message = f"{channel} reads {gain:.3g} times what it reads in the other runs in {run}"
    cure = "find out what was changed on this sensor, put its column right, or leave the channel out of this run"
    return MeasurementFault("gain", (run,), (channel,), message, cure, gain)


def drift_hypotheses(case: BaseRefits) -> Iterator[Hypothesis]:
    """Yield that channels have an offset or a drift, all of them together."""
    found: dict[str, dict[str, float]] = {}
    trials = []
    for trial, predicted in zip(case.trials, case.predictions, strict=True):
        if not is_held(trial.simulator.model, trial.values):
            return  # what nothing holds drifts by itself
        n = len(trial.recording.time)
        columns = np.column_stack([np.ones(n), np.linspace(-1, 1, n)])
        line = columns @ np.linalg.lstsq(columns, trial.recording.values - predicted[:n], rcond=None)[0]
        loudness = np.sqrt(np.mean((trial.recording.values - line) ** 2, axis=0))
        share = np.abs(line).max(axis=0) / np.maximum(loudness, 1e-300)
        for name, own in zip(trial.channels, share, strict=True):
            if own > DRIFT_NOTICED:
                found.setdefault(name, {})[trial.name] = float(own)
        values = trial.recording.values - np.where(share > DRIFT_NOTICED, line, 0.0)
        trials.append(replace(trial, recording=replace(trial.recording, values=values)))
    if found:
        faults = tuple(
            MeasurementFault(
                "drift",
                tuple(runs),
                (name,),
                f"{name} has an offset or drifts {place_words(tuple(runs), case.runs)}, "
                f"by up to {100 * max(runs.values()):.0f} % of its RMS",
                "take mean and trend off the column, or import the recording with its quiet lead-in, which does so",
            )
            for name, runs in found.items()
        )
        yield Hypothesis(tuple(trials), always(*faults), ONE_CHANNEL)


def scaled(trial: Trial, factors: Array) -> Trial:
    """Return a trial with its channels times factors `shape (n_channels,)`."""
    if np.all(factors == 1.0):
        return trial
    return replace(trial, recording=replace(trial.recording, values=trial.recording.values * factors))


def _nearest_factor(level: float, units: dict[str, float]) -> float:
    """Return by which factor readings are too large by their level, of those that exchanged units make; 1 where none is near."""
    worth = list(units.values())
    factors = sorted({one / other for one in worth for other in worth} | {1.0}, key=lambda factor: abs(level - np.log(factor)))
    return float(factors[0]) if abs(level - np.log(factors[0])) < NEAR_FACTOR else 1.0


def _unit_fault(names: tuple[str, ...], channel: str, quantity: str, factor: float, runs: tuple[str, ...]) -> MeasurementFault:
    units = UNITS_OF[quantity]
    pairs = [(one, other) for one in units for other in units if abs(np.log(units[other] / units[one] * factor)) < 1e-9]
    pair = next((pair for pair in pairs if next(iter(units)) in pair), pairs[0])
    many = f"{factor:.4g} times too large" if factor > 1 else f"{1 / factor:.4g} times too small"
    message = f"{channel} is {many} {place_words(runs, names)}: its readings are in {pair[1]}, and taken as {pair[0]}"
    known = factor_to_si(pair[1], parse_unit(next(iter(units)))[1]) is not None
    cure = f"set `unit: {pair[1]}` for it in the run file" if known else f"multiply its column by {1 / factor:.6g}"
    return MeasurementFault("unit", runs, (channel,), message, cure, factor)
