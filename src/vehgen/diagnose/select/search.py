"""Stage 3, name: fit the candidates together with the base parameters, and rank them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from vehgen.codegen import compile_all
from vehgen.diagnose import thresholds as limit
from vehgen.diagnose.detect.detection import Detection
from vehgen.diagnose.fits.candidate import Candidate, build_problem, has_room
from vehgen.diagnose.fits.model_fit import CurrentModel, ModelFit, as_fine, evaluate_fit, refine
from vehgen.diagnose.fits.multi_start import fit_candidate
from vehgen.diagnose.fits.occurring import occurring
from vehgen.diagnose.fits.released import release
from vehgen.diagnose.fits.restarts import restart
from vehgen.diagnose.fits.screening import screen
from vehgen.diagnose.localise.localisation import localise, one_force, shortlist
from vehgen.diagnose.localise.unknown_force import PlaceResult
from vehgen.diagnose.select.freed_base import split_idle
from vehgen.diagnose.select.special_cases import does_as_well, simplest_first
from vehgen.effects import EffectLocator
from vehgen.effects.evidence import Origins, Residual, StartingPoint
from vehgen.fit.alignment import align
from vehgen.fit.misfit import Misfit
from vehgen.simulate import SimulatorPool

Array = NDArray[np.float64]
DiagnosisProgress = Callable[[str, int, int, str], None]
"""Called with the stage, how many of how many, and the best so far."""
LOOKED_AT_AGAIN = 4
"""So many candidates are fitted again, from where they are, when recorder or noise turn out to be others."""
CONTENDER = 1.5
"""Beside those a candidate is fitted again that leaves less than so many times the mean square of the best."""
LEADING = 3
"""So many of the best fits are settled, where their response jumps ..."""
MAY_STILL_WIN = 2.0
"""... and which leave less than so many times the mean square of the best."""


@dataclass(frozen=True)
class SearchRound:
    """One search for one effect: what the `current` model leaves, the places tested and passed, and the candidates fitted, best first.

    `idle` are fits of freed base parameters alone that do as well as an effect whose fit freed them, and which is left out. `stopped` tells
    that Ctrl-C ended it before all candidates were fitted.
    """

    current: ModelFit
    places: tuple[PlaceResult, ...]
    passed: tuple[PlaceResult, ...]
    fits: tuple[ModelFit, ...]
    idle: tuple[ModelFit, ...] = ()
    stopped: bool = False


def search_round(
    detection: Detection,
    current: ModelFit,
    candidates: Sequence[Candidate],
    everything: bool = False,
    progress: DiagnosisProgress | None = None,
    workers: int = 1,
) -> SearchRound:
    """Test the places on what a fit leaves, then fit the candidates that may live there; `workers` processes compile their kernels."""
    beside = f" beside {current.label}" if current.effects else ""

    def say(stage: str, done: int, total: int, best: str) -> None:
        if progress is not None:
            progress(stage + beside, done, total, best)

    say("localise", 0, 1, "")
    try:
        places, passed = localise(current)
    except KeyboardInterrupt:
        return SearchRound(current, (), (), (), (), True)
    say("localise", 1, 1, passed[0].place.label if passed else "no single place")
    others = [item for item in candidates if not item.is_among(current.effects)]
    chosen = others if everything else shortlist(current, others, places, passed)
    alike = {item.effect.name for item in chosen if item.effect.tie_advice}  # no run tells where: all places are fitted
    chosen = [item for item in others if item in chosen or item.effect.name in alike]
    found, stopped = fit_candidates(detection, current, passed, chosen, say, everything, workers)
    rest = [item for item in others if item not in chosen]
    if rest and not stopped and not any(item.place.rows for item in passed) and _leave_most(found, current):
        wider, stopped = fit_candidates(detection, current, passed, rest, say, everything, workers)
        found = simplest_first(sorted([*found, *wider], key=merit), current)
    edge = () if current.effects else current.least_squares.on_bound
    fits, idle = (found, []) if stopped else split_idle(found, Fitter(detection, current, passed).fit_roughly, LEADING, edge)
    return SearchRound(current, tuple(places), tuple(passed), tuple(fits), tuple(idle), stopped)


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
    workers: int = 1,
) -> tuple[list[ModelFit], bool]:
    """Fit every candidate on top of a fit; return the fits, best first, and whether Ctrl-C ended this early.

    The candidates are screened first, unless `everything` is to be tried.
    """
    fitter = Fitter(detection, base, passed)
    current, locator, simulators = fitter.current, fitter.locator, fitter.simulators
    fits: list[ModelFit] = []
    candidates = [item for item in candidates if has_room(item, locator)]
    try:
        if not everything:
            progress("screen", 0, 1, "")
            candidates = screen(candidates, base, current, locator, simulators)
            progress("screen", 1, 1, f"{len(candidates)} candidates")
        if workers > 1:
            progress("compile", 0, 1, "")
            problems = [build_problem(item, current.problem, locator, simulators) for item in candidates if item.effect.changes_vehicle]
            compile_all([trial.simulator.kernel for problem in problems for trial in problem.trials], workers)
            progress("compile", 1, 1, f"{len(problems)} vehicles")
        for slow_first in (True, False):
            for done, candidate in enumerate(candidates, start=1):
                if slow_first or (fitter.laid is not None and candidate.effect.shows_in_slow_motions):
                    fit = fitter.fit(candidate, slow_first=slow_first)
                    fits += [] if fit is None else [fit]
                best = min(fits, key=merit, default=base)
                progress("name", done, len(candidates), f"{best.label}, chi {np.sqrt(best.training):.3f}")
            if any(np.isfinite(fit.validation) and fit.training < limit.NAMED_LEFT**2 for fit in fits):
                again = [fitter.fit(item, slow_first=False) for item in (_stuck(fits, base) if slow_first else ())]
                fits += [fit for fit in again if fit is not None]
                break
        nested = [fitter.fit_within(item, min(fits, key=merit)) for item in _missed_special_cases(fits, base)]
        fits += [fit for fit in nested if fit is not None]
        fits = simplest_first(sorted(_best_of_each(fits), key=merit), base)
        for i, fit in enumerate(fits[:LEADING]):
            near = fit.training <= MAY_STILL_WIN * fits[0].training and not fit.last.holds(fits[0].last)
            if np.isfinite(fit.validation) and near:
                fits[i] = restart(fit, detection.validation_runs, detection.floor.noises)
    except KeyboardInterrupt:
        return simplest_first(sorted(fits, key=merit), base), True
    return simplest_first(sorted(fits, key=merit), base), False


def _stuck(fits: Sequence[ModelFit], base: ModelFit) -> list[Candidate]:
    """Return candidates that were missed, not refuted: they left more than the model without them, at the place of a best fit at a bound.

    A best fit that ends at a bound of the base parameters may stand in for another law there, as relaxation does for a damper's mount.
    """
    best = min(fits, key=merit)
    if not best.least_squares.on_bound:
        return []
    missed = [fit.last for fit in fits if fit.training > base.training and fit.last.place == best.last.place]
    return [item for item in missed if item.effect.shows_in_slow_motions]


def _missed_special_cases(fits: Sequence[ModelFit], base: ModelFit) -> list[Candidate]:
    """Return special cases of the best fit's effect whose own fits do worse: perhaps in another minimum, of which friction makes many."""
    if not fits:
        return []
    best, before = min(fits, key=merit), max(base.training - 1, 0.0)
    others = [fit for fit in fits if best.last.holds(fit.last)]
    return [fit.last for fit in others if not does_as_well(fit.training, best.training, before)]


def _best_of_each(fits: Sequence[ModelFit]) -> list[ModelFit]:
    """Return the best fit of every candidate."""
    best: dict[tuple[tuple[str, str], ...], ModelFit] = {}
    for fit in sorted(fits, key=merit):
        best.setdefault(fit.key, fit)
    return list(best.values())


class Fitter:
    """Fits candidates on top of a fit; `passed` are the places that suffice to explain what it leaves."""

    def __init__(self, detection: Detection, base: ModelFit, passed: Sequence[PlaceResult]) -> None:
        self.detection, self.current, self.simulators = detection, CurrentModel.of(base), SimulatorPool()
        trial = self.current.problem.trials[0]
        self.locator = EffectLocator(trial.run.vehicle, dict(trial.values), occurring(base))
        self.origins = _origins(base, self.current, passed)
        self.residual = Residual(base.least_squares.misfit, base.least_squares.x)
        space = self.current.problem.space
        self.laid = None if base.effects else align(base.least_squares.misfit, space.unit(space.start), bands=())

    def fit(
        self, candidate: Candidate, begin: Sequence[tuple[float, ...]] = (), checked: bool = True, slow_first: bool = True
    ) -> ModelFit | None:
        """Fit one candidate from its own starts and from others; unless it is `checked`, not on the validation runs.

        The errors of runs begin anew in fits of a first effect: those of the base have bent to what is missing.
        Unless `slow_first`, all motions are fitted at once, from where the base's fit and the place test ended.
        """
        starts = [*begin, *candidate.effect.starts(candidate.place, self.locator, self.residual)]
        laid = self.laid if slow_first and candidate.effect.shows_in_slow_motions else None
        return self._fit(candidate, candidate.effect.origins(self.origins), starts, checked, laid, slow_first)

    def fit_within(self, candidate: Candidate, general: ModelFit) -> ModelFit | None:
        """Fit a special case of the last effect of a fit, all motions at once, from where that fit ended."""
        found, space = general.least_squares, self.current.problem.space
        known = dict(zip((item.name for item in general.last.effect.parameters), found.values[space.size :], strict=True))
        usual = candidate.effect.starts(candidate.place, self.locator, self.residual)[0]
        numbers = tuple(float(known.get(item.name, first)) for item, first in zip(candidate.effect.parameters, usual, strict=True))
        begin = space.unit(found.values[: space.size]), found.misfit.split(found.x)[1]
        return self._fit(candidate, [begin], [numbers], True, None, False)

    def _fit(
        self,
        candidate: Candidate,
        origins: Sequence[StartingPoint],
        starts: Sequence[tuple[float, ...]],
        checked: bool,
        laid: Array | None,
        slow_first: bool,
    ) -> ModelFit | None:
        runs, noises = self.detection.validation_runs if checked else (), self.detection.floor.noises
        return fit_candidate(
            candidate,
            self.current,
            runs,
            noises,
            self.detection.band,
            self.locator,
            self.simulators,
            origins,
            starts,
            laid,
            slow_first,
        )

    def fit_again(self, fit: ModelFit) -> ModelFit:
        """Fit a first effect anew from where it was, to runs whose recorders, noise, or part (training, validation) have changed."""
        problem = build_problem(fit.last, self.current.problem, self.locator, self.simulators)
        steps = {trial.name: trial for part in fit.parts for trial in part.misfit.problem.trials}
        problem = problem.with_trials([as_fine(trial, steps[trial.name]) for trial in problem.trials])
        noises, runs = self.detection.floor.noises, self.detection.validation_runs
        found = refine(problem, fit.least_squares, fit.least_squares.x, fit.effects, noises, self.detection.band, fit.parts)
        last, found = release(fit.last, self.current, found, self.locator, self.simulators)
        return replace(evaluate_fit((*fit.effects[:-1], last), found, runs, noises), equivalent_minima=fit.equivalent_minima)

    def weigh_again(self, fit: ModelFit) -> ModelFit:
        """Return a first effect's fit to the training runs as it is, by the noise that is now known."""
        old = fit.least_squares.misfit
        misfit = Misfit(
            old.problem, self.detection.floor.noises, fit.least_squares.values, old.nuisances, self.detection.band, old.shared, old.known
        )
        return evaluate_fit(fit.effects, replace(fit.least_squares, misfit=misfit), (), self.detection.floor.noises)

    def fit_roughly(self, candidate: Candidate) -> ModelFit | None:
        """Fit one candidate from its own starts, to the training runs alone."""
        return self.fit(candidate, checked=False)


def _origins(base: ModelFit, current: CurrentModel, passed: Sequence[PlaceResult]) -> Origins:
    """Return where base parameters and nuisances may begin: at the file's values, where the place test leaves them, where they are."""
    space = current.problem.space
    fitted: StartingPoint = current.unit, current.errors
    begun = fitted if base.effects else (space.unit(space.start), current.errors)
    placed = begun
    if one_force(passed):
        unit, errors = base.least_squares.misfit.split(passed[0].x)
        placed = unit, errors
    return Origins(begun, placed, fitted)


def merit(fit: ModelFit) -> float:
    """Return what ranks fits: -2 ln of the likelihood on the training runs and of the errors it supposes, with the price of its numbers.

    That price is BIC's for the last effect's numbers. Errors count because of two effects that do as well, the one that needs a phone's
    clock to be 30 ms off in every run is the less likely one.
    """
    return fit.squares + own_numbers(fit) * float(np.log(fit.n_residuals))


def own_numbers(fit: ModelFit) -> int:
    """Return how many numbers the last effect of a fit added."""
    return fit.last.effect.n_numbers(len(fit.least_squares.misfit.problem.trials))


def fit_leading_again(fitter: Fitter, fits: Sequence[ModelFit], weigh: bool) -> tuple[ModelFit, ...]:
    """Return fits of first effects, the leading ones fitted again from where they are.

    Where noise is much less than they were ranked by (`weigh`), all are weighed by it, and contenders fitted again, too.
    """
    leading = [fit for fit in fits[:LOOKED_AT_AGAIN] if np.isfinite(fit.validation)]
    rest = [fit for fit in fits if all(fit is not other for other in leading)]
    found = [fitter.fit_again(fit) for fit in leading]
    if weigh and found:
        rest = [fitter.weigh_again(fit) for fit in rest]
        near = CONTENDER * min(fit.training for fit in found)
        found += [fitter.fit_again(fit) for fit in rest if fit.training <= near]
        rest = [fit for fit in rest if fit.training > near]
    return tuple(simplest_first([*sorted(found, key=merit), *(sorted(rest, key=merit) if weigh else rest)], fitter.detection.base))
