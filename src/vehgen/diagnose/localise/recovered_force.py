"""The force that the place test recovers: its history in every run, how sure it is, and the motion of the place under it.

Sign: as force laws have it. Travel and force are positive in compression, so that a positive force resists a positive travel; at a body
the travel is its heave or pitch, and a positive force or moment acts against it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy
from numpy.typing import NDArray

from vehgen.codegen import Kernel
from vehgen.diagnose.detect.detection import Detection
from vehgen.diagnose.localise.unknown_force import Place, PlaceResult, posterior, score_locations
from vehgen.fit.alignment import align
from vehgen.fit.misfit import Misfit
from vehgen.fit.window import taper
from vehgen.mechanics.equations_of_motion import Channel, EquationsOfMotion
from vehgen.simulate.acquired import initial_states
from vehgen.simulate.frequency import force_response

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
DEAF = 0.05
"""Lines that see less of the force than this share of the median power tell little of it: near the frequency at which the wheel takes up
a suspension's force alone, what the model errs elsewhere would be blown up."""
TIED = 1.005
"""Hypotheses whose chi differ by no more than this factor do equally well."""
FADED = 0.2
"""Where the record's taper is below this, the motion's answer to the force is not scaled up any further."""


@dataclass(frozen=True, eq=False)
class RecoveredForce:
    """An unknown force in one run, and the motion of its place.

    Attributes
    ----------
    run, validation
        Name of the run; whether no fit has seen it.
    place
        Where the force acts.
    angular
        Whether travel, rate and force are an angle [rad], its rate [rad/s] and a moment [N m], not m, m/s and N.
    time, force, travel, rate
        `shape (n,)`: the force lies within the band only and fades with the record's taper at both ends; travel and rate are those of the
        base fit with its answer to the force.
    noise
        Standard deviation of the force from noise, `shape (n,)`.
    window
        The record's taper, `shape (n,)`.
    lines
        Which of the record's spectral lines see the force, `shape (n // 2 + 1,)`.
    variance
        The noise's one-sided PSD at these lines [N^2/Hz], `shape (n_seen,)`.
    answer
        Travel and rate per unit of force at all spectral lines, `shape (n // 2 + 1, 2)`.
    stiffness, damping
        Those of the base model at the place, to which the force adds; 0 at a body.
    variants
        What the base fit's uncertainty does, `shape (n_variants, 3, n)`: changes of force, travel and rate for independent directions of
        one standard deviation each. Of the force, without what the base model's own spring and damper take over.
    """

    run: str
    validation: bool
    place: Place
    angular: bool
    time: Array
    force: Array
    travel: Array
    rate: Array
    noise: Array
    window: Array
    lines: NDArray[np.bool_]
    variance: Array
    answer: Complex
    stiffness: float
    damping: float
    variants: Array

    @property
    def dt(self) -> float:
        """Sample interval [s]."""
        return float(self.time[1] - self.time[0])

    @property
    def units(self) -> tuple[str, str, str]:
        """Units of travel, rate and force."""
        return ("rad", "rad/s", "N m") if self.angular else ("m", "m/s", "N")

    @property
    def deviation(self) -> Array:
        """Standard deviation of the force from noise and base fit, `shape (n,)`."""
        return np.asarray(np.sqrt(self.noise**2 + (self.variants[:, 0] ** 2).sum(axis=0)))

    def observable(self, history: Array) -> Array:
        """Return what the test would recover of force histories `shape (n, ...)`: tapered, and nothing outside the lines that see it."""
        window = self.window.reshape(-1, *[1] * (history.ndim - 1))
        spectrum = np.fft.rfft(history * window, axis=0)
        spectrum[~self.lines] = 0.0
        return np.asarray(np.fft.irfft(spectrum, len(self.time), axis=0))

    def unseen_motion(self, history: Array) -> tuple[Array, Array]:
        """Return what the parts of a force history that the test cannot see add to travel and rate."""
        spectrum = np.fft.rfft(history)
        spectrum[self.lines] = 0.0
        motion = np.fft.irfft(self.answer * spectrum[:, None], len(self.time), axis=0)
        return np.asarray(motion[:, 0]), np.asarray(motion[:, 1])


def recover(detection: Detection, result: PlaceResult, component: int = 0) -> tuple[RecoveredForce, ...]:
    """Return the unknown force of a hypothesis in every run, training runs first.

    Untouched runs keep the base parameters of the hypothesis; what a run does not know of itself is fitted there by the place test.

    Parameters
    ----------
    detection
        Stage 1 of the diagnosis.
    result
        A tested hypothesis.
    component
        Which of the hypothesis's rows, where it has several.

    Returns
    -------
    Nothing for a hypothesis without a force: a channel, a sensor, none.
    """
    if component >= len(result.place.rows):
        return ()
    misfit = detection.base.least_squares.misfit
    if len(result.x) != misfit.n_unknowns:  # tested before a second look found another recorder
        (result,) = score_locations(misfit, detection.base.least_squares.x, [result.place])
    directions = np.asarray(np.linalg.cholesky(posterior(misfit, result)), dtype=np.float64)
    found = _recover(misfit, result, directions, component, False)
    n, known = misfit.n_parameters, misfit.common_errors(result.x)
    values = misfit.problem.space.values(result.x[:n])
    for trial in detection.validation_runs:
        alone = misfit.problem.with_trials([trial])
        frozen = Misfit(
            alone.searching((), alone.best_values(values)), misfit.noises, np.zeros(0), misfit.nuisances, misfit.band, known=known
        )
        for item in score_locations(frozen, align(frozen, np.zeros(0)), [result.place]):
            own = Misfit(alone, misfit.noises, values, misfit.nuisances, misfit.band, known=known)
            moved = replace(item, x=np.concatenate([result.x[:n], item.x]))
            spread = scipy.linalg.block_diag(directions[:n], np.linalg.cholesky(posterior(frozen, item)))
            found += _recover(own, moved, spread, component, True)
    return tuple(found)


def motions(misfit: Misfit, result: PlaceResult) -> dict[str, tuple[Array, Array]]:
    """Return travel and rate of a hypothesis's place in a misfit's runs, by name, each `shape (n,)`, as :func:`recover` does."""
    still = np.zeros((len(result.x), 0))
    return {run.run: (run.travel, run.rate) for run in _recover(misfit, result, still, 0, False)}


@dataclass(frozen=True, eq=False)
class _Raw:
    """A force as spectral lines of the band with their variance, the motion without it, and the element's stiffness and damping."""

    force: Complex
    variance: Array
    motion: Array
    answer: Complex
    element: tuple[float, float]


def _recover(misfit: Misfit, result: PlaceResult, directions: Array, component: int, validation: bool) -> list[RecoveredForce]:
    """Return the force in a misfit's runs, with the variants in `directions shape (n_unknowns, n_directions)`."""
    kernels: dict[int, tuple[EquationsOfMotion, Kernel]] = {}
    raw = _raw(misfit, result.place, component, result.x, kernels)
    moved = [_raw(misfit, result.place, component, result.x + direction, kernels) for direction in directions.T]
    found = []
    for t, (trial, own) in enumerate(zip(misfit.problem.trials, raw, strict=True)):
        n, dt = len(trial.recording.time), trial.recording.dt
        variance = own.variance * max(result.chi, 1.0) ** 2
        clear = own.variance < np.median(own.variance) / DEAF
        lines = np.isin(np.fft.rfftfreq(n, dt), misfit.frequency(t))
        lines[lines] = clear
        window = taper(n, dt, trial.fade_in)
        histories = [_history(item[t], clear, lines, window, dt) for item in (raw, *moved)]
        model = trial.simulator.model
        central = RecoveredForce(
            trial.name,
            validation,
            result.place,
            result.place.kind == "hinge" or result.place.rows[component] in list(model.motion.pitch.values()),
            trial.recording.time,
            *histories[0],
            window * float(np.sqrt(variance[clear].sum() / (n * dt))),
            window,
            lines,
            variance[clear],
            own.answer,
            *own.element,
            np.zeros((0, 3, n)),
        )
        changes = [_change(central, history, item[t].element) for history, item in zip(histories[1:], moved, strict=True)]
        found.append(replace(central, variants=np.reshape(changes, (-1, 3, n))))
    return found


def _raw(misfit: Misfit, place: Place, component: int, x: Array, kernels: dict[int, tuple[EquationsOfMotion, Kernel]]) -> list[_Raw]:
    """Least squares line by line in every run: F = (H* H)^-1 H* r with whitened H."""
    known = misfit.problem.best_values(misfit.problem.space.values(misfit.split(x)[0]))
    found = []
    for t, (trial, lines) in enumerate(zip(misfit.problem.trials, misfit.whitened_spectrum(x), strict=True)):
        model = trial.simulator.model
        values = trial.values | {name: value for name, value in known.items() if name not in trial.fixed}
        lined = misfit.frequency(t)
        number = model.element_number(place.kind, place.name)
        response = force_response(model, values, place.rows, lined, number) * trial.channel_factors(lined)[:, :, None]
        white = np.stack([misfit.whiten(t, misfit.read_at(t, response[:, :, j], x)) for j in range(len(place.rows))], axis=2)
        adjoint = white.conj().transpose(0, 2, 1)
        inverse = np.linalg.pinv(adjoint @ white, hermitian=True)
        if id(model) not in kernels:
            probe = _probe(model, place, component)
            kernels[id(model)] = probe, Kernel(probe)
        probe, kernel = kernels[id(model)]
        scenario = misfit.scenario(x, t)
        population = np.array([[values[name] for name in probe.parameters]])
        run = kernel.run(population, scenario.excitation(probe.wheel_offsets(values)), scenario.decimation, initial_states(scenario, 1))
        motion = run.responses[0, scenario.skipped :]
        frequency = np.asarray(np.fft.rfftfreq(len(motion), trial.recording.dt), dtype=np.float64)
        found.append(
            _Raw(
                -(inverse @ (adjoint @ lines[..., None]))[:, component, 0],
                np.asarray(inverse[:, component, component].real, dtype=np.float64),
                np.array(motion),
                -force_response(probe, values, place.rows[component : component + 1], frequency)[:, :, 0],
                _element(model, place, values),
            )
        )
    return found


def _history(raw: _Raw, clear: NDArray[np.bool_], lines: NDArray[np.bool_], window: Array, dt: float) -> tuple[Array, Array, Array]:
    """Return force, travel and rate; spectral lines that see little of the force are left at zero."""
    n = len(window)
    spectrum = np.zeros(len(lines), dtype=np.complex128)
    spectrum[lines] = raw.force[clear] * np.sqrt((window**2).sum() / (2 * dt))
    motion = raw.motion + np.fft.irfft(raw.answer * spectrum[:, None], n, axis=0) / np.maximum(window, FADED)[:, None]
    return np.asarray(np.fft.irfft(spectrum, n)), motion[:, 0], motion[:, 1]


def _change(run: RecoveredForce, history: tuple[Array, Array, Array], element: tuple[float, float]) -> Array:
    force, travel, rate = history
    own = run.observable((element[0] - run.stiffness) * travel + (element[1] - run.damping) * rate)
    return np.array([force + own - run.force, travel - run.travel, rate - run.rate])


def _probe(model: EquationsOfMotion, place: Place, component: int) -> EquationsOfMotion:
    """Return the model with two channels, travel and rate of a place."""
    row = place.rows[component]
    inputs = next((item.input_row for item in model.elements if (item.kind, item.name) == (place.kind, place.name)), {})
    travel = Channel("travel", "displacement", "", displacement=row, input=inputs)
    rate = Channel("rate", "velocity", "", velocity=row, input_rate=inputs)
    return replace(model, channels=(travel, rate))


def _element(model: EquationsOfMotion, place: Place, values: dict[str, float]) -> tuple[float, float]:
    """Return stiffness and damping of the base model at a place."""
    for item in model.elements:
        if (item.kind, item.name) == (place.kind, place.name):
            stiffness, damping = model.evaluate_list((item.k, item.c), values)
            return stiffness, damping
    return 0.0, 0.0


def strongest(results: Sequence[PlaceResult]) -> PlaceResult | None:
    """Return the hypothesis to show: the best one with a force, or a suspension that does as well (its tyre always does)."""
    forces = sorted((item for item in results if item.place.rows), key=lambda item: item.chi)
    tied = [item for item in forces if item.chi <= TIED * forces[0].chi]
    return next((item for item in tied if item.place.kind == "suspension"), forces[0] if forces else None)
