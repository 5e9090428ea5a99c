"""A box of panels and frame members as a mesh of rectangles and beams on one grid.

x runs from the front rearwards, y from left to right, z up; the origin is the front left bottom corner [m].
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from vehgen.cargo.frame_file import FrameModule, SpacedMember
from vehgen.cargo.panels import Layer
from vehgen.cargo.sections import Section

Array = NDArray[np.float64]
Indices = NDArray[np.int64]
GridPoint = tuple[int, int, int]

_FACES = {"floor": (2, 0), "roof": (2, -1), "front": (0, 0), "rear": (0, -1), "left": (1, 0), "right": (1, -1)}
"""The axis that a face is normal to, and its place on that axis: first or last."""
_UP = {0: (0.0, 0.0, 1.0), 1: (0.0, 0.0, 1.0), 2: (1.0, 0.0, 0.0)}
"""The direction of a section's height for members along each axis."""


@dataclass(frozen=True)
class BeamKind:
    """A section of a material: E [Pa], Poisson's ratio, density [kg/m^3]."""

    section: Section
    modulus: float
    poisson: float
    density: float


@dataclass
class Mesh:
    """Nodes, shells and beams.

    `nodes shape (n_nodes, 3)` [m]; `quads shape (n_quads, 4)` nodes round each rectangle and `quad_kinds shape (n_quads,)` indices into
    `layers`; `beams shape (n_beams, 2)`, `beam_kinds shape (n_beams,)` indices into `kinds`, `beam_up shape (n_beams, 3)` the direction of
    each section's height.
    """

    nodes: Array
    quads: Indices = field(default_factory=lambda: np.zeros((0, 4), dtype=np.int64))
    quad_kinds: Indices = field(default_factory=lambda: np.zeros(0, dtype=np.int64))
    layers: tuple[Layer, ...] = ()
    beams: Indices = field(default_factory=lambda: np.zeros((0, 2), dtype=np.int64))
    beam_kinds: Indices = field(default_factory=lambda: np.zeros(0, dtype=np.int64))
    beam_up: Array = field(default_factory=lambda: np.zeros((0, 3)))
    kinds: tuple[BeamKind, ...] = ()

    @property
    def n_dof(self) -> int:
        """Three translations and three rotations a node."""
        return 6 * len(self.nodes)


def box_grid(frame: FrameModule, size: float) -> tuple[Array, Array, Array]:
    """Return the grid lines along x, y and z: through every joist and stud, and at most `size` [m] apart."""
    box, members = frame.file.size, frame.file.frame
    along = [_stations(box.length, member) for member in (members.floor_joists, members.roof_joists, members.studs) if member]
    across = [_stations(box.width, members.studs)] if members.studs else []
    return _lines(box.length, along, size), _lines(box.width, across, size), _lines(box.height, [], size)


def box_node_count(frame: FrameModule, size: float) -> int:
    """Return about how many nodes a mesh size gives, at most."""
    n, m, k = (len(line) for line in box_grid(frame, size))
    return n * m * k - max(n - 2, 0) * max(m - 2, 0) * max(k - 2, 0)


def box_mesh(frame: FrameModule, size: float) -> tuple[Mesh, Indices]:
    """Mesh a module at a mesh size [m]; returns the mesh and the nodes at the bottom corners that it has."""
    grid = box_grid(frame, size)
    numbers: dict[GridPoint, int] = {}

    def node(point: GridPoint) -> int:
        return numbers.setdefault(point, len(numbers))

    quads: list[list[int]] = []
    quad_kinds: list[int] = []
    layers: list[Layer] = []
    for face, _, panel in frame.file.panels.faces():
        for rectangle in _face_quads(face, grid):
            quads.append([node(point) for point in rectangle])
            quad_kinds.append(len(layers))
        layers.append(frame.layer(panel))
    beams: list[list[int]] = []
    beam_kinds: list[int] = []
    beam_up: list[tuple[float, float, float]] = []
    kinds: list[BeamKind] = []
    for name, member in frame.file.frame.members():
        material = frame.file.materials[member.material]
        for axis, points in _member_lines(name, member, grid):
            for first, second in itertools.pairwise(points):
                beams.append([node(first), node(second)])
                beam_kinds.append(len(kinds))
                beam_up.append(_UP[axis])
        kinds.append(BeamKind(frame.file.sections[member.section].section(), material.E, material.nu, material.density))
    nodes = np.array([[grid[axis][index] for axis, index in enumerate(point)] for point in numbers])
    last_x, last_y = len(grid[0]) - 1, len(grid[1]) - 1
    corners = [numbers[point] for point in itertools.product((0, last_x), (0, last_y), (0,)) if point in numbers]
    mesh = Mesh(
        nodes,
        np.array(quads, dtype=np.int64).reshape(-1, 4),
        np.array(quad_kinds, dtype=np.int64),
        tuple(layers),
        np.array(beams, dtype=np.int64).reshape(-1, 2),
        np.array(beam_kinds, dtype=np.int64),
        np.array(beam_up, dtype=float).reshape(-1, 3),
        tuple(kinds),
    )
    return mesh, np.array(corners, dtype=np.int64)


def _stations(length: float, member: SpacedMember) -> Array:
    return np.linspace(0.0, length, max(math.ceil(length / member.spacing - 1e-9), 1) + 1)


def _lines(length: float, stations: list[Array], size: float) -> Array:
    """Return the stations, those that coincide once, with the gaps between them divided evenly."""
    found = np.unique(np.round(np.concatenate([[0.0, length], *stations]), 6))
    pieces = [np.linspace(a, b, math.ceil((b - a) / size - 1e-9) + 1)[:-1] for a, b in itertools.pairwise(found)]
    return np.concatenate([*pieces, [length]])


def _face_quads(face: str, grid: tuple[Array, Array, Array]) -> Iterator[list[GridPoint]]:
    normal, end = _FACES[face]
    first, second = (axis for axis in range(3) if axis != normal)
    fixed = end % len(grid[normal])
    for i, j in itertools.product(range(len(grid[first]) - 1), range(len(grid[second]) - 1)):
        corners = []
        for di, dj in ((0, 0), (1, 0), (1, 1), (0, 1)):
            point = [0, 0, 0]
            point[normal], point[first], point[second] = fixed, i + di, j + dj
            corners.append((point[0], point[1], point[2]))
        yield corners


def _member_lines(name: str, member: object, grid: tuple[Array, Array, Array]) -> Iterator[tuple[int, list[GridPoint]]]:
    """Yield each member of a kind: the axis it runs along, and its grid points."""
    nx, ny, nz = (len(line) for line in grid)
    top = nz - 1 if name in ("top_rails", "roof_joists") else 0
    inner_x: list[int] = []
    inner_y: list[int] = []
    if isinstance(member, SpacedMember):
        inner_x, inner_y = (_indices(grid[axis], _stations(float(grid[axis][-1]), member)[1:-1]) for axis in (0, 1))
    if name in ("bottom_rails", "top_rails"):
        for j in (0, ny - 1):
            yield 0, [(i, j, top) for i in range(nx)]
        for i in (0, nx - 1):
            yield 1, [(i, j, top) for j in range(ny)]
    elif name in ("floor_joists", "roof_joists"):
        for i in inner_x:
            yield 1, [(i, j, top) for j in range(ny)]
    elif name == "posts":
        for i, j in itertools.product((0, nx - 1), (0, ny - 1)):
            yield 2, [(i, j, k) for k in range(nz)]
    else:
        for i, j in [*itertools.product(inner_x, (0, ny - 1)), *itertools.product((0, nx - 1), inner_y)]:
            yield 2, [(i, j, k) for k in range(nz)]


def _indices(line: Array, stations: Array) -> list[int]:
    return [int(np.argmin(np.abs(line - station))) for station in stations]
