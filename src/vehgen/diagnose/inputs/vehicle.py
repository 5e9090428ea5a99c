"""A vehicle that is not the file's: axles elsewhere, other parameters, or recordings that have nothing to do with it.

Axles are suspected where moving one makes measured and predicted correlate better; the parameters where the base fit hangs on its bounds.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, fields, replace

import numpy as np
from numpy.typing import NDArray

from vehgen.codegen import Excitation
from vehgen.diagnose.fits.model_fit import BASE_RANGE
from vehgen.diagnose.inputs.comparison import Comparison, compare
from vehgen.diagnose.inputs.fault import Hypothesis, MeasurementFault
from vehgen.diagnose.inputs.refits import BaseRefits
from vehgen.diagnose.thresholds import NOISE_FLOOR
from vehgen.fit.adjustments import Adjustment, SpeedScale
from vehgen.fit.noise import transform
from vehgen.fit.problem import make_problem
from vehgen.simulate import Scenario

Array = NDArray[np.float64]
MOVED = 0.25
"""Largest share of the excess that axles elsewhere may leave: of honest effects a late sensor comes nearest, and leaves 0.39."""
OTHER = 0.004
"""The same for parameters beyond BASE_RANGE, unless the noise floor is reached: of honest effects relaxation comes nearest (0.017)."""
UNRELATED_SHARE = 0.6
"""Share of the energy that a stranger's recordings leave unexplained in every run; a wrong speed, an honest effect, leaves 0.52."""
NOTICED = 0.02
"""Gain in correlation from which a moved axle is fitted."""
AXLE_SHIFT_SHARE = 0.25
"""Axles are moved by up to this share of their distance to the axle before."""
AXLE_SHIFT_STEP_M, FINE_STEP = 0.1, 0.01
SPEED_FITS_TOO = 2.0
"""Where another speed leaves less than so many times what other axles leave, the axles are not blamed."""


@dataclass(frozen=True)
class _Moved(Scenario):
    axles: tuple[int, ...] = ()
    shift: float = 0.0

    def excitation(self, offsets: Array) -> Excitation:
        moved = np.array(offsets)
        moved[list(self.axles)] += self.shift
        return super().excitation(moved)


@dataclass(frozen=True)
class AxleShift(Adjustment):
    """How much further behind the first axle some axles run than the vehicle file says [m]; `axles` are their numbers."""

    axles: tuple[int, ...] = ()

    def scenario(self, scenario: Scenario, value: float) -> Scenario:
        """Return the scenario with the road `value` [m] later under the axles."""
        known = {item.name: getattr(scenario, item.name) for item in fields(Scenario) if item.init}
        return _Moved(**known, axles=self.axles, shift=value)


def axle_hypotheses(case: BaseRefits) -> Iterator[Hypothesis]:
    """Yield that one axle, or all from one on, run elsewhere, where that makes the recordings correlate better and no speed does."""
    trial = case.trials[0]
    names = list(trial.run.vehicle.axles)
    offsets = trial.simulator.model.wheel_offsets(trial.values)
    order = [int(i) for i in np.argsort(offsets)]
    found = []
    for k in range(1, len(order)):
        gap = float(offsets[order[k]] - offsets[order[k - 1]])
        for group in dict.fromkeys(((order[k],), tuple(order[k:]))):
            change = AxleShift("+".join(names[i] for i in group), AXLE_SHIFT_STEP_M, axles=group)
            reach = round(AXLE_SHIFT_SHARE * gap / AXLE_SHIFT_STEP_M)
            found.append((*_best(case, change, [i * AXLE_SHIFT_STEP_M for i in range(-reach, reach + 1)]), change))
    if not found:
        return
    score, value, change = max(found, key=lambda item: item[0])
    if score < _mean(case.comparisons) + NOTICED:
        return
    value = _best(case, change, [value + i * FINE_STEP for i in range(-5, 6)])[1]
    left = case.refit(case.problem, (change,), (value,))[1]
    if left > MOVED:
        return
    speed = SpeedScale("runs", 0.01, 1.0)
    scale = _best(case, speed, [0.9 + 0.01 * i for i in range(21)])[1]
    if case.refit(case.problem, (speed,), (scale,))[1] < SPEED_FITS_TOO * left:
        return
    moved = [names[i] for i in change.axles]

    def describe(numbers: Array) -> tuple[MeasurementFault, ...]:
        shift = float(numbers[-1])
        words = (
            f"{' and '.join(moved)} {'seems' if len(moved) == 1 else 'seem'} to run {abs(shift):.2f} m {'further' if shift > 0 else 'less'}"
        )
        met = "it meets" if len(moved) == 1 else "they meet"
        message = f"{words} behind {names[order[0]]} than the vehicle file says, by when {met} the road"
        return (MeasurementFault("axle_position", (), (), message, "measure the distance and put the vehicle file right", shift, "m"),)

    yield Hypothesis(case.trials, describe, MOVED, (change,), (value,))


def _mean(items: Sequence[Comparison]) -> float:
    return float(np.mean([item.score for item in items]))


def _best(case: BaseRefits, change: Adjustment, values: Sequence[float]) -> tuple[float, float]:
    """Return the mean correlation of all runs at the best of `values`, and that value."""
    best = (-np.inf, 0.0)
    for value in values:
        score = _mean([compare(trial, case.predict(trial, (change,), (value,)), case.band) for trial in case.trials])
        if score > best[0]:
            best = score, float(value)
    return best


def other_vehicle(case: BaseRefits) -> tuple[MeasurementFault, ...]:
    """Return that the vehicle has other parameters than the file says, where these explain the gap."""
    if not case.base.on_bound:
        return ()
    wide = replace(make_problem(case.detected), trials=case.trials)
    fit, left = case.refit(wide, unit=np.asarray(wide.space.unit(case.base.values)))
    if left > max(OTHER, (NOISE_FLOOR**2 - 1) / case.excess):
        return ()
    ratios = {
        name: value / start
        for name, value, start in zip(wide.space.names, fit.values, wide.space.start, strict=True)
        if min(value, start) > 0
    }
    far = sorted((name for name, ratio in ratios.items() if abs(np.log(ratio)) > BASE_RANGE), key=lambda name: -abs(np.log(ratios[name])))
    if not far:
        return ()
    listed = ", ".join(f"{name} {ratios[name]:.2f} times" for name in far[:4])
    message = (
        f"the recordings are of a vehicle with other parameters than the file's ({listed} its value): that alone explains "
        f"{100 * (1 - left):.0f} % of the gap"
    )
    return (MeasurementFault("other_parameters", (), (), message, "check the vehicle file, or calibrate first"),)


def unrelated_recording(case: BaseRefits) -> tuple[MeasurementFault, ...]:
    """Return that the recordings have nothing to do with the model, where it explains too little of every run's energy."""
    misfit, shares = case.base.misfit, []
    for t, (trial, (lines, _)) in enumerate(zip(misfit.problem.trials, misfit.residual_spectrum(case.base.x), strict=True)):
        inside = np.isin(np.fft.rfftfreq(len(trial.recording.time), trial.recording.dt), misfit.frequency(t))
        recorded = transform(trial.recording.values, trial.recording.dt, inside)
        shares.append(float(np.mean((np.abs(lines) ** 2).sum(axis=0) / (np.abs(recorded) ** 2).sum(axis=0))))
    if min(shares) < UNRELATED_SHARE:
        return ()
    message = f"the recalibrated model leaves {100 * min(shares):.0f} % or more of every run unexplained"
    cure = "check that vehicle, road, speed and places of the sensors are those of these recordings"
    return (MeasurementFault("stranger", (), (), message, cure),)
