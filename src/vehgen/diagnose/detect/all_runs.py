"""The base fitted to all runs, and what numbers of its own would gain a run beside it, to the first order."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from vehgen.diagnose.fits.model_fit import BASE_PRIOR_SIGMA, refine
from vehgen.fit.least_squares import LeastSquaresFit
from vehgen.fit.linearisation import linearise, real_rows

if TYPE_CHECKING:
    from vehgen.diagnose.detect.detection import Detection

Array = NDArray[np.float64]
BASE_PRIOR_WEIGHT = 1 / BASE_PRIOR_SIGMA**2
"""What a base parameter's prior adds to the information on it, in the unit cube."""


@dataclass(frozen=True)
class OwnNumbers:
    """Numbers that run `run` alone would have beside the common unknowns, which follow them.

    `rows shape (n, n_residuals)` are the derivatives of the run's whitened residuals, `cross shape (n, n_unknowns)` their products with
    those by the common unknowns; `information shape (n, n)` and `pull shape (n,)` half the second and first derivatives of -2 ln L.
    """

    run: int
    rows: Array
    cross: Array
    information: Array
    pull: Array

    @property
    def gain(self) -> float:
        """By how much -2 ln L would fall."""
        return float(self.pull @ np.linalg.solve(self.information, self.pull))

    @property
    def values(self) -> Array:
        """The numbers at which it would be least."""
        return np.asarray(-np.linalg.solve(self.information, self.pull))


class AllRuns:
    """The base fitted to all runs of a detection, validation runs too, and linearised there."""

    def __init__(self, detection: Detection) -> None:
        self.fit = _fit(detection)
        misfit = self.misfit = self.fit.misfit
        self.trials = misfit.problem.trials
        n, space = misfit.n_parameters, misfit.problem.space
        self._lines = misfit.whitened_spectrum(self.fit.x)
        self._linear = linearise(misfit, self.fit.x, one_sided=True)
        information, self._gradient = self._linear.normal(self._lines, self.fit.x)
        information[:n, :n] += BASE_PRIOR_WEIGHT * np.eye(n)
        self._gradient[:n] += BASE_PRIOR_WEIGHT * (self.fit.x[:n] - space.unit(space.start))
        self._inverse = np.linalg.pinv(information, hermitian=True)

    def own_parameters(self, run: int) -> OwnNumbers:
        """Return that a run has base parameters of its own, with the base's priors about the common ones."""
        n = self.misfit.n_parameters
        return self._own(run, self._linear.rows(run)[:n], BASE_PRIOR_WEIGHT * np.eye(n))

    def own_gain(self, run: int, channel: int) -> OwnNumbers:
        """Return that a channel reads more in a run than in the others, relative to what it should."""
        measured, residual = self.misfit.measured(run), self.misfit.residual_spectrum(self.fit.x)[run][0]
        lines = np.zeros_like(measured)
        lines[:, channel] = residual[:, channel] - measured[:, channel]
        return self._own(run, real_rows(self.misfit.whiten(run, lines[None])), np.zeros((1, 1)))

    def beside(self, own: OwnNumbers, other: OwnNumbers) -> OwnNumbers:
        """Return numbers of a run where other ones are set free, too."""
        between = -own.cross @ self._inverse @ other.cross.T
        if own.run == other.run:
            between += 2 * own.rows @ other.rows.T
        back = between @ np.linalg.inv(other.information)
        return OwnNumbers(own.run, own.rows, own.cross, own.information - back @ between.T, own.pull - back @ other.pull)

    def _own(self, run: int, rows: Array, prior: Array) -> OwnNumbers:
        cross = np.zeros((len(rows), len(self._gradient)))
        cross[:, self._linear.columns[run]] = 2 * rows @ self._linear.rows(run).T
        information = 2 * rows @ rows.T + prior - cross @ self._inverse @ cross.T
        pull = 2 * rows @ real_rows(self._lines[run][None])[0] - cross @ self._inverse @ self._gradient
        return OwnNumbers(run, rows, cross, information, pull)


def _fit(detection: Detection) -> LeastSquaresFit:
    fit, parts = detection.base.least_squares, detection.base.parts
    return refine(fit.misfit.problem.with_trials(detection.trials), fit, fit.x, (), fit.misfit.noises, known_errors=parts)
