"""Names what was found: the effects with their numbers, what else would do as well, and which run would tell."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from vehgen.diagnose import thresholds as limit
from vehgen.diagnose import wording
from vehgen.diagnose.design.experiment import propose
from vehgen.diagnose.detect.detection import Detection
from vehgen.diagnose.fits.candidate import Candidate
from vehgen.diagnose.fits.model_fit import ModelFit
from vehgen.diagnose.phrases import candidate_words
from vehgen.diagnose.select.alternatives import Alternative, alternatives_beside
from vehgen.diagnose.select.criteria import excess, p_value_of, tied
from vehgen.diagnose.select.estimates import estimate, unstable
from vehgen.diagnose.select.open_ends import told_alone, told_numbers
from vehgen.diagnose.select.ranking import SearchRound, holding
from vehgen.diagnose.select.search import DiagnosisProgress
from vehgen.diagnose.select.validation import gain_interval, validation_gain
from vehgen.diagnose.verdict import Gap, NamedEffect, NamedParameter, Verdict
from vehgen.fit.nuisances import Condition
from vehgen.simulate.last_used import LastUsed


class Naming:
    """Names the effects of a chain of fits, each of which adds one.

    Parameters
    ----------
    detection, rounds
        What was detected, and the rounds in which the effects were found.
    tried
        How many candidates could have been tried.
    progress
        Told of progress.
    interrupted
        Whether Ctrl-C ended the search: nothing more is fitted then.
    """

    def __init__(
        self, detection: Detection, rounds: Sequence[SearchRound], tried: int, progress: DiagnosisProgress, interrupted: bool
    ) -> None:
        self.detection, self.base, self.rounds = detection, detection.base, rounds
        self.tried, self.progress, self.interrupted = tried, progress, interrupted
        self.validation_runs = [trial.name for trial in detection.validation_runs]
        self._numbers = LastUsed[tuple[dict[str, NamedParameter], list[str]]](lambda item: 0)

    def verdict(self, chain: Sequence[ModelFit]) -> Verdict:
        """Return the verdict `named` or `ambiguous`, without gap and places."""
        return self._one(chain[0]) if len(chain) == 1 else self._several(chain)

    def _one(self, fit: ModelFit) -> Verdict:
        step = self._round_of(fit)
        ties = [Alternative(fit.last, item.last, item) for item in tied(step, fit)]
        effects = [self._effect(step, fit, 0, ties)]
        effects += [self._effect(step, item.fit, 0, []) for item in ties[:2]]
        if ties:
            told = [item.sentence for item in effects] + [self._words(item.candidate) for item in ties[2:]]
            return self._named(fit, ties, effects, wording.ambiguous(told))
        return self._named(fit, ties, effects, wording.named([effects[0].sentence], validation_gain(self.base, fit)))

    def _several(self, chain: Sequence[ModelFit]) -> Verdict:
        last = chain[-1]
        alternatives = [self._alternatives(chain, number) for number in range(len(chain))]
        effects = [self._effect(self._round_of(chain[i]), last, i, others) for i, others in enumerate(alternatives)]
        ties = [item for others in alternatives for item in others]
        told = [item.sentence for item in effects]
        reason = wording.named(told, validation_gain(self.base, last), [self._words(item.candidate) for item in ties])
        return self._named(last, ties, effects, reason)

    def parts(self, chain: Sequence[ModelFit]) -> Verdict:
        """Return the verdict `several_effects`, of effects of which only all together close the gap, with what each closes."""
        last = chain[-1]
        effects = [self._effect(self._round_of(chain[i]), last, i, []) for i in range(len(chain))]
        left = [float(np.sqrt(fit.training)) for fit in (self.base, *chain)]
        reason = wording.several_effects([item.sentence for item in effects], left, validation_gain(self.base, last))
        found = Verdict("several_effects", reason, tuple(effects), Gap(self.base.chi, last.chi, 1.0, ()), notes=self._notes(last))
        return replace(found, next_experiment=wording.ONE_AT_A_TIME)

    def _alternatives(self, chain: Sequence[ModelFit], number: int) -> list[Alternative]:
        """Return what ties with an effect: the last one's in its round, earlier ones' beside all that were found after them."""
        fit, step = chain[number], self._round_of(chain[number])
        if number == len(chain) - 1 or self.interrupted:
            return [Alternative(fit.last, item.last, item) for item in tied(step, fit)]
        self.progress("look for rivals", number, len(chain), fit.last.label)
        return alternatives_beside(self.detection, step, chain[-1], number)

    def _named(self, fit: ModelFit, ties: Sequence[Alternative], effects: Sequence[NamedEffect], reason: str) -> Verdict:
        return Verdict(
            "ambiguous" if ties else "named",
            reason,
            tuple(effects),
            Gap(self.base.chi, fit.chi, 1.0, ()),
            next_experiment=self._apart(fit, ties) if ties else None,
            notes=self._notes(fit),
        )

    def _round_of(self, fit: ModelFit) -> SearchRound:
        return next(item for item in self.rounds if any(own.key == fit.key for own in item.fits))

    def _words(self, candidate: Candidate, parameters: Mapping[str, NamedParameter] | None = None) -> str:
        return candidate_words(self.detection.trials[0].run.vehicle, candidate, parameters)

    def _apart(self, fit: ModelFit, ties: Sequence[Alternative]) -> str | None:
        """Return which run would tell tied models apart, by what each predicts."""
        if self.interrupted:
            return None
        advice = ties[0].candidate.effect.tie_advice
        if advice and all(effect.tie_advice == advice for item in ties for effect in (item.instead_of.effect, item.candidate.effect)):
            return advice
        self.progress("propose", 0, 1, "")
        found = propose(self.detection, (fit, *(item.fit for item in ties)))
        return found.text if found else None

    def _effect(self, step: SearchRound, fit: ModelFit, number: int, others: Sequence[Alternative]) -> NamedEffect:
        """Return the effect `number` of a fit, judged by what it closed in its own round."""
        own = next((item for item in step.fits if item.key == fit.key[: number + 1]), fit)
        candidate = fit.effects[number]
        parameters, hidden = self._told(fit, candidate)
        return NamedEffect(
            candidate.effect.name,
            candidate.place,
            parameters,
            p_value_of(step, own, self.tried),
            validation_gain(step.current, own),
            gain_interval(step.current, own, self.validation_runs),
            tuple(item.candidate.label for item in others),
            self._words(candidate, told_alone(parameters, hidden)),
        )

    def _told(self, fit: ModelFit, candidate: Candidate) -> tuple[dict[str, NamedParameter], list[str]]:
        """Return what :func:`told_numbers` does, which simulates: once of each effect."""
        return self._numbers.find((id(fit), candidate.label), fit, lambda: told_numbers(fit, candidate))

    def _notes(self, fit: ModelFit) -> tuple[str, ...]:
        told = []
        for candidate in fit.effects:
            told += [f"{candidate.label}: {text}" for text in unstable(fit, candidate)]
            if names := self._told(fit, candidate)[1]:
                told.append(f"{candidate.label}: {wording.not_told(names)}")
        if fit.least_squares.on_bound:
            told.append(f"on the bound of its range: {', '.join(fit.least_squares.on_bound)}")
        told += [wording.constant_force(item) for item in _constant_forces(fit)]
        told += self._more_general(fit)
        left = excess(fit.training)
        if left > limit.AGAIN**2 - 1:
            told.append(f"chi {np.sqrt(1 + left):.2f} is left unexplained")
        return tuple(told)

    def _more_general(self, fit: ModelFit) -> list[str]:
        """Return which effects do as well that hold the last one as a special case, with the constant forces that they suppose instead."""
        step, told = self._round_of(fit), []
        for item in holding(step.fits, fit, step.current):
            words = self._words(item.last, estimate(item, item.last))
            told.append(wording.more_general(words, [wording.constant_force_words(force) for force in _constant_forces(item)]))
        return told


def _constant_forces(fit: ModelFit) -> list[Condition]:
    """Return the constant forces that a fit supposes beside measured ones."""
    return [item for item in fit.least_squares.conditions() if item.name == "force_offset"]
