"""A whole module: what it weighs and where, its mode under refinement, the cargo it becomes, and files that cannot be used."""

import itertools
import math
import sys

import numpy as np
import pytest

from vehgen.cargo import load_cargo
from vehgen.cargo.box_mesh import box_grid, box_mesh
from vehgen.cargo.eigenmodes import Eigenmodes, RigidBody
from vehgen.cargo.frame_file import load_frame
from vehgen.cargo.module_model import _warnings, cargo_text, convergence, module_model, node_limit
from vehgen.errors import InputError

FRAME = """\
title: a small box
on: semitrailer
behind: fifth_wheel
front: 0.5 m
base: 0.2 m
size: {length: 2.4 m, width: 1.2 m, height: 1.0 m}
materials:
  steel: {E: 200 GPa, nu: 0.3, density: 7850 kg/m^3}
  board: {E: 8 GPa, nu: 0.25, density: 700 kg/m^3}
  wool: {E: 0 Pa, nu: 0, density: 2000 kg/m^3}
sections:
  rail: {tube: {height: 60 mm, width: 40 mm, thickness: 3 mm}}
  joist: {bar: {height: 50 mm, width: 10 mm}}
frame:
  bottom_rails: {material: steel, section: rail}
  posts: {material: steel, section: rail}
  floor_joists: {material: steel, section: joist, spacing: 0.65 m}
  studs: {material: steel, section: joist, spacing: 0.6 m}
panels:
  floor: {layers: [{material: board, thickness: 20 mm}, {material: wool, thickness: 50 mm}]}
  roof: {layers: [{material: board, thickness: 12 mm}]}
  front: {layers: [{material: board, thickness: 30 mm}]}
  walls: {layers: [{material: board, thickness: 12 mm}]}
mesh: {size: 0.2 m}
damping: [{frequency: 5 Hz, ratio: 0.03}, {frequency: 40 Hz, ratio: 0.03}]
"""


@pytest.fixture
def read(tmp_path):
    def read(text=FRAME):
        (tmp_path / "frame.yaml").write_text(text)
        return load_frame(tmp_path / "frame.yaml")

    return read


def test_the_grid_goes_through_every_member(read):
    x, y, z = box_grid(read(), 0.25)
    for station in (0.6, 1.2, 1.8):
        assert np.abs(x - station).min() < 1e-9
    assert np.diff(x).max() <= 0.25 + 1e-9
    assert (y[0], y[-1], z[-1]) == (0.0, 1.2, 1.0)
    mesh, corners = box_mesh(read(), 0.25)
    assert sorted(map(tuple, mesh.nodes[corners])) == [(0, 0, 0), (0, 1.2, 0), (2.4, 0, 0), (2.4, 1.2, 0)]
    assert len(np.unique(mesh.nodes.round(9), axis=0)) == len(mesh.nodes)


def test_mass_centre_and_inertia_are_those_of_the_parts(read):
    """Sums over panels and members as thin sheets and rods, each with its place, written by hand."""
    pytest.importorskip("pyfe3d")
    length, width, height = 2.4, 1.2, 1.0
    rail = 7850 * (0.06 * 0.04 - 0.054 * 0.034)
    joist = 7850 * 0.05 * 0.01
    parts = []  # mass, x, z, own length along x, own length along z
    for mass, z in ((700 * 0.020 + 2000 * 0.05, 0.0), (700 * 0.012, height)):
        parts.append((mass * length * width, length / 2, z, length, 0.0))
    parts += [(700 * thick * width * height, x, height / 2, 0.0, height) for thick, x in ((0.03, 0.0), (0.012, length))]
    parts += 2 * [(700 * 0.012 * length * height, length / 2, height / 2, length, height)]
    parts += 2 * [(rail * length, length / 2, 0.0, length, 0.0)]
    parts += [(rail * width, x, 0.0, 0.0, 0.0) for x in (0.0, length)]
    parts += [(rail * height, x, height / 2, 0.0, height) for x in (0.0, 0.0, length, length)]
    parts += [(joist * width, x, 0.0, 0.0, 0.0) for x in (0.6, 1.2, 1.8)]
    parts += [(joist * height, x, height / 2, 0.0, height) for x in (0.6, 1.2, 1.8) for _ in (0, 1)]
    parts += [(joist * height, x, height / 2, 0.0, height) for x in (0.0, length)]
    mass, x, z, along, up = np.array(parts).T
    cog = (mass @ x / mass.sum(), mass @ z / mass.sum())
    inertia = (mass * ((x - cog[0]) ** 2 + (z - cog[1]) ** 2 + (along**2 + up**2) / 12)).sum()
    body = module_model(read()).body
    assert body.mass == pytest.approx(mass.sum(), rel=1e-9)
    assert body.cog == pytest.approx([cog[0], width / 2, cog[1]], rel=1e-9)
    assert body.pitch_inertia == pytest.approx(inertia, rel=2e-3)  # the parts' own thickness is left out by hand


def test_the_modes_frequency_settles_under_refinement(read):
    pytest.importorskip("pyfe3d")
    text = FRAME.replace("length: 2.4 m, width: 1.2 m", "length: 2 m, width: 1 m").replace("spacing: 0.6 m", "spacing: 1 m")
    frame = read(text.replace("  floor_joists: {material: steel, section: joist, spacing: 0.65 m}\n", ""))
    found = [module_model(frame, size).frequency for size in (0.25, 0.125, 0.0625)]
    first, second = (a - b for a, b in itertools.pairwise(found))
    assert first / second == pytest.approx(4, rel=0.15)  # second order
    assert second < 0.04 * found[2]


def test_what_sits_on_the_spring(read):
    """k0 = (2 pi f0)^2 m0, c0 = 2 zeta (2 pi f0) m0, with the whole mass or the effective one and the rest fixed."""
    pytest.importorskip("pyfe3d")
    whole, effective = module_model(read()), module_model(read(FRAME + "mass: effective\n"))
    for model in (whole, effective):
        w0 = 2 * math.pi * model.frequency
        assert model.stiffness == pytest.approx(w0**2 * model.mass)
        assert model.damping == pytest.approx(2 * model.damping_ratio * w0 * model.mass)
    assert whole.mass == whole.body.mass
    assert whole.fixed_mass == 0
    assert effective.mass == pytest.approx(whole.effective_mass)
    assert effective.mass + effective.fixed_mass == pytest.approx(whole.mass)
    assert module_model(read(), mass="effective").mass == effective.mass
    assert 0.1 < whole.effective_share < 0.9
    assert whole.modes.effective_mass.sum() < whole.body.mass


def modes_of(effective, hourglass=0.01, complete=True):
    """Return modes of 5, 9 and 14 Hz that move some of a body of 1000 kg; the first has a share of its energy in hourglass control."""
    return Eigenmodes(np.array([5.0, 9.0, 14.0]), np.zeros((3, 1, 6)), np.array(effective), np.array([hourglass, 0.0, 0.0]), complete)


@pytest.mark.parametrize(
    ("modes", "said"),
    [
        (modes_of([520.0, 300.0, 100.0]), ""),
        (
            modes_of([450.0, 100.0, 300.0]),
            "moves 45% of the mass, so that one mass on a spring is a rough model; next: 14 Hz (30%) and 9 Hz",
        ),
        (modes_of([700.0, 0.0, 0.0], hourglass=0.07), "7% of the principal mode's strain energy is hourglass control"),
        (modes_of([700.0, 0.0, 0.0], complete=False), "modes were sought up to 14 Hz; a higher one may move more mass vertically"),
    ],
)
def test_a_module_that_one_spring_hardly_stands_for_is_warned_of(modes, said):
    assert said in "".join(_warnings(modes, RigidBody(1000.0, np.zeros(3), 0.0)))
    assert bool(_warnings(modes, RigidBody(1000.0, np.zeros(3), 0.0))) is bool(said)


def test_the_cargo_file_reads_back(read, tmp_path):
    pytest.importorskip("pyfe3d")
    for kind in ("total", "effective"):
        model = module_model(read(f"name: box\nsource: 'it''s ours'\n{FRAME}mass: {kind}\n"), 0.4)
        (tmp_path / "cargo.yaml").write_text(cargo_text(model))
        cargo = load_cargo(tmp_path / "cargo.yaml")
        module = cargo.file.module
        assert (module.mass, module.k0, module.c0, module.fixed_mass) == (model.mass, model.stiffness, model.damping, model.fixed_mass)
        assert (module.front, module.base) == (0.5, 0.2)
        assert module.pitch_inertia == model.body.pitch_inertia
        assert (module.cog.behind_front, module.cog.above_floor) == (model.body.cog[0], model.body.cog[2])
        assert (cargo.file.name, cargo.file.source) == ("box", "it's ours")


def test_convergence_study(read):
    pytest.importorskip("pyfe3d")
    sizes = [model.mesh_size for model in convergence(read(FRAME.replace("size: 0.2 m", "size: 0.4 m")))]
    assert sizes == pytest.approx([0.8, 0.4 * math.sqrt(2), 0.4, 0.4 / math.sqrt(2)])


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("material: steel, section: rail}\n  posts", "material: stel, section: rail}\n  posts", "no material 'stel'; did you mean 'steel'"),
        ("section: joist, spacing: 0.65 m", "section: joits, spacing: 0.65 m", "no section 'joits'; did you mean 'joist'"),
        ("{material: board, thickness: 30 mm}", "{material: bord, thickness: 30 mm}", "no material 'bord'; did you mean 'board'"),
        ("{material: board, thickness: 30 mm}", "{material: wool, thickness: 30 mm}", "a panel needs a layer with E above 0"),
        ("E: 200 GPa", "E: 200 kN", "expected kg m^-1 s^-2, found N in '200 kN'"),
        ("nu: 0.25", "nu: 0.5", "input should be less than 0.5"),
        ("length: 2.4 m", "lenght: 2.4 m", "unknown key 'lenght'; did you mean 'length'"),
        ("posts:", "pots:", "unknown key 'pots'; did you mean 'posts'"),
        ("rail: {tube:", "rail: {tub:", "unknown key 'tub'; did you mean 'tube'"),
        ("frequency: 40 Hz", "frequency: 5 Hz", "Rayleigh damping needs ratios at two different frequencies"),
        ("frequency: 40 Hz, ratio: 0.03", "frequency: 40 Hz, ratio: 0.9", "no Rayleigh damping has these two ratios"),
    ],
)
def test_a_bad_frame_file(read, old, new, message):
    assert old in FRAME
    with pytest.raises(InputError, match=r"frame\.yaml:\d+:\d+: ") as caught:
        read(FRAME.replace(old, new))
    assert message in str(caught.value)


def test_a_mesh_that_does_not_fit_into_memory(read):
    with pytest.raises(
        InputError, match=r"frame\.yaml:24:14: a mesh size of 0\.01 m makes about \d+ nodes, and \d+ fit in the memory; choose"
    ):
        module_model(
            read(FRAME.replace("size: 0.2 m", "size: 0.01 m").replace("length: 2.4", "length: 30").replace("width: 1.2", "width: 9"))
        )
    assert 1000 < node_limit() <= 50_000


def test_a_corner_without_anything(read):
    text = (
        FRAME[: FRAME.index("frame:")] + "panels: {roof: {layers: [{material: board, thickness: 12 mm}]}}\n" + FRAME[FRAME.index("mesh:") :]
    )
    with pytest.raises(InputError, match="a bottom corner is part of no panel and no member"):
        module_model(read(text))


def test_without_the_package(read, monkeypatch):
    monkeypatch.setitem(sys.modules, "pyfe3d", None)
    with pytest.raises(InputError, match=r"finite elements need the package pyfe3d: pip install 'vehgen\[fe\]'"):
        module_model(read())


def test_another_shell_element_finds_the_same_mode(read, monkeypatch):
    """Quad4 integrates fully and needs no hourglass control; both converge to the same frequency."""
    fe = pytest.importorskip("pyfe3d")
    frame = read(FRAME.replace("  floor_joists: {material: steel, section: joist, spacing: 0.65 m}\n", ""))
    found = module_model(frame, 0.12)

    class Quad(fe.Quad4):
        def update_KC0(self, rows, columns, values, prop, *options):
            if not options:
                super().update_KC0(rows, columns, values, prop)

    for name, other in (("Quad4R", Quad), ("Quad4RData", fe.Quad4Data), ("Quad4RProbe", fe.Quad4Probe)):
        monkeypatch.setattr(fe, name, other)
    monkeypatch.setattr("vehgen.cargo.eigenmodes.SPURIOUS", 2.0)  # all of its stiffness counts as hourglass control here
    monkeypatch.setattr("vehgen.cargo.module_model.COARSE_HOURGLASS", 2.0)
    other = module_model(frame, 0.12)
    assert other.frequency == pytest.approx(found.frequency, rel=0.03)
    assert other.body.mass == pytest.approx(found.body.mass, rel=1e-12)
    assert other.effective_share == pytest.approx(found.effective_share, rel=0.03)
