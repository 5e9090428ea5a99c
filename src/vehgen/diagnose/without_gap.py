"""Verdicts that need no gap: one error of all runs, one recorder in place of several, effects too faint for chi."""

from __future__ import annotations

from dataclasses import replace

from vehgen.diagnose import thresholds as limit
from vehgen.diagnose import wording
from vehgen.diagnose.detect.detection import with_usual_recorder
from vehgen.diagnose.ending import Ending
from vehgen.diagnose.fits.model_fit import ModelFit
from vehgen.diagnose.inputs.recorders import wrongly_declared
from vehgen.diagnose.result import Decided
from vehgen.diagnose.select.criteria import fall
from vehgen.diagnose.select.faint import faint_exchange, faint_look_again, faint_round, faintly_told
from vehgen.diagnose.select.one_cause import BEFORE, one_cause
from vehgen.diagnose.select.one_error import believable_law
from vehgen.diagnose.select.ranking import SearchRound, merit
from vehgen.diagnose.select.validation import validation_fall


class WithoutGap(Ending):
    """What a diagnosis tells where its base leaves noise, or would but for what it must suppose of the runs."""

    def _one_cause(self) -> Decided | None:
        """Return the verdict where all runs suppose the same error: it is one of all runs."""
        found = one_cause(self.detection, self._candidates(self.base))
        if found is None:
            return None
        sure, fits = found
        other = type(self)(sure, self.effects, self.everything, self.progress, self.runner)
        other.notes += [*self.notes, BEFORE]
        other.rounds = [SearchRound(sure.base, (), (), fits)]
        return other._name([fits[0]])

    def _by_one_recorder(self) -> Decided | None:
        """Return the verdict where one recorder and an effect explain far more than recorders that each sensor has for itself."""
        recorder = self.detection.recorder
        if recorder is None or not recorder.apart or (one := with_usual_recorder(self.detection)) is None:
            return None
        known, found = self.detection, faint_round(one, self._candidates(one.base), self.runner)
        if not found.fits or known.base.squares - merit(found.fits[0]) < limit.FAINT_FALL:
            return None
        self.detection, self.base = one, one.base
        if (told := self._faint(found)) is None:
            self.detection, self.base = known, known.base
        return told

    def _instead(self, strained: ModelFit) -> Decided | None:
        """Return the verdict where a law of the vehicle explains what a strained base has to suppose of the runs."""
        found = faint_round(self.detection, self._candidates(self.base), self.runner)
        law = believable_law(found.fits, strained)
        return self._faint(found) or (None if law is None else self._propose(wording.not_seen_again(self._words(law.last)), law))

    def _faint(self, found: SearchRound | None = None) -> Decided | None:
        """Return the verdict where an effect too small for chi is told by how far -2 ln of the likelihood falls with it.

        `found` are fits of a search that chi asked for (default: none were made).
        """
        if not self.validation_runs:
            return None
        self.progress("look for faint effects", 0, 1, "")
        found = faint_round(self.detection, self._candidates(self.base), self.runner) if found is None else replace(found, faint=True)
        found, detection = faint_look_again(found, self.detection, self.runner)
        best = faintly_told(found, detection)
        if best is None and (exchanged := faint_exchange(found, detection, self.runner)) is not None:
            found, detection = exchanged
            best = faintly_told(found, detection)
        if best is None:
            return None
        if mistakes := wrongly_declared(self.detection):
            return self._mistaken(mistakes)
        self.notes.append(wording.faint(self.detection.chi, fall(found, best), validation_fall(found.current, best)))
        self.detection, self.base = detection, detection.base
        self.rounds[:], self.chain = [found], [best]
        return self._name(self.chain)
