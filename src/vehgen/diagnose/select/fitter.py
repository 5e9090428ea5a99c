"""Fits candidates on top of a fit, one by one or side by side in other processes."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import cached_property, partial

import numpy as np
from numpy.typing import NDArray

from vehgen.diagnose.detect.detection import Detection
from vehgen.diagnose.fits.begun_again import release, restart
from vehgen.diagnose.fits.candidate import Candidate, build_problem, freed_alone
from vehgen.diagnose.fits.model_fit import CurrentModel, ModelFit, evaluate_fit, refine
from vehgen.diagnose.fits.multi_start import HOPELESS, fit_candidate
from vehgen.diagnose.fits.occurring import occurring
from vehgen.diagnose.fits.screening import FirstOrderGains
from vehgen.diagnose.localise.localisation import none_explains, one_force
from vehgen.diagnose.localise.unknown_force import PlaceResult
from vehgen.effects import EffectLocator
from vehgen.effects.evidence import Origins, Residual, StartingPoint
from vehgen.fit.alignment import align
from vehgen.fit.misfit import Misfit
from vehgen.fit.parallel import Runner
from vehgen.fit.resolution import as_fine
from vehgen.simulate import SimulatorPool

Array = NDArray[np.float64]


class Fitter:
    """Fits candidates on top of a fit; `passed` are the places that suffice to explain what it leaves.

    `nowhere` says that forces explain it at no single place; `hopeless` is the share of the fit's excess beyond which a candidate is not
    refined.
    """

    def __init__(self, detection: Detection, base: ModelFit, passed: Sequence[PlaceResult], hopeless: float = HOPELESS) -> None:
        self.detection, self.current, self.simulators, self.hopeless = detection, CurrentModel.of(base), SimulatorPool(), hopeless
        trial = self.current.problem.trials[0]
        self.locator = EffectLocator(trial.run.vehicle, dict(trial.values), occurring(base))
        self.origins, self.nowhere = _origins(base, self.current, passed), none_explains(passed)
        self.base, self.residual = base, Residual(base.least_squares.misfit, base.least_squares.x)

    @cached_property
    def laid(self) -> Array | None:
        """Errors at which runs lie over their recordings, `shape (n_errors,)`; None beside effects that were found before."""
        space = self.current.problem.space
        return None if self.base.effects else align(self.base.least_squares.misfit, space.unit(space.start), bands=())

    def first_order_gains(self) -> FirstOrderGains:
        """Return what candidates gain beside the fit, to the first order."""
        return FirstOrderGains(self.base, self.current, self.locator, self.simulators, self.residual)

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

    def fit_begun(self, begun: tuple[Candidate, tuple[float, ...]]) -> ModelFit | None:
        """Fit one candidate, all motions at once, from numbers of its own, too."""
        return self.fit(begun[0], [begun[1]] if begun[1] else [], slow_first=False)

    def fit_within(self, candidate: Candidate, general: ModelFit) -> ModelFit | None:
        """Fit a special case of the last effect of a fit, all motions at once, from where that fit ended."""
        found, space = general.least_squares, self.current.problem.space
        known = dict(zip((item.name for item in general.last.effect.parameters), found.values[space.size :], strict=True))
        usual = candidate.effect.starts(candidate.place, self.locator, self.residual)[0]
        numbers = tuple(float(known.get(item.name, first)) for item, first in zip(candidate.effect.parameters, usual, strict=True))
        return self.fit_from(candidate, (space.unit(found.values[: space.size]), found.misfit.split(found.x)[1]), numbers)

    def fit_without(self, fit: ModelFit) -> ModelFit | None:
        """Fit what the last effect of a fit set free, without it, from where that fit ended, to the training runs alone."""
        found, space = fit.least_squares, self.current.problem.space
        ended = space.unit(found.values[: space.size]), found.misfit.split(found.x)[1]
        return self._fit(freed_alone(fit.last.freed), [ended], [()], False, None, False)

    def fit_from(self, candidate: Candidate, begin: StartingPoint, numbers: tuple[float, ...]) -> ModelFit | None:
        """Fit one candidate, all motions at once, from parameters and errors, and numbers of its own."""
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
            self.hopeless,
        )

    def fit_again(self, fit: ModelFit) -> ModelFit:
        """Fit a first effect anew from where it was, to runs whose recorders, noise, or part (training, validation) have changed."""
        problem = build_problem(fit.last, self.current.problem, self.locator, self.simulators)
        steps = {trial.name: trial for part in fit.parts for trial in part.misfit.problem.trials}
        problem = problem.with_trials([as_fine(trial, steps[trial.name]) for trial in problem.trials])
        noises, runs = self.detection.floor.noises, self.detection.validation_runs
        found = refine(problem, fit.least_squares, fit.least_squares.x, fit.effects, noises, self.detection.band, fit.parts)
        last, found = release(fit.last, self.current, found, self.locator, self.simulators)
        again = evaluate_fit((*fit.effects[:-1], last), found, runs, noises, near=fit.parts)
        return replace(again, equivalent_minima=fit.equivalent_minima)

    def has_all_runs(self, fit: ModelFit) -> bool:
        """Return whether a fit was simulated on all runs that are fitted now, of which some may have been kept for checking before."""
        known = {trial.name for part in fit.parts for trial in part.misfit.problem.trials}
        return all(trial.name in known for trial in self.current.problem.trials)

    def weigh_again(self, fit: ModelFit) -> ModelFit:
        """Return a first effect's fit to the training runs as it is, by the noise that is now known."""
        old = fit.least_squares.misfit
        noises, values, band = self.detection.floor.noises, fit.least_squares.values, self.detection.band
        errors = old.split(fit.least_squares.x)[1]
        misfit = Misfit(old.problem, noises, values, old.nuisances, band, old.shared, old.known, errors, old.begun)
        return evaluate_fit(fit.effects, replace(fit.least_squares, misfit=misfit), (), noises)

    def fit_all(self, candidates: Sequence[Candidate], runner: Runner, slow_first: bool = True) -> Iterator[ModelFit | None]:
        """Yield what :meth:`fit` returns for each of some candidates, fitted wherever a runner works."""
        _ = self.laid if slow_first else None  # once, before it is sent to where candidates are fitted
        for candidate, fit in zip(candidates, runner.map(partial(self.fit, slow_first=slow_first), candidates), strict=True):
            yield None if fit is None else _as_here(fit, (*self.current.effects, candidate))

    def fit_all_begun(self, begun: Sequence[tuple[Candidate, tuple[float, ...]]], runner: Runner) -> Iterator[ModelFit]:
        """Yield what :meth:`fit_begun` returns for each of some candidates, but for failures, fitted wherever a runner works."""
        for item, fit in zip(begun, runner.map(self.fit_begun, begun), strict=True):
            if fit is not None:
                yield _as_here(fit, (*self.current.effects, item[0]))

    def fit_all_again(self, fits: Sequence[ModelFit], runner: Runner) -> list[ModelFit]:
        """Return what :meth:`fit_again` returns for each of some fits, fitted wherever a runner works."""
        return [_as_here(new, old.effects) for old, new in zip(fits, runner.map(self.fit_again, fits), strict=True)]

    def restart_all(self, fits: Sequence[ModelFit], runner: Runner) -> list[ModelFit]:
        """Return the lowest minima about some fits whose response jumps, sought wherever a runner works."""
        settle = partial(restart, validation_runs=self.detection.validation_runs, noises=self.detection.floor.noises)
        return [_as_here(new, old.effects) for old, new in zip(fits, runner.map(settle, fits), strict=True)]

    def fit_roughly(self, candidate: Candidate) -> ModelFit | None:
        """Fit one candidate from its own starts, to the training runs alone."""
        return self.fit(candidate, checked=False)

    def fit_at_once(self, candidate: Candidate) -> ModelFit | None:
        """Fit one candidate from its own starts, all motions at once, to the training runs alone."""
        return self.fit(candidate, checked=False, slow_first=False)


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


def _as_here(fit: ModelFit, effects: Sequence[Candidate]) -> ModelFit:
    """Return a fit that may come from another process with the effects that this one knows: their functions are others there."""
    own = tuple(replace(item, effect=known.effect) for item, known in zip(fit.effects, effects, strict=True))
    return replace(fit, effects=own)
