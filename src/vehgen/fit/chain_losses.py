"""What a fit leaves where other low-passes stand for its recorders.

Every chain filters the finely sampled response of the fit; what the fit's parameters and nuisances, held by their priors, can do about the
whitened residual is projected out. A chain's group delay at low frequency is taken off it: the fit's clock has found it already, and a
delay of a clock says nothing about a filter. What stands in a chain's place that a run file declares is late by its own, for which the
clock has not to make up.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from vehgen.fit.adjustments import RunState, adjust
from vehgen.fit.fine_response import FineResponse, fine_response
from vehgen.fit.least_squares import WEAK_PRIOR_SIGMA
from vehgen.fit.linearisation import linearise
from vehgen.fit.misfit import Misfit
from vehgen.fit.nuisances import LOW_PASS
from vehgen.measure.acquisition import AcquisitionChain

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
LEAST_GAIN = 0.05
"""A line that the assumed chain takes so far off tells nothing of the derivatives before it."""
UNSEEN = 1e-12
"""A direction of the unknowns whose scaled curvature is below this share of the largest is left alone."""


@dataclass(frozen=True)
class ChainFit:
    """A chain, and the sum of squares of the whitened residuals that it leaves."""

    chain: AcquisitionChain
    loss: float


@dataclass(frozen=True)
class StoredRuns:
    """What the trial of a chain needs of every run: its stored response, its state, derivatives by the `free` unknowns without whitening.

    `priors` are the weights of these unknowns. What stands for an unknown low-pass is not free: another chain is tried in its place.
    """

    misfit: Misfit
    x: Array
    responses: tuple[FineResponse, ...]
    states: tuple[RunState, ...]
    slopes: tuple[Complex, ...]
    free: NDArray[np.bool_]
    priors: Array

    @classmethod
    def of(cls, misfit: Misfit, x: Array) -> StoredRuns:
        """Return what the trials of chains share at the unknowns `x shape (n_unknowns,)`; parameters have weak priors about it."""
        n, shared = misfit.n_parameters, len(misfit.shared)
        of_errors = np.array([item.name not in LOW_PASS for item in misfit.conditions(x)], dtype=bool)
        free = np.concatenate([np.ones(n + shared, dtype=bool), of_errors])
        x = misfit.without(x, LOW_PASS)  # what stood for other chains than the one that the fit was made through
        weights = np.concatenate([np.full(n, 1 / WEAK_PRIOR_SIGMA), np.zeros(shared), np.ones(misfit.n_unknowns - n - shared)])
        spectra = linearise(misfit, x).spectra
        slopes = []
        for t, (trial, white) in enumerate(zip(misfit.problem.trials, spectra, strict=True)):
            inverse = np.linalg.inv(_whitener(misfit, t))
            assumed = trial.channel_factors(misfit.frequency(t))
            gain = np.where(np.abs(assumed) > LEAST_GAIN, assumed, 1.0)
            slopes.append(np.asarray((inverse @ white[free][..., None])[..., 0] / gain))
        numbers = range(len(misfit.problem.trials))
        values, responses = misfit.problem.space.values(misfit.split(x)[0])[None], tuple(fine_response(misfit, x, t) for t in numbers)
        states = tuple(misfit.state(t, values, misfit.errors_of(x, t), misfit.scenario(x, t)) for t in numbers)
        return cls(misfit, x, responses, states, tuple(slopes), free, weights[free])

    @property
    def size(self) -> int:
        """Number of whitened residuals."""
        return sum(2 * int(self.compared(t).sum()) * item.shape[2] for t, item in enumerate(self.slopes))

    def compared(self, number: int) -> NDArray[np.bool_]:
        """Return which spectral lines of a trial tell of its chains: not those of an engine, which no chain explains."""
        return self.misfit.problem.trials[number].beside_lines(self.misfit.frequency(number))

    def stated(self, number: int) -> list[AcquisitionChain]:
        """Return the chain of each channel of a trial as its run declares it."""
        trial = self.misfit.problem.trials[number]
        return [trial.scenario.chain(name).assumed(1 / trial.recording.dt) for name in trial.channels]

    def residual(self, number: int, chains: Sequence[AcquisitionChain]) -> Complex:
        """Return the whitened residual of a trial through chains, one a channel, `shape (n_compared, n_channels)`."""
        misfit, trial = self.misfit, self.misfit.problem.trials[number]
        response = adjust(misfit.shared, trial, self.responses[number].acquired(chains)[None], misfit.adjusted(self.x), self.states[number])
        left = misfit.measured(number) - misfit.channel_lines(number, response[0], misfit.errors_of(self.x, number))
        return misfit.whiten(number, left)[self.compared(number)]

    def whitened_slopes(self, number: int, factors: Complex) -> Complex:
        """Return a trial's derivatives by the unknowns, whitened, `shape (n_free, n_compared, n_channels)`.

        `factors` are what chains make of the channels' lines, `shape (n_lines, n_channels)`.
        """
        return np.ascontiguousarray(self.misfit.whiten(number, self.slopes[number] * factors)[:, self.compared(number)])


class ChainTrials:
    """Chains tried for some channels, while those of others stay.

    Parameters
    ----------
    runs
        What they are tried on.
    channels
        The channels that share the chain that is tried.
    beside
        Chains of other channels, by name; those of channels left out are as runs declare them.
    """

    def __init__(self, runs: StoredRuns, channels: Sequence[str], beside: Mapping[str, AcquisitionChain]) -> None:
        self._runs, self._channels, self._beside = runs, set(channels), beside
        errors = runs.misfit.split(runs.x)[1]
        supposed = np.concatenate([np.zeros(len(runs.x) - len(errors)), errors])  # errors are held about none, not about the fit's
        self._supposed = supposed[runs.free]
        self._parts = [self._split(t) for t in range(len(runs.slopes))]

    def fit(self, chain: AcquisitionChain) -> ChainFit:
        """Return the loss of a chain, its group delay taken off."""
        chain = replace(chain, delay=chain.delay - group_delay(chain))
        return ChainFit(chain, self.loss(chain))

    def loss(self, chain: AcquisitionChain | None = None) -> float:
        """Return the sum of squares that a chain leaves; without one, that of the chains that stay, where no channel shares one."""
        runs, priors = self._runs, self._runs.priors
        square, normal, pull = float(self._supposed @ self._supposed), np.diag(priors**2), priors * self._supposed
        for t, (fixed, turning) in enumerate(self._parts):
            left = runs.residual(t, self._chains(t, chain)).view(np.float64).ravel()
            frequency, slopes = runs.misfit.frequency(t)[runs.compared(t)], fixed
            for stated, part in turning.items():
                assert chain is not None
                slopes = slopes + part * _as_late(chain, stated).response(frequency)[:, None]
            rows = slopes.view(np.float64).reshape(len(slopes), -1)
            square, normal, pull = square + 2 * float(left @ left), normal + 2 * (rows @ rows.T), pull + 2 * (rows @ left)
        return _least(square, normal, pull)

    def _chains(self, number: int, chain: AcquisitionChain | None) -> list[AcquisitionChain]:
        """Return the chain of each channel of a trial."""
        known = dict(self._beside) if chain is None else {**self._beside, **dict.fromkeys(self._channels, chain)}
        pairs = zip(self._runs.misfit.problem.trials[number].channels, self._runs.stated(number), strict=True)
        return [_as_late(known[name], own) if name in known else own for name, own in pairs]

    def _split(self, number: int) -> tuple[Complex, dict[AcquisitionChain, Complex]]:
        """Return a trial's whitened derivatives through the channels whose chains stay, and through those that share the one tried.

        The latter before that chain, which turns each line of theirs alike, by the chain that the run declares of them.
        """
        runs, frequency = self._runs, self._runs.misfit.frequency(number)
        shared = np.array([name in self._channels for name in runs.misfit.problem.trials[number].channels], dtype=bool)
        staying = np.column_stack([chain.response(frequency) for chain in self._chains(number, None)]) * ~shared
        stated = runs.stated(number)
        groups = {own: shared & np.array([own == item for item in stated]) for own in dict.fromkeys(stated)}
        turning = {own: columns for own, columns in groups.items() if columns.any()}
        lines = np.ones_like(staying)
        return runs.whitened_slopes(number, staying), {own: runs.whitened_slopes(number, lines * of) for own, of in turning.items()}


def _least(square: float, normal: Array, pull: Array) -> float:
    """Return the least of y N y + 2 p y + square over y, in scaled unknowns."""
    scale = 1 / np.sqrt(np.maximum(np.diag(normal), 1e-300))
    values, vectors = np.linalg.eigh(normal * scale[:, None] * scale)
    kept = values > UNSEEN * values[-1]
    return float(square - ((vectors.T @ (pull * scale))[kept] ** 2 / values[kept]).sum())


def _whitener(misfit: Misfit, number: int) -> Complex:
    """Return the matrices that whiten a trial's lines, `shape (n_lines, n_channels, n_channels)`."""
    n, width = len(misfit.frequency(number)), len(misfit.problem.trials[number].channels)
    unit = np.broadcast_to(np.eye(width, dtype=np.complex128)[:, None], (width, n, width))
    return np.asarray(misfit.whiten(number, unit).transpose(1, 2, 0))


def group_delay(chain: AcquisitionChain) -> float:
    """Return how late a chain's low-pass is at low frequency [s], its own delay left out."""
    if chain.cut_off is None:
        return 0.0
    low = np.array([0.01 * chain.cut_off])
    return float(-np.angle(replace(chain, delay=0.0).response(low))[0] / (2 * np.pi * low[0]))


def _as_late(chain: AcquisitionChain, other: AcquisitionChain) -> AcquisitionChain:
    """Return a chain that is late by nothing at low frequency, made as late there as another one."""
    return replace(chain, delay=chain.delay + other.delay + group_delay(other))
