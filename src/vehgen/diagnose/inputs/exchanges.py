"""Runs that are not what their files say: files exchanged between two runs, speeds stated wrong."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from vehgen.diagnose.inputs.comparison import Comparison, compare
from vehgen.diagnose.inputs.fault import Hypothesis, MeasurementFault, always, place_words
from vehgen.diagnose.inputs.refits import BaseRefits
from vehgen.fit.trial import Trial

Array = NDArray[np.float64]
BADLY = 0.15
"""Runs of whose energy the file's prediction leaves this share may have been exchanged."""
BETTER = 0.5
"""Undone, a mistake must leave this share of the energy that was not explained before."""
SOMEWHAT_BETTER = 0.85
"""Another speed of one run that leaves this share is fitted too: where the file's parameters are off, they leave the rest."""
AS_GOOD_AS, MOST_EXCHANGES = 1.5, 2
"""Exchanges that leave this many times as much energy as the best are fitted too, so many at most."""
EXCHANGED_LEFT = 0.5
"""Largest share of the excess that may be left."""
WRONG_SPEED_LEFT = 0.25
UNITS_OF_SPEED = {"km/h": 1 / 3.6, "mph": 0.44704}
BESIDE_UNIT = tuple(1 + 0.005 * i for i in range(-8, 9))
"""Beside another unit, the speed is off by so much: over a long road even that is told."""
SPEED_FACTORS = tuple(round(0.7 + 0.01 * i, 2) for i in range(66))
"""True speeds over stated ones that are tried."""
HONEST_SPEED = 0.15
"""A speed wrong by up to this share, the same in all runs, is an effect (`speed_error`)."""
SAME_SPEED, LEAST_SPEED = 0.05, 0.025
"""Factors within this of one another are one; a factor this near to 1 is left to the fit."""
SAME_INTERVAL = 1e-6
"""Sampling intervals within this share of one another are one."""
_WHAT = {
    "recording": "the recordings of {} and {} have been exchanged",
    "speed": "the speeds of {} and {} have been exchanged",
    "road": "the roads of {} and {} have been exchanged",
}


def exchange_hypotheses(case: BaseRefits) -> Iterator[Hypothesis]:
    """Yield that two runs' recordings, speeds or roads were exchanged, for the pair and kind that explain most."""
    found: list[tuple[float, str, int, int, tuple[Trial, Trial]]] = []
    bad = [i for i, item in enumerate(case.comparisons) if item.unexplained > BADLY]
    for i, j in combinations(bad, 2):
        one, other = case.trials[i], case.trials[j]
        if one.channels != other.channels or abs(one.recording.dt / other.recording.dt - 1) > SAME_INTERVAL:
            continue
        before = case.comparisons[i].unexplained + case.comparisons[j].unexplained
        for kind in _WHAT:
            pair = exchanged(one, other, kind), exchanged(other, one, kind)
            own = [compare(trial, case.predict(trial), case.band) for trial in pair]
            after = sum(item.unexplained for item in own)
            if after < BETTER * before:
                placed = tuple(_placed(trial, item) for trial, item in zip(pair, own, strict=True))
                found.append((after, kind, i, j, (placed[0], placed[1])))
    found.sort(key=lambda item: item[0])
    for _, kind, i, j, pair in [item for item in found if item[0] <= AS_GOOD_AS * found[0][0]][:MOST_EXCHANGES]:
        trials = list(case.trials)
        trials[i], trials[j] = pair
        names = (case.trials[i].name, case.trials[j].name)
        message = f"{_WHAT[kind].format(*names)}: each suits what the other's file says"
        fault = MeasurementFault(f"exchanged_{kind}s", names, (), message, "put the two run files right, and their notes")
        yield Hypothesis(tuple(trials), always(fault), EXCHANGED_LEFT)


def speed_unit_hypotheses(case: BaseRefits) -> Iterator[Hypothesis]:
    """Yield that speeds are stated in another unit than they are meant in, in all runs that show it together."""
    trials: list[Trial] = []
    found: dict[tuple[str, float], list[str]] = {}
    for trial, item in zip(case.trials, case.comparisons, strict=True):
        trials.append(trial)
        if not trial.run.vehicle.axles or item.unexplained < BADLY:
            continue
        tried = {}
        for unit, worth in UNITS_OF_SPEED.items():
            for factor in (worth, 1 / worth):
                near = [
                    _compared(case, trial, factor * own, anchor) for anchor in (0.0, trial.scenario.first_arrival) for own in BESIDE_UNIT
                ]
                tried[unit, factor] = min(near, key=lambda pair: pair[1].unexplained)
        key = min(tried, key=lambda key: tried[key][1].unexplained)
        changed, own = tried[key]
        if own.unexplained < BETTER * item.unexplained:
            trials[-1] = _placed(changed, own)
            found.setdefault(key, []).append(trial.name)
    if found:
        faults = tuple(
            MeasurementFault(
                "speed_unit",
                tuple(runs),
                (),
                f"the speed is {'too high' if factor < 1 else 'too low'} by the factor between {unit} and m/s "
                f"{place_words(tuple(runs), case.runs)}",
                f"state the speed with its unit: {'it was meant in ' + unit if factor < 1 else 'it was meant in m/s'}",
                factor,
            )
            for (unit, factor), runs in found.items()
        )
        yield Hypothesis(tuple(trials), always(*faults), EXCHANGED_LEFT)


def speed_hypotheses(case: BaseRefits) -> Iterator[Hypothesis]:
    """Yield that speeds are stated wrong in some runs, and in the one run alone whose speed suits it least.

    One error of all runs is left to the effect `speed_error`.
    """
    gains: dict[int, float] = {}
    found: dict[int, tuple[float, Trial]] = {}
    for i, (trial, item) in enumerate(zip(case.trials, case.comparisons, strict=True)):
        if not trial.run.vehicle.axles:
            continue
        tried = {factor: _compared(case, trial, factor) for factor in SPEED_FACTORS}
        factor = min(tried, key=lambda key: tried[key][1].unexplained)
        changed, own = tried[factor]
        gain = own.unexplained / max(item.unexplained, 1e-300)
        if abs(factor - 1) > LEAST_SPEED and gain < SOMEWHAT_BETTER:
            gains[i] = gain
            found[i] = factor, _placed(changed, own)
    clear = tuple(i for i, gain in gains.items() if gain < BETTER)
    factors = [found[i][0] for i in clear]
    same = len(clear) == len(case.trials) and np.ptp(factors) <= SAME_SPEED
    if clear and not (same and max(abs(factor - 1) for factor in factors) <= HONEST_SPEED):
        yield _other_speeds(case, {i: found[i] for i in clear})
    alone = min(gains, key=lambda i: gains[i], default=None)
    if alone is not None and clear != (alone,):
        yield _other_speeds(case, {alone: found[alone]})


def _other_speeds(case: BaseRefits, found: Mapping[int, tuple[float, Trial]]) -> Hypothesis:
    """Return that runs, by number, were driven at so many times their stated speeds."""
    trials = [found[i][1] if i in found else trial for i, trial in enumerate(case.trials)]
    faults = tuple(
        MeasurementFault(
            "speed",
            (run,),
            (),
            f"the speed of {run} was about {100 * abs(factor - 1):.0f} % {'higher' if factor > 1 else 'lower'} than stated",
            "measure it by the time between the axles' arrivals at the hump, or by GPS, and put it right",
            factor,
        )
        for run, factor in ((case.trials[i].name, found[i][0]) for i in sorted(found))
    )
    return Hypothesis(tuple(trials), always(*faults), WRONG_SPEED_LEFT)


def _compared(case: BaseRefits, trial: Trial, factor: float, anchor: float = 0.0) -> tuple[Trial, Comparison]:
    """Return a trial at `factor` times its speed, where it is at the time `anchor` [s] unchanged, and how it then compares."""
    changed = replace(trial, scenario=trial.scenario.adjusted(speed=factor, anchor=anchor))
    return changed, compare(changed, case.predict(changed), case.band)


def _placed(trial: Trial, item: Comparison) -> Trial:
    """Return a trial whose scenario begins when its recording shows."""
    return replace(trial, scenario=trial.scenario.adjusted(delay=item.lag))


def exchanged(trial: Trial, other: Trial, kind: str) -> Trial:
    """Return a trial with another's recording, speed or road."""
    if kind == "recording":
        times = other.scenario
        scenario = replace(trial.scenario, duration=times.duration, start=times.start, dt=times.dt, decimation=times.decimation)
        return replace(trial, recording=other.recording, scenario=replace(scenario, skipped=times.skipped))
    if kind == "speed":
        return replace(trial, scenario=replace(trial.scenario, speed=other.scenario.speed))
    return replace(trial, scenario=replace(trial.scenario, track=other.scenario.track))
