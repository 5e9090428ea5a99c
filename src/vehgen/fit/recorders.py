"""Unknown recorders made known: the low-pass that suits a fit best stands in every run, or the band ends where folding would spoil it.

One stands for all sensors, or each has its own where that explains far more.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from vehgen.fit.chain_estimate import ChainEstimate, ChainSearch
from vehgen.fit.chain_losses import group_delay
from vehgen.fit.fine_response import fine_response, trusted_band
from vehgen.fit.misfit import Array, Misfit
from vehgen.fit.trial import LINE_WIDTH, Trial
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

    The compared `band` [Hz] is `cut` where several chains would do and folding might matter. `apart` are sets of channels, each a sensor's,
    with estimates of their own in place of the one for all.
    """

    estimate: ChainEstimate
    band: tuple[float, float]
    cut: bool
    channels: tuple[str, ...]
    apart: tuple[tuple[tuple[str, ...], ChainEstimate], ...] = ()

    @property
    def chain(self) -> AcquisitionChain:
        """The chain that stands for unknown ones, where one stands for all."""
        return self.estimate.best.chain

    @property
    def parts(self) -> tuple[tuple[tuple[str, ...], ChainEstimate], ...]:
        """Channels that share a chain, with its estimate: all of them, or each sensor's."""
        return self.apart or ((self.channels, self.estimate),)

    @property
    def chains(self) -> dict[str, AcquisitionChain]:
        """The chains that stand for unknown ones, by channel."""
        return {name: known.best.chain for part, known in self.parts for name in part}

    def is_usual(self, rate: float) -> bool:
        """Return whether it cuts off where recorders of a rate [Hz] do, or not at all."""
        edges = [chain.cut_off for chain in self.chains.values() if chain.filter != "ideal"]
        return all(edge is None or edge >= UNUSUAL_SHARE * rate for edge in edges)

    def with_usual(self, rate: float) -> list[FoundRecorder]:
        """Return it, one for all, a like one that cuts off where recorders of such a rate [Hz] usually do, and an ideal one, to compare.

        How a chain is found supposes that all else answers in proportion. Where it does not, a low-pass that is too low, with a hump of
        other form, or a profile of other height, stands where the recorder takes off nothing.
        """
        if self.apart:
            return [self, *replace(self, apart=()).with_usual(rate)]
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
        """Return the chains for all that do nearly as well as the best one, the best first."""
        known = self.estimate
        near = [item for item in known.others if item.loss - known.best.loss < CLEAR_RECORDER * known.scale]
        return [replace(self, estimate=replace(known, best=item, is_clear=False), apart=()) for item in near]

    def describe(self) -> str:
        """Return it in words."""
        kinds = [low_pass_words(known.best.chain) for _, known in self.parts]
        if self.apart:
            each = " and ".join(f"{kind} ({', '.join(part)})" for (part, _), kind in zip(self.parts, kinds, strict=True))
            text = f"the recorders' low-passes are not stated, and differ: the recordings look as if made through {each}"
        else:
            text = f"the recorder's low-pass is not stated; the recordings look as if made through {kinds[0]}"
        if not all(known.is_clear for _, known in self.parts):
            text += ", but others would do as well"
        if self.cut:
            text += f"; above {self.band[1]:.3g} Hz nothing is compared, as it may have been folded there: state `acquisition`"
        return text

    def applied(self, trials: Sequence[Trial]) -> list[Trial]:
        """Return trials whose unknown recorders are this one."""
        return _through(trials, self.chains)

    def forgotten(self, trials: Sequence[Trial]) -> list[Trial]:
        """Return trials on which this one stands with recorders that are unknown again."""
        return with_unknown(trials, self.channels)

    def is_like(self, other: FoundRecorder) -> bool:
        """Return whether another one is of the same kind and cuts off at the same frequency."""
        pairs = [(chain, other.chains.get(name)) for name, chain in self.chains.items()]
        return self.cut == other.cut and all(two is not None and _are_like(one, two) for one, two in pairs)


def low_pass_words(chain: AcquisitionChain) -> str:
    """Return a chain's low-pass in words."""
    known = {"none": "no low-pass at all", "ideal": "an ideal low-pass"}.get(chain.filter)
    return known or f"a {chain.filter} low-pass of order {chain.order} at {chain.cut_off:.3g} Hz"


def _are_like(one: AcquisitionChain, two: AcquisitionChain) -> bool:
    same = (one.filter, one.order) == (two.filter, two.order)
    return same and abs((one.cut_off or 0.0) - (two.cut_off or 0.0)) <= SAME_CUT_OFF * (two.cut_off or 1.0)


def clearest(recorders: Sequence[FoundRecorder], squares: Sequence[float]) -> int:
    """Return which of recorders from :meth:`FoundRecorder.with_usual` stands, by the sums of squares that refits through them leave."""
    less = [0.0, *[CLEAR_RECORDER] * (len(recorders) - 1)]
    best = int(np.argmin(np.subtract(squares, less)))
    return 1 + clearest(recorders[1:], squares[1:]) if best and recorders[0].apart else best


def with_unknown(trials: Sequence[Trial], channels: Sequence[str]) -> list[Trial]:
    """Return trials with the recorders of channels unknown."""
    return _through(trials, dict.fromkeys(channels, UNKNOWN))


def _through(trials: Sequence[Trial], chains: Mapping[str, AcquisitionChain]) -> list[Trial]:
    """Return trials with other recorders of some channels."""
    found = []
    for trial in trials:
        own = {name: chains.get(name) or trial.scenario.chain(name) for name in trial.channels}
        found.append(replace(trial, scenario=replace(trial.scenario, chains=own)))
    return found


def has_unknown(trials: Sequence[Trial]) -> bool:
    """Return whether the recorder of any channel is not known."""
    return any(not trial.scenario.chain(name).is_known for trial in trials for name in trial.channels)


def find_recorder(
    misfit: Misfit, x: Array, channels: Sequence[str] | None = None, band: tuple[float, float] | None = None
) -> FoundRecorder:
    """Return what stands for the unknown recorders of a fit's runs.

    Where several chains would do, the band ends at the frequency up to which folding matters in no run, but above the lines that are there
    before a hump, too, which folding cannot make. Sensors have chains of their own where these do far better than one for all. All of the
    band to be compared tells of chains, also what a fit through another chain had to leave out.

    Parameters
    ----------
    misfit, x
        A fit.
    channels
        Those whose recorder is not known (default: as the runs have it).
    band
        The band to be compared [Hz] (default: the fit's).
    """
    asked = band or misfit.band
    misfit, trials = _within(misfit, x, asked), misfit.problem.trials
    unknown = [name for trial in trials for name in trial.channels if not trial.scenario.chain(name).is_known]
    channels = tuple(channels or dict.fromkeys(unknown))
    search = ChainSearch.of(misfit, x)
    shared = search.estimate(channels)
    parts = by_sensor(trials, channels)
    own = search.estimate_apart(parts, shared.best)
    apart = tuple(zip(parts, own, strict=True)) if own and own[-1].scale <= MOST_LEFT else ()
    clear = shared.is_clear and shared.scale <= MOST_LEFT and all(known.is_clear for _, known in apart)
    if shared.scale > MOST_LEFT:
        ideal = next(item for item in (shared.best, *shared.others) if item.chain.filter == "ideal")
        rest = tuple(item for item in (shared.best, *shared.others) if item is not ideal)
        shared = replace(shared, best=ideal, others=rest, is_clear=False)
    if clear:
        return FoundRecorder(shared, asked, False, channels, apart)
    tops = [trusted_band(trial, fine_response(misfit, x, t), misfit.noises[trial.name]) for t, trial in enumerate(trials)]
    steady = [(1 + LINE_WIDTH) * line for trial in trials for line in trial.lines]
    top = min(max(min(tops), asked[1] / 2, *steady), asked[1])
    return FoundRecorder(shared, (asked[0], top), top < asked[1], channels, apart)


def _within(misfit: Misfit, x: Array, band: tuple[float, float]) -> Misfit:
    """Return the misfit over another band, the road's part of the noise as its unknowns have it."""
    if misfit.band == band:
        return misfit
    (unit, errors), n = misfit.split(x), misfit.n_parameters
    values, adjusted = misfit.problem.space.values(unit), x[n : n + len(misfit.shared)]
    return Misfit(misfit.problem, misfit.noises, values, misfit.nuisances, band, misfit.shared, misfit.known, errors, adjusted)


def by_sensor(trials: Sequence[Trial], channels: Sequence[str]) -> list[tuple[str, ...]]:
    """Return channels sensor by sensor: one recorder takes all that a sensor feels."""
    found: dict[str, dict[str, None]] = {}
    for trial in trials:
        for item in trial.recording.channels:
            if item.name in channels:
                found.setdefault(item.sensor, {})[item.name] = None
    return [tuple(names) for names in found.values()]
