"""Stage 3, name: fit the candidates together with the base parameters, and rank them."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from vehgen.diagnose import thresholds as limit
from vehgen.diagnose.detect.detection import Detection, look_again
from vehgen.diagnose.fits.candidate import Candidate, has_room
from vehgen.diagnose.fits.model_fit import ModelFit
from vehgen.diagnose.fits.screening import screen, shaking_in_earnest
from vehgen.diagnose.localise.localisation import localise, none_explains, owner, shortlist
from vehgen.diagnose.localise.unknown_force import PlaceResult
from vehgen.diagnose.select.criteria import passes
from vehgen.diagnose.select.early_end import MOST_AT_ONCE, settle
from vehgen.diagnose.select.fitter import Fitter
from vehgen.diagnose.select.freed_base import split_idle
from vehgen.diagnose.select.ranking import SearchRound, does_as_well, merit, simplest_first
from vehgen.fit.parallel import HERE, Runner

DiagnosisProgress = Callable[[str, int, int, str], None]
"""Called with the stage, how many of how many, and the best so far."""
LOOKS_AGAIN = 2
"""So often at most are noise and recorders found anew from the best fit."""
LOOKED_AT_AGAIN = 4
"""So many candidates are fitted again, from where they are, when recorder or noise turn out to be others."""
CONTENDER = 1.5
"""Beside those a candidate is fitted again that leaves less than so many times the mean square of the best."""
LEADING = 3
"""So many of the best fits are settled, where their response jumps ..."""
MAY_STILL_WIN = 2.0
"""... and which leave less than so many times the mean square of the best."""


def search_round(
    detection: Detection,
    current: ModelFit,
    candidates: Sequence[Candidate],
    everything: bool = False,
    progress: DiagnosisProgress | None = None,
    runner: Runner = HERE,
) -> SearchRound:
    """Test the places on what a fit leaves, then fit the candidates that may live there; both wherever `runner` works."""
    beside = f" beside {current.label}" if current.effects else ""

    def say(stage: str, done: int, total: int, best: str) -> None:
        if progress is not None:
            progress(stage + beside, done, total, best)

    say("localise", 0, 1, "")
    try:
        places, passed = localise(current, runner)
    except KeyboardInterrupt:
        return SearchRound(current, (), (), (), (), True)
    say("localise", 1, 1, passed[0].place.label if passed else "no single place")
    others = [item for item in candidates if not item.is_among(current.effects)]
    chosen = others if everything else shortlist(current, others, places, passed)
    alike = {item.effect.name for item in chosen if item.effect.tie_advice}  # no run tells where: all places are fitted
    chosen = [item for item in others if item in chosen or item.effect.name in alike]
    found, stopped = fit_candidates(detection, current, passed, chosen, say, everything, runner, _strained_place(current, places))
    rest = [item for item in others if item not in chosen]
    if rest and not stopped and none_explains(passed) and _leave_most(found, current):
        wider, stopped = fit_candidates(detection, current, passed, rest, say, everything, runner)
        found = simplest_first(sorted([*found, *wider], key=merit), current)
    if not stopped and (missed := _screened_out(chosen, found, current)):
        more, stopped = fit_candidates(detection, current, passed, missed, say, True, runner)
        found = simplest_first(sorted([*found, *more], key=merit), current)
    edge = () if current.effects else current.least_squares.on_bound
    fitter = Fitter(detection, current, passed)
    fits, idle = (found, []) if stopped else split_idle(found, fitter.fit_roughly, LEADING, edge, fitter.fit_without)
    return SearchRound(current, tuple(places), tuple(passed), tuple(fits), tuple(idle), stopped)


def _screened_out(chosen: Sequence[Candidate], fits: Sequence[ModelFit], current: ModelFit) -> list[Candidate]:
    """Return candidates that were not fitted, where no fit leaves what could be named beside a base that ends at its bounds.

    First orders about such a base mislead: a spring that hardens, which leaves noise where the base has chi 7, was not among the first 14.
    """
    if current.effects or not current.least_squares.on_bound or min((fit.training for fit in fits), default=np.inf) <= limit.NAMED_LEFT**2:
        return []
    return [item for item in chosen if not item.is_among([fit.last for fit in fits])]


def _strained_place(current: ModelFit, places: Sequence[PlaceResult]) -> str:
    """Return where one force explains a gap best, if the fit of the base ends at its bounds: first orders about such a fit mislead.

    A spring that hardens was left out for what its absence had made of the other parameters.
    """
    single = [item for item in places if item.place.rows and item.unknowns == 1 and item.place.kind != "body"]
    if current.effects or not current.least_squares.on_bound or not single:
        return ""
    return owner(min(single, key=lambda item: item.chi).place)


def _leave_most(fits: Sequence[ModelFit], current: ModelFit) -> bool:
    """Return whether no fit closes half of a gap: what channels may explain, none of their effects does."""
    return min((fit.training for fit in fits), default=np.inf) - 1 > (current.training - 1) / 2


def fit_candidates(
    detection: Detection,
    base: ModelFit,
    passed: Sequence[PlaceResult],
    candidates: Sequence[Candidate],
    progress: DiagnosisProgress,
    everything: bool = False,
    runner: Runner = HERE,
    kept_at: str = "",
) -> tuple[list[ModelFit], bool]:
    """Fit every candidate on top of a fit; return the fits, best first, and whether Ctrl-C ended this early.

    Unless `everything` is to be tried, those that are likeliest to the first order are tried first, and where one of them settles the gap
    only its rivals beside it; else the candidates are screened, but for those at the place `kept_at`.
    """
    fitter = Fitter(detection, base, passed)
    fits: list[ModelFit] = []
    candidates = [item for item in candidates if has_room(item, fitter.locator)]

    def add(fit: ModelFit) -> None:
        fits.append(fit)
        progress("screen", len(fits), MOST_AT_ONCE + 1, fit.label)

    try:
        if not everything:
            progress("screen", 0, 1, "")
            gains = fitter.first_order_gains()
            candidates = shaking_in_earnest(candidates, gains)
            if not base.effects:
                candidates = settle(fitter, gains, candidates, add, runner, kept_at)
            candidates = screen(candidates, gains, kept_at, fitter.nowhere)
            progress("screen", 1, 1, f"{len(candidates)} candidates")
        for slow_first in (True, False):
            chosen = [item for item in candidates if slow_first or (fitter.laid is not None and item.effect.shows_in_slow_motions)]
            for done, fit in enumerate(fitter.fit_all(chosen, runner, slow_first), start=1):
                fits += [] if fit is None else [fit]
                best = min(fits, key=merit, default=base)
                progress("name", done, len(chosen), f"{best.label}, chi {np.sqrt(best.training):.3f}")
            if any(np.isfinite(fit.validation) and fit.training < limit.NAMED_LEFT**2 for fit in fits):
                again = _stuck(fits, base) if slow_first else []
                fits += [fit for fit in fitter.fit_all(again, runner, slow_first=False) if fit is not None]
                break
        nested = [fitter.fit_within(item, min(fits, key=merit)) for item in _missed_special_cases(fits, base)]
        fits += [fit for fit in nested if fit is not None]
        fits = simplest_first(sorted(_best_of_each(fits), key=merit), base)
        for numbers in (range(1), range(1, LEADING)):  # the best first: who may still win is judged by where it ends
            contenders = [i for i in numbers if i < len(fits) and _may_still_win(fits[i], fits[0])]
            for i, fit in zip(contenders, fitter.restart_all([fits[i] for i in contenders], runner), strict=True):
                fits[i] = fit
    except KeyboardInterrupt:
        return simplest_first(_best_of_each(fits), base), True
    return simplest_first(sorted(fits, key=merit), base), False


def _may_still_win(fit: ModelFit, best: ModelFit) -> bool:
    """Return whether a fit is near enough to the best one to be sought a lower minimum for."""
    near = fit.training <= MAY_STILL_WIN * best.training and not fit.last.holds(best.last)
    return near and bool(np.isfinite(fit.validation))


def _stuck(fits: Sequence[ModelFit], base: ModelFit) -> list[Candidate]:
    """Return candidates that were missed, not refuted, at the place of a best fit that takes base parameters to their bounds.

    Such a fit may stand in for another law there, as relaxation does for a damper's mount. Missed are those that left more than the model
    without them, and those that set free what is at its bound and were left after rough fits.
    """
    best = min(fits, key=merit)
    bounds = set(best.least_squares.on_bound)
    beside = [fit for fit in fits if bounds and fit.last.place == best.last.place and fit.last.effect.shows_in_slow_motions]
    return [
        fit.last
        for fit in beside
        if fit.training > base.training or (not np.isfinite(fit.validation) and not bounds.isdisjoint(fit.last.freed))
    ]


def _missed_special_cases(fits: Sequence[ModelFit], base: ModelFit) -> list[Candidate]:
    """Return special cases of the best fit's effect whose own fits do worse, perhaps in another minimum, or were not refined."""
    if not fits:
        return []
    best, before = min(fits, key=merit), max(base.training - 1, 0.0)
    others = [fit for fit in fits if best.last.holds(fit.last)]
    return [fit.last for fit in others if not (np.isfinite(fit.validation) and does_as_well(fit.training, best.training, before))]


def _best_of_each(fits: Sequence[ModelFit]) -> list[ModelFit]:
    """Return the best fit of every candidate."""
    best: dict[tuple[tuple[str, str], ...], ModelFit] = {}
    for fit in sorted(fits, key=merit):
        best.setdefault(fit.key, fit)
    return list(best.values())


def fit_leading_again(fitter: Fitter, fits: Sequence[ModelFit], weigh: bool, runner: Runner = HERE) -> tuple[ModelFit, ...]:
    """Return fits of first effects, the leading ones fitted again from where they are.

    Where noise is much less than they were ranked by (`weigh`), or another recorder lets through another band, all are weighed by what is
    known now, and contenders fitted again, too.
    """
    weigh = weigh or any(fit.least_squares.misfit.band != fitter.detection.band for fit in fits)
    leading = [fit for fit in fits[:LOOKED_AT_AGAIN] if np.isfinite(fit.validation) and fit.training <= MAY_STILL_WIN * fits[0].training]
    rest = [fit for fit in fits if all(fit is not other for other in leading)]
    found = fitter.fit_all_again(leading, runner)
    if weigh and found:
        near = CONTENDER * min(fit.training for fit in found)
        weighed = [(fitter.weigh_again(fit), fit) for fit in rest]
        contenders = [fit for own, fit in weighed if own.training <= near and fitter.has_all_runs(fit)]
        found += fitter.fit_all_again(contenders, runner)
        rest = [own for own, fit in weighed if all(fit is not other for other in contenders)]
    return tuple(simplest_first([*sorted(found, key=merit), *(sorted(rest, key=merit) if weigh else rest)], fitter.detection.base))


def noise_by_its_law(detection: Detection, first: SearchRound) -> Detection | None:
    """Return a detection whose noise is told with the law that a gap's place asks for; None where that law does not close the gap then.

    A rough road shakes a vehicle that sticks otherwise than a linear one: by the noise of that, the right law may leave most of a gap.
    """
    places = {owner(item.place) for item in first.passed if item.place.rows and item.unknowns == 1}
    if not first.fits or first.fits[0].last.place not in places:
        return None
    fitter = Fitter(detection, first.current, first.passed, hopeless=np.inf)
    fit, found = fitter.fit(first.fits[0].last), detection
    if fit is None or not any(trial.jumps for trial in fit.least_squares.misfit.problem.trials):
        return None
    for _ in range(LOOKS_AGAIN):
        if (again := look_again(found, fit)) is None:
            break
        found = again
        fit = Fitter(found, found.base, ()).fit_again(fit)
    return found if passes(fit, found.base) else None
