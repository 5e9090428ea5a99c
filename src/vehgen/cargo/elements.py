"""Stiffness and mass matrices of a mesh, with the elements of pyfe3d (optional package).

Shells are Quad4R: bilinear Mindlin quadrilaterals, one integration point, hourglass control after Brockman 1987
(doi:10.1002/nme.1620241208). Beams are BeamC: Timoshenko beams with consistent shape functions. Members lie in the middle surfaces of the
panels they share nodes with.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
import scipy
from numpy.typing import NDArray

from vehgen.cargo.box_mesh import BeamKind, Mesh
from vehgen.errors import InputError

Array = NDArray[np.float64]
Sparse: TypeAlias = scipy.sparse.csc_matrix
SHEAR_FACTOR = 5 / 6
"""Shear correction of plates and of every section."""


@dataclass(frozen=True)
class ElementMatrices:
    """Matrices of a mesh, `shape (6 n_nodes, 6 n_nodes)`: stiffness K, the part of K that only controls hourglassing, consistent mass M."""

    K: Sparse
    hourglass: Sparse
    M: Sparse


def assemble(mesh: Mesh) -> ElementMatrices:
    """Assemble a mesh.

    Raises
    ------
    InputError
        When pyfe3d is not installed.
    """
    fe = _package()
    x = np.ascontiguousarray(mesh.nodes, dtype=float).ravel()
    shells, hourglass, shell_mass = _shells(fe, mesh, x)
    beams, beam_mass = _beams(fe, mesh, x)
    return ElementMatrices(shells + beams, hourglass, shell_mass + beam_mass)


def _package() -> Any:
    try:
        import pyfe3d
    except ImportError as error:
        raise InputError("finite elements need the package pyfe3d: pip install 'vehgen[fe]'") from error
    return pyfe3d


class _EntryList:
    """Rows, columns and values that elements write one after another."""

    def __init__(self, fe: Any, n_elements: int, size: int) -> None:
        self.size = size
        self.rows = np.zeros(n_elements * size, dtype=fe.INT)
        self.columns = np.zeros(n_elements * size, dtype=fe.INT)
        self.values = np.zeros(n_elements * size)

    def matrix(self, n_dof: int) -> Sparse:
        return scipy.sparse.csc_matrix((self.values, (self.rows, self.columns)), shape=(n_dof, n_dof))


def _shells(fe: Any, mesh: Mesh, x: Array) -> tuple[Sparse, Sparse, Sparse]:
    from pyfe3d.shellprop_utils import isotropic_plate

    properties = [
        isotropic_plate(thickness=layer.thickness, E=layer.modulus, nu=layer.poisson, rho=layer.density, shear_correction="constant")
        for layer in mesh.layers
    ]
    data, probe = fe.Quad4RData(), fe.Quad4RProbe()
    count = len(mesh.quads)
    stiffness, mass = _EntryList(fe, count, data.KC0_SPARSE_SIZE), _EntryList(fe, count, data.M_SPARSE_SIZE)
    bare = np.zeros_like(stiffness.values)
    for number, (nodes, kind) in enumerate(zip(mesh.quads.tolist(), mesh.quad_kinds.tolist(), strict=True)):
        quad = fe.Quad4R(probe)
        quad.n1, quad.n2, quad.n3, quad.n4 = nodes
        quad.c1, quad.c2, quad.c3, quad.c4 = (fe.DOF * node for node in nodes)
        quad.init_k_KC0, quad.init_k_M = number * stiffness.size, number * mass.size
        quad.update_rotation_matrix(x)
        quad.update_probe_xe(x)
        quad.update_KC0(stiffness.rows, stiffness.columns, stiffness.values, properties[kind])
        quad.update_KC0(stiffness.rows, stiffness.columns, bare, properties[kind], 1, 0.0, 0.0, 0.0, 0.0, 0.0)
        quad.update_M(mass.rows, mass.columns, mass.values, properties[kind])
    whole = stiffness.matrix(mesh.n_dof)
    stiffness.values -= bare
    return whole, stiffness.matrix(mesh.n_dof), mass.matrix(mesh.n_dof)


def _beams(fe: Any, mesh: Mesh, x: Array) -> tuple[Sparse, Sparse]:
    properties = [_beam_property(kind) for kind in mesh.kinds]
    data, probe = fe.BeamCData(), fe.BeamCProbe()
    count = len(mesh.beams)
    stiffness, mass = _EntryList(fe, count, data.KC0_SPARSE_SIZE), _EntryList(fe, count, data.M_SPARSE_SIZE)
    for number, (nodes, kind, up) in enumerate(zip(mesh.beams.tolist(), mesh.beam_kinds.tolist(), mesh.beam_up.tolist(), strict=True)):
        beam = fe.BeamC(probe)
        beam.n1, beam.n2 = nodes
        beam.c1, beam.c2 = (fe.DOF * node for node in nodes)
        beam.init_k_KC0, beam.init_k_M = number * stiffness.size, number * mass.size
        beam.update_rotation_matrix(*up, x)
        beam.update_probe_xe(x)
        beam.update_KC0(stiffness.rows, stiffness.columns, stiffness.values, properties[kind])
        beam.update_M(mass.rows, mass.columns, mass.values, properties[kind])
    return stiffness.matrix(mesh.n_dof), mass.matrix(mesh.n_dof)


def _beam_property(kind: BeamKind) -> Any:
    """Return pyfe3d's property of a section whose height is along the element's y axis, so that its strong axis is Izz."""
    from pyfe3d.beamprop import BeamProp

    section = kind.section
    shear = kind.modulus / (2 * (1 + kind.poisson))
    found = BeamProp()
    found.A, found.E, found.G = section.area, kind.modulus, shear
    found.G12 = found.G13 = SHEAR_FACTOR * shear
    found.Izz, found.Iyy, found.J = section.strong, section.weak, section.torsion
    found.intrho = kind.density * section.area
    found.intrhoy2, found.intrhoz2 = kind.density * section.strong, kind.density * section.weak
    return found
