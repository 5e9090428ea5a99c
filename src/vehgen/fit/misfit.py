"""The misfit that uses phase: whitened residuals of all channels, for least squares.

Residuals are compared line by line within a band (by Parseval's theorem the same as in time, for what lies within the band) and whitened
by the noise's cross spectral density, so that their sum of squares is -2 ln of the likelihood. What a run does not know of itself exactly
is fitted along with the parameters: its delay, the scales of its speed and of its hump's height.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from vehgen.fit.adjustments import Adjustment
from vehgen.fit.band import CALIBRATION_BAND_HZ
from vehgen.fit.noise import Noise, RoadAnswer, road_answer, transform
from vehgen.fit.problem import Problem
from vehgen.fit.trial import Trial
from vehgen.simulate import Scenario

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
Noises = dict[str, Noise]
"""Noise by name of the trial."""
UNIT_DIFFERENCE = 1e-6
"""Step of the differences to each side, in the unit cube and in units of a nuisance's uncertainty: so short that jumps of a response
seldom cross a sample."""


@dataclass(frozen=True)
class Nuisances:
    """Standard deviations of what a run does not know of itself; 0 leaves it out.

    `delay` of the recording's clock [s]; `speed` and `height` relative errors of the speed and of the road's height.
    """

    delay: float = 0.2
    speed: float = 0.01
    height: float = 0.0

    @property
    def names(self) -> tuple[str, ...]:
        """Those that are fitted."""
        return tuple(name for name in ("delay", "speed", "height") if getattr(self, name) > 0)

    def adjust(self, scenario: Scenario, values: Array) -> Scenario:
        """Return a scenario with errors `values shape (len(names),)`, in units of their standard deviations."""
        found = {name: float(value) * getattr(self, name) for name, value in zip(self.names, values, strict=True)}
        return scenario.adjusted(found.get("delay", 0.0), 1.0 + found.get("speed", 0.0), 1.0 + found.get("height", 0.0))


@dataclass(frozen=True)
class _Weight:
    """A trial's spectral lines within the band, the road's way into them, and the matrices that whiten it."""

    inside: NDArray[np.bool_]
    answer: RoadAnswer
    whitener: Complex


class Misfit:
    """Whitened residuals and their derivatives.

    The unknowns x are the searched parameters in the unit cube, then the shared adjustments in units of their scales, then each trial's
    nuisances in units of their standard deviations (which also enter as residuals, their prior).

    Parameters
    ----------
    problem
        Trials and searched parameters.
    noises
        One noise a trial.
    reference
        Searched values `shape (n_parameters,)` [SI] at which the road's part of the noise is computed: weights must not chase the fit.
    nuisances
        What is fitted along.
    band
        Frequencies compared [Hz].
    shared
        What may be wrong with runs or sensors, fitted along.
    renew
        Every how many calls the derivatives by nuisances are computed anew; in between the last ones serve, which change little. Beyond
        1 all derivatives are one-sided, which takes half of the time.
    """

    def __init__(
        self,
        problem: Problem,
        noises: Noises,
        reference: Array,
        nuisances: Nuisances | None = None,
        band: tuple[float, float] = CALIBRATION_BAND_HZ,
        shared: Sequence[Adjustment] = (),
        jacobian_refresh: int = 1,
    ) -> None:
        self.problem = problem
        self.noises = noises
        self.nuisances = nuisances or Nuisances()
        self.band = band
        self.shared = tuple(shared)
        self.jacobian_refresh = jacobian_refresh
        self._calls = 0
        self._kept: list[Array] = []
        self._weights = [self._weight(trial, problem.best_values(reference)) for trial in problem.trials]

    def _weight(self, trial: Trial, reference: Mapping[str, float]) -> _Weight:
        dt = trial.recording.dt
        frequency = np.asarray(np.fft.rfftfreq(len(trial.recording.time), dt), dtype=np.float64)
        inside = (frequency >= self.band[0]) & (frequency <= self.band[1])
        own = {name: value for name, value in reference.items() if name not in trial.fixed}
        answer = road_answer(trial, frequency[inside], trial.values | own)
        return _Weight(inside, answer, self.noises[trial.name].whitener(answer))

    @property
    def n_parameters(self) -> int:
        """Number of searched parameters."""
        return self.problem.space.size

    @property
    def n_unknowns(self) -> int:
        """Number of unknowns: parameters, shared adjustments, nuisances."""
        return self.n_parameters + len(self.shared) + len(self.problem.trials) * len(self.nuisances.names)

    def split(self, x: Array) -> tuple[Array, Array]:
        """Return the parameters `shape (n_parameters,)` in the unit cube and the nuisances `shape (n_trials, len(names))`."""
        start = self.n_parameters + len(self.shared)
        return x[: self.n_parameters], x[start:].reshape(len(self.problem.trials), len(self.nuisances.names))

    def adjusted(self, x: Array) -> Array:
        """Return the numbers of the shared adjustments, `shape (len(shared),)`."""
        own = x[self.n_parameters : self.n_parameters + len(self.shared)]
        return np.array([item.neutral + item.scale * value for item, value in zip(self.shared, own, strict=True)])

    def respond(self, trial: Trial, values: Array, numbers: Array, error: Array) -> Array:
        """Return what a trial's sensors read at searched values `shape (n, n_parameters)` [SI], adjustments and nuisances."""
        scenario = self.nuisances.adjust(trial.scenario, error)
        for item, value in zip(self.shared, numbers, strict=True):
            scenario = item.scenario(scenario, float(value))
        response = self.problem.respond(values, trial, scenario)[0]
        for i, item in enumerate(self.shared):
            response = item.response(trial, response, numbers[i:])
        return response

    def simulate(self, x: Array) -> list[Array]:
        """Return each trial's response, `shape (n_samples, n_channels)`."""
        unit, errors = self.split(x)
        values, numbers = self.problem.space.values(unit)[None], self.adjusted(x)
        return [self.respond(trial, values, numbers, error)[0] for trial, error in zip(self.problem.trials, errors, strict=True)]

    def residual_spectrum(self, x: Array) -> list[tuple[Complex, RoadAnswer]]:
        """Return each trial's residual, measured minus simulated, as spectral lines, with the road's way into them."""
        found = []
        for trial, weight, simulated in zip(self.problem.trials, self._weights, self.simulate(x), strict=True):
            found.append((transform(trial.recording.values - simulated, trial.recording.dt, weight.inside), weight.answer))
        return found

    def whitened_spectrum(self, x: Array) -> list[Complex]:
        """Return each trial's whitened residual lines, `shape (n_lines, n_channels)`, E|line|^2 = 1 where model and noise are right."""
        return [_apply(weight.whitener, lines) for weight, (lines, _) in zip(self._weights, self.residual_spectrum(x), strict=True)]

    def whiten(self, number: int, lines: Complex) -> Complex:
        """Return lines `shape (..., n_lines, n_channels)` of trial `number` whitened."""
        return _apply(self._weights[number].whitener, lines)

    def whitened_signal(self, number: int, signal: Array) -> Complex:
        """Return the whitened lines of a signal `shape (n_samples, n_channels)` in trial `number`."""
        return self.whiten(number, transform(signal, self.problem.trials[number].recording.dt, self._weights[number].inside))

    def frequency(self, number: int) -> Array:
        """Return the frequencies of trial `number`'s lines [Hz]."""
        return self._weights[number].answer.frequency

    def residuals(self, x: Array) -> Array:
        """Return the whitened residuals, the nuisances' priors last: each of unit variance where model and noise are right."""
        return np.concatenate([*(flatten(lines) for lines in self.whitened_spectrum(x)), x[self.n_parameters + len(self.shared) :]])

    @contextmanager
    def quickly(self, jacobian_refresh: int) -> Iterator[None]:
        """Within this context derivatives are one-sided, those by nuisances computed anew every `renew` calls only."""
        before, self.jacobian_refresh, self._calls = self.jacobian_refresh, jacobian_refresh, 0
        try:
            yield
        finally:
            self.jacobian_refresh, self._calls = before, 0

    def whitened_derivatives(self, x: Array) -> list[Complex]:
        """Return the derivatives of :meth:`whitened_spectrum` by differences, each `shape (n_unknowns, n_lines, n_channels)`."""
        unit, errors = self.split(x)
        numbers = self.adjusted(x)
        n, s, k = self.n_parameters, len(self.shared), len(self.nuisances.names)
        quick = self.jacobian_refresh > 1
        values = self.problem.space.values(unit + np.vstack([np.eye(n), np.zeros((1, n)) if quick else -np.eye(n)]) * UNIT_DIFFERENCE)
        middle = self.problem.space.values(unit)[None]
        found = []
        fresh = self._calls % self.jacobian_refresh == 0
        self._calls += 1
        if fresh:
            self._kept = []
        for t, (trial, weight, error) in enumerate(zip(self.problem.trials, self._weights, errors, strict=True)):
            derived = np.zeros((self.n_unknowns, len(trial.recording.time), len(trial.channels)))
            responses = self.respond(trial, values, numbers, error) if len(values) else np.zeros((0, *derived.shape[1:]))
            centre = responses[n] if quick else None
            if n:
                derived[:n] = (
                    (responses[:n] - responses[n]) / UNIT_DIFFERENCE if quick else (responses[:n] - responses[n:]) / (2 * UNIT_DIFFERENCE)
                )
            for j, item in enumerate(self.shared):
                step = UNIT_DIFFERENCE * item.scale * np.eye(s)[j]
                derived[n + j] = self._slope(trial, middle, (numbers, step), (error, np.zeros(k)), centre)
            if fresh:
                steps = UNIT_DIFFERENCE * np.eye(k)
                self._kept.append(np.zeros((k, *derived.shape[1:])))
                for j, step in enumerate(steps):
                    self._kept[t][j] = self._slope(trial, middle, (numbers, np.zeros(s)), (error, step), centre)
            derived[n + s + t * k : n + s + (t + 1) * k] = self._kept[t]
            found.append(-_apply(weight.whitener, transform(derived, trial.recording.dt, weight.inside)))
        return found

    def _slope(self, trial: Trial, values: Array, numbers: tuple[Array, Array], error: tuple[Array, Array], centre: Array | None) -> Array:
        """Return the change of a trial's response per STEP, when numbers and errors (value, step) are moved by their steps."""
        ahead = self.respond(trial, values, numbers[0] + numbers[1], error[0] + error[1])[0]
        if centre is not None:
            return np.asarray((ahead - centre) / UNIT_DIFFERENCE)
        behind = self.respond(trial, values, numbers[0] - numbers[1], error[0] - error[1])[0]
        return np.asarray((ahead - behind) / (2 * UNIT_DIFFERENCE))

    def jacobian(self, x: Array) -> Array:
        """Return the derivatives of :meth:`residuals`, `shape (n_residuals, n_unknowns)`."""
        start = self.n_parameters + len(self.shared)
        prior = np.zeros((self.n_unknowns - start, self.n_unknowns))
        prior[:, start:] = np.eye(self.n_unknowns - start)
        return np.vstack([*(flatten(lines, first=1).T for lines in self.whitened_derivatives(x)), prior])

    def draw(self, x: Array, random: np.random.Generator) -> list[Array]:
        """Return measurements as they might have come out: the response plus noise, one array a trial (for a bootstrap)."""
        found = []
        for trial, weight, simulated in zip(self.problem.trials, self._weights, self.simulate(x), strict=True):
            noise = self.noises[trial.name]
            found.append(simulated + noise.draw(weight.answer, len(simulated), np.flatnonzero(weight.inside), random))
        return found


def _apply(whitener: Complex, lines: Complex) -> Complex:
    return np.asarray((whitener @ lines[..., None])[..., 0])


def flatten(white: Complex, first: int = 0) -> Array:
    """Return real and imaginary parts as residuals of unit variance; the axes before `first` are kept."""
    flat = white.reshape(*white.shape[:first], -1) * np.sqrt(2)
    return np.concatenate([flat.real, flat.imag], axis=-1)
