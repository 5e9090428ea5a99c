"""Which low-pass was a recording made through? Chains tried on one stored response of a fitted model.

Every chain filters the finely sampled response of the base fit; what the fit's parameters and nuisances, held by their priors, can do about
the whitened residual is projected out, and the sums of squares that are left are compared. A chain's group delay at low frequency is taken
off it: the base fit's clock has found it already, and a delay of a clock says nothing about a filter. What stands in a chain's place that a
run file declares is late by its own, for which the clock has not to make up.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy
from numpy.typing import NDArray

from vehgen.fit.adjustments import RunState, adjust
from vehgen.fit.fine_response import FineResponse, fine_response
from vehgen.fit.least_squares import WEAK_PRIOR_SIGMA
from vehgen.fit.linearisation import linearise
from vehgen.fit.misfit import Misfit
from vehgen.fit.nuisances import LOW_PASS
from vehgen.fit.parallel import one_blas_thread
from vehgen.fit.trial import Trial
from vehgen.fit.window import flatten
from vehgen.measure.acquisition import POINT_SAMPLES, UNKNOWN, AcquisitionChain, FilterKind

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
CLEAR_LOSS = 10.0
"""A chain is clear where nothing that differs from it comes within this of its sum of squares, chi2 = 1."""
LOW_PASSES: tuple[tuple[FilterKind, int], ...] = tuple((kind, order) for kind in ("butterworth", "bessel") for order in (2, 4, 8))
"""Kinds and orders tried."""
ROUGH_LOW_PASSES: tuple[tuple[FilterKind, int], ...] = (("bessel", 2), ("butterworth", 4))
"""A soft and a steep one, where chains are roughly sought."""
CUT_OFF_SHARES = np.geomspace(0.15, 0.5, 7)
"""Cut-offs first tried, over the recording's rate."""
LOWEST_SHARE = 0.03
"""Where the lowest of them is best, lower ones are tried, down to this."""
REFINED_SHARE = 0.01
"""A cut-off is refined to this share of itself."""
SAME_GAIN = 0.05
"""Chains whose gains differ by less throughout the band are the same."""
UNSEEN = 1e-12
"""A direction of the unknowns whose scaled curvature is below this share of the largest is left alone."""
ROUGHLY_BETTER, FAR_BETTER = 30.0, 100.0
"""Sensors have low-passes of their own where one of them, roughly sought, lets the sum of squares fall by the first of these, and all of
them together by the second. What takes less off is no effect either (an effect is told from a fall of 150)."""
FAR_BETTER_LEFT = 0.5
"""They leave at most this share of what the mean square is above that of noise: a missing effect, too, passes in part for a low-pass."""
APART_SWEEPS = 2
"""So often each of them is sought, the others being as found before."""


@dataclass(frozen=True)
class ChainFit:
    """A chain, and the sum of squares of the whitened residuals that it leaves."""

    chain: AcquisitionChain
    loss: float


@dataclass(frozen=True)
class ChainEstimate:
    """The chain that fits best, and how well others do.

    Attributes
    ----------
    best
        Of all kinds tried, without its group delay at low frequency.
    others
        The best of every other kind and order, by their loss.
    scale
        The mean square that the best leaves, or 1 where it is less: differences of losses count in its unit.
    is_clear
        Whether no chain that differs from it does as well.
    """

    best: ChainFit
    others: tuple[ChainFit, ...]
    scale: float
    is_clear: bool


def estimate_chain(misfit: Misfit, x: Array, *, channels: Sequence[str] | None = None) -> ChainEstimate:
    """Return the chain that explains the recordings best.

    Parameters
    ----------
    misfit, x
        The base fit, its recorders' unknown low-passes assumed ideal.
    channels
        Those that share the chain that is sought (default: those with an unknown one; where there is none, all).
    """
    trials = misfit.problem.trials
    every = dict.fromkeys(name for trial in trials for name in trial.channels)
    unknown = [name for name in every if any(name in trial.channels and not trial.scenario.chain(name).is_known for trial in trials)]
    return ChainSearch.of(misfit, x).estimate(tuple(channels or unknown or every))


def slowest_rate(trials: Sequence[Trial]) -> float:
    """Return the lowest rate at which any of the recordings was sampled [Hz]."""
    return min(1 / trial.recording.dt for trial in trials)


@dataclass(frozen=True)
class ChainSearch:
    """What the trial of a chain needs of every run: its stored response, its state, derivatives by the `free` unknowns without whitening.

    `priors` are those of these unknowns. What stands for an unknown low-pass is not free: another chain is tried in its place.
    """

    misfit: Misfit
    x: Array
    responses: tuple[FineResponse, ...]
    states: tuple[RunState, ...]
    slopes: tuple[Complex, ...]
    free: NDArray[np.bool_]
    priors: Array

    @classmethod
    def of(cls, misfit: Misfit, x: Array) -> ChainSearch:
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
            gain = np.where(np.abs(assumed) > SAME_GAIN, assumed, 1.0)
            slopes.append(np.asarray((inverse @ white[free][..., None])[..., 0] / gain))
        numbers = range(len(misfit.problem.trials))
        values, responses = misfit.problem.space.values(misfit.split(x)[0])[None], tuple(fine_response(misfit, x, t) for t in numbers)
        states = tuple(misfit.state(t, values, misfit.errors_of(x, t), misfit.scenario(x, t)) for t in numbers)
        return cls(misfit, x, responses, states, tuple(slopes), free, np.diag(weights[free]))

    @property
    def size(self) -> int:
        """Number of whitened residuals."""
        return sum(2 * int(self._compared(t).sum()) * item.shape[2] for t, item in enumerate(self.slopes))

    @property
    def rate(self) -> float:
        """The lowest rate of the recordings [Hz]."""
        return slowest_rate(self.misfit.problem.trials)

    def estimate(self, channels: Sequence[str], beside: Mapping[str, AcquisitionChain] | None = None) -> ChainEstimate:
        """Return the chain that channels share, those of other channels being as runs declare them, or by channel as in `beside`."""
        beside = beside or {}
        with one_blas_thread():  # tall and thin matrices: more threads only wait for one another
            families = [self.fit(chain, channels, beside) for chain in (POINT_SAMPLES, UNKNOWN.assumed(self.rate))]
            families += [self._best_cut_off(kind, order, channels, beside) for kind, order in LOW_PASSES]
        best, *others = sorted(families, key=lambda item: item.loss)
        scale = max(1.0, best.loss / self.size)
        rivals = (item for item in others if item.loss - best.loss < CLEAR_LOSS * scale)
        clear = all(_alike(item.chain, best.chain, self.misfit.band) for item in rivals)
        return ChainEstimate(best, tuple(others), scale, clear)

    def estimate_apart(self, parts: Sequence[tuple[str, ...]], shared: ChainFit) -> list[ChainEstimate]:
        """Return a chain for each of several sets of channels where these do far better than the one `shared` by all; nothing else."""
        known = {name: shared.chain for part in parts for name in part}
        noticed = shared.loss - ROUGHLY_BETTER * max(1.0, shared.loss / self.size)
        if len(parts) < 2 or not any(self.rough_loss(part, known) <= noticed for part in parts):
            return []
        found: list[ChainEstimate] = []
        for _ in range(APART_SWEEPS):
            found.clear()
            for part in parts:
                found.append(self.estimate(part, known))
                known |= dict.fromkeys(part, found[-1].best.chain)
        return found if self.is_far_better(found[-1].best.loss, shared.loss) else []

    def is_far_better(self, loss: float, than: float) -> bool:
        """Return whether chains that leave a loss explain so much more than others that these cannot be the right ones."""
        left, before = (max(item / self.size - 1, 0.0) for item in (loss, than))
        return than - loss >= FAR_BETTER * max(1.0, loss / self.size) and left <= FAR_BETTER_LEFT * before

    def rough_loss(self, channels: Sequence[str], beside: Mapping[str, AcquisitionChain]) -> float:
        """Return what a chain of some channels leaves, roughly sought, the others as in :meth:`estimate`."""
        edges = [float(share) * self.rate for share in CUT_OFF_SHARES[::2]]
        chains = [POINT_SAMPLES, *(AcquisitionChain(kind, order, edge) for kind, order in ROUGH_LOW_PASSES for edge in edges)]
        return min(self.fit(chain, channels, beside).loss for chain in chains)

    def fit(self, chain: AcquisitionChain, channels: Sequence[str], beside: Mapping[str, AcquisitionChain]) -> ChainFit:
        """Return the loss of a chain of some channels, its group delay taken off."""
        chain = replace(chain, delay=chain.delay - group_delay(chain))
        return ChainFit(chain, self.loss({**beside, **dict.fromkeys(channels, chain)}))

    def loss(self, known: Mapping[str, AcquisitionChain]) -> float:
        """Return the sum of squares that chains leave, by channel; those of other channels are as runs declare them."""
        misfit, residuals, slopes = self.misfit, [], []
        for t, trial in enumerate(misfit.problem.trials):
            stated = [trial.scenario.chain(name).assumed(1 / trial.recording.dt) for name in trial.channels]
            chains = [_as_late(known[name], own) if name in known else own for name, own in zip(trial.channels, stated, strict=True)]
            response = adjust(misfit.shared, trial, self.responses[t].acquired(chains)[None], misfit.adjusted(self.x), self.states[t])
            frequency = misfit.frequency(t)
            factors = np.column_stack([item.response(frequency) for item in chains])
            left = misfit.measured(t) - misfit.channel_lines(t, response[0], misfit.errors_of(self.x, t))
            left, factors = left * self._compared(t)[:, None], factors * self._compared(t)[:, None]
            residuals.append(flatten(misfit.whiten(t, left)))
            slopes.append(flatten(misfit.whiten(t, self.slopes[t] * factors), first=1).T)
        errors = misfit.split(self.x)[1]
        supposed = np.concatenate([np.zeros(len(self.x) - len(errors)), errors])  # errors are held about none, not about the fit's
        return _projected(np.concatenate([*residuals, supposed[self.free]]), np.vstack([*slopes, self.priors]))

    def _compared(self, number: int) -> NDArray[np.bool_]:
        """Return which spectral lines of a trial tell of its chains: not those of an engine, which no chain explains."""
        return self.misfit.problem.trials[number].beside_lines(self.misfit.frequency(number))

    def _best_cut_off(self, kind: FilterKind, order: int, channels: Sequence[str], beside: Mapping[str, AcquisitionChain]) -> ChainFit:
        """Return the best cut-off of a kind of low-pass."""
        tried: dict[float, ChainFit] = {}

        def loss(log_share: float) -> float:
            chain = AcquisitionChain(kind, order, float(np.exp(log_share)) * self.rate)
            tried[log_share] = self.fit(chain, channels, beside)
            return tried[log_share].loss

        grid = np.log(CUT_OFF_SHARES).tolist()
        losses = [loss(item) for item in grid]
        while losses[0] == min(losses) and grid[0] > np.log(LOWEST_SHARE):
            grid.insert(0, 2 * grid[0] - grid[1])
            losses.insert(0, loss(grid[0]))
        i = int(np.argmin(losses))
        ends = grid[max(i - 1, 0)], grid[min(i + 1, len(grid) - 1)]
        scipy.optimize.minimize_scalar(loss, bounds=ends, method="bounded", options={"xatol": REFINED_SHARE, "maxiter": 8})
        return min(tried.values(), key=lambda item: item.loss)


def _projected(residual: Array, slopes: Array) -> float:
    """Return the least |residual + slopes y|^2 over y, by the normal equations in scaled unknowns."""
    normal, pull = slopes.T @ slopes, slopes.T @ residual
    scale = 1 / np.sqrt(np.maximum(np.diag(normal), 1e-300))
    values, vectors = np.linalg.eigh(normal * scale[:, None] * scale)
    kept = values > UNSEEN * values[-1]
    return float(residual @ residual - ((vectors.T @ (pull * scale))[kept] ** 2 / values[kept]).sum())


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


def _alike(one: AcquisitionChain, other: AcquisitionChain, band: tuple[float, float]) -> bool:
    """Whether two chains make the same of what lies within the band, and of what lies above it."""
    frequency = np.linspace(*band, 50)
    same = np.abs(np.abs(one.response(frequency)) - np.abs(other.response(frequency))).max() < SAME_GAIN
    return bool(same) and (one.filter == "none") == (other.filter == "none")
