"""Mistakes in labels, signs, axle positions and vehicle, undone one at a time to see whether the gap goes with them.

Labels and signs are suspected by correlation with the vehicle file's prediction, which no honest effect turns round; axle positions where
moving an axle makes measured and predicted correlate better; the vehicle where the base fit hangs on its bounds. A suspicion counts only
when the base model, fitted again with the mistake undone, keeps no more than a share of its excess chi^2 - 1 over all runs.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from vehgen.codegen import Excitation
from vehgen.diagnose.detect.noise_floor import find_noise_floor
from vehgen.diagnose.fits.model_fit import BASE_PRIOR_SIGMA, BASE_RANGE, JACOBIAN_REFRESH, NUISANCES
from vehgen.diagnose.inputs.finding import Finding
from vehgen.diagnose.inputs.labels import correlate, relabelled, true_labels
from vehgen.diagnose.thresholds import NOISE_FLOOR
from vehgen.fit.adjustments import Adjustment, SpeedScale
from vehgen.fit.alignment import MOST_SIGMAS
from vehgen.fit.least_squares import COARSE_TOLERANCE, WEAK_PRIOR_SIGMA, FitOptions, LeastSquaresFit, fit_least_squares
from vehgen.fit.misfit import Misfit
from vehgen.fit.noise import transform
from vehgen.fit.problem import Problem, make_problem
from vehgen.fit.trial import Trial
from vehgen.simulate import Scenario

if TYPE_CHECKING:
    from vehgen.diagnose.detect.detection import Detection

Array = NDArray[np.float64]
RELABELLED = 0.5
"""Largest share of the excess that another labelling may leave: the true effect may still be in it."""
MOVED = 0.25
"""The same for axles elsewhere: of honest effects a late sensor comes nearest, and leaves 0.39."""
OTHER = 0.004
"""The same for parameters beyond BOUND, unless the noise floor is reached: of honest effects relaxation comes nearest, and leaves 0.017."""
UNRELATED_SHARE = 0.6
"""Share of the energy that a stranger's recordings leave unexplained in every run; a wrong speed, an honest effect, leaves 0.52."""
NOTICED = 0.02
"""Gain in correlation from which a moved axle is fitted."""
AXLE_SHIFT_SHARE = 0.25
"""Axles are moved by up to this share of their distance to the axle before."""
AXLE_SHIFT_STEP_M, FINE_STEP = 0.1, 0.01


@dataclass(frozen=True)
class Suspicion:
    """A mistake, the share of the excess that is left with it undone, and the largest share at which it counts."""

    findings: tuple[Finding, ...]
    left: float
    limit: float


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


def suspect(detection: Detection) -> Iterator[Suspicion]:
    """Yield every mistake that there is reason to suspect, refitted."""
    case = _BaseRefits(detection)
    yield from _labels(case)
    yield from _axles(case)
    yield from _other_vehicle(case)


class _BaseRefits:
    """A detection's runs, all of them, and refits of the base model to them."""

    def __init__(self, detection: Detection) -> None:
        self.base = detection.base.least_squares
        self.trials = (*detection.problem.trials, *detection.validation_runs)
        self.problem = detection.problem.with_trials(self.trials)
        self.noises = detection.floor.noises
        self.band = self.base.misfit.band
        self.excess = max(detection.chi**2 - 1, 1e-9)

    def predict(self, trial: Trial, change: Adjustment | None = None, value: float = 0.0) -> Array:
        """Return what the vehicle file predicts, `shape (n_samples, n_channels)`."""
        scenario = trial.scenario if change is None else change.scenario(trial.scenario, value)
        return np.asarray(trial.simulator.run(trial.simulator.parameters(trial.values), scenario).responses[0])

    def refit(
        self, problem: Problem, unit: Array | None = None, change: Adjustment | None = None, value: float = 0.0, lags: Array | None = None
    ) -> tuple[LeastSquaresFit, float]:
        """Fit the base model and return the fit with the share of the excess that it leaves."""
        start = None
        if lags is not None:
            start = self.errors_at(problem, lags)
        same = all(one is other for one, other in zip(problem.trials, self.trials, strict=True))
        options = FitOptions(
            NUISANCES,
            self.band,
            max_steps=20,
            tolerance=COARSE_TOLERANCE,
            jacobian_refresh=JACOBIAN_REFRESH,
            prior_sigma=BASE_PRIOR_SIGMA if unit is None else WEAK_PRIOR_SIGMA,
        )
        fit = fit_least_squares(
            problem,
            problem.space.unit(problem.space.start) if unit is None else unit,
            options,
            noises=self.noises if same else find_noise_floor(problem.trials, self.band).noises,
            start=start,
            shared=() if change is None else (change,),
            numbers=() if change is None else (value,),
        )
        lines = np.concatenate([item.ravel() for item in fit.misfit.whitened_spectrum(fit.x)])
        return fit, float((np.mean(np.abs(lines) ** 2) - 1) / self.excess)

    def errors_at(self, problem: Problem, lags: Array) -> Array:
        """Return errors of sensors and runs, none but the delays `lags shape (n_trials,)` [s]."""
        misfit = Misfit(problem, self.noises, problem.space.start, NUISANCES, self.band)
        start = np.zeros(misfit.n_errors)
        for t, lag in enumerate(lags):
            place = misfit.error_position(t, "delay")
            if place is not None:
                start[place] = np.clip(lag / NUISANCES.delay, -MOST_SIGMAS, MOST_SIGMAS)
        return start

    def best(self, change: Adjustment, values: Sequence[float]) -> tuple[float, float, Array]:
        """Return the mean correlation of all runs at the best of `values`, that value, and each run's lag there [s]."""
        found: tuple[float, float, Array] = (-np.inf, 0.0, np.zeros(0))
        for value in values:
            scores, lags = [], []
            for trial in self.trials:
                mean = np.diagonal(correlate(trial, self.predict(trial, change, value), self.band), axis1=1, axis2=2).mean(axis=1)
                scores.append(mean.max())
                lags.append((int(mean.argmax()) - len(mean) // 2) * trial.recording.dt)
            if np.mean(scores) > found[0]:
                found = float(np.mean(scores)), float(value), np.array(lags)
        return found


def _labels(case: _BaseRefits) -> Iterator[Suspicion]:
    found = {trial.name: true_labels(trial, correlate(trial, case.predict(trial), case.band)) for trial in case.trials}
    wrong = {name: pattern for name, pattern in found.items() if not pattern.trivial}
    if not wrong:
        return
    hypotheses = [wrong]
    common, count = Counter(wrong.values()).most_common(1)[0]
    if count > len(case.trials) / 2 and len({trial.channels for trial in case.trials}) == 1:
        hypotheses.append({trial.name: common for trial in case.trials})
    for hypothesis in hypotheses[: 1 if hypotheses[-1] == wrong else 2]:
        trials = [hypothesis[trial.name].undo(trial) if trial.name in hypothesis else trial for trial in case.trials]
        yield Suspicion(tuple(relabelled(case.trials, hypothesis)), case.refit(case.problem.with_trials(trials))[1], RELABELLED)


def _axles(case: _BaseRefits) -> Iterator[Suspicion]:
    trial = case.trials[0]
    names = list(trial.run.vehicle.axles)
    offsets = trial.simulator.model.wheel_offsets(trial.values)
    order = [int(i) for i in np.argsort(offsets)]
    as_filed = case.best(Adjustment(""), [0.0])[0]
    found = []
    for k in range(1, len(order)):
        gap = float(offsets[order[k]] - offsets[order[k - 1]])
        for group in dict.fromkeys(((order[k],), tuple(order[k:]))):
            change = AxleShift("+".join(names[i] for i in group), AXLE_SHIFT_STEP_M, axles=group)
            reach = round(AXLE_SHIFT_SHARE * gap / AXLE_SHIFT_STEP_M)
            found.append((*case.best(change, [i * AXLE_SHIFT_STEP_M for i in range(-reach, reach + 1)]), change))
    if not found:
        return
    score, value, lags, change = max(found, key=lambda item: item[0])
    if score < as_filed + NOTICED:
        return
    _, value, lags = case.best(change, [value + i * FINE_STEP for i in range(-5, 6)])
    fit, left = case.refit(case.problem, None, change, value, lags)
    if left > MOVED:
        return
    speed = SpeedScale("runs", 0.01, 1.0)
    _, value, lags = case.best(speed, [0.9 + 0.01 * i for i in range(21)])
    if case.refit(case.problem, None, speed, value, lags)[1] < 2 * left:
        return
    shift = float(fit.misfit.adjusted(fit.x)[0])
    moved = [names[i] for i in change.axles]
    words = f"{' and '.join(moved)} {'seems' if len(moved) == 1 else 'seem'} to run {abs(shift):.2f} m {'further' if shift > 0 else 'less'}"
    message = (
        f"{words} behind {names[order[0]]} than the vehicle file says, by when {'it meets' if len(moved) == 1 else 'they meet'} the road: "
        "measure the distance and put the file right"
    )
    yield Suspicion((Finding("axle_position", None, None, message, True),), left, MOVED)


def _other_vehicle(case: _BaseRefits) -> Iterator[Suspicion]:
    if not case.base.on_bound:
        return
    wide = make_problem(case.trials)
    fit, left = case.refit(wide, np.asarray(wide.space.unit(case.base.values)))
    ratios = {
        name: value / start
        for name, value, start in zip(wide.space.names, fit.values, wide.space.start, strict=True)
        if min(value, start) > 0
    }
    far = sorted((name for name, ratio in ratios.items() if abs(np.log(ratio)) > BASE_RANGE), key=lambda name: -abs(np.log(ratios[name])))
    if far:
        listed = ", ".join(f"{name} {ratios[name]:.2f} times" for name in far[:4])
        message = (
            f"the recordings are of a vehicle with other parameters than the file's ({listed} its value): that alone explains "
            f"{100 * (1 - left):.0f} % of the gap; check the file, or calibrate first"
        )
        limit = max(OTHER, (NOISE_FLOOR**2 - 1) / case.excess)
        yield Suspicion((Finding("other_parameters", None, None, message, True),), left, limit)


def unrelated_recording(detection: Detection) -> Suspicion:
    """Return the suspicion that the recordings have nothing to do with the model; `left` is the most it explains of a run's energy."""
    base, shares = detection.base.least_squares, []
    misfit = base.misfit
    for t, (trial, (lines, _)) in enumerate(zip(misfit.problem.trials, misfit.residual_spectrum(base.x), strict=True)):
        inside = np.isin(np.fft.rfftfreq(len(trial.recording.time), trial.recording.dt), misfit.frequency(t))
        recorded = transform(trial.recording.values, trial.recording.dt, inside)
        shares.append(float(np.mean((np.abs(lines) ** 2).sum(axis=0) / (np.abs(recorded) ** 2).sum(axis=0))))
    low = min(shares)
    message = (
        f"the recalibrated model leaves {100 * low:.0f} % or more of every run unexplained: check that vehicle, road, speed and "
        "places of the sensors are those of these recordings"
    )
    return Suspicion((Finding("stranger", None, None, message, True),), 1 - low, 1 - UNRELATED_SHARE)
