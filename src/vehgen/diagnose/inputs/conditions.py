"""What a fit had to suppose of the runs: a speed, a height or a clock far beyond its prior is a finding, however well the fit is."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Protocol

import numpy as np

from vehgen.diagnose.inputs.fault import MeasurementFault, place_words
from vehgen.fit.least_squares import LeastSquaresFit

BEYOND = 4.0
"""A condition of so many standard deviations of its prior is a finding."""
AGREE = 0.15
"""Conditions of two runs that undo one another within this share of themselves are an exchange; of all runs, one cause."""


class Condition(Protocol):
    """What a fit supposes of a run or a sensor.

    `name` is one of delay, speed, height, length, wander, clock, gain, tilt, position; `place` the sensor or channel, or empty; `value`
    is in `unit`; `sigmas` is the value over its prior's standard deviation.
    """

    @property
    def run(self) -> str:
        """The run."""
        ...

    @property
    def name(self) -> str:
        """What is supposed."""
        ...

    @property
    def place(self) -> str:
        """The sensor or channel, or empty."""
        ...

    @property
    def value(self) -> float:
        """By how much."""
        ...

    @property
    def unit(self) -> str:
        """The unit of the value."""
        ...

    @property
    def sigmas(self) -> float:
        """The value over its prior's standard deviation."""
        ...


@dataclass(frozen=True)
class RunCondition:
    """A nuisance of a run as a :class:`Condition`."""

    run: str
    name: str
    place: str
    value: float
    unit: str
    sigmas: float


_FAULT_OF = {
    "delay": ("clock", "the recording {where} starts {amount} {late} than the file says, or the road lies elsewhere along the way"),
    "speed": ("speed", "the speed {where} was {amount} {more} than stated"),
    "height": ("hump_height", "the road {where} is {amount} {more} than stated, or all channels read as much {more}"),
    "length": ("hump_length", "the hump {where} is {amount} {longer} than stated"),
    "wander": ("wander", "the speed {where} wandered by {amount}"),
    "clock": ("clock_rate", "the clock of {place} {where} runs {amount} {fast}"),
    "gain": ("gain", "{place} reads {amount} {more} {where} than it should"),
    "tilt": ("tilt", "{place} sits tilted by {amount} {where}"),
    "position": ("position", "{place} sits {amount} off {where}"),
}
"""The kind of fault, and what is wrong, by the condition's name."""
_CURES = {
    "delay": "state when the recording starts, or measure where the road begins",
    "speed": "measure the speed by GPS or by the time between the axles' arrivals, and put it right",
    "height": "measure the height of the road and check that the channels' gain is that of the other runs",
    "length": "measure the hump's length and put the run file right",
    "wander": "record again at a steadier speed, or give the run a measured speed",
    "clock": "check the recorder's sampling rate against a stopwatch",
    "gain": "check the sensor's calibration and the column's unit",
    "tilt": "mount the sensor level, or import the recording so that its axes are turned upright",
    "position": "measure where the sensor sits and put the run file right",
}


def conditions_of(fit: LeastSquaresFit) -> list[RunCondition]:
    """Return what a fit supposes of its runs."""
    nuisances = fit.misfit.nuisances
    units = {"delay": "s"}
    found = []
    for trial, errors in zip(fit.misfit.problem.trials, fit.misfit.split(fit.x)[1], strict=True):
        for name, sigmas in zip(nuisances.names, errors, strict=True):
            value = float(sigmas) * float(getattr(nuisances, name))
            found.append(RunCondition(trial.name, name, "", value, units.get(name, ""), float(sigmas)))
    return found


def findings_of_conditions(
    conditions: Sequence[Condition], runs: Sequence[str], heights: Mapping[str, float] | None = None
) -> tuple[MeasurementFault, ...]:
    """Return what conditions beyond BEYOND standard deviations tell.

    Parameters
    ----------
    conditions
        All conditions of a fit.
    runs
        The names of all runs.
    heights
        The heights of humps [m] by run, as stated (default: unknown): two runs whose heights suit each other's were exchanged.
    """
    beyond = [item for item in conditions if abs(item.sigmas) > BEYOND and item.name in _FAULT_OF]
    found: list[MeasurementFault] = []
    known = {run: height for run, height in (heights or {}).items() if height > 0}
    for one, other in combinations([item for item in beyond if item.name == "height" and item.run in known and item.value > -1], 2):
        ratio = known[other.run] / known[one.run]
        if abs(np.log((1 + one.value) / ratio)) < AGREE and abs(np.log((1 + other.value) * ratio)) < AGREE:
            beyond = [item for item in beyond if item not in (one, other)]
            message = (
                f"the hump heights of {one.run} and {other.run} have been exchanged: each suits the other's recording "
                f"({100 * one.value:+.0f} % and {100 * other.value:+.0f} %)"
            )
            cure = "put the humps of the two run files right, or exchange their recordings"
            found.append(MeasurementFault("exchanged_heights", (one.run, other.run), (), message, cure))
    for name, place in dict.fromkeys((item.name, item.place) for item in beyond):
        left = [item for item in beyond if (item.name, item.place) == (name, place)]
        while left:
            alike = [item for item in left if abs(item.value - left[0].value) <= AGREE * abs(left[0].value)]
            found.append(_fault(alike, tuple(runs)))
            left = [item for item in left if item not in alike]
    return tuple(found)


def _fault(alike: Sequence[Condition], runs: tuple[str, ...]) -> MeasurementFault:
    """Return the fault that conditions of the same name and nearly the same value tell together."""
    item = alike[0]
    value, own = float(np.mean([other.value for other in alike])), tuple(other.run for other in alike)
    kind, sentence = _FAULT_OF[item.name]
    amount = f"{abs(value):.3g} {item.unit}" if item.unit else f"{100 * abs(value):.3g} %"
    up = value > 0
    words = {"late": "later" if up else "earlier", "more": "more" if up else "less", "longer": "longer" if up else "shorter"}
    words |= {"fast": "too fast" if up else "too slow", "place": item.place or "the recorder"}
    message = sentence.format(where=place_words(own, runs), amount=amount, **words)
    message += f" ({max(abs(other.sigmas) for other in alike):.0f} standard deviations of what was thought possible)"
    return MeasurementFault(kind, own, (item.place,) if item.place else (), message, _CURES[item.name], value, item.unit)
