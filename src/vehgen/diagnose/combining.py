"""Several effects at once: what a first one leaves is explained by a further one, by the second of a pair, or part by part."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from vehgen.diagnose import thresholds as limit
from vehgen.diagnose.detect.detection import Detection
from vehgen.diagnose.fits.candidate import Candidate
from vehgen.diagnose.fits.model_fit import ModelFit, evaluate_fit
from vehgen.diagnose.localise.localisation import suffices
from vehgen.diagnose.select.criteria import adds, excess, is_told, needs_both, p_value_of, passes, seeds, unfinished
from vehgen.diagnose.select.group_members import leading_group, member_seeds, with_rest
from vehgen.diagnose.select.ranking import SearchRound
from vehgen.diagnose.select.validation import seen_again

MOST_EFFECTS = 3
"""So many effects are added at most, each of which is sure beside the others ..."""
MOST_TOGETHER = 4
"""... or of which only the whole set closes the gap."""


@dataclass(frozen=True)
class Combiner:
    """Adds effects to effects of one base.

    Attributes
    ----------
    detection, base
        What was detected, and the base.
    tried
        How many candidates could have been tried.
    search
        Looks for an effect beside those of a fit.
    candidates
        Returns every effect at every place of a fit's vehicle.
    looked
        The looks made so far, none of which is made again.
    """

    detection: Detection
    base: ModelFit
    tried: int
    search: Callable[[ModelFit], SearchRound]
    candidates: Callable[[ModelFit], Sequence[Candidate]]
    looked: list[SearchRound]

    def further(self, chain: Sequence[ModelFit]) -> list[ModelFit]:
        """Return a chain of fits with what is found in what the last one leaves, until nothing is left or nothing passes."""
        found = list(chain)
        while len(found) < MOST_EFFECTS and unfinished(found[-1], self.base):
            look = self._look(found[-1])
            if look.stopped or not look.fits or not adds(look, look.fits[0]) or not self._is_sure(look, look.fits[0]):
                break
            found.append(look.fits[0])
        return found

    def pair(self, first: SearchRound) -> list[ModelFit]:
        """Return a pair of effects that passes, with what is found beside it; nothing where none does.

        Where one force leaves noise, only a tyre and its suspension can be two. A law that a group has alike is tried first at its axles
        alone, where each has numbers of its own.
        """
        others = seeds(first)[:1] if suffices(first.passed, self.base) else seeds(first)
        members = {item.key: item for item in member_seeds(first)}
        for seed in (members | {item.key: item for item in others}).values():
            known = self._checked(seed)
            look = self._apart(known, leading_group(first)) if seed.key in members else self._look(known)
            if look.stopped:
                return []
            if look.fits and self._both(first, look, look.fits[0]):
                return self.further([known, look.fits[0]])
        return []

    def together(self, first: SearchRound) -> list[ModelFit]:
        """Return effects that close the gap together, though each explains a part: the best one beside those before, and so on."""
        chain = [self._checked(seed) for seed in seeds(first)[:1]]
        while 0 < len(chain) < MOST_TOGETHER and unfinished(chain[-1], self.base):
            look = self._look(chain[-1])
            best = next(iter(look.fits), None)
            part = best is not None and excess(best.training) <= limit.PARTLY * excess(chain[-1].training)
            if look.stopped or best is None or not part or not self._is_sure(look, best):
                break
            chain.append(best)
        return chain if len(chain) > 1 and passes(chain[-1], self.base) and self._holds(chain[-1]) else []

    def _look(self, known: ModelFit) -> SearchRound:
        """Return the look for an effect beside those of a fit."""
        return next((item for item in self.looked if item.current.key == known.key), None) or self.search(known)

    def _apart(self, known: ModelFit, group: ModelFit | None) -> SearchRound:
        """Return the look beside a law at one axle of a group, with what its other axles do from where the group's fit ended."""
        look = self._look(known)
        if look.stopped or group is None:
            return look
        found = with_rest(look, group, self.candidates(known), self.detection)
        self.looked[:] = [found if item is look else item for item in self.looked]
        return found

    def _checked(self, seed: ModelFit) -> ModelFit:
        return evaluate_fit(seed.effects, seed.least_squares, self.detection.validation_runs, self.detection.floor.noises)

    def _is_sure(self, look: SearchRound, fit: ModelFit) -> bool:
        """Return whether an added effect is no chance, and the runs tell its size."""
        return p_value_of(look, fit, self.tried) <= limit.SIGNIFICANT and is_told(fit)

    def _holds(self, fit: ModelFit) -> bool:
        """Return whether validation runs speak for what a fit adds to the base."""
        return seen_again(self.base, fit, [trial.name for trial in self.detection.validation_runs])

    def _both(self, first: SearchRound, look: SearchRound, pair: ModelFit) -> bool:
        enough = passes(pair, self.base) and adds(look, pair) and needs_both(pair, first.fits)
        return enough and self._is_sure(look, pair) and self._holds(pair)
