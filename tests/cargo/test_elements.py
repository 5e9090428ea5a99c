"""Elements and eigenmodes against closed forms of beams and plates."""

import math
from dataclasses import replace

import numpy as np
import pytest

from vehgen.cargo.box_mesh import BeamKind, Mesh
from vehgen.cargo.eigenmodes import eigenmodes, rigid_body
from vehgen.cargo.elements import ElementMatrices, assemble
from vehgen.cargo.panels import Layer
from vehgen.cargo.sections import Section

pytest.importorskip("pyfe3d")

E, NU, RHO = 200e9, 0.3, 7850.0


def beam(n, length=6.0, height=0.03, width=0.02):
    """A slender beam along x whose height is vertical, with its exact bending wave constant sqrt(EI/rho A)/(2 pi)."""
    nodes = np.zeros((n + 1, 3))
    nodes[:, 0] = np.linspace(0, length, n + 1)
    area, strong, weak = height * width, width * height**3 / 12, height * width**3 / 12
    kind = BeamKind(Section(area, strong, weak, weak), E, NU, RHO)
    beams = np.array([[i, i + 1] for i in range(n)])
    mesh = Mesh(nodes, beams=beams, beam_kinds=np.zeros(n, int), beam_up=np.tile([0.0, 0, 1], (n, 1)), kinds=(kind,))
    return mesh, [math.sqrt(E * inertia / (RHO * area)) / (2 * math.pi * length**2) for inertia in (strong, weak)]


def plate(n, m, a=2.0, b=1.5, h=0.006):
    """A plate, the degrees of freedom that its simple support holds, and its exact frequencies by mode (Navier)."""
    nodes = np.array([[x, y, 0] for x in np.linspace(0, a, n + 1) for y in np.linspace(0, b, m + 1)])
    first = np.array([i * (m + 1) + j for i in range(n) for j in range(m)])
    quads = np.stack([first, first + m + 1, first + m + 2, first + 1], axis=1)
    mesh = Mesh(nodes, quads, np.zeros(len(quads), int), (Layer(h, E, NU, RHO),))
    x, y = nodes[:, 0], nodes[:, 1]
    across, along = (x == 0) | (x == a), (y == 0) | (y == b)
    held = np.zeros((len(nodes), 6), bool)
    held[:, [0, 1, 5]] = True
    held[across | along, 2] = True
    held[across, 3] = held[along, 4] = True  # no twist along a supported edge
    D = E * h**3 / 12 / (1 - NU**2)
    exact = sorted(math.pi / 2 * ((p / a) ** 2 + (q / b) ** 2) * math.sqrt(D / (RHO * h)) for p in range(1, 9) for q in range(1, 9))
    return mesh, np.flatnonzero(held), exact


@pytest.mark.parametrize(
    ("ends", "held", "roots", "shares"),
    [
        # roots of sin x = 0 and cos x cosh x = -1; effective mass 8/(k pi)^2 of odd modes, and (2 sigma/x)^2 of a cantilever
        ("pinned", [2, -4], [k * math.pi for k in (1, 2, 3)], [8 / math.pi**2, 0.0, 8 / (9 * math.pi**2)]),
        ("cantilever", [2, 4], [1.875104069, 4.694091133, 7.854757438], [0.613076, 0.188300, 0.064735]),
    ],
)
def test_bending_of_slender_beams(ends, held, roots, shares):
    """Upright and lying: Euler and Bernoulli's frequencies, and the mass that each mode moves."""
    n = 24
    mesh, constants = beam(n)
    matrices = assemble(mesh)
    upright = [6 * i + d for i in range(n + 1) for d in (0, 1, 3, 5)] + [item % mesh.n_dof for item in held]
    modes = eigenmodes(matrices, np.unique(upright), 3)
    assert modes.frequency == pytest.approx([root**2 * constants[0] for root in roots], rel=4e-4)
    assert modes.effective_mass / rigid_body(mesh, matrices.M).mass == pytest.approx(shares, abs=6e-3)
    sideways = {2: 1, -4: -5, 4: 5}
    lying = [6 * i + d for i in range(n + 1) for d in (0, 2, 3, 4)] + [sideways[item] % mesh.n_dof for item in held]
    modes = eigenmodes(matrices, np.unique(lying), 3)
    assert modes.frequency == pytest.approx([root**2 * constants[1] for root in roots], rel=4e-4)
    assert modes.effective_mass == pytest.approx(0.0, abs=1e-9)


def test_a_shaft_twists_as_fast_as_its_torsion_constant_and_polar_inertia_tell():
    """Held at one end it swings at (2 k - 1)/(4 L) sqrt(G J/(rho I_p))."""
    n, length, strong, weak = 24, 2.0, 4e-8, 1e-8
    mesh, _ = beam(n, length)
    kind = BeamKind(Section(6e-4, strong, weak, 2.5e-8), E, NU, RHO)
    held = [6 * i + d for i in range(n + 1) for d in (0, 1, 2, 4, 5)] + [3]
    modes = eigenmodes(assemble(replace(mesh, kinds=(kind,))), np.unique(held), 2)
    wave = math.sqrt(E / (2 * (1 + NU)) * 2.5e-8 / (RHO * (strong + weak)))
    assert modes.frequency == pytest.approx([wave / (4 * length), 3 * wave / (4 * length)], rel=3e-3)


def test_a_short_beam_shears_and_turns_as_timoshenkos_does():
    """Pinned, with k = m pi/L: (S k^2 - rho A w^2) (E I k^2 + S - rho I w^2) = (S k)^2, S = 5/6 G A; the lower root of each k."""
    n, length, height, width = 40, 1.0, 0.25, 0.1
    mesh, _ = beam(n, length, height, width)
    held = [6 * i + d for i in range(n + 1) for d in (0, 1, 3, 5)] + [2, mesh.n_dof - 4]
    area, inertia = height * width, width * height**3 / 12
    S = 5 / 6 * E / (2 * (1 + NU)) * area
    expected = []
    for k in (math.pi / length, 2 * math.pi / length):
        a, b, c = RHO**2 * area * inertia, RHO * (area * (E * inertia * k**2 + S) + inertia * S * k**2), E * inertia * S * k**4
        expected.append(math.sqrt((b - math.sqrt(b**2 - 4 * a * c)) / (2 * a)) / (2 * math.pi))
    modes = eigenmodes(assemble(mesh), np.unique(held), 2)
    assert modes.frequency == pytest.approx(expected, rel=2e-3)


def test_modes_are_complete_once_one_moves_more_than_all_beyond_can():
    """A beam that is higher than wide sways first, which lifts no mass; its second mode lifts 81 %."""
    n = 12
    mesh, _ = beam(n)
    matrices = assemble(mesh)
    held = [0, 1, 2, 3, *(mesh.n_dof - 6 + d for d in (1, 2))]
    assert not eigenmodes(matrices, held, 1).complete
    assert eigenmodes(matrices, held, 2).complete


def test_simply_supported_plate_converges_to_naviers_frequencies():
    errors = []
    for n in (12, 24, 48):
        mesh, held, exact = plate(n, n)
        matrices = assemble(mesh)
        modes = eigenmodes(matrices, held, 5)
        errors.append(np.abs(modes.frequency / exact[:5] - 1))
    assert errors[2].max() < 0.007
    assert errors[2][0] < 0.002
    assert (errors[0] / errors[1] > 3.4).all()
    assert (errors[1] / errors[2] > 3.4).all()
    mass = rigid_body(mesh, matrices.M).mass
    assert modes.effective_mass[0] / mass == pytest.approx((8 / math.pi**2) ** 2, rel=2e-3)


def on_corners(n):
    """A square plate that only its four corners hold."""
    mesh, _, _ = plate(n, n, 2.0, 2.0)
    held = np.zeros((len(mesh.nodes), 6), bool)
    held[:, [0, 1, 5]] = True
    held[np.isin(mesh.nodes[:, :2], (0, 2)).all(axis=1), 2] = True
    return mesh, np.flatnonzero(held)


def test_a_square_plate_on_four_corners():
    """Leissa, Vibration of Plates (NASA SP-160, 1969): 7.11, 15.77, 15.77, 19.60 sqrt(D/rho h)/a^2 at a Poisson's ratio of 0.3."""
    h, a = 0.006, 2.0
    unit = math.sqrt(E * h**2 / 12 / (1 - NU**2) / RHO) / (2 * math.pi * a**2)
    mesh, held = on_corners(32)
    modes = eigenmodes(assemble(mesh), held, 4)
    assert modes.frequency / unit == pytest.approx([7.11, 15.77, 15.77, 19.60], rel=4e-3)


def test_only_rigid_motions_are_free_of_force():
    mesh, _, _ = plate(2, 2)
    K = assemble(mesh).K.toarray()
    squares = np.linalg.eigvalsh(K)
    assert (np.abs(squares[:6]) < 1e-12 * squares[-1]).all()
    assert squares[6] > 1e-8 * squares[-1]
    np.testing.assert_allclose(K, K.T, atol=1e-12 * squares[-1])


def test_hourglass_modes_are_told_from_the_plates_own():
    """With nearly all hourglass control taken away an artefact has the lowest frequency; it is not taken for a mode."""
    mesh, held = on_corners(16)
    whole = assemble(mesh)
    weak = 1e-6
    bare = ElementMatrices(whole.K - (1 - weak) * whole.hourglass, weak * whole.hourglass, whole.M)
    sound, artefacts = eigenmodes(whole, held, 6), eigenmodes(bare, held, 6)
    assert sound.genuine.all()
    assert artefacts.frequency[0] < 0.05 * sound.frequency[0]
    assert artefacts.genuine.tolist() == [False] + 5 * [True]
    assert artefacts.principal > 0
