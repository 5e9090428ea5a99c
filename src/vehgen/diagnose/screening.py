"""Which of many candidates are worth fitting: the first-order gain of each, found without a fit.

At each of a candidate's starts the whitened residual moves by d. What the base parameters and nuisances can do by themselves is projected
out of d and of the residual r; along d, scaled freely, r then falls by (r.d)^2/(d.d). This ranks, it does not judge: it sees no curvature.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from vehgen.diagnose.candidate import Candidate, pose, starts
from vehgen.diagnose.fitting import HOLD, NUISANCES, Fit, Footing
from vehgen.effects import Surveyor
from vehgen.identify.misfit import Misfit
from vehgen.simulate import Simulator

Array = NDArray[np.float64]
MOST = 14
"""So many candidates that are forces are kept."""


def screen(
    candidates: Sequence[Candidate],
    base: Fit,
    footing: Footing,
    surveyor: Surveyor,
    simulators: dict[object, Simulator],
    begin: Mapping[str, Sequence[tuple[float, ...]]],
) -> list[Candidate]:
    """Return the candidates worth fitting: all of sensors, runs and engines, of the others the MOST with the largest first-order gain.

    Parameters
    ----------
    candidates, base, footing
        What to choose from, the fit they are added to, and the same fit as a footing.
    surveyor, simulators
        As for :func:`vehgen.diagnose.candidate.pose`.
    begin
        Starts of candidates by the quantity they adjust, where they are not their own.
    """
    always = [item for item in candidates if item.effect.edit is None]
    forces = [item for item in candidates if item.effect.edit is not None]
    if len(forces) <= MOST:
        return list(candidates)
    misfit, x = base.polished.misfit, base.polished.x
    residual, basis = _free_of_base(misfit, x)
    gains = []
    for candidate in forces:
        problem = pose(candidate, footing.problem, surveyor, simulators)
        posed = Misfit(problem, misfit.noises, problem.space.start, NUISANCES, misfit.band, footing.shared)
        best = 0.0
        for combination in begin.get(candidate.effect.adjusts) or starts(candidate, surveyor):
            point = problem.space.start.copy()
            point[len(footing.unit) :] = combination[: len(candidate.parameters)]
            unit = np.concatenate([footing.unit, problem.space.unit(point)[len(footing.unit) :]])
            moved = posed.residuals(np.concatenate([unit, np.zeros(len(footing.shared)), footing.errors])) - misfit.residuals(x)
            if np.all(np.isfinite(moved)):
                best = max(best, _gain(residual, moved, basis))
        gains.append((best, candidate))
    gains.sort(key=lambda item: -item[0])
    kept = {id(candidate) for _, candidate in gains[:MOST]} | {id(item) for item in always}
    return [item for item in candidates if id(item) in kept]


def _free_of_base(misfit: Misfit, x: Array) -> tuple[Array, Array]:
    """Return the residual without what base parameters and nuisances can move, and an orthonormal basis of that."""
    n = misfit.n_parameters
    springs = np.hstack([np.eye(n) / HOLD, np.zeros((n, misfit.n_unknowns - n))])
    basis = np.linalg.qr(np.vstack([misfit.jacobian(x), springs]))[0]
    residual = np.concatenate([misfit.residuals(x), np.zeros(n)])
    return residual - basis @ (basis.T @ residual), basis


def _gain(residual: Array, moved: Array, basis: Array) -> float:
    padded = np.concatenate([moved, np.zeros(len(residual) - len(moved))])
    free = padded - basis @ (basis.T @ padded)
    along = float(residual @ free)
    return along**2 / max(float(free @ free), 1e-12) if along < 0 else 0.0
