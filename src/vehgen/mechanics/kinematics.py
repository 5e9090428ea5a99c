"""How every body and axle moves, as rows over the independent coordinates.

Small motions in the pitch plane (ISO 8855: x forward, z up, pitch nose-down positive): a point (x, z) of a body rises by
heave - x*pitch and moves forward by fore_aft + z*pitch. A body that bends turns by more or less than its pitch from place to place,
about its neutral axis: what it carries, and pins above or below that axis, follow the turn at their place. Hinges are constraints and
are eliminated here: the first-declared body of a hinged group keeps its heave, every other body's heave follows from the pins.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

import sympy as sp

from vehgen.mechanics.coordinates import Coordinate
from vehgen.mechanics.rows import Row, combine, unit
from vehgen.mechanics.symbols import to_sympy
from vehgen.vehicle.model import Vehicle
from vehgen.vehicle.parts import GROUND, Point


@dataclass(frozen=True)
class BendingMotion:
    """The row of a body's bending coordinate, the length over which it bends, and the height of its neutral axis above the COG."""

    row: Row
    length: sp.Expr
    axis: sp.Expr


@dataclass(frozen=True)
class Kinematics:
    """Rows of heave, pitch and bending per body, hop per axle, and fore-aft motion per body relative to its group.

    `groups[body]` names the body whose fore-aft motion all bodies of its group share; `fore_aft[body]` is what the body moves
    ahead of it.
    """

    coordinates: tuple[Coordinate, ...]
    heave: dict[str, Row]
    pitch: dict[str, Row]
    hop: dict[str, Row]
    fore_aft: dict[str, Row] = field(default_factory=dict)
    groups: dict[str, str] = field(default_factory=dict)
    bending: dict[str, BendingMotion] = field(default_factory=dict)

    def rise(self, body: str, x: sp.Expr) -> Row:
        """Return the vertical motion of the point x ahead of a body's COG; the ground does not move."""
        if body == GROUND:
            return {}
        return combine((sp.S.One, self.heave[body]), (-x, self.pitch[body]), *self._bent(body, (6 * x**2, sp.S.One)))

    def turn(self, body: str, x: sp.Expr) -> Row:
        """Return the pitch of a body at the point x ahead of its COG, nose-down positive: where it bends, a point may turn more."""
        if body == GROUND:
            return {}
        return combine((sp.S.One, self.pitch[body]), *self._bent(body, (-12 * x, sp.S.Zero)))

    def forward(self, body: str, x: sp.Expr, z: sp.Expr) -> Row:
        """Return how far the point (x, z) of a body moves ahead of its group; on its neutral axis bending moves none."""
        above = z - self.bending[body].axis if body in self.bending else sp.S.Zero
        return combine((sp.S.One, self.fore_aft[body]), (z, self.pitch[body]), *self._bent(body, (-12 * x * above, sp.S.Zero)))

    def _bent(self, body: str, shape: tuple[sp.Expr, sp.Expr]) -> list[tuple[sp.Expr, Row]]:
        """Return what bending adds: with shape (a, b) it is (a/length^2 - b/2) of its coordinate; s = 2 x/length in (3 s^2 - 1)/2."""
        if body not in self.bending:
            return []
        mode = self.bending[body]
        return [(shape[0] / mode.length**2 - shape[1] / 2, mode.row)]

    def index(self, name: str) -> int:
        """Return the place of a coordinate by name."""
        return [coordinate.name for coordinate in self.coordinates].index(name)


def derive_kinematics(vehicle: Vehicle) -> Kinematics:
    """Choose the independent coordinates of a vehicle and express every motion in them."""
    followers = {body: (parent, parent_point, point) for body, parent, parent_point, point in _hinge_order(vehicle)}
    coordinates: list[Coordinate] = []
    for name, body in vehicle.bodies.items():
        if "heave" in body.motions and name not in followers:
            coordinates.append(Coordinate("heave", name))
        if "pitch" in body.motions:
            coordinates.append(Coordinate("pitch", name))
        if body.bending is not None:
            coordinates.append(Coordinate("bending", name))
    coordinates += [Coordinate("hop", name) for name, axle in vehicle.axles.items() if axle.mass is not None]
    index = {coordinate.name: i for i, coordinate in enumerate(coordinates)}
    motion = Kinematics(
        tuple(coordinates),
        {},
        {},
        {name: unit(index[f"hop.{name}"]) for name in vehicle.axles if f"hop.{name}" in index},
    )

    for name, body in vehicle.bodies.items():
        if body.bending is not None:
            row = unit(index[f"bending.{name}"])
            motion.bending[name] = BendingMotion(row, to_sympy(body.bending.length), to_sympy(body.bending.z))
    for name in _carrier_order(vehicle):
        body = vehicle.bodies[name]
        carrier = body.carried_by
        if "pitch" in body.motions:
            motion.pitch[name] = unit(index[f"pitch.{name}"])
        else:
            motion.pitch[name] = motion.turn(carrier.body, to_sympy(carrier.x)) if carrier else {}
        if "heave" in body.motions and name not in followers:
            motion.heave[name] = unit(index[f"heave.{name}"])
        elif name not in followers:
            motion.heave[name] = motion.rise(carrier.body, to_sympy(carrier.x)) if carrier else {}
        if carrier is None and name not in followers:
            motion.fore_aft[name], motion.groups[name] = {}, name
        elif carrier is not None:
            motion.fore_aft[name] = motion.forward(carrier.body, to_sympy(carrier.x), to_sympy(carrier.z))
            motion.groups[name] = motion.groups[carrier.body]
        for follower, (parent, parent_point, point) in followers.items():
            if parent in motion.heave and follower not in motion.heave:
                _follow(motion, index, follower, parent, parent_point, point)
    return motion


def _follow(motion: Kinematics, index: dict[str, int], body: str, parent: str, parent_point: Point, point: Point) -> None:
    """Express a hinged body's motion by its parent's: both see the pin move alike."""
    motion.pitch[body] = unit(index[f"pitch.{body}"])
    motion.heave[body] = {}
    own = motion.rise(body, to_sympy(point.x))
    motion.heave[body] = combine((sp.S.One, motion.rise(parent, to_sympy(parent_point.x))), (sp.S.NegativeOne, own))
    motion.fore_aft[body] = {}
    own = motion.forward(body, to_sympy(point.x), to_sympy(point.z))
    pin = motion.forward(parent, to_sympy(parent_point.x), to_sympy(parent_point.z))
    motion.fore_aft[body] = combine((sp.S.One, pin), (sp.S.NegativeOne, own))
    motion.groups[body] = motion.groups[parent]


def _hinge_order(vehicle: Vehicle) -> Iterator[tuple[str, str, Point, Point]]:
    """Yield (body, parent, parent's point, own point) outwards from the first-declared body of each hinged group."""
    placed: set[str] = set()
    for root in vehicle.bodies:
        if root in placed:
            continue
        placed.add(root)
        front = [root]
        while front:
            parent = front.pop(0)
            for hinge in vehicle.hinges.values():
                for (near, near_point), (far, far_point) in (hinge.ends, hinge.ends[::-1]):
                    if near == parent and far not in placed:
                        placed.add(far)
                        front.append(far)
                        yield far, parent, near_point, far_point


def _carrier_order(vehicle: Vehicle) -> list[str]:
    """Return the bodies that no hinge moves, carriers before what they carry; hinged followers come with their parents."""
    followers = {body for body, *_ in _hinge_order(vehicle)}

    def depth(name: str) -> int:
        carriers = 0
        while (carrier := vehicle.bodies[name].carried_by) is not None:
            name, carriers = carrier.body, carriers + 1
        return carriers

    return sorted((name for name in vehicle.bodies if name not in followers), key=depth)
