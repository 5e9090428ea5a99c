"""Fitted models asked about runs that nobody has driven yet: what each predicts, and how far two of them are apart.

How far A and B are apart is what B would still be wrong by if A were true and B were fitted to all runs, old and new:

    d^2 = min over x of |W (y_A - y_B) - J x|^2 + x' L x

with W the noise's whitener, J the derivatives of B's prediction by its parameters, its adjustments and what the new run does not know of
itself (delay, speed, height), and L the information that the runs so far hold about them. It is linear about B's fit, and the expected
difference of chi-squared between the two.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from vehgen.diagnose.design.candidate_runs import CandidateRun
from vehgen.diagnose.fits.model_fit import ModelFit, base_priors
from vehgen.fit.alignment import MOST_SIGMAS, best_delay
from vehgen.fit.linearisation import linearise
from vehgen.fit.misfit import Misfit
from vehgen.fit.noise import Noise
from vehgen.fit.nuisances import Nuisances
from vehgen.fit.problem import Problem
from vehgen.fit.recording import RecordedChannel
from vehgen.fit.trial import Trial
from vehgen.fit.window import flatten, transform
from vehgen.measure.acquisition import POINT_SAMPLES
from vehgen.mechanics import Output
from vehgen.mechanics.outputs import ElementOutput, PointOutput
from vehgen.simulate import Simulator

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
SPREAD = 0.29
"""Standard deviation of an effect's own parameter in the unit cube before any run: that of an even distribution."""
REFITS = 4
SETTLED_GAIN = 0.9
"""A step of a refit that leaves more than this share of the distance is the last one."""
ABSENT = 1e6
"""A channel with so many times its noise counts as not there."""


OF_NEW_RUNS = Nuisances(
    delay=0.05, speed=0.005, height=0.02, wander=0, length=0, form=0, skew=0, wear=0, clock=0, lag=0, gain=0, tilt=0, position=0,
    axle_position=0, odometer=0, roll_off=0, edge=0, dispersion=0, edge_dispersion=0,
)  # fmt: skip
"""What a new run, driven with care, does not know of itself."""
PHONE = {"acceleration": 0.0125, "pitch_rate": 5e-4}
"""Noise of a phone where the runs do not tell [m/s^2, rad/s]."""


@dataclass(frozen=True)
class Separation:
    """How far two models are apart in a run: `distance` is d^2, over `count` whitened residuals; `x` where the refit ends."""

    distance: float
    count: int
    x: Array


@dataclass
class FittedModel:
    """A fitted model with the channels of `trial`; `noise` is theirs."""

    fit: ModelFit
    trial: Trial
    noise: Noise
    _answers: dict[str, Array] = field(default_factory=dict)
    _locals: dict[tuple[str, tuple[str, ...]], tuple[Misfit, Array]] = field(default_factory=dict)

    @classmethod
    def of(cls, fit: ModelFit, channels: tuple[str, ...]) -> FittedModel:
        """Return the rival that records `channels` as the fit's own runs did, with the most noise found in any of them."""
        misfit = fit.least_squares.misfit
        group = [trial for trial in misfit.problem.trials if trial.channels == channels]
        noises = [misfit.noises[trial.name] for trial in group]
        loudest = np.max([item.sigma for item in noises], axis=0)
        return cls(fit, group[0], replace(noises[0], sigma=loudest, drawn=None))  # what is drawn is of one run and its channels

    def with_outputs(self, outputs: Sequence[PointOutput]) -> FittedModel:
        """Return the rival with more channels, as noisy as its own of the same quantity, on its first recorder; compiles a simulator."""
        known: dict[str, list[float]] = {}
        for channel, own in zip(self.trial.recording.channels, self.noise.sigma, strict=True):
            known.setdefault(channel.quantity, []).append(float(own))
        sigma = np.array([np.mean(known.get(item.quantity, [PHONE[item.quantity]])) for item in outputs])
        measurement = self.trial.recording
        added = tuple(RecordedChannel(item.name, item.place.name, item.quantity, item) for item in outputs)
        channels = (*measurement.channels, *added)
        simulator = self.simulator(tuple(channel.output for channel in channels))
        values = simulator.model.values(overrides=self.trial.run.values())
        blank = np.zeros((len(measurement.time), len(channels)))
        own = self.trial.scenario
        like = next((own.chain(name) for name in self.trial.channels), POINT_SAMPLES)
        scenario = replace(own, chains={**own.chains, **dict.fromkeys((item.name for item in outputs), like)})
        recording = replace(measurement, values=blank, channels=channels)
        trial = replace(self.trial, simulator=simulator, scenario=scenario, values=values, recording=recording)
        noise = replace(self.noise, sigma=np.concatenate([self.noise.sigma, sigma]))
        if noise.louder is not None:
            noise = replace(noise, louder=np.column_stack([noise.louder, np.ones((len(noise.louder), len(sigma)))]))
        return FittedModel(self.fit, trial, noise)

    def simulator(self, outputs: Sequence[Output]) -> Simulator:
        """Compile the model with other outputs."""
        return Simulator(self.trial.run.vehicle, outputs, self.trial.run.forces())

    def misfit(self, run: CandidateRun, noise: Noise | None = None) -> Misfit:
        """Return the misfit of this model over a run that recorded nothing."""
        fitted = self.fit.least_squares.misfit
        time = run.scenario.time[:: run.scenario.decimation]
        measurement = replace(self.trial.recording, time=time, values=np.zeros((len(time), len(self.trial.channels))))
        scenario = replace(run.scenario, chains=self.trial.scenario.chains)
        trial = replace(self.trial, name=run.name, scenario=scenario, recording=measurement)
        problem = Problem((trial,), fitted.problem.space)
        noises, known = {run.name: noise or self.noise}, fitted.common_errors(self.fit.least_squares.x)
        return Misfit(problem, noises, self.fit.least_squares.values, OF_NEW_RUNS, fitted.band, fitted.shared, known, begun=fitted.begun)

    def local(self, run: CandidateRun, channels: tuple[str, ...]) -> tuple[Misfit, Array]:
        """Return the misfit over a run with some channels only, and its derivatives at the fit."""
        key = run.name, channels
        if key not in self._locals:
            kept = np.isin(self.trial.channels, channels)
            misfit = self.misfit(run, replace(self.noise, sigma=np.where(kept, 1.0, ABSENT) * self.noise.sigma))
            self._locals[key] = misfit, linearise(misfit, self.begin(misfit)).jacobian
        return self._locals[key]

    def begin(self, misfit: Misfit) -> Array:
        """Return the fitted parameters and adjustments, then the errors of a new run's misfit, none."""
        fitted = self.fit.least_squares.misfit
        return np.concatenate([self.fit.least_squares.x[: fitted.n_parameters + len(fitted.shared)], np.zeros(misfit.n_errors)])

    @cached_property
    def information(self) -> Array:
        """What the runs so far and the priors of the fit say of parameters and adjustments, `shape (n, n)`."""
        misfit = self.fit.least_squares.misfit
        n = misfit.n_parameters
        own = sum(len(item.parameters) for item in self.fit.effects)
        jacobian = linearise(misfit, self.fit.least_squares.x).jacobian
        whole = jacobian.T @ jacobian
        held = base_priors(misfit.problem.space.names[: n - own], self.fit.effects)
        whole[:n, :n] += np.diag(np.concatenate([held, np.full(own, SPREAD)]) ** -2.0)
        k = n + len(misfit.shared)
        return np.asarray(whole[:k, :k] - whole[:k, k:] @ np.linalg.solve(whole[k:, k:], whole[k:, :k]))

    def predict(self, run: CandidateRun) -> Array:
        """Return what its channels would read, `shape (n_samples, n_channels)`."""
        if run.name not in self._answers:
            misfit = self.misfit(run)
            self._answers[run.name] = misfit.simulate(self.begin(misfit))[0]
        return self._answers[run.name]

    def travels(self, run: CandidateRun, axles: Sequence[str]) -> Array:
        """Return the travel of the suspensions of axles, `shape (n_samples, len(axles))` [m]; compiles a simulator."""
        simulator = self.simulator([ElementOutput(f"travel of {name}", name, "suspension_travel") for name in axles])
        trial = replace(self.trial, simulator=simulator, values=simulator.model.values(overrides=self.trial.run.values()))
        misfit, scenario = self.fit.least_squares.misfit, run.scenario
        for item, value in zip(misfit.shared, misfit.adjusted(self.fit.least_squares.x), strict=True):
            scenario = item.scenario(scenario, float(value))
        return np.asarray(misfit.problem.respond(self.fit.least_squares.values[None], trial, scenario)[0][0])


def at_most(truth: FittedModel, fitted: FittedModel, run: CandidateRun, channels: tuple[str, ...]) -> Separation:
    """Return a distance that no refit and no roughness of the road can exceed, quickly; 0 where a prediction is not finite."""
    lines, dt = _difference(truth, fitted, run), fitted.trial.recording.dt
    kept = np.isin(fitted.trial.channels, channels)
    distance = float(((np.abs(lines) ** 2).sum(axis=0) / (dt * fitted.noise.sigma**2))[kept].sum())
    return Separation(distance if np.isfinite(distance) else 0.0, 2 * len(lines) * len(channels), fitted.begin(fitted.misfit(run)))


def separate(truth: FittedModel, fitted: FittedModel, run: CandidateRun, channels: tuple[str, ...]) -> Separation:
    """Return how far `fitted` stays from the prediction of `truth` after its refit to all runs: REFITS Gauss-Newton steps at most.

    They begin at the fit, and at the fit with the new run's clock where the two predictions correlate best.
    """
    misfit, jacobian = fitted.local(run, channels)
    wanted = misfit.whitened_signal(0, truth.predict(run))
    start = fitted.begin(misfit)
    count, k = 2 * wanted.size * len(channels) // wanted.shape[1], len(fitted.information)

    def left(x: Array) -> tuple[float, Array]:
        residuals = np.concatenate([flatten(wanted + misfit.whitened_spectrum(x)[0]), x[k:]])
        away = x[:k] - start[:k]
        return float(residuals @ residuals + away @ fitted.information @ away), residuals

    late = start.copy()
    place = misfit.error_position(0, "delay")
    if place is not None:
        late[k + place] = np.clip(_later(truth, fitted, run) / OF_NEW_RUNS.delay, -MOST_SIGMAS, MOST_SIGMAS)
    x, (distance, residuals) = min(((item, left(item)) for item in (start, late)), key=lambda item: item[1][0])
    if x is late:
        jacobian = linearise(misfit, x).jacobian
    for turn in range(REFITS):
        normal, slope = jacobian.T @ jacobian, jacobian.T @ residuals
        normal[:k, :k] += fitted.information
        slope[:k] += fitted.information @ (x[:k] - start[:k])
        new = x - np.linalg.lstsq(normal, slope, rcond=1e-12)[0]
        new[: misfit.n_parameters] = np.clip(new[: misfit.n_parameters], 0.0, 1.0)
        nearer, residuals_there = left(new)
        if not nearer < distance:
            break
        settled = nearer > SETTLED_GAIN * distance
        x, distance, residuals = new, nearer, residuals_there
        if settled or distance < 1.0 or turn == REFITS - 1:
            break
        jacobian = linearise(misfit, x).jacobian
    return Separation(distance if np.isfinite(distance) else 0.0, count, x)


def _later(truth: FittedModel, fitted: FittedModel, run: CandidateRun) -> float:
    """Return by how much later [s] the prediction of `fitted` must come to correlate best with that of `truth`."""
    return best_delay(truth.predict(run), fitted.predict(run), fitted.trial.recording.dt, fitted.fit.least_squares.misfit.band)[0]


def peak(truth: FittedModel, fitted: FittedModel, run: CandidateRun, channels: Sequence[str], x: Array) -> tuple[str, float]:
    """Return the channel in which the predictions differ most, `fitted` at x, and by how many standard deviations of its noise."""
    left = np.abs(truth.predict(run) - fitted.misfit(run).simulate(x)[0]).max(axis=0) / fitted.noise.sigma
    left = np.where(np.isin(fitted.trial.channels, channels), np.nan_to_num(left), -1.0)
    best = int(np.argmax(left))
    return fitted.trial.channels[best], float(left[best])


def _difference(truth: FittedModel, fitted: FittedModel, run: CandidateRun) -> Complex:
    """Return the spectral lines of the difference of two predictions within the band, `shape (n_lines, n_channels)`."""
    difference, dt = truth.predict(run) - fitted.predict(run), fitted.trial.recording.dt
    frequency = np.fft.rfftfreq(len(difference), dt)
    low, high = fitted.fit.least_squares.misfit.band
    return transform(difference, dt, (frequency >= low) & (frequency <= high), seen=fitted.trial.window)
