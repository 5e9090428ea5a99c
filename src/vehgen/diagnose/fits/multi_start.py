"""One candidate fitted: quickly from many starts, further from the best of them, finely from the one that ends lowest."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from vehgen.diagnose.fits.begun_again import release, without_strain
from vehgen.diagnose.fits.candidate import Candidate, build_problem, carried
from vehgen.diagnose.fits.model_fit import (
    JACOBIAN_REFRESH,
    NUISANCES,
    CurrentModel,
    ModelFit,
    base_priors,
    evaluate_fit,
    refine,
)
from vehgen.effects import EffectLocator
from vehgen.effects.evidence import StartingPoint
from vehgen.fit.alignment import WIDER
from vehgen.fit.least_squares import COARSE_TOLERANCE, FitOptions, LeastSquaresFit, fit_least_squares
from vehgen.fit.misfit import Misfit, Noises
from vehgen.fit.problem import Problem
from vehgen.fit.resolution import resolve
from vehgen.fit.trial import Trial
from vehgen.simulate import SimulatorPool

Array = NDArray[np.float64]
HOPELESS, BESIDE_SETTLED = 0.5, 0.1
"""A candidate that leaves more than this share of the excess after the rough fits is not refined; the same beside one that leaves noise."""
SLOW_FIRST = ((4.0, 4, 8), (10.0, 2, 8), (20.0, 1, 6), (None, 1, 8))
"""Stages of a fit to slow motions first: highest frequency [Hz] (None: the band's), how many of the best are followed, steps of each."""
AT_ONCE = ((None, 8, 4), (None, 2, 8))
"""Stages of a fit to all motions from near the end."""
SLOW_HZ = 10.0
"""Up to here runs have few errors: how a speed wanders or a hump is worn shows in faster motions."""
FEW_NUISANCES = replace(NUISANCES, length=0, form=0, skew=0, wear=0, wander=0, lag=0, gain=0, tilt=0, position=0)
LEAST_HOPELESS = 2.0
"""An excess of slow motions below this may be due to the errors left out."""
CLOSED_SHARE = 0.01
"""Share of the excess at which no other start is needed."""
Start = tuple[Array, Array, tuple[float, ...]]
"""Where a fit begins: parameters in the unit cube, errors of runs and sensors, numbers of adjustments."""


def fit_candidate(
    candidate: Candidate,
    current: CurrentModel,
    validation_runs: Sequence[Trial],
    noises: Noises,
    band: tuple[float, float],
    locator: EffectLocator,
    simulators: SimulatorPool,
    origins: Sequence[StartingPoint],
    begin: Sequence[tuple[float, ...]] | None = None,
    laid: Array | None = None,
    slow_first: bool = True,
    hopeless: float = HOPELESS,
) -> ModelFit | None:
    """Fit a candidate's effect together with what it is added to.

    Parameters
    ----------
    candidate, current
        What to add, and to what.
    validation_runs, noises, band, locator, simulators
        As elsewhere.
    origins
        Where the base begins: each is tried with each start of the effect.
    begin
        Where the effect's own numbers begin (default: its own starts).
    laid
        Errors at which runs lie over their recordings, `shape (n_errors,)`, where slow motions begin, with few errors (default: those of
        the origins, with all errors).
    slow_first
        Fit slow motions first, not all at once.
    hopeless
        A candidate that leaves more than this share of the current model's excess after the rough fits is not refined.

    Returns
    -------
    None where the simulation fails at every start.
    """
    problem = build_problem(candidate, current.problem, locator, simulators)
    rough = _Rough(candidate, current, problem, noises, band, laid, slow_first)
    best = rough.search(origins, begin or candidate.effect.starts(candidate.place, locator))
    if best is None:
        return None
    effects = (*current.effects, candidate)
    if best.chi2 - 1 > hopeless * max(current.training - 1, 0.0):
        return evaluate_fit(effects, best, (), noises)
    fit = without_strain(refine(resolve(best.misfit, best.x), best, best.x, effects), effects)
    candidate, fit = release(candidate, current, fit, locator, simulators)
    near = () if candidate.shared else current.validation_fits  # what changes runs changes what their errors must be
    return evaluate_fit((*current.effects, candidate), fit, validation_runs, noises, near=near)


class _Rough:
    """Rough fits of one candidate."""

    def __init__(
        self,
        candidate: Candidate,
        current: CurrentModel,
        problem: Problem,
        noises: Noises,
        band: tuple[float, float],
        laid: Array | None,
        slow_first: bool,
    ) -> None:
        self.candidate, self.current, self.problem, self.noises, self.band = candidate, current, problem, noises, band
        self.laid = laid
        self.stages = SLOW_FIRST if slow_first and candidate.effect.shows_in_slow_motions else AT_ONCE
        self.shared = (*current.shared, *candidate.shared)
        self.n_effect_parameters = current.n_effect_parameters + len(candidate.parameters)
        self.priors = base_priors(problem.space.names[: problem.space.size - self.n_effect_parameters], (*current.effects, candidate))

    def search(self, origins: Sequence[StartingPoint], begin: Sequence[tuple[float, ...]]) -> LeastSquaresFit | None:
        """Return the lowest of the rough fits, from many starts, of which the best are followed.

        Far from the truth all motions at once would turn fast ones by whole cycles and end where the errors of runs stand at their bounds;
        slow motions have one minimum, in which each wider band begins (C. Bunks et al., Geophysics 60, 1995, doi:10.1190/1.1443880).
        """
        low, high = self.band
        stages = [item for item in self.stages if item[0] is None or WIDER * low < item[0] < high / WIDER]
        first = self._misfit(stages[0][0])
        starts, fits = self._starts(first, origins, begin), list[LeastSquaresFit]()
        for top, count, steps in stages:
            misfit = first if top == stages[0][0] else self._misfit(top)
            starts = [(*self._like(misfit, fit), tuple(fit.misfit.adjusted(fit.x))) for fit in fits] or starts
            fits = []
            for start in starts[:count]:
                fits.append(self._fit(start, misfit, steps))
                if top is None and self._closed(fits[-1]):
                    break
            fits.sort(key=lambda item: item.loss)
            if not fits:
                return None
            if top == SLOW_HZ and self.laid is not None and self._is_hopeless(fits[0]):
                whole = self._misfit(None)
                return self._fit((*self._like(whole, fits[0]), tuple(fits[0].misfit.adjusted(fits[0].x))), whole, 1)
        return fits[0]

    def _misfit(self, top: float | None) -> Misfit:
        """Return the misfit of a stage; slow motions are simulated with long steps."""
        few = self.laid is not None and top is not None and top <= SLOW_HZ
        band = self.band[0], top or self.band[1]
        problem = self.problem if top is None else self.problem.with_trials([item.for_slow_motions(top) for item in self.problem.trials])
        return Misfit(problem, self.noises, problem.space.start, FEW_NUISANCES if few else NUISANCES, band, self.shared)

    def _like(self, misfit: Misfit, fit: LeastSquaresFit) -> tuple[Array, Array]:
        """Return parameters and errors of a stage as the fit before it has them."""
        return fit.misfit.split(fit.x)[0], misfit.errors_like(fit.misfit, fit.x)

    def _closed(self, fit: LeastSquaresFit) -> bool:
        return fit.chi2 - 1 <= CLOSED_SHARE * max(self.current.training - 1, 0.0)

    def _is_hopeless(self, fit: LeastSquaresFit) -> bool:
        """Return whether slow motions are explained no better than by the current model."""
        return fit.chi2 - 1 > max(HOPELESS * (self.current.slow(SLOW_HZ) - 1), LEAST_HOPELESS)

    def _fit(self, start: Start, misfit: Misfit, steps: int) -> LeastSquaresFit:
        options = FitOptions(
            misfit.nuisances,
            misfit.band,
            max_steps=steps,
            tolerance=COARSE_TOLERANCE,
            jacobian_refresh=JACOBIAN_REFRESH,
            prior_sigma=self.priors,
            n_effect_parameters=self.n_effect_parameters,
        )
        unit, errors, numbers = start
        nearby = self.current.nearby if misfit.nuisances is NUISANCES else None
        return fit_least_squares(
            misfit.problem, unit, options, noises=self.noises, start=errors, shared=self.shared, numbers=numbers, nearby=nearby
        )

    def _starts(self, misfit: Misfit, origins: Sequence[StartingPoint], begin: Sequence[tuple[float, ...]]) -> list[Start]:
        """Return the points at which fits may begin, those of the lowest loss first."""
        n, own = len(self.current.unit), len(self.candidate.parameters)
        space = self.problem.space
        whole = misfit if misfit.nuisances is NUISANCES else self._misfit(None)
        neutral = tuple(item.neutral for item in self.current.shared)
        ranked = []
        for base, begun_errors in origins:
            errors = begun_errors if self.laid is None else self.laid
            few = misfit.errors_like(whole, np.concatenate([np.zeros(whole.n_unknowns - len(errors)), errors]))
            for combination in begin:
                point = space.start.copy()
                if own:
                    point[n:] = combination[:own]
                begun = carried(np.clip(base, 0.01, 0.99), self.current.problem.space, space)
                unit = np.concatenate([begun, space.unit(point)[n:]])
                numbers = (*neutral, *combination[: len(self.candidate.shared)])
                units = [(value - item.neutral) / item.scale for item, value in zip(self.shared, numbers, strict=True)]
                loss = float((misfit.residuals(np.concatenate([unit, units, few])) ** 2).sum())
                if np.isfinite(loss):
                    ranked.append((loss, unit, few, numbers))
        ranked.sort(key=lambda item: item[0])
        return [(unit, errors, numbers) for _, unit, errors, numbers in ranked]
