"""Runs that are not what their files say: files exchanged between two runs, speeds stated wrong."""

from __future__ import annotations

from collections.abc import Iterator
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
AS_GOOD_AS, MOST_EXCHANGES = 1.5, 2
"""Exchanges that leave this many times as much energy as the best are fitted too, so many at most."""
EXCHANGED_LEFT = 0.5
"""Largest share of the excess that may be left."""
WRONG_SPEED_LEFT = 0.25
UNITS_OF_SPEED = {"km/h": 1 / 3.6, "mph": 0.44704}
SPEED_FACTORS = tuple(round(0.7 + 0.01 * i, 2) for i in range(66))
"""True speeds over stated ones that are tried."""
HONEST_SPEED = 0.15
"""A speed wrong by up to this share, the same in all runs, is an effect (`speed_error`)."""
SAME_SPEED, LEAST_SPEED = 0.02, 0.025
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
            pair = _exchanged(one, other, kind), _exchanged(other, one, kind)
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
                changed = at_speed(trial, factor)
                tried[unit, factor] = (changed, compare(changed, case.predict(changed), case.band))
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
    """Yield that speeds are stated wrong in some runs; one error of all runs is left to the effect `speed_error`."""
    trials: list[Trial] = []
    found: dict[str, float] = {}
    for trial, item in zip(case.trials, case.comparisons, strict=True):
        trials.append(trial)
        if not trial.run.vehicle.axles:
            continue
        tried = {}
        for factor in SPEED_FACTORS:
            changed = at_speed(trial, factor)
            tried[factor] = (changed, compare(changed, case.predict(changed), case.band))
        factor = min(tried, key=lambda key: tried[key][1].unexplained)
        changed, own = tried[factor]
        if abs(factor - 1) > LEAST_SPEED and own.unexplained < BETTER * item.unexplained:
            trials[-1] = _placed(changed, own)
            found[trial.name] = factor
    same = len(found) == len(case.trials) and np.ptp(list(found.values())) <= SAME_SPEED
    if not found or (same and max(abs(factor - 1) for factor in found.values()) <= HONEST_SPEED):
        return
    faults = tuple(
        MeasurementFault(
            "speed",
            (run,),
            (),
            f"the speed of {run} was about {100 * abs(factor - 1):.0f} % {'higher' if factor > 1 else 'lower'} than stated",
            "measure it by the time between the axles' arrivals at the hump, or by GPS, and put it right",
            factor,
        )
        for run, factor in found.items()
    )
    yield Hypothesis(tuple(trials), always(*faults), WRONG_SPEED_LEFT)


def at_speed(trial: Trial, factor: float) -> Trial:
    """Return a trial at `factor` times its speed."""
    return replace(trial, scenario=trial.scenario.adjusted(speed=factor))


def _placed(trial: Trial, item: Comparison) -> Trial:
    """Return a trial whose scenario begins when its recording shows."""
    return replace(trial, scenario=trial.scenario.adjusted(delay=item.lag))


def _exchanged(trial: Trial, other: Trial, kind: str) -> Trial:
    """Return a trial with another's recording, speed or road."""
    if kind == "recording":
        times = other.scenario
        scenario = replace(trial.scenario, duration=times.duration, start=times.start, dt=times.dt, decimation=times.decimation)
        return replace(trial, recording=other.recording, scenario=scenario)
    if kind == "speed":
        return replace(trial, scenario=replace(trial.scenario, speed=other.scenario.speed))
    return replace(trial, scenario=replace(trial.scenario, track=other.scenario.track))
