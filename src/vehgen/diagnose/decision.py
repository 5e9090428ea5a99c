"""From what was detected to a verdict: look for effects, hold them against chance and one another, look again."""

from __future__ import annotations

from dataclasses import replace

from vehgen.diagnose import thresholds as limit
from vehgen.diagnose import wording
from vehgen.diagnose.combining import Combiner
from vehgen.diagnose.design.experiment import VISIBLE
from vehgen.diagnose.detect.detection import BELIEVED_SIGMAS, FREE_SIGMAS, Detection, look_again, run_gaps, supposing, with_usual_recorder
from vehgen.diagnose.detect.odd_run import OddChannel, OddRun, disagreement
from vehgen.diagnose.fits.begun_again import is_strained
from vehgen.diagnose.fits.model_fit import ModelFit
from vehgen.diagnose.inputs.checks import variety_notes
from vehgen.diagnose.inputs.fault import MeasurementFault
from vehgen.diagnose.inputs.humps import exchanged_humps
from vehgen.diagnose.inputs.judging import (
    odd_mistake,
    plain_mistake_instead,
    plain_mistakes,
    recorded_mistakes,
    supposed_mistakes,
    timing_mistakes,
)
from vehgen.diagnose.inputs.recorders import wrongly_declared
from vehgen.diagnose.localise.localisation import localise
from vehgen.diagnose.result import Decided
from vehgen.diagnose.select.criteria import freed_instead, p_value_of, passes
from vehgen.diagnose.select.fitter import Fitter
from vehgen.diagnose.select.freed_base import split_idle
from vehgen.diagnose.select.group_members import with_members
from vehgen.diagnose.select.needless import without_needless
from vehgen.diagnose.select.one_error import explains_easily, one_error, price_of_belief
from vehgen.diagnose.select.placebo_laws import COUNT, compare_with_placebo_laws
from vehgen.diagnose.select.ranking import SearchRound, own_numbers
from vehgen.diagnose.select.reaching_runs import with_reaching_run
from vehgen.diagnose.select.search import LEADING, LOOKS_AGAIN, fit_leading_again, noise_by_its_law, search_round
from vehgen.diagnose.select.validation import seen_again
from vehgen.diagnose.without_gap import WithoutGap
from vehgen.errors import InputError

LOOK_AGAIN_SHARE = 0.5
"""Where the best candidate leaves no more than this share of the excess, recorder and profiles are judged by it."""
MUCH_QUIETER = 2.0
"""Where noise is found to be less by so much than what candidates were last weighed by, all of them are weighed anew."""
BELIEF_TOO_DEAR = 60.0
"""Errors beyond belief without which -2 ln L rises by more are told, though chi stays quiet: by healthy runs it rose by 37 at most."""


class Decision(WithoutGap):
    """One diagnosis on its way: what was detected, the library, and the rounds so far."""

    def decide(self) -> Decided:
        """Return the verdict with the fitted models; after Ctrl-C what was found until then."""
        try:
            return self._decide()
        except KeyboardInterrupt:
            self.interrupted = True
            return self._name(self.chain) if self.chain else self._stopped()

    def _decide(self) -> Decided:
        detection = self.detection
        self.notes += variety_notes(detection.trials)
        if mistakes := recorded_mistakes(detection) or exchanged_humps(detection):
            return self._mistaken(mistakes)
        if (cause := self._one_cause()) or detection.is_quiet:
            return cause or self._without_gap()
        if detection.chi <= limit.WEAK and is_strained(self.base.least_squares) and (strained := self._freed()):
            return strained
        mistakes = plain_mistakes(detection) or wrongly_declared(detection)
        found = self._mistaken(mistakes) if mistakes else self._explain_gap()
        if found.verdict.verdict != "too_weak" or not self.detection.is_quiet:
            return found
        self.rounds.clear()  # of a gap that noise and recorders have closed, found by the best effect
        return self._without_gap()

    def _without_gap(self) -> Decided:
        """Return the verdict where the base explains the runs."""
        if law := self._by_one_recorder():
            return law
        return self._strained(mistakes) if (mistakes := supposed_mistakes(self.detection)) else self._quiet()

    def _freed(self) -> Decided | None:
        """Return the verdict where a small gap closes once errors that the base has at their bounds may be as large as they will."""
        free = supposing(self.detection, FREE_SIGMAS)
        if not free.is_quiet or not (mistakes := supposed_mistakes(free)):
            return None
        self.detection, self.base = free, free.base
        return self._strained(mistakes)

    def _strained(self, mistakes: tuple[MeasurementFault, ...]) -> Decided:
        """Return the verdict where the base explains the runs, but supposes more of them than can be believed: an effect or a mistake."""
        if instead := plain_mistake_instead(self.detection):
            return self._mistaken(instead)
        believed, free = (supposing(self.detection, most) for most in (BELIEVED_SIGMAS, FREE_SIGMAS))
        if free.is_quiet and price_of_belief(free.base, self.base) > 0 and (sized := supposed_mistakes(free)):  # held ones make others
            self.detection, self.base, mistakes = free, free.base, sized
        other = Decision(believed, self.effects, self.everything, self.progress, self.runner)
        other.notes += self.notes
        if believed.is_quiet:
            if price_of_belief(self.base, believed.base) > BELIEF_TOO_DEAR:
                single = other._one_mistake() or other._instead(self.base)
                return single or (self._by_one_error(believed) if len(mistakes) > 1 else None) or self._mistaken(mistakes)
            if left := supposed_mistakes(believed):
                return self._mistaken(left)
            other.notes.append(wording.supposed([item.message for item in mistakes]))
            return other._quiet()
        if mistaken := other._one_mistake():
            return mistaken
        found = other._explain_gap()
        if single := self._by_one_error(believed, found):
            return single
        simpler = 0 < len(found.verdict.faults) < len(mistakes) and other.undone is not None and other.undone[1].at_once
        return found if simpler or explains_easily(found) else self._mistaken(mistakes)

    def _by_one_error(self, believed: Detection, found: Decided | None = None) -> Decided | None:
        """Return the verdict where one error of all runs, or of a sensor, explains what the base supposes many for."""
        single = one_error(self.detection, believed, found, self._candidates(believed.base), self.runner)
        self.interrupted = single.stopped
        if not single.fits:
            return None
        other = Decision(believed, self.effects, self.everything, self.progress, self.runner)
        other.notes, other.rounds = list(self.notes), [single]
        return other._name([single.fits[0]])

    def _quiet(self) -> Decided:
        """Return the verdict where chi shows no gap: a faint effect, runs that disagree, or nothing."""
        if isinstance(odd := disagreement(self.detection), OddChannel):
            return self._mistaken((odd_mistake(odd),))
        return self._faint() or self._disagreeing(odd) or self._nothing()

    def _explain_gap(self, anew: bool = True) -> Decided:
        detection = self.detection
        if not detection.validation_runs:
            return self._unchecked(wording.a_gap(detection.chi))
        if self.base.least_squares.on_bound and (mistakes := timing_mistakes(detection)):
            return self._mistaken(mistakes)
        if not self._candidates(self.base):
            raise InputError("no effect of the library can live on this vehicle")
        first = self._search_round(self.base)
        if first.stopped:
            return self._stopped()
        for _ in range(LOOKS_AGAIN):
            again = first if freed_instead(first, self.base) else self._again(first)
            if again is first:
                break
            first = again
        if freed := freed_instead(first, self.base):
            unseen = self.base.training <= limit.NOISE_FLOOR**2  # the gap is of validation runs alone, to which nothing is fitted
            return (self._other_mistakes(first) if unseen else None) or self._out_of_range(freed)
        weak = self._add(first) if first.fits else self._all_idle()
        self._leave_out_needless()
        if self.interrupted:
            return self._name(self.chain) if self.chain else self._stopped()
        if ended := self._other_mistakes(first) or weak or (self._name(self.chain) if self.chain else None):
            return ended
        return (self._otherwise(first) if anew else None) or self._unknown(first)

    def _otherwise(self, first: SearchRound) -> Decided | None:
        """Return the verdict by the noise of a vehicle with the law that a gap's place asks for, or through a usual recorder.

        None where neither names anything. Through a recorder as no other is, an effect that smooths looks like none; it leaves noise.
        """
        found = self._anew(noise_by_its_law(self.detection, first))
        if found is not None or self.interrupted:
            return found
        found = self._anew(with_usual_recorder(self.detection))
        return found if found is not None and found.verdict.gap.after <= limit.WEAK else None

    def _anew(self, detection: Detection | None) -> Decided | None:
        """Return the verdict on another detection of the same runs; None where that names nothing."""
        if detection is None:
            return None
        other = Decision(detection, self.effects, self.everything, self.progress, self.runner)
        other.notes += self.notes
        found = other._explain_gap(anew=False)
        self.interrupted = found.stopped
        return found if found.verdict.effects else None

    def _again(self, first: SearchRound) -> SearchRound:
        """Return a round of the leading candidates, recorder and profiles being as the best has them; the same round where they were so."""
        best = first.fits[0] if first.fits else None
        if best is None or best.training - 1 > LOOK_AGAIN_SHARE * (self.base.training - 1):
            return first
        detection = look_again(self.detection, best) or with_reaching_run(self.detection, best)
        if detection is None:
            return first
        held = self.validation_runs
        self.detection, self.base = detection, detection.base
        if self.validation_runs != held:  # what places leave is told of the runs that are fitted
            places, passed = localise(self.base, self.runner)
            first = replace(first, places=tuple(places), passed=tuple(passed))
        fitter = Fitter(detection, self.base, first.passed)
        quieter = self.base.training > MUCH_QUIETER * self.weighed_by
        fits, idle = list(fit_leading_again(fitter, first.fits, quieter, self.runner)), list[ModelFit]()
        if quieter:  # what loud noise hid, freed base parameters may do as well
            self.weighed_by = self.base.training
            fits, idle = split_idle(fits, fitter.fit_roughly, LEADING, self.base.least_squares.on_bound, fitter.fit_without)
        self.rounds[:] = [replace(first, current=self.base, fits=tuple(fits), idle=tuple(idle))]
        return self.rounds[-1]

    def _add(self, first: SearchRound) -> Decided | None:
        """Add what passes to the chain; return the verdict where the best effect is too weak to be named."""
        best = first.fits[0]
        good = passes(best, self.base)
        weak = self._too_weak(first, best, good)
        if weak is not None and weak.verdict.verdict != "measurement_fault" and (faint := self._faint(first)) is not None:
            return faint
        if weak is None and good and (imitation := self._imitation(best)):
            return self._other_mistakes(first) or self._unknown(first, imitation)
        if weak is None and good:
            self.chain = self._combiner().further([best])
            if not self.interrupted and max(self.chain[-1].training, self.chain[-1].validation) > limit.NAMED_LEFT**2:
                self._combine(first)
        elif weak is None:
            self._combine(first)
        return weak

    def _all_idle(self) -> Decided | None:
        """Return the verdict where a gap is small, and no effect does more for it than base parameters do."""
        if (chi := self.detection.chi) > limit.WEAK:
            return None
        return self._disagreeing(disagreement(self.detection)) or self._end("too_weak", wording.small_gap(chi))

    def _disagreeing(self, odd: OddRun | OddChannel | None) -> Decided | None:
        """Return the verdict where little seems to be missing, but a run or one of its channels does not agree with the others."""
        if odd is None:
            return None
        if isinstance(odd, OddChannel) or (odd.others_agree and self._no_effect_passes()):
            return self._mistaken((odd_mistake(odd),))
        return self._end("too_weak", wording.odd_run(odd), wording.odd_run_again(odd))

    def _no_effect_passes(self) -> bool:
        """Whether the library has been tried, now if not before, and nothing of it passes."""
        first = (self.rounds or [self._search_round(self.base)])[0]
        return not first.stopped and not any(passes(fit, self.base) for fit in first.fits[:1])

    def _too_weak(self, first: SearchRound, best: ModelFit, good: bool) -> Decided | None:
        """Return the verdict where the best effect is not told from chance, from random laws, or by the validation runs."""
        chi, p = self.detection.chi, p_value_of(first, best, self.tried)
        if p > limit.SIGNIFICANT and (good or chi <= VISIBLE):
            return self._propose(wording.not_told_from_chance(chi, p), best)
        if chi <= limit.WEAK and not good:
            return self._disagreeing(disagreement(self.detection)) or self._propose(wording.small_gap(chi), best)
        if not good:
            return None
        if own_numbers(best) and not seen_again(self.base, best, self.validation_runs):  # what has no number was not fitted
            shown = [gap.run for gap in run_gaps(self.detection) if gap.chi > limit.WEAK and gap.run not in self.validation_runs]
            if shown and chi > VISIBLE:
                return self._end("insufficient_data", *wording.seen_once(self._words(best.last), chi, shown))
            return self._propose(wording.not_seen_again(self._words(best.last)), best)
        rivals = compare_with_placebo_laws(first, best)
        if rivals is not None and rivals[1] >= rivals[0] - limit.DECOY:
            return self._propose(wording.like_a_random_law(self._words(best.last), *rivals), best)
        if rivals is not None:
            self.notes.append(wording.best_random_law(COUNT, rivals[1]))
        return None

    def _search_round(self, current: ModelFit) -> SearchRound:
        found = search_round(self.detection, current, self._candidates(current), self.everything, self.progress, self.runner)
        self.rounds.append(found)
        self.interrupted = self.interrupted or found.stopped
        return found

    def _combiner(self) -> Combiner:
        return Combiner(self.detection, self.base, self.tried, self._search_round, self._candidates, self.rounds)

    def _leave_out_needless(self) -> None:
        """Leave out of several effects what the others do as well without."""
        if len(self.chain) > 1 and not self.interrupted:
            self.progress("do without", 0, 1, self.chain[-1].label)
            self.chain = without_needless(self.chain, self.detection, self.rounds)
            self.parts = self.parts and len(self.chain) > 1

    def _combine(self, first: SearchRound) -> None:
        """Look for a pair of effects that passes, then for a set of parts; not where a single mistake tells all that effects would."""
        if self.detection.chi > limit.WEAK and self._undone().at_once and self._other_mistakes(first):
            return
        fitter = Fitter(self.detection, self.base, first.passed)
        first = self.rounds[0] = with_members(first, self._candidates(self.base), fitter.fit)
        self.chain = self._combiner().pair(first)
        if not self.chain and not self.interrupted:
            self.chain = self._combiner().together(first)
            self.parts = bool(self.chain)
