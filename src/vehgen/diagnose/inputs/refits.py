"""Fits of the base model to all runs, with mistakes undone: what they leave of the gap."""

from __future__ import annotations

from collections.abc import Sequence
from copy import copy
from dataclasses import replace
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from vehgen.diagnose.fits.model_fit import BASE_PRIOR_SIGMA, JACOBIAN_REFRESH, NUISANCES
from vehgen.diagnose.inputs.comparison import Comparison, compare
from vehgen.diagnose.inputs.fault import Hypothesis
from vehgen.diagnose.thresholds import NOISE_FLOOR
from vehgen.fit.adjustments import Adjustment, RunState, adjust
from vehgen.fit.least_squares import COARSE_TOLERANCE, WEAK_PRIOR_SIGMA, FitOptions, LeastSquaresFit, fit_least_squares
from vehgen.fit.misfit import Noises
from vehgen.fit.noise import Noise
from vehgen.fit.problem import Problem
from vehgen.fit.recorders import FoundRecorder
from vehgen.fit.trial import Trial

if TYPE_CHECKING:
    from vehgen.diagnose.detect.detection import Detection

Array = NDArray[np.float64]
BLINDING = 1e4
"""The noise of a channel that is not to count is taken as so many times its own."""
REFIT_STEPS = 20
LEAST_RUNS = 3
"""Of so many runs at least, one may be wrong while the others tell the vehicle."""
REFIT_TOP_HZ = 15.0
"""Refits compare up to this frequency [Hz]: above, a low-pass that was found for a wrong model would stand in the way of the right one."""


class BaseRefits:
    """All runs of a detection, with the mistakes found so far undone, and refits of the base model to them.

    `excess` is chi^2 - 1 of the base model on these runs, `first_excess` that before any mistake was undone; `shared`, `numbers` and
    `blind` undo what was found, as in :class:`Hypothesis`. Recorders whose low-pass is not known count as unknown again, and refits
    compare slow motions, where these show the gap: the low-pass was found for a model that does not fit. `known` are parameters that are
    known better than by the vehicle file: predictions are of them. `odd` is the run without which they became known.
    """

    def __init__(self, detection: Detection) -> None:
        self.base = detection.base.least_squares
        self.detected = self.trials = detection.trials
        self.problem = detection.problem.with_trials(self.trials)
        self.begin = self.problem.space.unit(self.problem.space.start)
        self.known: dict[str, float] = {}
        self.odd = ""
        self.band = self.refit_band = self.base.misfit.band
        self.excess = max(detection.chi**2 - 1, 1e-9)
        self.shared: tuple[Adjustment, ...] = ()
        self.numbers: tuple[float, ...] = ()
        self.blind: frozenset[tuple[str, str]] = frozenset()
        right = detection.base.training <= NOISE_FLOOR**2  # a mistake is in validation runs alone
        worst = max(detection.base.mean_squares, key=lambda run: detection.base.mean_squares[run])
        if right:
            self.odd = worst
            self._know(self.base.values)
        if detection.recorder is not None and self.band[1] > REFIT_TOP_HZ:
            self._forget(detection.recorder, detection.asked_band)
        self.first_excess = self.excess
        if not right and len(self.trials) >= LEAST_RUNS:
            self._know_by_others(worst)

    def of_vehicle(self, values: Array) -> BaseRefits:
        """Return the same with the vehicle known, by its searched parameters `shape (n,)`."""
        other = copy(self)
        other._know(values)
        return other

    def _know(self, values: Array) -> None:
        """Take a vehicle as known: predictions are of it, and refits begin there."""
        self.begin = self.problem.space.unit(values)
        self.known = self.problem.best_values(values)
        self._predict_anew()

    def _predict_anew(self) -> None:
        for name in ("predictions", "comparisons"):
            self.__dict__.pop(name, None)

    def _know_by_others(self, run: str) -> None:
        """Take the vehicle of all runs but one as known, where that leaves noise: the base has bent to what is wrong in that run."""
        blind = frozenset((run, channel) for trial in self.trials if trial.name == run for channel in trial.channels)
        fit, left = self.refit(self.problem, blind=blind)
        if left <= self.noise:
            self.odd = run
            self._know(fit.values)

    def _forget(self, recorder: FoundRecorder, band: tuple[float, float]) -> None:
        """Take the low-pass that was found as unknown again, and compare slow motions, where the gap shows there."""
        known = self.trials, self.problem, self.refit_band, self.excess
        self.trials = tuple(recorder.forgotten(self.trials))
        self.problem = self.problem.with_trials(self.trials)
        self.refit_band = band[0], REFIT_TOP_HZ
        self.excess = 1.0
        self.excess = self.refit(self.problem)[1]
        if self.excess <= NOISE_FLOOR**2 - 1:
            self.trials, self.problem, self.refit_band, self.excess = known

    @property
    def noise(self) -> float:
        """The share of the excess at which what is left counts as noise."""
        return (NOISE_FLOOR**2 - 1) / self.excess

    @property
    def runs(self) -> tuple[str, ...]:
        """The runs' names."""
        return tuple(trial.name for trial in self.trials)

    @cached_property
    def predictions(self) -> list[Array]:
        """What is predicted for every run, `shape (n_samples, n_channels)`."""
        return [self.predict(trial) for trial in self.trials]

    @cached_property
    def comparisons(self) -> list[Comparison]:
        """Every run beside its prediction."""
        return [compare(trial, own, self.band) for trial, own in zip(self.trials, self.predictions, strict=True)]

    def predict(self, trial: Trial, shared: Sequence[Adjustment] = (), numbers: Sequence[float] = ()) -> Array:
        """Return what is predicted for a trial, adjusted also by `shared` at `numbers`, `shape (n_samples, n_channels)`."""
        adjustments, values, scenario = (*self.shared, *shared), np.array((*self.numbers, *numbers)), trial.scenario
        for item, value in zip(adjustments, values, strict=True):
            scenario = item.scenario(scenario, float(value))
        vehicle = trial.values | {name: value for name, value in self.known.items() if name not in trial.fixed}
        response = np.asarray(trial.simulator.run(trial.simulator.parameters(vehicle), scenario).responses)
        return np.asarray(adjust(adjustments, trial, response, values, RunState(scenario, vehicles=(vehicle,)))[0])

    def accept(self, hypothesis: Hypothesis, fit: LeastSquaresFit, left: float) -> None:
        """Undo a mistake for all that follows, given its refit and the share of the excess that it leaves."""
        self.trials, self.shared, self.blind = hypothesis.trials, (*self.shared, *hypothesis.shared), self.blind | hypothesis.blind
        self.numbers = tuple(float(value) for value in fit.misfit.adjusted(fit.x))
        self.problem = self.problem.with_trials(self.trials)
        self.excess = max(self.excess * left, 1e-9)
        self._predict_anew()

    def judge(self, hypothesis: Hypothesis) -> tuple[LeastSquaresFit, float]:
        """Return the refit with a mistake undone, and the share of the excess that it leaves."""
        return self.refit(self.problem.with_trials(hypothesis.trials), hypothesis.shared, hypothesis.numbers, blind=hypothesis.blind)

    def refit(
        self,
        problem: Problem,
        shared: Sequence[Adjustment] = (),
        numbers: Sequence[float] = (),
        *,
        unit: Array | None = None,
        blind: frozenset[tuple[str, str]] = frozenset(),
    ) -> tuple[LeastSquaresFit, float]:
        """Fit the base model and return the fit with the share of the excess that it leaves.

        Parameters
        ----------
        problem
            Runs and searched parameters.
        shared, numbers
            Adjustments fitted along with those that undo what was found, and where they begin.
        unit
            Where the parameters begin (default: the file's values, or the base's where these leave noise, held by the base's prior).
        blind
            Channels of runs that are not to count.
        """
        options = FitOptions(
            NUISANCES,
            self.refit_band,
            max_steps=REFIT_STEPS,
            tolerance=COARSE_TOLERANCE,
            jacobian_refresh=JACOBIAN_REFRESH,
            prior_sigma=BASE_PRIOR_SIGMA if unit is None else WEAK_PRIOR_SIGMA,
        )
        blind = blind | self.blind
        fit = fit_least_squares(
            problem,
            self.begin if unit is None else unit,
            options,
            noises=self._noises(problem.trials, blind),
            shared=(*self.shared, *shared),
            numbers=(*self.numbers, *numbers),
        )
        powers = []
        for trial, lines in zip(problem.trials, fit.misfit.whitened_spectrum(fit.x), strict=True):
            counted = [(trial.name, channel) not in blind for channel in trial.channels]
            powers.append(np.abs(lines[:, counted]).ravel() ** 2)
        lines = np.concatenate(powers)
        prior = sum(item.sigmas**2 for item in fit.conditions()) / (2 * len(lines))  # else a mistake is undone by supposing another
        return fit, float((np.mean(lines) + prior - 1) / self.excess)

    def _noises(self, trials: Sequence[Trial], blind: frozenset[tuple[str, str]]) -> Noises:
        known = {id(trial.recording): self.base.misfit.noises[trial.name] for trial in self.detected}  # noise goes with the recording
        before = {trial.name: trial for trial in self.detected}
        found = {
            trial.name: known.get(id(trial.recording)) or _as_loud(self.base.misfit.noises[trial.name], before[trial.name], trial)
            for trial in trials
        }
        blinded: Noises = {}
        for trial in trials:
            own = found[trial.name]
            factors = np.array([BLINDING if (trial.name, channel) in blind else 1.0 for channel in trial.channels])
            blinded[trial.name] = replace(own, sigma=own.sigma * factors)
        return blinded


def base_refits(detection: Detection) -> BaseRefits:
    """Return refits of a detection's base with no mistake undone yet; how they begin is found once."""
    return copy(_begun(detection))


@lru_cache(maxsize=2)
def _begun(detection: Detection) -> BaseRefits:
    return BaseRefits(detection)


def _as_loud(noise: Noise, trial: Trial, changed: Trial) -> Noise:
    """Return a trial's noise where a mistake of its recording is undone: louder as its channels move more from sample to sample."""
    before, after = (np.diff(item.recording.values, axis=0).std(axis=0) for item in (trial, changed))
    return replace(noise, sigma=noise.sigma * after / np.maximum(before, 1e-300))
