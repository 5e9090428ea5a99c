"""Which low-pass was a recording made through? Chains tried on one stored response of a fitted model, and the least sum of squares.

What each of them leaves is in :mod:`vehgen.fit.chain_losses`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

from vehgen.fit.chain_losses import ChainFit, ChainTrials, StoredRuns
from vehgen.fit.misfit import Misfit
from vehgen.fit.parallel import one_blas_thread
from vehgen.fit.trial import Trial
from vehgen.measure.acquisition import POINT_SAMPLES, UNKNOWN, AcquisitionChain, FilterKind

Array = NDArray[np.float64]
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
REFINED_SHARE, MOST_REFINED = 0.01, 6
"""A cut-off is refined to this share of itself, in so many steps at most."""
SURELY_WORSE = 100.0
"""It is not refined where it would still leave so much more than the best chain that was tried before, chi2 = 1."""
SAME_GAIN = 0.05
"""Chains whose gains differ by less throughout the band are the same."""
ROUGHLY_BETTER, FAR_BETTER = 30.0, 100.0
"""Sensors have low-passes of their own where one of them, roughly sought, lets the sum of squares fall by the first of these, and all of
them together by the second. What takes less off is no effect either (an effect is told from a fall of 150)."""
FAR_BETTER_LEFT = 0.5
"""They leave at most this share of what the mean square is above that of noise: a missing effect, too, passes in part for a low-pass."""
APART_SWEEPS, HALFWAY = 2, 0.5
"""So often each of them is sought, the others being as found before; not again where the first time led not so far of what is asked."""


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
    """Looks for the chains through which the runs of a fit were recorded."""

    runs: StoredRuns

    @classmethod
    def of(cls, misfit: Misfit, x: Array) -> ChainSearch:
        """Return the search for chains at the unknowns `x shape (n_unknowns,)` of a fit."""
        return cls(StoredRuns.of(misfit, x))

    @property
    def rate(self) -> float:
        """The lowest rate of the recordings [Hz]."""
        return slowest_rate(self.runs.misfit.problem.trials)

    def estimate(self, channels: Sequence[str], beside: Mapping[str, AcquisitionChain] | None = None) -> ChainEstimate:
        """Return the chain that channels share, those of other channels being as runs declare them, or by channel as in `beside`."""
        with one_blas_thread():  # small matrices: more threads only wait for one another
            trials = ChainTrials(self.runs, channels, beside or {})
            families = [[trials.fit(chain)] for chain in (POINT_SAMPLES, UNKNOWN.assumed(self.rate))]
            families += sorted((self._on_grid(trials, *known) for known in LOW_PASSES), key=_least_loss)
            for family in families[2:]:
                self._refine(trials, family, min(map(_least_loss, families)))
        best, *others = sorted((min(family, key=lambda item: item.loss) for family in families), key=lambda item: item.loss)
        scale = self._scale(best.loss)
        rivals = (item for item in others if item.loss - best.loss < CLEAR_LOSS * scale)
        clear = all(_alike(item.chain, best.chain, self.runs.misfit.band) for item in rivals)
        return ChainEstimate(best, tuple(others), scale, clear)

    def _scale(self, loss: float) -> float:
        """Return the mean square of a loss, or 1 where it is less."""
        return max(1.0, loss / self.runs.size)

    def estimate_apart(self, parts: Sequence[tuple[str, ...]], shared: ChainFit) -> list[ChainEstimate]:
        """Return a chain for each of several sets of channels where these do far better than the one `shared` by all; nothing else."""
        known = {name: shared.chain for part in parts for name in part}
        noticed = shared.loss - ROUGHLY_BETTER * self._scale(shared.loss)
        if len(parts) < 2 or not any(self.rough_loss(part, known) <= noticed for part in parts):
            return []
        found: list[ChainEstimate] = []
        for sweep in range(APART_SWEEPS):
            if sweep and not self.is_far_better(found[-1].best.loss, shared.loss, HALFWAY):
                return []
            found.clear()
            for part in parts:
                found.append(self.estimate(part, known))
                known |= dict.fromkeys(part, found[-1].best.chain)
        return found if self.is_far_better(found[-1].best.loss, shared.loss) else []

    def is_far_better(self, loss: float, than: float, way: float = 1.0) -> bool:
        """Return whether chains that leave a loss explain so much more than others that these cannot be the right ones.

        With a `way` below 1, whether they do this share of what is asked.
        """
        left, before = (max(item / self.runs.size - 1, 0.0) for item in (loss, than))
        return than - loss >= way * FAR_BETTER * self._scale(loss) and left <= (1 - way * (1 - FAR_BETTER_LEFT)) * before

    def rough_loss(self, channels: Sequence[str], beside: Mapping[str, AcquisitionChain]) -> float:
        """Return what a chain of some channels leaves, roughly sought, the others as in :meth:`estimate`."""
        edges = [float(share) * self.rate for share in CUT_OFF_SHARES[::2]]
        chains = [POINT_SAMPLES, *(AcquisitionChain(kind, order, edge) for kind, order in ROUGH_LOW_PASSES for edge in edges)]
        trials = ChainTrials(self.runs, channels, beside)
        return min(trials.fit(chain).loss for chain in chains)

    def stated_loss(self) -> float:
        """Return what is left through the chains that the runs declare."""
        return ChainTrials(self.runs, (), {}).loss()

    def fit(self, chain: AcquisitionChain, channels: Sequence[str]) -> ChainFit:
        """Return the loss of a chain of some channels, those of others being as runs declare them."""
        return ChainTrials(self.runs, channels, {}).fit(chain)

    def _on_grid(self, trials: ChainTrials, kind: FilterKind, order: int) -> list[ChainFit]:
        """Return low-passes of a kind whose cut-offs lie a step from one another, until the lowest one is not the best."""
        step = CUT_OFF_SHARES[1] / CUT_OFF_SHARES[0]
        tried = [trials.fit(AcquisitionChain(kind, order, float(share) * self.rate)) for share in CUT_OFF_SHARES]
        while tried[0].loss == _least_loss(tried) and (tried[0].chain.cut_off or 0.0) > LOWEST_SHARE * self.rate:
            tried.insert(0, trials.fit(AcquisitionChain(kind, order, (tried[0].chain.cut_off or 0.0) / step)))
        return tried

    def _refine(self, trials: ChainTrials, tried: list[ChainFit], best: float) -> None:
        """Try cut-offs where a curve through the losses of those tried is lowest; not where that is surely far above the `best` loss."""
        kind, order = tried[0].chain.filter, tried[0].chain.order
        for _ in range(MOST_REFINED):
            tried.sort(key=lambda item: item.chain.cut_off or 0.0)
            places, losses = np.log([item.chain.cut_off or 0.0 for item in tried]), np.array([item.loss for item in tried])
            lowest, loss = _lowest(places, losses)
            far = 2 * loss - float(losses.min()) > best + SURELY_WORSE * self._scale(best)
            if far or float(np.abs(places - lowest).min()) < REFINED_SHARE:
                return
            tried.append(trials.fit(AcquisitionChain(kind, order, float(np.exp(lowest)))))


def _least_loss(tried: Sequence[ChainFit]) -> float:
    return min(item.loss for item in tried)


def _lowest(places: Array, losses: Array) -> tuple[float, float]:
    """Return where a curve through losses is lowest beside the least of them, and how low it is there."""
    i = int(np.argmin(losses))
    curve = scipy.interpolate.CubicSpline(places, losses)
    turns = curve.derivative().roots(extrapolate=False)
    beside = turns[(turns > places[max(i - 1, 0)]) & (turns < places[min(i + 1, len(places) - 1)])]
    lowest = min([float(places[i]), *beside.tolist()], key=lambda place: float(curve(place)))
    return lowest, float(curve(lowest))


def _alike(one: AcquisitionChain, other: AcquisitionChain, band: tuple[float, float]) -> bool:
    """Whether two chains make the same of what lies within the band, and of what lies above it."""
    frequency = np.linspace(*band, 50)
    same = np.abs(np.abs(one.response(frequency)) - np.abs(other.response(frequency))).max() < SAME_GAIN
    return bool(same) and (one.filter == "none") == (other.filter == "none")
