"""A mistake of the measurement: what is told of it, and the supposition that it was made."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from vehgen.fit.adjustments import Adjustment
from vehgen.fit.trial import Trial

Array = NDArray[np.float64]


@dataclass(frozen=True)
class MeasurementFault:
    """A mistake of the measurement, in words that name the run, the channel and the cure.

    `kind` is one word for programs; `runs` are the runs that it was made in (empty: all, or none in particular), `channels` the channels or
    sensors (empty: none in particular); `value` is its number [unit], where it has one; `message` says what is wrong, `cure` what to do.
    """

    kind: str
    runs: tuple[str, ...]
    channels: tuple[str, ...]
    message: str
    cure: str
    value: float | None = None
    unit: str = ""


@dataclass(frozen=True)
class Hypothesis:
    """The supposition that a mistake was made: the runs with it undone, for the base model to be fitted to again.

    `trials` are all runs, in their order; `shared` are adjustments fitted along that undo what no change of the runs can, from `numbers`
    on; `blind` names channels of runs, `(run, channel)`, that are not to count. `describe` tells the faults from the fitted numbers.
    `limit` is the largest share of the excess chi^2 - 1 that may be left.
    """

    trials: tuple[Trial, ...]
    describe: Callable[[Array], tuple[MeasurementFault, ...]]
    limit: float
    shared: tuple[Adjustment, ...] = ()
    numbers: tuple[float, ...] = ()
    blind: frozenset[tuple[str, str]] = frozenset()


def always(*faults: MeasurementFault) -> Callable[[Array], tuple[MeasurementFault, ...]]:
    """Return a description that tells the same faults whatever the fitted numbers are."""
    return lambda numbers: faults


def place_words(runs: tuple[str, ...], all_runs: tuple[str, ...]) -> str:
    """Return in which runs a mistake was made, in words."""
    if set(runs) == set(all_runs):
        return "in all runs"
    return f"in {', '.join(runs[:-1])} and {runs[-1]}" if len(runs) > 1 else f"in {runs[0]}"
