"""Recorders that are wrong: a clock that runs too fast, and a filter that cuts off what the vehicle does."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from vehgen.diagnose.detect.detection import Detection, detect
from vehgen.diagnose.fits.begun_again import is_strained
from vehgen.diagnose.inputs.adjustments import ClockRate, RecorderFilter
from vehgen.diagnose.inputs.comparison import compare
from vehgen.diagnose.inputs.fault import Hypothesis, MeasurementFault, place_words
from vehgen.diagnose.inputs.refits import BaseRefits
from vehgen.fit.adjustments import SpeedScale
from vehgen.fit.chain_estimate import FAR_BETTER, ChainSearch
from vehgen.fit.recorders import FoundRecorder, by_sensor, low_pass_words, with_unknown
from vehgen.fit.trial import Trial
from vehgen.fit.window import transform
from vehgen.measure.acquisition import AcquisitionChain

Array = NDArray[np.float64]
RATE_LEFT = 0.25
"""Largest share of the excess that another rate of the clock may leave."""
FILTER_LEFT = 0.5
"""The same for a filter, of which the order is not known, and which cuts the noise too, so that it is taken as smaller than it is."""
RATES = tuple(round(0.85 + 0.01 * i, 2) for i in range(31))
RATE_NOTICED, LEAST_RATE_ERROR = 0.02, 0.02
"""Gain in correlation from which another rate of the clock is fitted, and the smallest such rate less one."""
AS_WELL = 3.0
"""A clock is told from a speed where it leaves less by this factor; where it leaves less at all, the two are a tie."""
CLOCK = ClockRate("", 0.01, 1.0, low=0.7, high=1.4)
SLOW_BAND_HZ, FAST_BAND_HZ = (0.5, 4.0), (15.0, 35.0)
"""A filtered channel follows the prediction in the lower band, and lacks most of it in the upper."""
FILTERED_SHARE = 0.35
"""Share of the predicted amplitude in the upper band, over that in the lower, below which a filter is fitted."""
FIRST_CUTOFF_HZ = 10.0
SLOW_RECORDER_HZ = 20.0
"""A recorder that cuts off below this hides wheel hop."""
DECLARATION_CURE = "write `acquisition: unknown`, or what the recorder's data sheet says"
FILTER_CURE = "switch the recorder's filter off, or record faster than it filters; else compare below the cut-off with `band`"


def other_rate(case: BaseRefits) -> tuple[float, float] | None:
    """Return the rate of a clock that is too fast or too slow, and the share of the excess that it leaves, where it explains the runs."""
    scores = []
    for rate in RATES:
        own = [compare(trial, case.predict(trial, (CLOCK,), (rate,)), case.band).score for trial in case.trials]
        scores.append(float(np.mean(own)))
    best = RATES[int(np.argmax(scores))]
    if max(scores) < scores[RATES.index(1.0)] + RATE_NOTICED or abs(best - 1) < LEAST_RATE_ERROR:
        return None
    left = case.refit(case.problem, (CLOCK,), (best,))[1]
    return (best, left) if left <= max(RATE_LEFT, case.noise) else None


def rate_hypotheses(case: BaseRefits) -> Iterator[Hypothesis]:
    """Yield that the recorder's clock is too fast or too slow; a tie with the speed is told as such."""
    if (known := other_rate(case)) is None:
        return
    best, by_clock = known
    by_speed = min(case.refit(case.problem, (SpeedScale("runs", 0.01, 1.0),), (start,))[1] for start in (1 / best, 1.0))
    if by_speed < by_clock:
        return

    def describe(numbers: Array) -> tuple[MeasurementFault, ...]:
        rate = float(numbers[-1])
        words = f"the recorder's clock seems to run {100 * abs(rate - 1):.1f} % too {'fast' if rate > 1 else 'slow'} in all runs"
        cure = "check the recorder's sampling rate against a stopwatch, and the speed against a measured stretch"
        if by_speed < max(AS_WELL * by_clock, case.noise):
            return (MeasurementFault("clock_or_speed", (), (), f"{words}, or the speeds are stated wrong by as much", cure, rate),)
        return (MeasurementFault("clock_rate", (), (), words, cure, rate),)

    yield Hypothesis(case.trials, describe, max(RATE_LEFT, case.noise), (CLOCK,), (best,))


def slow_recorder(recorder: FoundRecorder | None, runs: tuple[str, ...]) -> tuple[MeasurementFault, ...]:
    """Return that a recorder which nobody stated cuts off what a vehicle does, where a fit that leaves nothing has found so clearly."""
    found = []
    for channels, known in () if recorder is None else recorder.parts:
        cutoff = known.best.chain.cut_off
        if known.is_clear and cutoff is not None and cutoff < SLOW_RECORDER_HZ:
            message = f"{', '.join(channels)} {'was' if len(channels) == 1 else 'were'} low-passed at about {cutoff:.2g} Hz in all runs"
            found.append(MeasurementFault("low_pass", runs, channels, message, FILTER_CURE, cutoff, "Hz"))
    return tuple(found)


def wrongly_declared(detection: Detection) -> tuple[MeasurementFault, ...]:
    """Return that recorders are not what run files say of them, where the base leaves noise behind what the recordings show."""
    every = tuple(dict.fromkeys(name for trial in detection.trials for name in trial.channels))
    sought = () if detection.recorder is None else detection.recorder.channels
    declared = tuple(name for name in every if name not in sought)
    if not declared:
        return ()
    search = ChainSearch.of(detection.base.least_squares.misfit, detection.base.least_squares.x)
    stated = search.stated_loss()
    sets = dict.fromkeys((declared, *by_sensor(detection.trials, declared)))
    if not any(search.is_far_better(search.rough_loss(channels, {}), stated) for channels in sets):
        return ()
    anew = detect(with_unknown(detection.trials, every), detection.asked_band)
    if anew.recorder is None or not anew.is_quiet or is_strained(anew.base.least_squares):
        return ()
    search = ChainSearch.of(anew.base.least_squares.misfit, anew.base.least_squares.x)
    least, found = search.stated_loss(), []
    for part, known in anew.recorder.parts:
        for chain, names in _declared_chains(detection, [name for name in part if name in declared]).items():
            if search.fit(chain, names).loss < least + FAR_BETTER:
                continue
            message = (
                f"{', '.join(names)}: `acquisition` says {low_pass_words(chain)}, but the recordings look as if made through "
                f"{low_pass_words(known.best.chain)}{'' if known.is_clear else ', though others would do as well'}"
            )
            found.append(MeasurementFault("recorder", (), names, message, DECLARATION_CURE, known.best.chain.cut_off, "Hz"))
    return tuple(found)


def _declared_chains(detection: Detection, channels: Sequence[str]) -> dict[AcquisitionChain, tuple[str, ...]]:
    """Return channels by the low-pass that run files declare of them, the first run's that has them; clocks tell how late it is."""
    found: dict[AcquisitionChain, tuple[str, ...]] = {}
    for name in channels:
        stated = next(trial.scenario.chain(name) for trial in detection.trials if name in trial.channels)
        chain = replace(stated.filtering(), delay=0.0)
        found[chain] = (*found.get(chain, ()), name)
    return found


def filter_hypotheses(case: BaseRefits) -> Iterator[Hypothesis]:
    """Yield that channels were filtered, all of them together by one filter; and that all channels were, where most of them seem so.

    A channel that is mostly noise seems to have kept what a filter takes off.
    """
    found: dict[str, tuple[str, ...]] = {}
    for trial, predicted in zip(case.trials, case.predictions, strict=True):
        kept = _kept(trial, predicted)
        slow = tuple(name for name, share in zip(trial.channels, kept, strict=True) if share < FILTERED_SHARE)
        if slow:
            found[trial.name] = slow
    if not found:
        return
    seen = tuple(dict.fromkeys(name for names in found.values() for name in names))
    every = tuple(dict.fromkeys(name for trial in case.trials for name in trial.channels))
    yield _filtered(case, tuple(found), seen)
    if len(every) > len(seen) > len(every) / 2:
        yield _filtered(case, case.runs, every)


def _filtered(case: BaseRefits, runs: tuple[str, ...], channels: tuple[str, ...]) -> Hypothesis:
    def describe(numbers: Array) -> tuple[MeasurementFault, ...]:
        cutoff = float(np.exp(numbers[-1]))
        where = place_words(runs, case.runs)
        message = f"{', '.join(channels)} {'was' if len(channels) == 1 else 'were'} low-passed at about {cutoff:.2g} Hz {where}"
        return (MeasurementFault("low_pass", runs, channels, message, FILTER_CURE, cutoff, "Hz"),)

    change = RecorderFilter("", 0.1, runs=runs, channels=channels)
    return Hypothesis(case.trials, describe, FILTER_LEFT, (change,), (float(np.log(FIRST_CUTOFF_HZ)),))


def _kept(trial: Trial, predicted: Array) -> Array:
    """Return the recorded over the predicted amplitude at high frequencies, over that at low ones, `shape (n_channels,)`."""
    dt, n = trial.recording.dt, len(predicted)
    frequency = np.fft.rfftfreq(n, dt)
    shares = []
    for low, high in (FAST_BAND_HZ, SLOW_BAND_HZ):
        inside = (frequency >= low) & (frequency <= min(high, 0.45 / dt))
        measured, model = (transform(item, dt, inside, seen=trial.window) for item in (trial.recording.values[:n], predicted))
        shares.append(np.sqrt((np.abs(measured) ** 2).sum(axis=0) / np.maximum((np.abs(model) ** 2).sum(axis=0), 1e-300)))
    return np.asarray(shares[0] / np.maximum(shares[1], 1e-300))
