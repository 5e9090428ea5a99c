"""First-order gains of every candidate of the library, also of those that a diagnosis would fit without a look at theirs.

As in the diagnosis's screening: at each start of a candidate the whitened residuals move by d; what base parameters and errors of runs can
do is projected out of d and of the residual r, which then falls by (r.d)^2/(d.d) along d. What has no number of its own cannot be scaled
and falls by |r|^2 - |r + d|^2.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from vehgen.diagnose.fits.candidate import Candidate, build_problem, carried, has_room
from vehgen.diagnose.fits.first_order import ProbeMotion
from vehgen.diagnose.fits.model_fit import NUISANCES
from vehgen.diagnose.fits.projection import Projection
from vehgen.diagnose.select.fitter import Fitter
from vehgen.fit.misfit import Misfit, flatten
from vehgen.fit.problem import Problem

Array = NDArray[np.float64]


def first_order_gains(fitter: Fitter, candidates: Sequence[Candidate]) -> list[tuple[float, Candidate]]:
    """Return the gain and the candidate, the largest gain first, of those that have something to search."""
    found = _Gains(fitter)
    gains = [(found.of(item), item) for item in candidates if has_room(item, fitter.locator)]
    return sorted(gains, key=lambda item: -item[0])


class _Gains:
    def __init__(self, fitter: Fitter) -> None:
        self.fitter = fitter
        self.misfit, self.x = fitter.detection.base.least_squares.misfit, fitter.detection.base.least_squares.x
        self.projection, self.motion = Projection.of(self.misfit, self.x), ProbeMotion(self.misfit, self.x)
        self.lines = np.concatenate([flatten(item) for item in self.misfit.whitened_spectrum(self.x)])

    def of(self, candidate: Candidate) -> float:
        """Return the largest gain over a candidate's starts."""
        fitter, n = self.fitter, len(candidate.parameters)
        current = fitter.current
        problem = build_problem(candidate, current.problem, fitter.locator, fitter.simulators)
        begun = carried(current.unit, current.problem.space, problem.space)
        exact = Misfit(problem, self.misfit.noises, problem.space.start, NUISANCES, self.misfit.band, candidate.shared)
        best, scaled = 0.0, bool(n or candidate.shared)
        for start in candidate.effect.starts(candidate.place, fitter.locator, fitter.residual):
            point = problem.space.start.copy()
            point[len(current.unit) :] = start[:n]
            unit = np.concatenate([begun, problem.space.unit(point)[len(current.unit) :]])
            moved = None if candidate.shared else self.motion.moved(problem, problem.space.values(unit))
            if moved is None:
                moved = self._simulated(exact, candidate, problem, unit, start)
            if np.all(np.isfinite(moved)):
                best = max(best, self._gain(moved, scaled))
        return best

    def _simulated(self, exact: Misfit, candidate: Candidate, problem: Problem, unit: Array, start: tuple[float, ...]) -> Array:
        numbers = [(value - item.neutral) / item.scale for item, value in zip(candidate.shared, start, strict=False)]
        lines = exact.whitened_spectrum(np.concatenate([unit, numbers, self.fitter.current.errors]))
        return np.asarray(np.concatenate([flatten(item) for item in lines]) - self.lines)

    def _gain(self, moved: Array, scaled: bool) -> float:
        free, left = self.projection.remainder(moved), self.projection.left
        along, squared = float(left @ free), max(float(free @ free), 1e-12)
        if along >= 0:
            return 0.0
        return along**2 / squared if scaled else max(-2 * along - squared, 0.0)
