"""Effects too faint for chi: found by what they take off -2 ln of the likelihood, of the training runs and of validation runs.

A fall of some hundreds is far beyond chance, but spread over thousands of lines it is a few hundredths of chi, which noise that was told a
little too large hides. Here laws are ranked, and held against one another and against random laws, by how far they let -2 ln L fall.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from vehgen.diagnose import thresholds as limit
from vehgen.diagnose.detect.detection import Detection, look_again
from vehgen.diagnose.fits.candidate import Candidate, has_room
from vehgen.diagnose.fits.model_fit import ModelFit
from vehgen.diagnose.fits.screening import MOST_BEHIND, hides_behind, shaking_in_earnest
from vehgen.diagnose.localise.localisation import localise_at
from vehgen.diagnose.select.criteria import fall, falls_as_far, is_told
from vehgen.diagnose.select.fitter import Fitter
from vehgen.diagnose.select.freed_base import fitted_freed
from vehgen.diagnose.select.placebo_laws import like_a_placebo_law
from vehgen.diagnose.select.ranking import SearchRound, goes_before, merit
from vehgen.diagnose.select.reaching_runs import with_checking_run
from vehgen.diagnose.select.search import LOOKS_AGAIN, fit_leading_again
from vehgen.diagnose.select.validation import surely_falls, validation_fall
from vehgen.effects.kinds import ShakingEffect
from vehgen.fit.parallel import HERE, Runner

FIRST_ORDER, MOST_LAWS, MOST_OTHERS = 60.0, 4, 3
"""Laws of the vehicle are fitted that gain so much to the first order, and so many of them at most, the largest gains first; then so many
of other kinds, each at its best place, as the first ones may all be one law at several places ..."""
FIRST_ORDER_OF_ERRORS, MOST_ERRORS = 25.0, 4
"""... and errors of all runs or of a sensor, of which the base's own errors take in the most."""

Begun = tuple[Candidate, tuple[float, ...]]
"""A candidate, and the numbers at which its fit begins."""


def faint_round(detection: Detection, candidates: Sequence[Candidate], runner: Runner = HERE) -> SearchRound:
    """Fit the candidates that gain most to the first order beside the base; return them, largest fall first.

    Fitted, too, are laws of tyres that the base may hide: an unsprung mass, or a tyre's stiffness, at its bound does part of what
    these do, so that they gain nothing to the first order. As little is missing, fits begin where the base's ended, with numbers as
    the first order has them, all motions at once.
    """
    base = detection.base
    fitter = Fitter(detection, base, ())
    gains = fitter.first_order_gains()
    ranked = [(*gains.of(item), item) for item in shaking_in_earnest(candidates, gains) if has_room(item, fitter.locator)]
    ranked.sort(key=lambda known: -known[0])
    laws = [(item, begin) for gain, begin, item in ranked if item.effect.changes_vehicle and gain > FIRST_ORDER]
    held = set(base.least_squares.on_bound)
    behind = [(item, begin) for gain, begin, item in ranked if gain <= FIRST_ORDER and hides_behind(item, held, fitter.locator.vehicle)]
    errors = [(item, begin) for gain, begin, item in ranked if not item.effect.changes_vehicle and gain > FIRST_ORDER_OF_ERRORS]
    fits = list(fitter.fit_all_begun([*_of_many_kinds(laws), *behind[:MOST_BEHIND], *errors[:MOST_ERRORS]], runner))
    found = SearchRound(base, (), (), (), faint=True)
    clear = [fit for fit in fits if fall(found, fit) >= limit.FAINT_FALL]
    checked = {id(fit): fitter.fit_again(fit) for fit in clear if not np.isfinite(fit.validation)}
    fits = sorted((checked.get(id(fit), fit) for fit in fits), key=merit)
    return replace(found, fits=tuple(_likeliest_first(found, fits)))


def _of_many_kinds(ranked: Sequence[Begun]) -> list[Begun]:
    """Return the first MOST_LAWS laws, and of those after them the first of each other kind, MOST_OTHERS of these at most."""
    chosen = list(ranked[:MOST_LAWS])
    kinds = {item.effect.name for item, _ in chosen}
    others: dict[str, Begun] = {}
    for known in ranked[MOST_LAWS:]:
        others.setdefault(known[0].effect.name, known)
    return [*chosen, *[known for name, known in others.items() if name not in kinds][:MOST_OTHERS]]


def faint_look_again(found: SearchRound, detection: Detection, runner: Runner = HERE) -> tuple[SearchRound, Detection]:
    """Return a round with noise and recorders as its best fit tells them, and what is detected then; both as they are where none is clear.

    What is missing passes in part for roughness of the road, by which noise is told too large for chi to show a gap.
    """
    for _ in range(LOOKS_AGAIN):
        best = next(iter(found.fits), None)
        if best is None or not _falls(found, best) or (again := look_again(detection, best)) is None:
            break
        found, detection = _beside(again, found, runner), again
    return found, detection


def faint_exchange(found: SearchRound, detection: Detection, runner: Runner = HERE) -> tuple[SearchRound, Detection] | None:
    """Return a round and a detection that check its best fit on the training run that shows it most; None where there is none to check.

    Friction that holds an axle all through the gentle run that was kept for checking cannot be seen there. That run is fitted instead, if
    it does not speak against the fit, and the effect has to be found in the others anew, and in the run that is now kept.
    Fits that fell too little to be checked at all are left out.
    """
    best = next(iter(found.fits), None)
    if best is None or not best.last.effect.changes_vehicle:
        return None
    if fall(found, best) < limit.FAINT_FALL or validation_fall(found.current, best) < 0:
        return None
    exchanged = with_checking_run(detection, best)
    if exchanged is None:
        return None
    checked = [fit for fit in found.fits if np.isfinite(fit.validation) and fall(found, fit) > 0]
    return _again(exchanged, found, Fitter(exchanged, exchanged.base, ()).fit_all_again(checked, runner)), exchanged


def _beside(detection: Detection, found: SearchRound, runner: Runner) -> SearchRound:
    """Return a round's fits made again, from where they are, beside another detection's base."""
    return _again(detection, found, fit_leading_again(Fitter(detection, detection.base, ()), found.fits, weigh=True, runner=runner))


def _again(detection: Detection, found: SearchRound, fits: Sequence[ModelFit]) -> SearchRound:
    """Return a round of fits that were made again beside a detection's base."""
    found = replace(found, current=detection.base)
    return replace(found, fits=tuple(_likeliest_first(found, sorted(fits, key=merit))))


def faintly_told(found: SearchRound, detection: Detection) -> ModelFit | None:
    """Return the best fit of a round if the recordings ask for its effect; None where they do not.

    -2 ln L falls by FAINT_FALL on the training runs, beyond the price of its numbers, and by FAINT_VALIDATION on the validation runs, on
    which the squares surely fall unless it is of a few lines; not by what its freed base parameters alone do, nor as with one of many
    random laws at its place. The runs tell its size, and it leaves noise, with no parameter at a bound.
    """
    best = next(iter(found.fits), None)
    runs = [trial.name for trial in detection.validation_runs]
    if best is None or not _falls(found, best) or not is_told(best):
        return None
    of_lines = isinstance(best.last.effect, ShakingEffect)  # what it takes off lies in few lines, of which a draw may miss all
    if not (of_lines or surely_falls(found.current, best, runs)):
        return None
    if _ends_at_a_bound(best) or not replace(detection, base=best).is_quiet or not _beats_freed_base(found, best, detection):
        return None
    places = localise_at(found.current, best.last.place)
    return None if like_a_placebo_law(places, found.current, best) else best


def _falls(found: SearchRound, fit: ModelFit) -> bool:
    return fall(found, fit) >= limit.FAINT_FALL and validation_fall(found.current, fit) >= limit.FAINT_VALIDATION


def _likeliest_first(found: SearchRound, fits: Sequence[ModelFit]) -> list[ModelFit]:
    """Return fits in their order, but first one that falls as far as the best: its special case, or within bounds where that is at one."""
    for fit in fits[1:]:
        likelier = goes_before(fit, fits[0], _ends_at_a_bound(fit), _ends_at_a_bound(fits[0]))
        if likelier and falls_as_far(found, fit, fits[0]):
            return [fit, *(item for item in fits if item is not fit)]
    return list(fits)


def _ends_at_a_bound(fit: ModelFit) -> bool:
    """Return whether a parameter, or a number of an error, is at the end of its range."""
    return bool(fit.least_squares.on_bound or fit.least_squares.adjusted_to_bounds)


def _beats_freed_base(found: SearchRound, best: ModelFit, detection: Detection) -> bool:
    """Return whether an effect does more than the base parameters that it frees, and those at the edge of their bounds."""
    names = tuple(dict.fromkeys((*best.last.freed, *found.current.least_squares.on_bound)))
    freed = fitted_freed(names, Fitter(detection, found.current, ()).fit_at_once) if names else None
    return freed is None or merit(freed) - merit(best) >= limit.FAINT_FALL
