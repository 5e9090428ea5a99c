"""Which mistakes of the measurement were made? Each is undone, the base model fitted again, and the best is kept; then again."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from copy import copy
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from vehgen.diagnose.detect.odd_run import OddChannel, OddRun
from vehgen.diagnose.detect.road_error import measured_profiles
from vehgen.diagnose.inputs.amplitudes import (
    dead_hypotheses,
    drift_hypotheses,
    gain_hypotheses,
    hidden_mistakes,
    other_gain,
    silent_hypotheses,
    unit_hypotheses,
)
from vehgen.diagnose.inputs.axles import axle_hypotheses
from vehgen.diagnose.inputs.checks import check_inputs
from vehgen.diagnose.inputs.clocks import clock_hypotheses
from vehgen.diagnose.inputs.conditions import BEYOND, findings_of_conditions, moved_roads
from vehgen.diagnose.inputs.copies import find_copies
from vehgen.diagnose.inputs.driving import input_hypotheses
from vehgen.diagnose.inputs.exchanges import exchange_hypotheses, speed_hypotheses, speed_unit_hypotheses
from vehgen.diagnose.inputs.fault import Hypothesis, MeasurementFault
from vehgen.diagnose.inputs.humps import hump_hypotheses, odd_hump_hypotheses, road_heights
from vehgen.diagnose.inputs.labels import label_hypotheses
from vehgen.diagnose.inputs.levels import level_hypotheses
from vehgen.diagnose.inputs.recorders import filter_hypotheses, rate_hypotheses, slow_recorder
from vehgen.diagnose.inputs.refits import BaseRefits, base_refits
from vehgen.diagnose.inputs.road_features import feature_hypotheses
from vehgen.diagnose.inputs.vehicle import other_vehicle, strange_run, strange_run_hypotheses, unrelated_recording
from vehgen.diagnose.thresholds import NOISE_FLOOR, WEAK
from vehgen.fit.least_squares import LeastSquaresFit

if TYPE_CHECKING:
    from vehgen.diagnose.detect.detection import Detection
    from vehgen.diagnose.fits.model_fit import ModelFit

MOST_MISTAKES = 3
"""So many mistakes told end the search."""
HELPS = 0.95
"""A plain mistake that leaves more than this share of the excess is not looked at beside another."""
CLEARLY_BETTER = 3.0
"""Mistakes win over effects where these leave so many times their excess."""
CLEAR, BY_FAR = 0.1, 0.5
"""A plain mistake that leaves the one share of the excess is not compared with subtle ones; these must leave the other share of its own."""
FLOOR = NOISE_FLOOR**2 - 1
"""Excess at which nothing is left."""
Generator = Callable[[BaseRefits], Iterator[Hypothesis]]
PLAIN: tuple[Generator, ...] = (
    input_hypotheses,
    label_hypotheses,
    unit_hypotheses,
    dead_hypotheses,
    exchange_hypotheses,
    speed_unit_hypotheses,
    lambda case: clock_hypotheses(case, decisive=True),
)
"""What no effect of the library looks like: looked for before any effect is."""
SUBTLE: tuple[Generator, ...] = (
    silent_hypotheses,
    speed_hypotheses,
    lambda case: clock_hypotheses(case, decisive=False),
    gain_hypotheses,
    level_hypotheses,
    drift_hypotheses,
    filter_hypotheses,
    axle_hypotheses,
    hump_hypotheses,
    feature_hypotheses,
    rate_hypotheses,
    strange_run_hypotheses,
    odd_hump_hypotheses,
)
"""What an effect may look like, looked for where none explains the runs."""


@dataclass(frozen=True)
class _Judged:
    hypothesis: Hypothesis
    fit: LeastSquaresFit
    left: float
    faults: tuple[MeasurementFault, ...]

    @property
    def strained(self) -> bool:
        """Whether the refit supposes something of runs or sensors beyond belief."""
        return any(abs(item.sigmas) > BEYOND for item in self.fit.conditions())

    def explains(self, excess: float) -> bool:
        """Whether it leaves noise of an excess, and supposes nothing else."""
        return self.left * excess <= FLOOR and not self.strained


@dataclass(frozen=True)
class Undone:
    """The mistakes that explain a gap, the one that explains most first; none where none does.

    `left` is the share of the gap's excess that they leave; `at_once` tells whether a single one leaves noise, and supposes nothing else.
    `case` holds the runs with the mistakes undone.
    """

    faults: tuple[MeasurementFault, ...]
    left: float
    at_once: bool
    case: BaseRefits


def find_mistakes(detection: Detection, plain_only: bool = False) -> Undone:
    """Return the mistakes that explain the base model's gap; with `plain_only` subtle ones only where they stand beside plain ones."""
    case = base_refits(detection)
    found: list[MeasurementFault] = []
    at_once = False
    while len(found) < MOST_MISTAKES:
        steps = _next(case, plain_only)
        if not steps:
            break
        at_once = not found and len(steps) == 1 and steps[0].explains(case.excess)
        for step in steps:
            found += step.faults
            case.accept(step.hypothesis, step.fit, step.left)
        if case.excess <= FLOOR:
            break
    return Undone(tuple(found), case.excess / case.first_excess, at_once, case)


def _next(case: BaseRefits, plain_only: bool) -> tuple[_Judged, ...]:
    """Return the mistake that explains most, or two plain ones that only together explain enough; nothing where there is none."""
    judged = _judge(case, PLAIN)
    best = _least(judged, case.excess)
    if best is None and (pair := _pair(case, judged)):
        return pair
    doubtful = not plain_only if best is None else best.left > CLEAR and best.left * case.excess > FLOOR
    if doubtful:
        other = _least(_judge(case, SUBTLE), case.excess)
        best = other if best is None or (other is not None and other.left < BY_FAR * best.left) else best
    return () if best is None else (best,)


def _judge(case: BaseRefits, generators: tuple[Generator, ...]) -> list[_Judged]:
    """Return the hypotheses of generators, refitted; the first that leaves noise, and supposes nothing else, ends the search."""
    judged: list[_Judged] = []
    for generate in generators:
        for hypothesis in generate(case):
            fit, left = case.judge(hypothesis)
            faults = hypothesis.describe(fit.misfit.adjusted(fit.x))
            if faults:
                judged.append(_Judged(hypothesis, fit, left, faults))
        best = _least(judged, case.excess)
        if best is not None and best.explains(case.excess):
            break
    return judged


def _least(judged: Sequence[_Judged], excess: float) -> _Judged | None:
    """Return what leaves least of what keeps its limit; of what leaves noise, what supposes nothing else."""
    kept = [item for item in judged if item.left <= item.hypothesis.limit]
    return min([item for item in kept if item.explains(excess)] or kept, key=lambda item: item.left, default=None)


def _explaining(case: BaseRefits, judged: Sequence[_Judged]) -> tuple[MeasurementFault, ...]:
    """Return the faults of what alone leaves noise, and supposes nothing else; nothing where none does."""
    best = _least(judged, case.excess)
    return best.faults if best is not None and best.explains(case.excess) else ()


def _pair(case: BaseRefits, judged: Sequence[_Judged]) -> tuple[_Judged, ...]:
    """Return a mistake that does not explain enough by itself, with a second one that does beside it."""
    first = min(judged, key=lambda item: item.left, default=None)
    if first is None or first.left > HELPS:
        return ()
    beside = copy(case)
    beside.accept(first.hypothesis, first.fit, first.left)
    second = _least(_judge(beside, PLAIN), beside.excess)
    return () if second is None or first.left * second.left > first.hypothesis.limit else (first, second)


def recorded_mistakes(detection: Detection) -> tuple[MeasurementFault, ...]:
    """Return what recordings show by themselves: clipped and stuck channels, copies of a pass, units that noise hides, dead channels."""
    hidden = hidden_mistakes(detection.trials, detection.band) if detection.is_quiet else ()
    return (*check_inputs(detection.trials), *find_copies(detection.trials, detection.floor.noises, detection.band), *hidden)


def supposed_mistakes(detection: Detection) -> tuple[MeasurementFault, ...]:
    """Return what the base fit had to suppose of the runs beyond belief, or that it explains nothing of them at all."""
    conditions = [item for part in detection.base.parts for item in part.conditions()]
    found = findings_of_conditions(conditions, [trial.name for trial in detection.trials], road_heights(detection.trials))
    speeds = {trial.name: trial.scenario.top_speed for trial in detection.trials if measured_profiles(trial)}
    told = {run for item in found if item.kind == "clock" for run in item.runs}
    arrivals = {trial.name: trial.scenario.first_arrival - trial.scenario.start for trial in detection.trials if trial.scenario.track.parts}
    moved = (item for item in moved_roads(conditions, speeds, arrivals) if not told & set(item.runs))
    stranger = unrelated_recording(detection.base.least_squares)
    unlike = (_mislabelled(detection) or stranger) if stranger else ()
    return (*found, *unlike, *moved, *_slow(detection))


def plain_mistake_instead(detection: Detection) -> tuple[MeasurementFault, ...]:
    """Return the plain mistake that explains the runs better than all that a base supposes of them; nothing where there is none.

    A base may bend a road and its place so far that noise is left of a run which was driven at another speed altogether.
    """
    case = base_refits(detection)
    return _explaining(case, _judge(case, PLAIN))


def _mislabelled(detection: Detection) -> tuple[MeasurementFault, ...]:
    """Return the wrong labels that leave least once they are put right, where recordings are no stranger's then."""
    case = base_refits(detection)
    right = [(hypothesis, *case.judge(hypothesis)) for hypothesis in label_hypotheses(case)]
    known = [item for item in right if not unrelated_recording(item[1])]
    return min(known, key=lambda item: item[2])[0].describe(np.zeros(0)) if known else ()


def _slow(detection: Detection) -> tuple[MeasurementFault, ...]:
    """Return that a recorder which nobody stated cuts off what a vehicle does."""
    return slow_recorder(detection.recorder, tuple(trial.name for trial in detection.trials))


def odd_mistake(odd: OddRun | OddChannel) -> MeasurementFault:
    """Return the mistake by which a run, or one of its channels, does not agree with the others."""
    return other_gain(odd.run, odd.channel, odd.factor) if isinstance(odd, OddChannel) else strange_run(odd.run)


def plain_mistakes(detection: Detection) -> tuple[MeasurementFault, ...]:
    """Return mistakes that no effect of the library looks like; a slow recorder where the base leaves next to nothing behind it.

    Where a base has bent to a mistake so far that refits do not tell, the vehicle file's predictions do.
    """
    slow = _slow(detection) if detection.chi <= WEAK else ()
    return slow or find_mistakes(detection, plain_only=True).faults or hidden_mistakes(detection.trials, detection.band)


def timing_mistakes(detection: Detection) -> tuple[MeasurementFault, ...]:
    """Return that axles are elsewhere than the vehicle file says, or a clock runs fast or slow, where that alone leaves noise."""
    case = base_refits(detection)
    return _explaining(case, [*_judge(case, (axle_hypotheses,)), *_judge(case, (rate_hypotheses,))])


def explain_gap(
    detection: Detection,
    leading: ModelFit | None = None,
    vehicle: bool = True,
    nearest: ModelFit | None = None,
    undone: Undone | None = None,
) -> tuple[MeasurementFault, ...]:
    """Return the mistakes that explain what the base model misses, whatever they look like; nothing where none does, or nothing is missing.

    Parameters
    ----------
    detection
        The base model's gap.
    leading
        What effects explain best; mistakes must leave a clearly smaller excess (default: no effects were found).
    vehicle
        Whether the vehicle may be another one altogether, as effects leave something or explain nothing. Then a low-pass wins that does
        nearly as well as they do: it cuts off noise, too, so that what it leaves is held against too small a one.
    nearest
        What comes nearest, though it may explain little: recordings much of which it explains are no stranger's (default: `leading`).
    undone
        The mistakes that were found (default: look for them).
    """
    if detection.is_quiet:
        return supposed_mistakes(detection)
    undone = undone or find_mistakes(detection)
    found = undone.faults
    kinds = {item.kind for item in found}
    clock = kinds == {"clock_or_speed"}
    better = 1.0 if clock else CLEARLY_BETTER  # a tie with the effect is a tie
    better = 1 / CLEARLY_BETTER if vehicle and kinds == {"low_pass"} else better
    tie = clock and undone.case.excess <= FLOOR
    if found and (leading is None or tie or better * undone.left < (leading.chi**2 - 1) / (detection.chi**2 - 1)):
        return found
    if found or not vehicle:
        return ()
    nearest = nearest or leading
    return other_vehicle(undone.case) or unrelated_recording(undone.case.base if nearest is None else nearest.least_squares)
