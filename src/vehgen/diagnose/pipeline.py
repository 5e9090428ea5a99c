"""The diagnosis in five stages: detect, localise, name, add, verify. Each can be used by itself; each leaves its evidence."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from threadpoolctl import threadpool_limits

from vehgen.diagnose import thresholds as limit
from vehgen.diagnose.candidate import list_candidates
from vehgen.diagnose.decoys import COUNT, compare
from vehgen.diagnose.detection import Detection, detect, kind_of_run, split_runs
from vehgen.diagnose.estimates import estimate, gain_interval, held_out_gain, unstable
from vehgen.diagnose.experiment import propose, propose_stronger
from vehgen.diagnose.fitting import Fit
from vehgen.diagnose.free_form import FreeForm, fit_free_form, recover, strongest
from vehgen.diagnose.inputs import check_inputs, explain_gap
from vehgen.diagnose.judging import adds, chance, excess, needs_both, passes, seeds, tied, unfinished
from vehgen.diagnose.localisation import localise, shortlist, suffices
from vehgen.diagnose.naming import Progress, Round, look
from vehgen.diagnose.place_test import PlaceResult
from vehgen.diagnose.verdict import Gap, NamedEffect, Verdict, VerdictName, sentence
from vehgen.effects import Effect, library
from vehgen.errors import InputError
from vehgen.identify.trial import Trial

MOST_EFFECTS = 3
"""So many effects are added at most."""


@dataclass(frozen=True)
class Diagnosis:
    """A finished diagnosis with the evidence of all stages.

    `rounds` are the looks for one effect each, the first on the base; `chosen` the fits that were added, each on top of the one before.
    `stopped` tells that Ctrl-C ended it; `law` describes an unknown force that no effect of the library explains.
    """

    trials: tuple[Trial, ...]
    detection: Detection
    rounds: tuple[Round, ...]
    chosen: tuple[Fit, ...]
    verdict: Verdict
    stopped: bool = False
    law: FreeForm | None = None

    @property
    def places(self) -> tuple[PlaceResult, ...]:
        """The places tested on the base, best first."""
        return self.rounds[0].places if self.rounds else ()

    @property
    def passed(self) -> tuple[PlaceResult, ...]:
        """The smallest hypotheses that reach the floor on the base."""
        return self.rounds[0].passed if self.rounds else ()

    @property
    def fits(self) -> tuple[Fit, ...]:
        """The candidates tried on the base, best first."""
        return self.rounds[0].fits if self.rounds else ()


def diagnose(
    trials: Sequence[Trial],
    effects: Sequence[Effect] | None = None,
    everything: bool = False,
    tell: Progress | None = None,
    band: tuple[float, float] | None = None,
    workers: int = 1,
) -> Diagnosis:
    """Find what a vehicle's model lacks.

    Parameters
    ----------
    trials
        Runs with recordings, of one vehicle. At least three are needed to name anything: one in three stays untouched by all fits.
    effects
        The library to try (default: all effects known).
    everything
        Try the whole library everywhere, whatever the place test says.
    tell
        Told of progress.
    band
        Frequencies compared [Hz] (default: what the run files ask for).
    workers
        So many processes compile the candidates' kernels. More than one needs `if __name__ == "__main__":` around a script's work.

    Returns
    -------
    The diagnosis. After Ctrl-C what was found until then; only during the first stage Ctrl-C is passed on.

    Raises
    ------
    InputError
        For trials that do not belong together.
    """
    with threadpool_limits(1, user_api="blas"):
        say = tell or (lambda stage, done, total, best: None)
        say("detect", 0, 1, "")
        detection = detect(sorted(trials, key=kind_of_run), band)  # whatever order they came in
        say("detect", 1, 1, f"chi {detection.chi:.3f}")
        return _Case(detection, list(effects if effects is not None else library().values()), everything, say, workers).decide()


class _Case:
    """One diagnosis on its way: what was detected, the library, and the rounds so far."""

    def __init__(self, detection: Detection, effects: Sequence[Effect], everything: bool, tell: Progress, workers: int) -> None:
        self.detection = detection
        self.base = detection.base
        self.everything = everything
        self.tell = tell
        self.workers = workers
        self.rounds: list[Round] = []
        self.notes: list[str] = []
        vehicle = detection.trials[0].run.vehicle
        self.candidates = list_candidates(vehicle, detection.trials, effects, detection.floor.noises)

    def decide(self) -> Diagnosis:
        """Return the diagnosis."""
        detection = self.detection
        shown = check_inputs(detection.trials)
        fatal = [item.message for item in shown if item.fatal]
        self.notes += [item.message for item in shown if not item.fatal]
        if fatal:
            return self._end("insufficient_data", "; ".join(fatal), "record these channels anew, or leave them out of the run files")
        if max(detection.chi, float(np.sqrt(self.base.train))) <= limit.NOISE_FLOOR:
            return self._end("no_missing_effect", f"the recalibrated model is at the noise floor: chi {detection.chi:.3f}")
        if not detection.held_out:
            count = len(detection.trials)
            return self._end(
                "insufficient_data",
                f"chi is {detection.chi:.2f}, but {count} run{'s' if count > 1 else ''} leave none untouched to check an effect on",
                "record at least three runs, with two hump heights or speeds",
            )
        if not self.candidates:
            raise InputError("no effect of the library can live on this vehicle")
        first = self._look(self.base)
        if first.stopped or not first.fits:
            return self._stopped(first)
        best = first.fits[0]
        p = chance(first, best, len(self.candidates))
        good = passes(best, self.base)
        interval = gain_interval(self.base, best, [trial.name for trial in detection.held_out])
        if p > limit.SIGNIFICANT or (detection.chi <= limit.WEAK and not good) or (good and interval is not None and interval[0] <= 0):
            reason = f"chi is {detection.chi:.3f}, but no effect is told from chance (p {p:.2g})"
            self.tell("propose", 0, 1, "")
            louder = propose_stronger(detection, best)
            return self._end("too_weak", reason, louder.text if louder else None)
        rivals = compare(first, best, detection) if good else None
        if rivals is not None and rivals[1] >= rivals[0] - limit.DECOY:
            reason = f"{best.label} closes {100 * rivals[0]:.0f} % of the excess, a random law at the same place {100 * rivals[1]:.0f} %"
            return self._end("too_weak", reason)
        if rivals is not None:
            self.notes.append(f"the best of {COUNT} random laws at the same place closes {100 * rivals[1]:.0f} % of the excess")
        chain = self._further([best]) if good else self._pair(first)
        if self.rounds[-1].stopped and not chain:
            return self._stopped(first)
        if not chain or unfinished(chain[-1], self.base):
            wrong = explain_gap(detection)
            if wrong:
                return self._end("insufficient_data", wrong[0].message, "; ".join(item.message for item in wrong[1:]) or None)
        return self._name(chain) if chain else self._unknown(first)

    def _look(self, footing: Fit) -> Round:
        found = look(self.detection, footing, self.candidates, self.everything, self.tell, self.workers)
        self.rounds.append(found)
        return found

    def _further(self, chain: list[Fit]) -> list[Fit]:
        """Look again on what the last fit leaves, until nothing is left or nothing passes."""
        while len(chain) < MOST_EFFECTS and unfinished(chain[-1], self.base):
            found = self._look(chain[-1])
            if found.stopped or not found.fits or not adds(found, found.fits[0]):
                break
            if chance(found, found.fits[0], len(self.candidates)) > limit.SIGNIFICANT:
                break
            chain.append(found.fits[0])
        return chain

    def _pair(self, first: Round) -> list[Fit]:
        """Return the two fits of a pair of effects that passes; where one force leaves noise, only a tyre and its suspension can be two."""
        tried = seeds(first)[:1] if suffices(first.passed, self.base) else seeds(first)
        for seed in tried:
            found = self._look(seed)
            if found.stopped:
                break
            if found.fits and passes(found.fits[0], self.base) and adds(found, found.fits[0]) and needs_both(found.fits[0], first.fits):
                return self._further([seed, found.fits[0]])
        return []

    def _gap(self, fit: Fit | None = None) -> Gap:
        last = fit or self.base
        return Gap(self.base.chi, last.chi, 1.0, _runs(self.base, last, self.detection.held_out))

    def _places(self) -> tuple[tuple[str, float], ...]:
        first = self.rounds[0]
        return tuple((item.place.label, item.chi) for item in (first.passed or first.places)[:5])

    def _end(self, verdict: VerdictName, reason: str, next_experiment: str | None = None, fit: Fit | None = None) -> Diagnosis:
        places = self._places() if self.rounds else ()
        found = Verdict(verdict, reason, (), self._gap(fit), places, next_experiment=next_experiment, notes=tuple(self.notes))
        return Diagnosis(self.detection.trials, self.detection, tuple(self.rounds), (), found)

    def _stopped(self, found: Round) -> Diagnosis:
        done = f"{len(found.fits)} candidates" if found.fits else "no candidate"
        best = f"; the best so far is {found.fits[0].label}, chi {np.sqrt(found.fits[0].train):.2f}" if found.fits else ""
        ended = self._end("insufficient_data", f"stopped by hand after {done}{best}", "let the diagnosis run to its end")
        return replace(ended, stopped=True)

    def _unknown(self, first: Round) -> Diagnosis:
        best = first.fits[0]
        where = sentence([item.place.label for item in first.passed[:3]]) if first.passed else "no single place"
        left = f"chi {np.sqrt(best.train):.2f} ({np.sqrt(best.held_out):.2f} untouched)"
        reason = f"the best of {len(first.fits)} candidates, {best.label}, leaves {left}; the residual wants an unknown force at {where}"
        shown = strongest(first.passed)
        law = None if shown is None else fit_free_form(recover(self.detection, shown))
        ended = self._end("not_in_library", reason, fit=best)
        if law is None:
            return ended
        verdict = replace(ended.verdict, free_form=law.to_dict(), notes=(*ended.verdict.notes, law.describe()))
        return replace(ended, verdict=verdict, law=law)

    def _name(self, chain: list[Fit]) -> Diagnosis:
        last = chain[-1]
        steps = [next(item for item in self.rounds if fit in item.fits) for fit in chain]
        alternatives = [tied(step, fit) for step, fit in zip(steps, chain, strict=True)]
        effects = [
            self._effect(step, last, i, [item.last.label for item in others])
            for i, (step, others) in enumerate(zip(steps, alternatives, strict=True))
        ]
        ties = alternatives[0] if len(chain) == 1 else [item for others in alternatives for item in others]
        if len(chain) == 1:
            effects += [self._effect(steps[0], item, 0, []) for item in ties[:2]]
        names = [item.label for item in (chain[0], *ties)] if len(chain) == 1 else [last.label]
        closed = 100 * held_out_gain(self.base, last)
        reason = f"{last.label} close{'s' if len(chain) == 1 else ''} {closed:.1f} % of the excess on untouched runs"
        if ties and len(chain) == 1:
            reason = f"{sentence(names)} explain the runs equally well"
        elif ties:
            reason += f", and so {'does' if len(ties) == 1 else 'do'} {sentence([item.last.label for item in ties])}"
        verdict = Verdict(
            "ambiguous" if ties else "named",
            reason,
            tuple(effects),
            self._gap(last),
            self._places(),
            next_experiment=self._apart(chain, ties) if ties else None,
            notes=self._notes(last),
        )
        return Diagnosis(
            self.detection.trials, self.detection, tuple(self.rounds), tuple(chain), verdict, any(item.stopped for item in self.rounds)
        )

    def _apart(self, chain: list[Fit], ties: list[Fit]) -> str | None:
        """Return which run would tell tied models apart, by what each predicts."""
        self.tell("propose", 0, 1, "")
        found = propose(self.detection, (chain[-1], *ties))
        return found.text if found else None

    def _effect(self, step: Round, fit: Fit, number: int, others: list[str]) -> NamedEffect:
        """Return the effect `number` of a fit, judged by what it closed in its own round."""
        own = next((item for item in step.fits if item.effects == fit.effects[: number + 1]), fit)
        candidate = fit.effects[number]
        untouched = [trial.name for trial in self.detection.held_out]
        return NamedEffect(
            candidate.effect.name,
            candidate.place,
            estimate(fit, candidate),
            chance(step, own, len(self.candidates)),
            held_out_gain(step.footing, own),
            gain_interval(step.footing, own, untouched),
            tuple(others),
        )

    def _notes(self, fit: Fit) -> tuple[str, ...]:
        told = list(self.notes)
        for candidate in fit.effects:
            told += [f"{candidate.label}: {text}" for text in unstable(fit, candidate)]
        if fit.polished.on_bound:
            told.append(f"on the bound of its range: {', '.join(fit.polished.on_bound)}")
        left = excess(fit.train)
        if left > limit.AGAIN**2 - 1:
            told.append(f"chi {np.sqrt(1 + left):.2f} is left unexplained")
        return tuple(told)


def _runs(base: Fit, fit: Fit, held_out: Sequence[Trial]) -> tuple[dict[str, object], ...]:
    later = {trial.name for trial in held_out}
    return tuple(
        {
            "run": item,
            "untouched": item in later,
            "before": float(np.sqrt(base.runs[item])),
            "after": float(np.sqrt(fit.runs.get(item, base.runs[item]))),
        }
        for item in base.runs
    )


__all__ = ["Detection", "Diagnosis", "detect", "diagnose", "localise", "look", "shortlist", "split_runs"]
