"""What the base can do by itself: the directions in which its parameters and nuisances move the residuals, projected out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from vehgen.diagnose.fits.candidate import Candidate
from vehgen.diagnose.fits.model_fit import base_priors
from vehgen.fit.least_squares import WEAK_PRIOR_SIGMA
from vehgen.fit.linearisation import linearise
from vehgen.fit.misfit import Misfit
from vehgen.fit.window import flatten

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Projection:
    """A fit's residuals without what its unknowns, held by their priors, can do about them.

    `basis` spans what they can do, `shape (n_residuals + n_unknowns, n_unknowns)`; `left` is what they cannot explain, `shape
    (n_residuals + n_unknowns,)`, the priors last.
    """

    basis: Array
    left: Array

    @classmethod
    def of(cls, misfit: Misfit, x: Array, effects: Sequence[Candidate] = ()) -> Projection:
        """Return the projection at unknowns x of a fit with `effects`: every unknown is held by its own prior."""
        total = misfit.n_unknowns
        held = np.ones(total)
        own = sum(len(item.parameters) for item in effects)
        n = misfit.n_parameters - own
        held[:n] = 1 / base_priors(misfit.problem.space.names[:n], effects)
        held[n : misfit.n_parameters] = 1 / WEAK_PRIOR_SIGMA
        slopes = np.vstack([*(flatten(item, first=1).T for item in linearise(misfit, x).spectra), np.diag(held)])
        residual = np.concatenate([*(flatten(item) for item in misfit.whitened_spectrum(x)), np.zeros(total)])
        basis = np.linalg.qr(slopes)[0]
        return cls(basis, residual - basis @ (basis.T @ residual))

    @property
    def size(self) -> int:
        """How many residuals there are."""
        return int(len(self.basis) - self.basis.shape[1])

    def remainder(self, moved: Array) -> Array:
        """Return changes of the residuals `shape (n_residuals, ...)`, without what the base can undo, with the priors' rows."""
        padded = np.concatenate([moved, np.zeros((len(self.basis) - len(moved), *moved.shape[1:]))])
        return np.asarray(padded - self.basis @ (self.basis.T @ padded))
