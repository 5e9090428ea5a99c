"""Runs that are louder or quieter than their files let expect: another hump height, or the heights of two runs exchanged."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from vehgen.diagnose.inputs.adjustments import RunLevel
from vehgen.diagnose.inputs.fault import Hypothesis, MeasurementFault
from vehgen.diagnose.inputs.humps import road_heights
from vehgen.diagnose.inputs.refits import BaseRefits

Array = NDArray[np.float64]
LEVEL_NOTICED, LEVEL_FAR = 0.1, 1.5
"""A run's level off by more than the one and less than the other, as a logarithm, is fitted."""
NEAR_RATIO = 0.15
"""Levels of two runs within this of the ratio of their heights, as logarithms, suggest an exchange."""
LEVEL_LEFT = 0.25
"""Largest share of the excess that may be left."""


def level_hypotheses(case: BaseRefits) -> Iterator[Hypothesis]:
    """Yield that two runs' hump heights were exchanged, and that the one run that stands out most is of another height."""
    levels = [float(np.median(item.levels)) for item in case.comparisons]
    heights = road_heights(case.trials)
    for i, j in combinations(range(len(levels)), 2):
        one, other = case.runs[i], case.runs[j]
        if one in heights and other in heights and heights[one] * heights[other] > 0:
            ratio = float(np.log(heights[other] / heights[one]))
            if abs(ratio) > LEVEL_NOTICED and max(abs(levels[i] - ratio), abs(levels[j] + ratio)) < NEAR_RATIO:
                yield _exchanged_heights(case, (one, other), ratio)
    if len(levels) < 3:
        return
    apart = np.array(levels) - np.median(levels)
    loudest = int(np.abs(apart).argmax())
    if LEVEL_NOTICED < abs(apart[loudest]) < LEVEL_FAR:
        yield _other_level(case, case.runs[loudest], float(np.exp(apart[loudest])))


def _exchanged_heights(case: BaseRefits, runs: tuple[str, str], ratio: float) -> Hypothesis:
    """Return that two runs' heights, the second over the first exp(`ratio`), stand in each other's files."""

    def describe(numbers: Array) -> tuple[MeasurementFault, ...]:
        changes = [100 * (float(value) - 1) for value in numbers[-2:]]
        message = (
            f"the hump heights of {runs[0]} and {runs[1]} have been exchanged: each suits the other's recording "
            f"({changes[0]:+.0f} % and {changes[1]:+.0f} %)"
        )
        cure = "put the humps of the two run files right, or exchange their recordings"
        return (MeasurementFault("exchanged_heights", runs, (), message, cure),)

    shared = tuple(RunLevel("all", 0.05, 1.0, run=run) for run in runs)
    return Hypothesis(case.trials, describe, LEVEL_LEFT, shared, (float(np.exp(ratio)), float(np.exp(-ratio))))


def _other_level(case: BaseRefits, run: str, begin: float) -> Hypothesis:
    """Return that one run's road is `begin` times as high as its file says, or all its channels read so much more."""

    def describe(numbers: Array) -> tuple[MeasurementFault, ...]:
        more = float(numbers[-1]) - 1
        message = (
            f"the road in {run} is {100 * abs(more):.3g} % {'more' if more > 0 else 'less'} than stated, or all channels read as much "
            f"{'more' if more > 0 else 'less'}"
        )
        cure = "measure the height of the road and check that the channels' gain is that of the other runs"
        return (MeasurementFault("hump_height", (run,), (), message, cure, more),)

    return Hypothesis(case.trials, describe, LEVEL_LEFT, (RunLevel("all", 0.05, 1.0, run=run),), (begin,))
