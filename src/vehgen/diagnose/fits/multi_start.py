"""One candidate fitted: quickly from many starts, further from the best of them, finely from the one that ends lowest."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

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
from vehgen.fit.least_squares import COARSE_TOLERANCE, FitOptions, LeastSquaresFit, fit_least_squares
from vehgen.fit.misfit import Misfit, Noises
from vehgen.fit.problem import Problem
from vehgen.fit.resolution import resolve
from vehgen.fit.trial import Trial
from vehgen.simulate import SimulatorPool

Array = NDArray[np.float64]
HOPELESS = 0.5
"""A candidate that leaves more than this share of the excess after the rough fits is not refined."""
STAGES = ((4.0, 4, 8), (10.0, 2, 8), (20.0, 1, 6), (None, 1, 8))
"""Highest frequency [Hz] (None: the band's), how many of the best are followed so far, and so many steps of each."""
WIDER = 1.2
"""A stage is left out that does not reach so many times as high as the band begins, or lower than it ends."""
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
) -> ModelFit | None:
    """Fit a candidate's effect together with what it is added to.

    Parameters
    ----------
    candidate, current
        What to add, and to what. A candidate that leaves HOPELESS of the current model's excess after the rough fits is not refined.
    validation_runs, noises, band, locator, simulators
        As elsewhere.
    origins
        Where the base begins: each is tried with each start of the effect.
    begin
        Where the effect's own numbers begin (default: its own starts).

    Returns
    -------
    None where the simulation fails at every start.
    """
    problem = build_problem(candidate, current.problem, locator, simulators)
    rough = _Rough(candidate, current, problem, noises, band)
    best = rough.search(origins, begin or candidate.effect.starts(candidate.place, locator))
    if best is None:
        return None
    effects = (*current.effects, candidate)
    if best.chi2 - 1 > HOPELESS * max(current.training - 1, 0.0):
        return evaluate_fit(effects, best, (), noises)
    return evaluate_fit(effects, refine(resolve(best.misfit, best.x), best, best.x, effects), validation_runs, noises)


class _Rough:
    """Rough fits of one candidate."""

    def __init__(self, candidate: Candidate, current: CurrentModel, problem: Problem, noises: Noises, band: tuple[float, float]) -> None:
        self.candidate, self.current, self.problem, self.noises, self.band = candidate, current, problem, noises, band
        self.shared = (*current.shared, *candidate.shared)
        self.nearby = current.nearby
        self.n_effect_parameters = current.n_effect_parameters + len(candidate.parameters)
        self.priors = base_priors(problem.space.names[: problem.space.size - self.n_effect_parameters], (*current.effects, candidate))

    def search(self, origins: Sequence[StartingPoint], begin: Sequence[tuple[float, ...]]) -> LeastSquaresFit | None:
        """Return the lowest of the rough fits: slow motions first, from many starts, then faster ones from the best of them.

        All motions at once would turn fast ones by whole cycles and end where the errors of runs stand at their bounds; slow motions have
        one minimum, in which each wider band begins (C. Bunks et al., Geophysics 60, 1995, doi:10.1190/1.1443880).
        """
        starts, fits = self._starts(origins, begin), list[LeastSquaresFit]()
        low, high = self.band
        for top, count, steps in STAGES:
            if top is not None and not WIDER * low < top < high / WIDER:
                continue
            fits = []
            for start in starts[:count]:
                fits.append(self._fit(start, (low, top or high), steps))
                if top is None and self._closed(fits[-1]):
                    break
            fits.sort(key=lambda item: item.loss)
            starts = [(*fit.misfit.split(fit.x), tuple(fit.misfit.adjusted(fit.x))) for fit in fits]
        return fits[0] if fits else None

    def _closed(self, fit: LeastSquaresFit) -> bool:
        return fit.chi2 - 1 <= CLOSED_SHARE * max(self.current.training - 1, 0.0)

    def _fit(self, start: Start, band: tuple[float, float], steps: int) -> LeastSquaresFit:
        options = FitOptions(
            NUISANCES,
            band,
            max_steps=steps,
            tolerance=COARSE_TOLERANCE,
            jacobian_refresh=JACOBIAN_REFRESH,
            prior_sigma=self.priors,
            n_effect_parameters=self.n_effect_parameters,
        )
        unit, errors, numbers = start
        nearby = self.nearby if band == self.band else None
        return fit_least_squares(
            self.problem, unit, options, noises=self.noises, start=errors, shared=self.shared, numbers=numbers, nearby=nearby
        )

    def _starts(self, origins: Sequence[StartingPoint], begin: Sequence[tuple[float, ...]]) -> list[Start]:
        """Return the points at which fits may begin, those of the lowest loss first."""
        n, own = len(self.current.unit), len(self.candidate.parameters)
        space = self.problem.space
        misfit = Misfit(self.problem, self.noises, space.start, NUISANCES, (self.band[0], self._first_top()), self.shared)
        neutral = tuple(item.neutral for item in self.current.shared)
        ranked = []
        for base, errors in origins:
            for combination in begin:
                point = space.start.copy()
                if own:
                    point[n:] = combination[:own]
                begun = carried(np.clip(base, 0.01, 0.99), self.current.problem.space, space)
                unit = np.concatenate([begun, space.unit(point)[n:]])
                numbers = (*neutral, *combination[: len(self.candidate.shared)])
                units = [(value - item.neutral) / item.scale for item, value in zip(self.shared, numbers, strict=True)]
                loss = float((misfit.residuals(np.concatenate([unit, units, errors])) ** 2).sum())
                if np.isfinite(loss):
                    ranked.append((loss, unit, errors, numbers))
        ranked.sort(key=lambda item: item[0])
        return [(unit, errors, numbers) for _, unit, errors, numbers in ranked]

    def _first_top(self) -> float:
        low, high = self.band
        return next((top for top, _, _ in STAGES if top is not None and WIDER * low < top < high / WIDER), high)
