"""How a diagnosis ends: what it knows on its way, and the verdict that each end makes of it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from vehgen.diagnose import thresholds as limit
from vehgen.diagnose import wording
from vehgen.diagnose.collecting import run_chis
from vehgen.diagnose.design.experiment import propose_stronger
from vehgen.diagnose.detect.detection import Detection
from vehgen.diagnose.fits.candidate import Candidate, list_candidates
from vehgen.diagnose.fits.model_fit import ModelFit
from vehgen.diagnose.inputs.conditions import alike_in_all_runs
from vehgen.diagnose.inputs.fault import MeasurementFault
from vehgen.diagnose.inputs.judging import Undone, explain_gap, find_mistakes, supposed_mistakes
from vehgen.diagnose.localise.free_form import FreeForm, fit_free_form, recover, strongest
from vehgen.diagnose.naming import Naming
from vehgen.diagnose.phrases import candidate_words, force_words
from vehgen.diagnose.result import Decided, DiagnosisModels
from vehgen.diagnose.select.criteria import explained_shares, passes, unfinished
from vehgen.diagnose.select.estimates import estimate, excluded
from vehgen.diagnose.select.freed_base import freed_ratios
from vehgen.diagnose.select.ranking import SearchRound, numbers_at_ends
from vehgen.diagnose.select.search import DiagnosisProgress
from vehgen.diagnose.select.validation import gain_interval
from vehgen.diagnose.verdict import Gap, NamedParameter, PlaceChi, Verdict, VerdictName
from vehgen.effects import Effect
from vehgen.effects.locator import undamped_tyres
from vehgen.fit.parallel import HERE, Runner


class Ending:
    """What a diagnosis knows on its way (what was detected, the library, the rounds so far), and how it ends with that."""

    def __init__(
        self, detection: Detection, effects: Sequence[Effect], everything: bool, progress: DiagnosisProgress, runner: Runner = HERE
    ) -> None:
        self.detection = detection
        self.base = detection.base
        self.weighed_by = detection.base.training
        self.everything = everything
        self.progress = progress
        self.runner = runner
        self.effects = effects
        self.rounds: list[SearchRound] = []
        self.chain: list[ModelFit] = []
        self.parts = False
        self.notes: list[str] = []
        self.undone: tuple[Detection, Undone] | None = None
        self.interrupted = False
        self.tried = len(self._candidates(self.base))

    @property
    def validation_runs(self) -> list[str]:
        """Their names."""
        return [trial.name for trial in self.detection.validation_runs]

    def _candidates(self, current: ModelFit) -> list[Candidate]:
        """Return what may live on the vehicle of a fit: a walking beam leaves its axles no suspension.

        Nothing lives on what an effect has added, as on the mount of a load that is itself supposed.
        """
        vehicle, known = current.least_squares.misfit.problem.trials[0].run.vehicle, self.detection.trials[0].run.vehicle
        added = {name for kind in ("bodies", "hinges", "links") for name in set(getattr(vehicle, kind)) - set(getattr(known, kind))}
        found = list_candidates(vehicle, self.detection.trials, self.effects, self.detection.floor.noises)
        return [item for item in found if added.isdisjoint(item.members)]

    def _gap(self, fit: ModelFit | None = None) -> Gap:
        last = fit or self.base
        return Gap(self.base.chi, last.chi, 1.0, run_chis(self.base, last, self.validation_runs))

    def _places(self) -> tuple[PlaceChi, ...]:
        return tuple(PlaceChi(item.place.label, item.chi) for item in self.rounds[0].passed[:5]) if self.rounds else ()

    def _mistaken(self, mistakes: tuple[MeasurementFault, ...]) -> Decided:
        ended = self._end("measurement_fault", wording.mistaken([item.message for item in mistakes]))
        return replace(ended, verdict=replace(ended.verdict, faults=mistakes))

    def _other_mistakes(self, first: SearchRound) -> Decided | None:
        """Return the verdict where a mistake that looks like an effect explains the runs, and no effect of the vehicle does.

        An effect that closes the gap, but is too weak to be named, is held against mistakes as one that is.
        """
        leading = self.chain[-1] if self.chain else next((fit for fit in first.fits[:1] if passes(fit, self.base)), None)
        unsure = leading is None or (bool(self.chain) and unfinished(leading, self.base))
        of_vehicle = all(candidate.effect.changes_vehicle for fit in self.chain[-1:] for candidate in fit.effects)
        if self.detection.chi <= limit.WEAK or (self.chain and of_vehicle and not unsure):
            return None
        mistakes = explain_gap(self.detection, leading, unsure, leading or next(iter(first.fits), None), self._undone())
        one_place = bool(first.passed) and any(item.kind == "other_parameters" for item in mistakes)  # no other vehicle errs at one place
        return self._mistaken(mistakes) if mistakes and not one_place else None

    def _undone(self) -> Undone:
        """Return the mistakes that explain what the base misses, looked for once."""
        if self.undone is None or self.undone[0] is not self.detection:
            self.progress("look for mistakes", 0, 1, "")
            self.undone = self.detection, find_mistakes(self.detection)
        return self.undone[1]

    def _one_mistake(self) -> Decided | None:
        """Return the verdict that a mistake is made which alone explains all, and which no effect of a vehicle looks like.

        That is a wrong speed of some runs, a clock, or, where runs differ in speed, a low-pass: what tyres smooth goes with the speed.
        """
        found, trials = self._undone(), self.detection.trials
        speeds = [trial.scenario.top_speed for trial in trials]
        varied = max(speeds) > limit.VARIED_SPEEDS * min(speeds)
        kinds = {item.kind for item in found.faults}
        some = kinds == {"speed"} and all(len(item.runs) < len(trials) for item in found.faults)
        alone = some or kinds == {"clock_or_speed"} or (varied and kinds == {"low_pass"})
        return self._mistaken(found.faults) if found.at_once and alone else None

    def _end(self, verdict: VerdictName, reason: str, next_experiment: str | None = None) -> Decided:
        notes = (*self.notes, *(self._edge() if verdict == "too_weak" else ()))
        found = Verdict(verdict, reason, (), self._gap(), self._places(), next_experiment=next_experiment, notes=notes)
        return self._decided(found, ())

    def _decided(self, verdict: Verdict, chain: Sequence[ModelFit], law: FreeForm | None = None) -> Decided:
        libraries = tuple(dict.fromkeys(effect.file for effect in self.effects if effect.file))
        return Decided(DiagnosisModels(self.detection, tuple(self.rounds), tuple(chain), law, libraries), verdict, self.interrupted)

    def _edge(self) -> list[str]:
        """Return the note on base parameters that the refit leaves at the edge of their bounds, if there are any."""
        found = self.base.least_squares
        space = found.misfit.problem.space
        low = {name for name, value, filed in zip(space.names, found.values, space.start, strict=True) if value < filed}
        tyres = undamped_tyres(self.detection.trials[0].run.vehicle, low.intersection(found.on_bound))
        return [wording.at_the_edge(found.on_bound, tyres)] if found.on_bound else []

    def _stopped(self) -> Decided:
        self.interrupted = True
        fits = self.rounds[0].fits if self.rounds else ()
        best = (self._words(fits[0].last), float(np.sqrt(fits[0].training))) if fits else None
        return self._end("insufficient_data", wording.stopped(len(fits), best), "let the diagnosis run to its end")

    def _nothing(self) -> Decided:
        conditions = [item for part in self.base.parts for item in part.conditions()]
        self.notes += [*alike_in_all_runs(conditions, [trial.name for trial in self.detection.trials]), *self._edge()]
        if not self.validation_runs:
            return self._unchecked(wording.no_gap(self.detection.chi))
        return self._end("no_missing_effect", wording.no_missing_effect(self.detection.chi))

    def _unchecked(self, found: str) -> Decided:
        """Return the verdict that no run is left to check what the fit to all of them `found`."""
        trials = self.detection.trials
        more = f"record at least three runs{', with two hump heights or speeds' if trials[0].run.vehicle.axles else ''}"
        return self._end("insufficient_data", wording.too_few_runs(found, len(trials)), more)

    def _propose(self, reason: str, best: ModelFit) -> Decided:
        self.progress("propose", 0, 1, "")
        louder = propose_stronger(self.detection, best)
        return self._end("too_weak", reason, louder.text if louder and louder.separates else "no run within reach would show it clearly")

    def _out_of_range(self, freed: ModelFit) -> Decided:
        return self._end("insufficient_data", wording.out_of_range(freed_ratios(freed)), "check the file, or calibrate first")

    def _unknown(self, first: SearchRound, reason: str = "") -> Decided:
        supposed = supposed_mistakes(self.detection)
        if not reason and {item.kind for item in supposed} == {"low_pass"}:  # no effect does as much
            return self._mistaken(supposed)
        best = (len(first.fits), self._words(first.fits[0].last), float(np.sqrt(first.fits[0].training))) if first.fits else None
        self.notes += self._edge()
        chains = [trial.scenario.chain(name) for trial in self.detection.trials for name in trial.channels]
        if self.detection.recorder is None and not all(chain.filtering().is_point_sample for chain in chains):
            self.notes.append("recorders were taken for what `acquisition` says of them: where that is a guess, write `unknown` instead")
        if supposed:
            self.notes.append(wording.supposed([item.message for item in supposed]))
        if first.fits:
            self.notes.append(wording.ranked([(self._words(fit.last), share) for fit, share in explained_shares(first, self.base)]))
        causes = [force_words(item.place.kind, item.place.name) for item in first.passed[:3]]
        freed = first.idle[0].last.freed if first.idle else ()
        ended = self._end("not_in_library", reason or wording.not_in_library(best, causes, freed))
        law = None if (shown := strongest(first.passed)) is None else fit_free_form(recover(self.detection, shown))
        if law is None:
            return ended
        verdict = replace(ended.verdict, free_form=law.to_dict(), notes=(*ended.verdict.notes, law.describe()))
        return self._decided(verdict, (), law)

    def _imitation(self, best: ModelFit) -> str:
        """Return why the best effect may only stand in for another one, though it closes the gap; nothing where nothing says so."""
        if apart := excluded(best):
            return wording.imitates(self._words(best.last), apart)
        ends, gain = numbers_at_ends(best), gain_interval(self.base, best, self.validation_runs)
        left = best.chi if unfinished(best, self.base) else None
        unsure = bool(ends) and (gain is None or gain[0] < limit.AT_LEAST or left is not None)
        return wording.imitates(self._words(best.last, estimate(best)), (), ends, left) if unsure else ""

    def _name(self, chain: list[ModelFit]) -> Decided:
        naming = Naming(self.detection, self.rounds, self.tried, self.progress, self.interrupted)
        named = naming.parts(chain) if self.parts else naming.verdict(chain)
        verdict = replace(named, gap=self._gap(chain[-1]), places=self._places(), notes=(*self.notes, *named.notes))
        return self._decided(verdict, chain)

    def _words(self, candidate: Candidate, parameters: Mapping[str, NamedParameter] | None = None) -> str:
        return candidate_words(self.detection.trials[0].run.vehicle, candidate, parameters)
