"""Static equilibrium where force laws share in carrying the weight.

With travels d = J q from the unloaded position, stiffness K, laws f and the generalised weight W,
    K q + J^T f(J q) = W.
All individuals take Newton steps together, each halved until the residual falls; the tangent is K + J^T f' J. Who does not arrive is
solved alone: the weight grows from nothing to its whole in steps, or springs to the ground fade, each step solved by Powell's hybrid
method from the last (scipy.optimize.root; M. J. D. Powell, in P. Rabinowitz (ed.), Numerical Methods for Nonlinear Algebraic Equations,
1970).
A solution whose tangent is not positive definite is unstable, and no equilibrium.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from vehgen.mechanics.equations_of_motion import EquationsOfMotion
from vehgen.mechanics.evaluation import PopulationValues
from vehgen.mechanics.law_terms import REST
from vehgen.mechanics.rows import SparseMatrix
from vehgen.mechanics.symbols import derivative

Array = NDArray[np.float64]
MAX_NEWTON = 60
CONVERGED = 1e-11
"""Residual over the weight at which Newton's iteration stops, in the norm of (force)^2/mass."""
ACCEPTED = 1e-8
"""The same, above which there is no equilibrium."""
LOAD_STEPS = 20
HELD_BY = 1e6, 1e-3
"""Springs to the ground between which a search fades them, over the mass [1/s^2]."""
LONGEST_FALL = 30.0
"""What travels further [m] until something holds it has fallen."""
NOT_FOUND = "no stable static equilibrium was found: its laws that count from the unloaded position cannot carry its weight"


@dataclass(frozen=True)
class Equilibria:
    """Where a population stands: `displacement shape (n_individuals, n_dof)` and `travels shape (n_individuals, n_elements)` [m, rad].

    `forces shape (n_individuals, n_elements)` is what each element carries with its laws [N, N m]. `failures` says of an individual why
    it has no equilibrium; its rows are NaN.
    """

    displacement: Array
    travels: Array
    forces: Array
    failures: dict[int, str]


def equilibria(model: EquationsOfMotion, parameters: Array) -> Equilibria:
    """Solve the static equilibrium of every individual of `parameters shape (n_individuals, n_parameters)` [SI].

    An individual whose parameters are not finite has rows of NaN and no entry in `failures`.
    """
    finite = np.isfinite(parameters).all(axis=1)
    n, n_elements = len(parameters), len(model.elements)
    displacement = np.full((n, model.n_dof), np.nan)
    travels, forces = np.full((n, n_elements), np.nan), np.full((n, n_elements), np.nan)
    failures: dict[int, str] = {}
    if finite.any():
        members = np.flatnonzero(finite)
        with np.errstate(all="ignore"):
            balance = _Balance(model, parameters[members])
            q = balance.newton(balance.start())
            error = balance.error(q)
            for i in np.flatnonzero(~(error < ACCEPTED)):
                q[i] = _Balance(model, parameters[members[[i]]]).alone()[0]
            error, stiff = balance.error(q), balance.least_stiffness(q)
            good = (error < ACCEPTED) & (stiff > 0)
            failures = {int(member): NOT_FOUND for member in members[~good]}
            displacement[members[good]] = q[good]
            travels[members[good]] = balance.travels(q)[good]
            forces[members[good]] = balance.carried(q)[good]
    return Equilibria(displacement, travels, forces, failures)


class _Balance:
    """The equilibrium equations of some individuals."""

    def __init__(self, model: EquationsOfMotion, parameters: Array) -> None:
        self.columns = columns = PopulationValues(model, parameters)
        n, n_dof = columns.n, model.n_dof

        def matrix(entries: SparseMatrix, rows: int, width: int) -> Array:
            found = np.zeros((n, rows, width))
            for (i, j), value in entries.items():
                found[:, i, j] = columns.value(value)
            return found

        elements = model.elements
        self.K = matrix(model.stiffness_entries, n_dof, n_dof)
        self.weight = matrix({(i, 0): value for i, value in model.weight_entries.items()}, n_dof, 1)[:, :, 0]
        self.rows = matrix({(i, j): value for i, item in enumerate(elements) for j, value in item.row.items()}, len(elements), n_dof)
        self.k = np.array([columns.value(item.k) for item in elements]).T
        mass = matrix({(i, i): model.mass_entries[i, i] for i in range(n_dof)}, n_dof, n_dof)
        self.scale = 1 / np.sqrt(np.einsum("nii->ni", mass))
        preloads = {i: sp.Add(*(term.preload() for term in item.laws)) for i, item in enumerate(elements)}
        self.laws = {i: (force, derivative(force, REST)) for i, force in preloads.items() if force != 0}
        self.heavy = np.linalg.norm(self.weight * self.scale, axis=1)

    def travels(self, q: Array) -> Array:
        """Return J q, `shape (n, n_elements)`."""
        return np.asarray(np.einsum("nei,ni->ne", self.rows, q))

    def carried(self, q: Array) -> Array:
        """Return the force in every element, `shape (n, n_elements)`."""
        travels = self.travels(q)
        forces = self.k * travels
        for i, (force, _) in self.laws.items():
            forces[:, i] += self.columns.value(force, {REST: travels[:, i]})
        return forces

    def residual(self, q: Array) -> Array:
        """Return K q + J^T f(J q) - W, `shape (n, n_dof)`."""
        travels = self.travels(q)
        found = np.einsum("nij,nj->ni", self.K, q) - self.weight
        for i, (force, _) in self.laws.items():
            found += self.rows[:, i] * self.columns.value(force, {REST: travels[:, i]})[:, None]
        return np.asarray(found)

    def tangent(self, q: Array) -> Array:
        """Return K + J^T f'(J q) J, `shape (n, n_dof, n_dof)`."""
        travels = self.travels(q)
        found = self.K.copy()
        for i, (_, slope) in self.laws.items():
            row = self.rows[:, i]
            found += self.columns.value(slope, {REST: travels[:, i]})[:, None, None] * row[:, :, None] * row[:, None, :]
        return found

    def error(self, q: Array) -> Array:
        """Return the residual over the weight, `shape (n,)`."""
        return np.asarray(np.linalg.norm(self.residual(q) * self.scale, axis=1) / self.heavy)

    def start(self) -> Array:
        """Return where the linear springs alone would stand, as far as they hold the vehicle."""
        return _solve(self.K, self.weight)

    def newton(self, q: Array) -> Array:
        """Return the populations' displacements after damped Newton steps."""
        error = self.error(q)
        for _ in range(MAX_NEWTON):
            if not (error > CONVERGED).any():
                break
            step = _solve(self.tangent(q), self.residual(q))
            share = np.where(error > CONVERGED, 1.0, 0.0)
            for _halving in range(12):
                tried = q - share[:, None] * step
                found = self.error(tried)
                worse = ~(found < error) & (share > 0)
                if not worse.any():
                    break
                share = np.where(worse, share / 2, share)
            better = found < error
            if not better.any():
                break
            q, error = np.where(better[:, None], tried, q), np.where(better, found, error)
        return q

    def alone(self) -> Array:
        """Return the displacement `shape (1, n_dof)` of the only individual, NaN where none is found.

        Its weight grows from nothing to its whole. Where that leads nowhere, as from a gap that no spring bridges, springs hold every
        motion to its unloaded place, and fade.
        """
        scale, whole = self.scale[0], np.ones(LOAD_STEPS)
        found = self._followed(np.zeros(len(scale)), np.linspace(0, 1, LOAD_STEPS + 1)[1:], 0 * whole)
        if not np.isfinite(found).all():
            found = self._followed(np.zeros(len(scale)), whole, np.append(np.geomspace(*HELD_BY, LOAD_STEPS - 1), 0.0))
            if not (np.abs(self.travels((scale * found)[None])) < LONGEST_FALL).all():  # it fell until a far stop caught it
                found = np.full(len(scale), np.nan)
        return np.asarray(scale * found)[None]

    def _followed(self, x: Array, loads: Array, springs: Array) -> Array:
        """Return the scaled displacement that shares of the weight and springs to the ground [1/s^2], one after the other, lead to."""
        import scipy

        scale = self.scale[0]

        def residual(x: Array, load: float, spring: float) -> Array:
            return np.asarray(scale * (self.residual((scale * x)[None]) + (1 - load) * self.weight)[0] + spring * x)

        def tangent(x: Array, _load: float, spring: float) -> Array:
            return np.asarray(scale[:, None] * self.tangent((scale * x)[None])[0] * scale + spring * np.eye(len(x)))

        for given in zip(loads, springs, strict=True):
            for method in ("hybr", "lm"):
                found = scipy.optimize.root(residual, x, given, method=method, jac=tangent, tol=1e-13)
                if np.isfinite(found.x).all() and np.linalg.norm(residual(found.x, *given)) < ACCEPTED * self.heavy[0]:
                    x = found.x
                    break
            else:
                return np.full(len(scale), np.nan)
        return x

    def least_stiffness(self, q: Array) -> Array:
        """Return the lowest eigenvalue of the tangent in the metric of the masses [1/s^2], `shape (n,)`; -inf where q is not finite."""
        good = np.asarray(np.isfinite(q).all(axis=1))
        found = np.full(len(q), -np.inf)
        if good.any():
            scaled = self.tangent(np.where(good[:, None], q, 0.0)) * self.scale[:, :, None] * self.scale[:, None, :]
            found[good] = np.linalg.eigvalsh(scaled[good])[:, 0]
        return found


def _solve(matrices: Array, right: Array) -> Array:
    """Solve `matrices shape (n, m, m)` x = `right shape (n, m)`; by least squares where one is singular."""
    try:
        return np.asarray(np.linalg.solve(matrices, right[:, :, None])[:, :, 0])
    except np.linalg.LinAlgError:
        finite = np.where(np.isfinite(matrices), matrices, 0.0)
        return np.asarray((np.linalg.pinv(finite, hermitian=True) @ right[:, :, None])[:, :, 0])
