"""The misfit that uses phase: whitened residuals of all channels, for least squares.

Residuals are compared line by line within a band (by Parseval's theorem the same as in time, for what lies within the band) and whitened
by the noise's cross spectral density, so that their sum of squares is -2 ln of the likelihood. What runs and sensors do not know of
themselves exactly is fitted along with the parameters (see :mod:`vehgen.fit.nuisances`).
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from vehgen.fit.adjustments import Adjustment, RunState, adjust
from vehgen.fit.band import CALIBRATION_BAND_HZ
from vehgen.fit.noise import Noise
from vehgen.fit.nuisances import Condition, Nuisances
from vehgen.fit.problem import Problem
from vehgen.fit.road_answer import RoadAnswer, as_adjusted, as_read, road_answer
from vehgen.fit.run_errors import RunErrors
from vehgen.fit.trial import Trial
from vehgen.fit.window import flatten, transform
from vehgen.simulate import Scenario

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
Noises = dict[str, Noise]
"""Noise by name of the trial."""


@dataclass(frozen=True)
class _Weight:
    """A trial's spectral lines within the band, those measured, the road's way into them, and the matrices that whiten it."""

    inside: NDArray[np.bool_]
    measured: Complex
    answer: RoadAnswer
    whitener: Complex


class Misfit:
    """Whitened residuals.

    The unknowns x are the searched parameters in the unit cube, then the shared adjustments in units of their scales, then the errors of
    sensors and of each trial in units of their standard deviations (which also enter as residuals, their prior).

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
    known
        Errors of all runs that stand, by name and place.
    supposed, begun
        Errors `shape (n_errors,)` and adjustments `shape (len(shared),)`, in their units, at which the road's part of the noise is
        computed, too: at another speed axles meet it one sooner after the other (default: none, and neutral ones).
    """

    def __init__(
        self,
        problem: Problem,
        noises: Noises,
        reference: Array,
        nuisances: Nuisances | None = None,
        band: tuple[float, float] = CALIBRATION_BAND_HZ,
        shared: Sequence[Adjustment] = (),
        known: Mapping[tuple[str, str], float] | None = None,
        supposed: Array | None = None,
        begun: Sequence[float] | Array = (),
    ) -> None:
        self.problem = problem
        self.noises = noises
        self.nuisances = nuisances or Nuisances()
        self.band = band
        self.shared = tuple(shared)
        self.known = dict(known or {})
        self.common = tuple(item for item in self.nuisances.of_all_runs(problem.trials) if (item.name, item.place) not in self.known)
        self.errors = tuple(RunErrors.of(trial, self.common, self.nuisances.of_run(trial), self.known) for trial in problem.trials)
        self.begun = np.array(begun) if len(begun) else np.zeros(len(self.shared))
        at = np.concatenate([np.zeros(self.n_parameters), self.begun, np.zeros(self.n_errors) if supposed is None else supposed])
        self._weights = [self._weight(t, problem.best_values(reference), at) for t in range(len(problem.trials))]

    def _weight(self, number: int, reference: Mapping[str, float], x: Array) -> _Weight:
        trial, dt = self.problem.trials[number], self.problem.trials[number].recording.dt
        frequency = np.asarray(np.fft.rfftfreq(len(trial.recording.time), dt), dtype=np.float64)
        inside = (frequency >= self.band[0]) & (frequency <= self.band[1])
        answer, noise = self.answer(number, frequency[inside], reference, x), self.noises[trial.name]
        measured = transform(self.recorded(number), dt, inside, seen=trial.window)
        return _Weight(inside, measured, answer, noise.whitener(answer))

    def answer(self, number: int, frequency: Array, reference: Mapping[str, float], x: Array, *, windowed: bool = True) -> RoadAnswer:
        """Return how roughness comes into trial `number`'s channels, at reference values [SI] and errors of x; not `windowed`: as it is."""
        trial = self.problem.trials[number]
        own = {name: value for name, value in reference.items() if name not in trial.fixed}
        errors, error = self.errors[number], self.errors_of(x, number)
        driven = replace(trial, scenario=self._with_adjustments(errors.steady(trial.scenario, error), self.adjusted(x)))
        found = road_answer(driven, frequency, trial.values | own, self.nuisances.speed_spread(trial), windowed=windowed)
        return as_adjusted(as_read(found, errors.reading(frequency, error)), trial, self.shared, self.adjusted(x))

    @property
    def n_parameters(self) -> int:
        """Number of searched parameters."""
        return self.problem.space.size

    @property
    def n_errors(self) -> int:
        """Number of errors of all runs and of each."""
        return len(self.common) + sum(len(item.own) for item in self.errors)

    @property
    def n_unknowns(self) -> int:
        """Number of unknowns: parameters, shared adjustments, errors."""
        return self.n_parameters + len(self.shared) + self.n_errors

    def split(self, x: Array) -> tuple[Array, Array]:
        """Return the parameters in the unit cube `shape (n_parameters,)` and the errors `shape (n_errors,)`."""
        return x[: self.n_parameters], x[self.n_parameters + len(self.shared) :]

    def own_columns(self, number: int) -> slice:
        """Return where the errors of trial `number` alone stand among the unknowns."""
        start = self.n_parameters + len(self.shared) + len(self.common) + sum(len(item.own) for item in self.errors[:number])
        return slice(start, start + len(self.errors[number].own))

    def columns(self, number: int) -> NDArray[np.intp]:
        """Return which unknowns trial `number` depends on: parameters, adjustments, errors of all runs, its own."""
        own = self.own_columns(number)
        return np.concatenate([np.arange(self.n_parameters + len(self.shared) + len(self.common)), np.arange(own.start, own.stop)])

    def errors_of(self, x: Array, number: int) -> Array:
        """Return the errors of trial `number`, those of all runs first, `shape (n_common + n_own,)`."""
        return np.asarray(x[self.columns(number)[self.n_parameters + len(self.shared) :]])

    def error_position(self, number: int, name: str) -> int | None:
        """Return where an error of trial `number` stands among all `n_errors`; None where it is left out."""
        names = [item.name for item in self.errors[number].own]
        return self.own_columns(number).start - self.n_unknowns + self.n_errors + names.index(name) if name in names else None

    def scenario(self, x: Array, number: int) -> Scenario:
        """Return what trial `number` drives through, with its errors and the adjustments."""
        return self._driven(number, self.problem.trials[number], self.adjusted(x), self.errors_of(x, number))

    def conditions(self, x: Array) -> tuple[Condition, ...]:
        """Return what the unknowns say of sensors and runs."""
        found = [("", item) for item in self.common]
        found += [(trial.name, item) for trial, errors in zip(self.problem.trials, self.errors, strict=True) for item in errors.own]
        return tuple(
            Condition(run, item.name, item.place, float(number) * item.sigma, item.unit, item.sigma)
            for (run, item), number in zip(found, self.split(x)[1], strict=True)
        )

    def common_errors(self, x: Array) -> dict[tuple[str, str], float]:
        """Return the errors that hold in all runs, by name and place, those that stand included."""
        return {**self.known, **{(item.name, item.place): item.value for item in self.conditions(x) if not item.run}}

    def errors_like(self, other: Misfit, x: Array) -> Array:
        """Return errors `shape (n_errors,)` as another misfit's unknowns x have them; those that it leaves out are 0."""
        known = {item.key: item.sigmas for item in other.conditions(x)}
        return np.array([known.get(item.key, 0.0) for item in self.conditions(np.zeros(self.n_unknowns))])

    def without(self, x: Array, names: Sequence[str]) -> Array:
        """Return the unknowns x with all errors of some names at 0."""
        start = self.n_parameters + len(self.shared)
        return np.concatenate([x[:start], x[start:] * [item.name not in names for item in self.conditions(x)]])

    def adjusted(self, x: Array) -> Array:
        """Return the numbers of the shared adjustments, `shape (len(shared),)`."""
        own = x[self.n_parameters : self.n_parameters + len(self.shared)]
        return np.array([item.neutral + item.scale * value for item, value in zip(self.shared, own, strict=True)])

    def respond(
        self, number: int, values: Array, numbers: Array, error: Array, trial: Trial | None = None, scenario: Scenario | None = None
    ) -> Array:
        """Return how the places of trial `number`'s sensors move, `shape (n, n_samples, n_channels)`.

        At searched values `shape (n, n_parameters)` [SI], adjustments and the trial's errors; what the sensors' own errors make of it is
        left to :meth:`channel_lines`. `trial` stands in for the trial itself, with another step, `scenario` for what it drives through.
        """
        trial = trial or self.problem.trials[number]
        scenario = scenario or self._driven(number, trial, numbers, error)
        response = self.problem.respond(values, trial, scenario)[0]
        return adjust(self.shared, trial, response, numbers, self.state(number, values, error, scenario))

    def respond_nearby(self, number: int, values: Array, numbers: Array, errors: Array) -> Array:
        """Return how the places of trial `number`'s sensors move in drives that hardly differ, `shape (n, n_samples, n_channels)`.

        As :meth:`respond` at searched values `shape (n, n_parameters)` [SI], each with its adjustments `shape (n, n_adjustments)` and
        errors of the trial `shape (n, n_errors)`; differences from the first are right to the first order.
        """
        trial = self.problem.trials[number]
        driven = [self._driven(number, trial, *pair) for pair in zip(numbers, errors, strict=True)]
        found = self.problem.respond_nearby(values, trial, driven[0], driven[1:])
        states = [self.state(number, values[i : i + 1], errors[i], one) for i, one in enumerate(driven)]
        return np.concatenate([adjust(self.shared, trial, *one) for one in zip(found[:, None], numbers, states, strict=True)])

    def _driven(self, number: int, trial: Trial, numbers: Array, error: Array) -> Scenario:
        """Return what a trial drives through, at adjustments and errors."""
        return self._with_adjustments(self.errors[number].scenario(trial.scenario, error), numbers)

    def _with_adjustments(self, scenario: Scenario, numbers: Array) -> Scenario:
        for item, value in zip(self.shared, numbers, strict=True):
            scenario = item.scenario(scenario, float(value))
        return scenario

    def state(self, number: int, values: Array, error: Array, scenario: Scenario) -> RunState:
        """Return what is supposed of trial `number` at values `shape (n, n_parameters)` [SI], its errors, and what it drives through."""
        vehicles = tuple(self.problem.values_of(own, self.problem.trials[number]) for own in values) if self.shared else ()
        return RunState(scenario, self.errors[number].clocks(error), vehicles)

    def channel_lines(self, number: int, response: Array, error: Array) -> Complex:
        """Return the spectral lines of what trial `number`'s sensors read of motions `shape (..., n_samples, n_channels)`."""
        return self.read(number, self.unread(number, response, error), error)

    def unread(self, number: int, response: Array, error: Array, later: float = 0.0) -> Complex:
        """Return the spectral lines of motions under the windows of late clocks, all `later` [s], which :meth:`read` then turns."""
        trial, clocks = self.problem.trials[number], self.errors[number].clocks(error) + later
        return transform(response, trial.recording.dt, self._weights[number].inside, clocks, trial.window)

    def read(self, number: int, lines: Complex, error: Array) -> Complex:
        """Return what trial `number`'s sensors make of spectral lines of motions `shape (..., n_lines, n_channels)`."""
        reading = self.errors[number].reading(self.frequency(number), error)
        return lines if reading is None else reading.apply(lines)

    def read_at(self, number: int, lines: Complex, x: Array) -> Complex:
        """Return :meth:`read` of lines at all unknowns x."""
        return self.read(number, lines, self.errors_of(x, number))

    def motions(self, x: Array) -> list[Array]:
        """Return how the places of the sensors move in each trial, `shape (n_samples, n_channels)`."""
        values, numbers = self.problem.space.values(self.split(x)[0])[None], self.adjusted(x)
        return [self.respond(t, values, numbers, self.errors_of(x, t))[0] for t in range(len(self.problem.trials))]

    def simulate(self, x: Array) -> list[Array]:
        """Return what the sensors read in each trial, `shape (n_samples, n_channels)`."""
        return [
            self.errors[t].read(motion, trial.recording.dt, self.errors_of(x, t))
            for t, (trial, motion) in enumerate(zip(self.problem.trials, self.motions(x), strict=True))
        ]

    def residual_spectrum(self, x: Array) -> list[tuple[Complex, RoadAnswer]]:
        """Return each trial's residual, measured minus simulated, as spectral lines, with the road's way into them."""
        return [
            (weight.measured - self.channel_lines(t, motion, self.errors_of(x, t)), weight.answer)
            for t, (weight, motion) in enumerate(zip(self._weights, self.motions(x), strict=True))
        ]

    def whitened_spectrum(self, x: Array) -> list[Complex]:
        """Return each trial's whitened residual lines, `shape (n_lines, n_channels)`, E|line|^2 = 1 where model and noise are right."""
        return [_apply(weight.whitener, lines) for weight, (lines, _) in zip(self._weights, self.residual_spectrum(x), strict=True)]

    def whiten(self, number: int, lines: Complex) -> Complex:
        """Return lines `shape (..., n_lines, n_channels)` of trial `number` whitened."""
        return _apply(self._weights[number].whitener, lines)

    def signal_lines(self, number: int, signal: Array) -> Complex:
        """Return the spectral lines of a signal `shape (n_samples, n_channels)` in trial `number`."""
        trial = self.problem.trials[number]
        return transform(signal, trial.recording.dt, self._weights[number].inside, seen=trial.window)

    def whitened_signal(self, number: int, signal: Array) -> Complex:
        """Return :meth:`signal_lines` whitened."""
        return self.whiten(number, self.signal_lines(number, signal))

    def recorded(self, number: int) -> Array:
        """Return what trial `number` recorded, less what roughness shifts, `shape (n_samples, n_channels)`."""
        return self.noises[self.problem.trials[number].name].unshifted(self.problem.trials[number].recording.values)

    def measured(self, number: int) -> Complex:
        """Return the spectral lines of :meth:`recorded`, `shape (n_lines, n_channels)`."""
        return self._weights[number].measured

    def frequency(self, number: int) -> Array:
        """Return the frequencies of trial `number`'s lines [Hz]."""
        return self._weights[number].answer.frequency

    def residuals(self, x: Array) -> Array:
        """Return the whitened residuals, the errors' priors last: each of unit variance where model and noise are right."""
        return np.concatenate([*(flatten(lines) for lines in self.whitened_spectrum(x)), x[self.n_parameters + len(self.shared) :]])


def _apply(whitener: Complex, lines: Complex) -> Complex:
    """Return whitened lines: one product of matrices a line for all spectra, as many small products would be slow."""
    rows = lines.reshape(math.prod(lines.shape[:-2]), *lines.shape[-2:]).swapaxes(0, 1)
    return np.asarray((rows @ whitener.swapaxes(-1, -2)).swapaxes(0, 1).reshape(lines.shape))
