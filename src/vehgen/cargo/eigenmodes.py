"""Eigenmodes of a supported mesh, how much mass each moves vertically, and which of them are artefacts of the elements."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

from vehgen.cargo.box_mesh import Mesh
from vehgen.cargo.elements import ElementMatrices, Sparse
from vehgen.errors import InputError

Array = NDArray[np.float64]
SPURIOUS = 0.5
"""A mode with a larger share of its strain energy in hourglass control is an artefact."""
ZERO_HZ = 1e-3
"""Below it a mode is a mechanism."""
BAND_HZ = 25.0
"""Modes are sought up to here at least: what vehicles excite."""
ENOUGH_MASS_SHARE = 0.25
"""And until one of them moves this share of the mass."""
ROOM = 40
"""The subspace of ARPACK has room for so many more modes than twice those asked for: equal studs have dozens of equal modes."""
MOST_RESTARTS = 100
"""Healthy structures need a few; one that needs more is nearly a mechanism."""
FIRST_COUNT, MOST = 16, 256


@dataclass(frozen=True)
class RigidBody:
    """A structure as a rigid body: mass [kg], COG `shape (3,)` [m], inertia about the COG round the y axis [kg m^2]."""

    mass: float
    cog: Array
    pitch_inertia: float


@dataclass(frozen=True)
class Eigenmodes:
    """Modes by ascending frequency.

    `frequency shape (n_modes,)` [Hz]; `shapes shape (n_modes, n_nodes, 6)`, unit modal mass; `effective_mass shape (n_modes,)` moved
    vertically when the supports move vertically [kg]; `hourglass shape (n_modes,)` share of the strain energy; `complete` tells that no
    mode beyond these can move more mass than the most that one of them does.
    """

    frequency: Array
    shapes: Array
    effective_mass: Array
    hourglass: Array
    complete: bool

    @property
    def genuine(self) -> NDArray[np.bool_]:
        """Which modes belong to the structure rather than to the elements, `shape (n_modes,)`."""
        found: NDArray[np.bool_] = (self.hourglass <= SPURIOUS) & (self.frequency > ZERO_HZ)
        return found

    @property
    def principal(self) -> int:
        """The genuine mode with the largest effective mass; raises InputError where there is none."""
        genuine = self.genuine
        if not genuine.any():
            raise InputError("every mode is an hourglass mode or a mechanism of the mesh; choose a smaller mesh size")
        return int(np.argmax(np.where(genuine, self.effective_mass, -1.0)))


def rigid_body(mesh: Mesh, M: Sparse) -> RigidBody:
    """Return what a mesh weighs, and where, from its consistent mass matrix."""
    x, _, z = mesh.nodes.T
    motions = np.zeros((len(x), 6, 4))
    for axis in range(3):
        motions[:, axis, axis] = 1.0
    motions[:, 0, 3], motions[:, 2, 3], motions[:, 4, 3] = z, -x, 1.0  # a unit rotation about the y axis through the origin
    rigid = motions.reshape(-1, 4)
    found = rigid.T @ (M @ rigid)
    mass = float(found[2, 2])
    cog_x, cog_z = -found[2, 3] / mass, found[0, 3] / mass
    weights = (M @ rigid[:, 2]).reshape(-1, 6)[:, 2]
    cog = np.array([cog_x, float(weights @ mesh.nodes[:, 1]) / mass, cog_z])
    return RigidBody(mass, cog, float(found[3, 3] - mass * (cog_x**2 + cog_z**2)))


def eigenmodes(matrices: ElementMatrices, held: NDArray[np.int64], count: int | None = None) -> Eigenmodes:
    """Solve K v = (2 pi f)^2 M v with some degrees of freedom held, by ARPACK in shift-invert mode about 0.

    Parameters
    ----------
    matrices
        Of the mesh.
    held
        Degrees of freedom that cannot move (six a node).
    count
        How many modes; None: as many as it takes to be sure of the largest effective mass, or to pass BAND_HZ and ENOUGH; at most MOST.

    Raises
    ------
    InputError
        When the structure is a mechanism, or ARPACK finds no modes.
    """
    n_dof = matrices.K.shape[0]
    free = np.setdiff1d(np.arange(n_dof), held)
    K, M = matrices.K[free][:, free].tocsc(), matrices.M[free][:, free].tocsc()
    solve = _factor(K)
    vertical = np.zeros(n_dof)
    vertical[2::6] = 1.0
    pull = matrices.M @ vertical
    total = float(vertical @ pull)
    wanted = count or FIRST_COUNT
    while True:
        wanted = min(wanted, len(free) - 1)
        squares, vectors = _solve(K, M, solve, wanted)
        effective = (vectors.T @ pull[free]) ** 2
        shapes = np.zeros((n_dof, wanted))
        shapes[free] = vectors
        energy = np.einsum("ij,ij->j", shapes, matrices.K @ shapes)
        hourglass = np.einsum("ij,ij->j", shapes, matrices.hourglass @ shapes) / np.maximum(energy, np.finfo(float).tiny)
        frequency = np.sqrt(np.maximum(squares, 0.0)) / (2 * math.pi)
        genuine = np.where(hourglass <= SPURIOUS, effective, 0.0)
        complete = bool(total - effective.sum() <= genuine.max())
        enough = frequency[-1] > BAND_HZ and genuine.max() > ENOUGH_MASS_SHARE * total
        if count is not None or complete or enough or wanted >= min(MOST, len(free) - 1):
            by_node = shapes.T.reshape(wanted, -1, 6)
            return Eigenmodes(frequency, by_node, effective, hourglass, complete)
        wanted *= 2


def _factor(K: Sparse) -> scipy.sparse.linalg.LinearOperator:
    """Factorise a symmetric positive definite matrix, with an ordering that keeps it sparse."""
    diagonal = K.diagonal()
    try:
        if diagonal.min() <= 1e-14 * diagonal.max():
            raise RuntimeError("a degree of freedom has no stiffness")
        factor = scipy.sparse.linalg.splu(K, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    except RuntimeError as error:
        raise InputError("the structure is a mechanism: part of it can move without resistance; add members or panels") from error
    return scipy.sparse.linalg.LinearOperator(K.shape, matvec=factor.solve, dtype=np.float64)


def _solve(K: Sparse, M: Sparse, solve: scipy.sparse.linalg.LinearOperator, count: int) -> tuple[Array, Array]:
    """Return (2 pi f)^2 `shape (count,)` in ascending order and vectors `shape (n_free, count)` of unit modal mass."""
    start = np.random.default_rng(1).standard_normal(K.shape[0])
    try:
        size = min(2 * count + ROOM, K.shape[0] - 1)
        squares, vectors = scipy.sparse.linalg.eigsh(
            K, count, M=M, sigma=0.0, OPinv=solve, which="LM", v0=start, tol=1e-9, ncv=size, maxiter=MOST_RESTARTS
        )
    except scipy.sparse.linalg.ArpackNoConvergence as error:
        raise InputError(f"only {len(error.eigenvalues)} of {count} eigenmodes were found; choose another mesh size") from error
    order = np.argsort(squares)
    vectors = vectors[:, order]
    return squares[order], vectors / np.sqrt(np.einsum("ij,ij->j", vectors, M @ vectors))
