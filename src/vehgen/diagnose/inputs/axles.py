"""Axles that stand elsewhere than the vehicle file says: suspected where moving some makes measured and predicted correlate better."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from vehgen.diagnose.inputs.adjustments import AxleShift
from vehgen.diagnose.inputs.comparison import Comparison, compare
from vehgen.diagnose.inputs.fault import Hypothesis, MeasurementFault, always
from vehgen.diagnose.inputs.recorders import other_rate
from vehgen.diagnose.inputs.refits import BaseRefits
from vehgen.files.expressions import parse
from vehgen.fit.adjustments import SpeedScale
from vehgen.fit.least_squares import LeastSquaresFit
from vehgen.fit.trial import Trial
from vehgen.simulate import SimulatorPool

Array = NDArray[np.float64]
MOVED = 0.25
"""Largest share of the excess that axles elsewhere may leave: of honest effects a late sensor comes nearest, and leaves 0.39."""
NOTICED = 0.02
"""Gain in correlation from which a moved axle is fitted."""
AXLE_SHIFT_SHARE, LONGEST_SHIFT_M = 0.25, 1.0
"""Distances between axles are changed by up to this share of themselves; where numbers say them, of which there may be many, by no more
than so much."""
AXLE_SHIFT_STEP_M, FINE_STEP = 0.1, 0.01
SPEED_SCALES = tuple(round(0.8 + 0.01 * i, 2) for i in range(41))
"""True speeds over stated ones that are tried in the axles' place."""
NUDGE = 1e-3
"""Parameters are changed by this share to see which axles they move."""
SPEED_FITS_TOO, SPEED_DEARER = 2.0, 36.0
"""Where another speed or clock leaves noise, or less than so many times what other axles leave, the axles are not blamed; but for a speed
with which -2 ln L is higher by so much: errors beyond belief make up for it."""


@dataclass(frozen=True)
class _Distance:
    """How far behind the first axle some axles run [m]: what a parameter of the vehicle file says, or, without one, its numbers.

    Where numbers say it, the road comes later to the axles that are `moved`; of axles of one body the lever arms change, too.
    """

    axles: tuple[str, ...]
    value: float
    parameter: str = ""
    moved: tuple[float, ...] = ()

    @property
    def reach(self) -> float:
        """How far it may be off [m]."""
        own = AXLE_SHIFT_SHARE * self.value
        return own if self.parameter else min(own, LONGEST_SHIFT_M)

    def hypothesis(self, trials: Sequence[Trial], value: float) -> Hypothesis:
        """Return that the distance is another [m]; where numbers say it, how long it is is fitted."""
        if self.parameter:
            others = tuple(replace(trial, values=trial.values | {self.parameter: value}) for trial in trials)
            return Hypothesis(others, always(self.fault(value)), MOVED)
        return self._further(trials, value - self.value)

    def hypotheses(self, trials: Sequence[Trial], value: float) -> Iterator[Hypothesis]:
        """Yield that the distance is another [m] and, where numbers say it of axles of one body, that these sit elsewhere on it, too."""
        yield self.hypothesis(trials, value)
        vehicle, by = trials[0].run.vehicle, value - self.value
        if not self.parameter and len({vehicle.axles[name].body for name in self.axles}) == 1:
            moved = {name: {"x": vehicle.axles[name].x - parse(f"{by!r} m")} for name in self.axles}
            changed, simulators = vehicle.with_changes({"axles": moved}), SimulatorPool()
            elsewhere = [trial.with_vehicle(changed, simulators) for trial in trials]
            yield self._further(elsewhere, 0.0, by)

    def _further(self, trials: Sequence[Trial], begin: float, known: float = 0.0) -> Hypothesis:
        """Return that the axles run further behind [m], by what the trials' vehicle has already, and by what is fitted from `begin` on."""
        shift = AxleShift(" and ".join(self.axles), AXLE_SHIFT_STEP_M, moved=self.moved)
        return Hypothesis(tuple(trials), partial(self._told, known), MOVED, (shift,), (begin,))

    def _told(self, known: float, numbers: Array) -> tuple[MeasurementFault, ...]:
        return (self.fault(self.value + known + float(numbers[-1])),)

    def fault(self, value: float) -> MeasurementFault:
        """Return that the distance is another [m]."""
        shift = value - self.value
        words = f"{' and '.join(self.axles)} {'seems' if len(self.axles) == 1 else 'seem'} to run {abs(shift):.2f} m "
        words += f"{'further' if shift > 0 else 'less'} behind the axles before than the vehicle file says, by when the road is met"
        subject = f"{self.parameter} is" if self.parameter else f"{self.axles[0]} runs"
        behind = "" if self.parameter else " behind the first axle"
        message = f"{words}: {subject} about {value:.2f} m{behind} there, not {self.value:.2f} m"
        return MeasurementFault("axle_position", (), (), message, "measure the distance and put the vehicle file right", shift, "m")


def axle_hypotheses(case: BaseRefits) -> Iterator[Hypothesis]:
    """Yield that axles are another distance apart, where that makes the recordings correlate better, and no speed or clock does."""
    found = []
    for distance in _distances(case):
        steps = round(distance.reach / AXLE_SHIFT_STEP_M)
        values = [distance.value + i * AXLE_SHIFT_STEP_M for i in range(-steps, steps + 1)]
        found.append((*_best(case, distance, values), distance))
    if not found:
        return
    score, value, distance = max(found, key=lambda item: item[0])
    if score < _mean(case.comparisons) + NOTICED:
        return
    value = _best(case, distance, [value + i * FINE_STEP for i in range(-5, 6)])[1]
    judged = [(*case.judge(item), item) for item in distance.hypotheses(case.trials, value)]
    moved, left, hypothesis = min(judged, key=lambda item: item[1])
    if left <= MOVED and not _speed_does_as_well(case, moved, left):
        yield hypothesis


def _speed_does_as_well(case: BaseRefits, moved: LeastSquaresFit, left: float) -> bool:
    """Return whether another speed in all runs, or another clock's rate, explains what moved axles do, of which `left` is left."""
    speed = SpeedScale("runs", 0.01, 1.0)
    scores = {
        scale: _mean([compare(trial, case.predict(trial, (speed,), (scale,)), case.band) for trial in case.trials])
        for scale in SPEED_SCALES
    }
    scale = max(scores, key=lambda key: scores[key])
    enough, clock = max(SPEED_FITS_TOO * left, case.noise), other_rate(case)
    faster, by_speed = case.refit(case.problem, (speed,), (scale,))
    return (by_speed < enough and faster.loss < moved.loss + SPEED_DEARER) or (clock is not None and clock[1] < enough)


def _distances(case: BaseRefits) -> list[_Distance]:
    """Return what of the vehicle file says where axles run and is not fitted: parameters, and numbers where no parameter does."""
    trial, found = case.trials[0], []
    for name, value in trial.values.items():
        free = name not in case.problem.space.names and not any(name in own.fixed for own in case.trials)
        if free and value > 0 and (axles := _axles_moved(trial, name)):
            found.append(_Distance(axles, value, name))
    return found + _by_numbers(trial, found)


def _by_numbers(trial: Trial, named: Sequence[_Distance]) -> list[_Distance]:
    """Return the distances of axles that no parameter moves by themselves: each alone, and each with all axles behind it."""
    offsets = dict(zip(trial.simulator.model.layout.axles, trial.simulator.model.wheel_offsets(trial.values).tolist(), strict=True))
    known = [set(distance.axles) for distance in named]
    groups: dict[tuple[str, ...], float] = {}
    for axle in (axle for axle, offset in offsets.items() if offset > 0 and trial.scenario.track.parts):
        if {axle} not in known:
            behind = sorted((other for other in offsets if offsets[other] >= offsets[axle]), key=offsets.__getitem__)
            groups |= {(axle,): offsets[axle], tuple(behind): offsets[axle]}
    return [
        _Distance(axles, value, moved=tuple(float(axle in axles) for axle in offsets))
        for axles, value in groups.items()
        if set(axles) not in known
    ]


def _axles_moved(trial: Trial, name: str) -> tuple[str, ...]:
    """Return the axles that a parameter moves along the vehicle."""
    model, changed = trial.simulator.model, trial.values | {name: trial.values[name] * (1 + NUDGE)}
    shifts = np.abs(model.wheel_offsets(changed) - model.wheel_offsets(trial.values))
    return tuple(axle for axle, shift in zip(trial.run.vehicle.axles, shifts, strict=True) if shift > NUDGE * NUDGE)


def _mean(items: Sequence[Comparison]) -> float:
    return float(np.mean([item.score for item in items]))


def _best(case: BaseRefits, distance: _Distance, values: Sequence[float]) -> tuple[float, float]:
    """Return the mean correlation of all runs at the best of several values of a distance [m], and that value."""
    best = (-np.inf, distance.value)
    for value in values:
        supposed = distance.hypothesis(case.trials, value)
        predicted = ((trial, case.predict(trial, supposed.shared, supposed.numbers)) for trial in supposed.trials)
        score = _mean([compare(trial, own, case.band) for trial, own in predicted])
        if score > best[0]:
            best = score, value
    return best
