"""What else an earlier effect could be, once the later ones stand beside it.

Of several effects the first is chosen while the others are still missing: what tells it from its rivals then may be what is missing. Each
rival is fitted anew, with the later effects beside it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from vehgen.diagnose.detect.detection import Detection
from vehgen.diagnose.fits.candidate import Candidate
from vehgen.diagnose.fits.model_fit import ModelFit
from vehgen.diagnose.select.criteria import excess, same
from vehgen.diagnose.select.estimates import fitted_numbers
from vehgen.diagnose.select.fitter import Fitter
from vehgen.diagnose.select.ranking import SearchRound, does_as_well

RIVALS = 4
"""So many rivals of an effect are tried beside the later ones."""


@dataclass(frozen=True)
class Alternative:
    """A candidate that does as well in the place of an effect: `fit` holds all effects, with it in that place."""

    instead_of: Candidate
    candidate: Candidate
    fit: ModelFit


def alternatives_beside(detection: Detection, step: SearchRound, fit: ModelFit, number: int) -> list[Alternative]:
    """Return what does as well in the place of an effect, beside those that were found after it.

    Parameters
    ----------
    detection
        What was detected.
    step
        The round in which the effect was found.
    fit
        The fit of all effects.
    number
        Which of its effects.
    """
    chosen, later = fit.effects[number], fit.effects[number + 1 :]
    without = refit_later(detection, step.current, later, fit)
    if not without:
        return []
    before = excess(without[-1].training)
    found = []
    for rival in _rivals(step, chosen, later):
        both = refit_later(detection, rival, later, fit)
        if both and does_as_well(both[-1].training, fit.training, before):
            found.append(Alternative(chosen, rival.last, both[-1]))
    return found


def _rivals(step: SearchRound, chosen: Candidate, later: Sequence[Candidate]) -> list[ModelFit]:
    """Return the rivals that come nearest in an effect's round: first those that no run tells from it, then by rank."""
    others = [item for item in step.fits if not item.last.is_among((chosen, *later)) and not same(item.last, chosen)]
    alike = [item for item in others if chosen.effect.tie_advice and item.last.effect.tie_advice == chosen.effect.tie_advice]
    return [*alike, *(item for item in others if item not in alike)][:RIVALS]


def refit_later(detection: Detection, base: ModelFit, later: Sequence[Candidate], whole: ModelFit, checked: bool = False) -> list[ModelFit]:
    """Return fits that add the later effects of a whole fit to another base, one by one, begun where they are there.

    Unless they are `checked`, not on the validation runs. Nothing is returned where an effect cannot live on that base.
    """
    found: list[ModelFit] = []
    for candidate in later:
        current = found[-1] if found else base
        trials = current.least_squares.misfit.problem.trials
        if candidate.place not in candidate.effect.places(trials[0].run.vehicle, trials):
            return []
        fit = Fitter(detection, current, ()).fit(candidate, [fitted_numbers(whole, candidate)], checked=checked)
        if fit is None:
            return []
        found.append(fit)
    return found
