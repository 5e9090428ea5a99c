"""The misfit that uses phase: whitened residuals of all channels, for least squares.

Residuals are compared line by line within a band (by Parseval's theorem the same as in time, for what lies within the band) and whitened
by the noise's cross spectral density, so that their sum of squares is -2 ln of the likelihood. What a run does not know of itself exactly
is fitted along with the parameters: its delay, the scales of its speed and of its hump's height.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
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
    """Whitened residuals.

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
    """

    def __init__(
        self,
        problem: Problem,
        noises: Noises,
        reference: Array,
        nuisances: Nuisances | None = None,
        band: tuple[float, float] = CALIBRATION_BAND_HZ,
        shared: Sequence[Adjustment] = (),
    ) -> None:
        self.problem = problem
        self.noises = noises
        self.nuisances = nuisances or Nuisances()
        self.band = band
        self.shared = tuple(shared)
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
