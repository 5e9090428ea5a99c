"""Unknown recorders made known: the low-pass that suits a fit best stands in every run, or the band ends where folding would spoil it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from vehgen.fit.chain_estimate import ChainEstimate, estimate_chain, fine_response, trusted_band
from vehgen.fit.misfit import Array, Misfit
from vehgen.fit.trial import Trial
from vehgen.measure.acquisition import AcquisitionChain


@dataclass(frozen=True)
class FoundRecorder:
    """What stands for the recorders that are not known: the best `estimate`, and where the compared `band` [Hz] ends for that."""

    estimate: ChainEstimate
    band: tuple[float, float]
    cut: bool

    @property
    def chain(self) -> AcquisitionChain:
        """The chain that stands for unknown ones."""
        return self.estimate.best.chain

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
        return [with_chain(trial, self.chain) for trial in trials]


def has_unknown(trials: Sequence[Trial]) -> bool:
    """Return whether the recorder of any channel is not known."""
    return any(not trial.scenario.chain(name).is_known for trial in trials for name in trial.channels)


def with_chain(trial: Trial, chain: AcquisitionChain) -> Trial:
    """Return a trial with a chain in place of those that are not known, its delays kept."""
    known = {name: trial.scenario.chain(name) for name in trial.channels}
    chains = {name: own if own.is_known else replace(chain, delay=chain.delay + own.delay) for name, own in known.items()}
    return replace(trial, scenario=replace(trial.scenario, chains=chains))


def find_recorder(misfit: Misfit, x: Array) -> FoundRecorder:
    """Return what stands for the unknown recorders of a fit's runs.

    Where several chains would do, the band ends at the frequency up to which folding matters in no run.
    """
    estimate = estimate_chain(misfit, x)
    if estimate.is_clear:
        return FoundRecorder(estimate, misfit.band, False)
    trials = misfit.problem.trials
    tops = [trusted_band(trial, fine_response(misfit, x, t), misfit.noises[trial.name]) for t, trial in enumerate(trials)]
    top = max(min([*tops, misfit.band[1]]), misfit.band[1] / 2)
    return FoundRecorder(estimate, (misfit.band[0], top), top < misfit.band[1])
