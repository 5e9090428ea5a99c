"""Unknown recorders made known: the low-pass that suits a fit best stands in every run, or the band ends where folding would spoil it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from vehgen.fit.chain_estimate import ChainEstimate, estimate_chain, group_delay
from vehgen.fit.fine_response import fine_response, trusted_band
from vehgen.fit.misfit import Array, Misfit
from vehgen.fit.trial import Trial
from vehgen.measure.acquisition import UNKNOWN, AcquisitionChain

MOST_LEFT = 2.0
"""A fit that leaves a larger mean square lacks something that passes for a low-pass: an ideal one is then taken, until more is known."""
USUAL_SHARE, UNUSUAL_SHARE = 0.43, 0.35
"""Recorders usually cut off at the one share of their rate, and seldom below the other."""
SAME_CUT_OFF = 0.1
"""Cut-offs that differ by less than this share are the same."""

CLEAR_RECORDER = 30.0
"""One found by its low-pass stands where it leaves a sum of squares smaller by this than those that are usual."""


@dataclass(frozen=True)
class FoundRecorder:
    """What stands for the recorders of `channels`, which no run file declares: the best `estimate`.

    The compared `band` [Hz] is `cut` where several chains would do and folding might matter.
    """

    estimate: ChainEstimate
    band: tuple[float, float]
    cut: bool
    channels: tuple[str, ...]

    @property
    def chain(self) -> AcquisitionChain:
        """The chain that stands for unknown ones."""
        return self.estimate.best.chain

    def is_usual(self, rate: float) -> bool:
        """Return whether it cuts off where recorders of a rate [Hz] do, or not at all."""
        return self.chain.cut_off is None or self.chain.filter == "ideal" or self.chain.cut_off >= UNUSUAL_SHARE * rate

    def with_usual(self, rate: float) -> list[FoundRecorder]:
        """Return it, a like one that cuts off where recorders of such a rate [Hz] usually do, and an ideal one: what refits compare.

        How a chain is found supposes that all else answers in proportion. Where it does not, a low-pass that is too low, with a hump of
        other form, or a profile of other height, stands where the recorder takes off nothing.
        """
        ideal = min(
            (item for item in (self.estimate.best, *self.estimate.others) if item.chain.filter == "ideal"), key=lambda item: item.loss
        )
        chains = [self.chain, ideal.chain]
        if not self.is_usual(rate):
            usual = replace(self.chain, cut_off=USUAL_SHARE * rate, delay=0.0)
            chains.insert(1, replace(usual, delay=-group_delay(usual)))
        others = [
            replace(self, estimate=replace(self.estimate, best=replace(self.estimate.best, chain=chain), is_clear=False))
            for chain in chains[1:]
        ]
        return [self, *(item for item in others if item.chain != self.chain)]

    def nearly_as_good(self) -> list[FoundRecorder]:
        """Return the chains that do nearly as well, the best first."""
        known = self.estimate
        near = [item for item in known.others if item.loss - known.best.loss < CLEAR_RECORDER * known.scale]
        return [replace(self, estimate=replace(known, best=item, is_clear=False)) for item in near]

    def describe(self) -> str:
        """Return it in words."""
        chain = self.chain
        kind = {"none": "no low-pass at all", "ideal": "an ideal low-pass"}.get(chain.filter)
        if kind is None:
            kind = f"a {chain.filter} low-pass of order {chain.order} at {chain.cut_off:.3g} Hz"
        text = f"the recorder's low-pass is not stated; the recordings look as if made through {kind}"
        if not self.estimate.is_clear:
            text += ", but others would do as well"
        if self.cut:
            text += f"; above {self.band[1]:.3g} Hz nothing is compared, as it may have been folded there: state `acquisition`"
        return text

    def applied(self, trials: Sequence[Trial]) -> list[Trial]:
        """Return trials whose unknown recorders are this one."""
        found = []
        for trial in trials:
            chains = {name: self.chain if name in self.channels else trial.scenario.chain(name) for name in trial.channels}
            found.append(replace(trial, scenario=replace(trial.scenario, chains=chains)))
        return found

    def forgotten(self, trials: Sequence[Trial]) -> list[Trial]:
        """Return trials on which this one stands with recorders that are unknown again."""
        found = []
        for trial in trials:
            chains = {name: UNKNOWN if name in self.channels else trial.scenario.chain(name) for name in trial.channels}
            found.append(replace(trial, scenario=replace(trial.scenario, chains=chains)))
        return found

    def is_like(self, other: FoundRecorder) -> bool:
        """Return whether another one is of the same kind and cuts off at the same frequency."""
        one, two = self.chain, other.chain
        same = (one.filter, one.order, self.cut) == (two.filter, two.order, other.cut)
        return same and abs((one.cut_off or 0.0) - (two.cut_off or 0.0)) <= SAME_CUT_OFF * (two.cut_off or 1.0)


def clearest(recorders: Sequence[FoundRecorder], squares: Sequence[float]) -> int:
    """Return which of recorders from :meth:`FoundRecorder.with_usual` stands, by the sums of squares that refits through them leave."""
    less = [0.0, *[CLEAR_RECORDER] * (len(recorders) - 1)]
    return int(np.argmin(np.subtract(squares, less)))


def has_unknown(trials: Sequence[Trial]) -> bool:
    """Return whether the recorder of any channel is not known."""
    return any(not trial.scenario.chain(name).is_known for trial in trials for name in trial.channels)


def find_recorder(
    misfit: Misfit, x: Array, channels: Sequence[str] | None = None, band: tuple[float, float] | None = None
) -> FoundRecorder:
    """Return what stands for the unknown recorders of a fit's runs.

    Where several chains would do, the band ends at the frequency up to which folding matters in no run.

    Parameters
    ----------
    misfit, x
        A fit.
    channels
        Those whose recorder is not known (default: as the runs have it).
    band
        The band to be compared [Hz] (default: the fit's).
    """
    trials, asked = misfit.problem.trials, band or misfit.band
    unknown = [name for trial in trials for name in trial.channels if not trial.scenario.chain(name).is_known]
    channels = tuple(channels or dict.fromkeys(unknown))
    estimate = estimate_chain(misfit, x, channels=channels)
    if estimate.is_clear and estimate.scale <= MOST_LEFT:
        return FoundRecorder(estimate, asked, False, channels)
    if estimate.scale > MOST_LEFT:
        ideal = next(item for item in (estimate.best, *estimate.others) if item.chain.filter == "ideal")
        rest = tuple(item for item in (estimate.best, *estimate.others) if item is not ideal)
        estimate = replace(estimate, best=ideal, others=rest, is_clear=False)
    tops = [trusted_band(trial, fine_response(misfit, x, t), misfit.noises[trial.name]) for t, trial in enumerate(trials)]
    top = max(min([*tops, asked[1]]), asked[1] / 2)
    return FoundRecorder(estimate, (asked[0], top), top < asked[1], channels)
