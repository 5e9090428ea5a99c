"""Another hump than the file says: its length and its shape, by what suits the recordings better."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import cache, partial
from itertools import combinations, product
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from vehgen.diagnose.inputs.comparison import compare
from vehgen.diagnose.inputs.fault import Hypothesis, MeasurementFault, always, place_words
from vehgen.diagnose.inputs.refits import BaseRefits, base_refits
from vehgen.fit.trial import Trial
from vehgen.road import Hump

if TYPE_CHECKING:
    from vehgen.diagnose.detect.detection import Detection

Array = NDArray[np.float64]
RunScore = Callable[[int, str, float], float]
"""How well a run, by its number, is foretold over a hump of a shape and so many times the stated length."""
SHAPES = ("half_sine", "versine", "trapezoid")
LENGTHS = tuple(round(0.6 + 0.05 * i, 2) for i in range(23))
"""True lengths over stated ones that are tried."""
FINE_LENGTHS = tuple(0.01 * i for i in range(-4, 5))
FAR_LENGTHS = (0.6, 0.75, 0.95, 1.2, 1.5)
"""Those from which refits reach all between: a length may err by 12 %."""
RISEN = 0.02
"""Gain in correlation from which another hump is fitted."""
HUMP_LEFT = 0.25
"""Largest share of the excess that another hump may leave."""
ONE_HUMP = 0.02
"""Humps whose lengths and heights agree within this share are one."""
TOWARDS, EXCHANGE_TOLD = 2.0, 36.0
"""Two heights, each so many standard deviations nearer to the other, may have been exchanged; so much -2 ln L must then fall at least."""


def hump_hypotheses(case: BaseRefits) -> Iterator[Hypothesis]:
    """Yield that humps have another length or shape: all of them, those of one size, or that of one run only, each of every shape.

    A refit tells which: a speed a little off costs more correlation than a wrong shape.
    """
    groups, score = _groups(case.trials), cache(partial(_score, case))  # of a run with others over its hump, then of it alone
    changed = [item for group in groups if (item := _best(case, group, score)) is not None]
    alone = [(number,) for group in groups if len(group) > 1 for number in group]
    single = [item for runs in (*groups, *alone) for shape in SHAPES if (item := _best(case, runs, score, (shape,))) is not None]
    for items in ([changed] if len(changed) > 1 else []) + [[item] for item in single]:
        yield _other_humps(case, items)


def odd_hump_hypotheses(case: BaseRefits) -> Iterator[Hypothesis]:
    """Yield that the run that the vehicle of all others does not explain is over a hump of each shape and of lengths far apart.

    Correlations need not tell: with the true hump 0.62, with the file's 0.66, where a refit left nothing over the true one.
    """
    for number in (i for group in _groups(case.trials) for i in group if case.trials[i].name == case.odd):
        for shape, factor in product(SHAPES, FAR_LENGTHS):
            yield _other_humps(case, [_changed(case, (number,), shape, factor)])


def _other_humps(case: BaseRefits, items: Sequence[tuple[dict[int, Trial], MeasurementFault]]) -> Hypothesis:
    """Return that runs are over other humps."""
    changed = {number: trial for runs, _ in items for number, trial in runs.items()}
    trials = tuple(changed.get(number, trial) for number, trial in enumerate(case.trials))
    return Hypothesis(trials, always(*(fault for _, fault in items)), HUMP_LEFT)


def _groups(trials: Sequence[Trial]) -> list[tuple[int, ...]]:
    """Return the numbers of the runs over each hump; runs over several humps are left out."""
    found: list[tuple[Hump, list[int]]] = []
    for i, trial in enumerate(trials):
        if len(trial.scenario.humps) != 1 or _top(trial.scenario.humps[0]) == 0:
            continue
        hump = trial.scenario.humps[0]
        for other, members in found:
            if abs(hump.length / other.length - 1) < ONE_HUMP and abs(_top(hump) / _top(other) - 1) < ONE_HUMP:
                members.append(i)
                break
        else:
            found.append((hump, [i]))
    return [tuple(members) for _, members in found]


def _best(
    case: BaseRefits, group: tuple[int, ...], score: RunScore, shapes: Sequence[str] = SHAPES
) -> tuple[dict[int, Trial], MeasurementFault] | None:
    """Return runs, by number, over the hump that suits them best, with the fault told; None where that is the file's."""

    def mean(shape: str, factor: float) -> float:
        return float(np.mean([score(number, shape, factor) for number in group]))

    as_filed = float(np.mean([case.comparisons[i].score for i in group]))
    scores = {(shape, factor): mean(shape, factor) for shape in shapes for factor in LENGTHS}
    shape, factor = max(scores, key=lambda key: scores[key])
    fine = {(shape, factor + step): mean(shape, factor + step) for step in FINE_LENGTHS}
    shape, factor = max(fine, key=lambda key: fine[key])
    return None if fine[shape, factor] < as_filed + RISEN else _changed(case, group, shape, factor)


def _changed(case: BaseRefits, group: tuple[int, ...], shape: str, factor: float) -> tuple[dict[int, Trial], MeasurementFault]:
    """Return runs, by number, over a hump of another shape, and of `factor` times the length, with the fault told."""
    changed, levels = {i: _over(case.trials[i], shape, factor) for i in group}, []
    for i, trial in changed.items():
        item = compare(trial, case.predict(trial), case.band)
        levels.append(float(np.mean(item.levels)))
        changed[i] = replace(trial, scenario=trial.scenario.adjusted(delay=item.lag, height=float(np.exp(levels[-1]))))
    hump = changed[group[0]].scenario.humps[0]
    runs, height = tuple(case.trials[i].name for i in group), _top(hump) * float(np.exp(np.mean(levels)))
    words = f"about {hump.length:.2g} m long, {1e3 * height:.0f} mm high and shaped as a {shape.replace('_', ' ')}"
    message = f"the hump {place_words(runs, case.runs)} is another than the file says: one {words} suits the recordings"
    cure = "measure length, height and profile of the hump and put the run file right"
    return changed, MeasurementFault("hump", runs, (), message, cure, hump.length, "m")


def _score(case: BaseRefits, number: int, shape: str, factor: float) -> float:
    """Return how well a run, by its number, is foretold over a hump of another shape and so many times as long."""
    changed = _over(case.trials[number], shape, factor)
    return compare(changed, case.predict(changed), case.band).score


def _over(trial: Trial, shape: str, factor: float) -> Trial:
    """Return a trial over a hump of another shape, and of `factor` times the length about the same middle."""
    track = trial.scenario.track
    old = trial.scenario.humps[0]
    new = Hump.from_shape(shape, old.at + (1 - factor) * old.length / 2, factor * old.length, _top(old))
    parts = tuple(new if part is old else part for part in track.parts)
    return replace(trial, scenario=replace(trial.scenario, track=replace(track, parts=parts)))


def _top(hump: Hump) -> float:
    """Return the height of a hump [m]."""
    heights = hump.shape(np.linspace(0.0, hump.length, 201))
    return float(heights[np.abs(heights).argmax()])


def road_heights(trials: Sequence[Trial]) -> dict[str, float]:
    """Return the height of every run's highest hump [m] by its name; runs without humps are left out."""
    return {trial.name: max(_top(hump) for hump in trial.scenario.humps) for trial in trials if trial.scenario.humps}


def exchanged_humps(detection: Detection) -> tuple[MeasurementFault, ...]:
    """Return which two runs' humps were exchanged, where the base supposes heights nearer to one another's, and leaves noise over them."""
    heights = {item.run: item.sigmas for part in detection.base.parts for item in part.conditions() if item.name == "height"}
    single = [i for i, trial in enumerate(detection.trials) if trial.scenario.over_humps_alone and len(trial.scenario.humps) == 1]
    tops = {i: _top(detection.trials[i].scenario.humps[0]) for i in single}
    rising = [(i, j) if tops[i] < tops[j] else (j, i) for i, j in combinations(tops, 2) if tops[i] != tops[j]]
    names = [trial.name for trial in detection.trials]
    suspected = [(i, j) for i, j in rising if min(heights.get(names[i], 0.0), -heights.get(names[j], 0.0)) >= TOWARDS]
    if not suspected:
        return ()
    case = base_refits(detection)
    refits = {pair: case.refit(case.problem.with_trials(_exchanged(case.trials, *pair))) for pair in suspected}
    best = min(refits, key=lambda pair: refits[pair][0].loss)
    fit, left = refits[best]
    if left > case.noise or case.refit(case.problem)[0].loss - fit.loss < EXCHANGE_TOLD:
        return ()
    pair = names[best[0]], names[best[1]]
    message = f"the humps of {pair[0]} and {pair[1]} have been exchanged: each suits the other's recording"
    return (
        MeasurementFault("exchanged_heights", pair, (), message, "put the humps of the two run files right, or exchange their recordings"),
    )


def _exchanged(trials: Sequence[Trial], i: int, j: int) -> list[Trial]:
    """Return trials of which two, by number, have one another's hump where their own is."""
    found = list(trials)
    for number, other in ((i, j), (j, i)):
        own, hump = trials[number].scenario, trials[other].scenario.humps[0]
        track = replace(own.track, parts=(replace(hump, at=own.humps[0].at),))
        found[number] = replace(trials[number], scenario=replace(own, track=track))
    return found
