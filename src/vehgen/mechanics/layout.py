"""Where every body, axle and hinge sits along the vehicle."""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

from vehgen.errors import InputError
from vehgen.mechanics.symbols import to_sympy
from vehgen.vehicle.model import Vehicle
from vehgen.vehicle.parts import GROUND


@dataclass(frozen=True)
class Layout:
    """Positions from the first body's COG as sympy expressions [m]: x ahead, z above (None where the file does not tell)."""

    bodies: dict[str, tuple[sp.Expr, sp.Expr | None]]
    axles: dict[str, sp.Expr]
    hinges: dict[str, tuple[sp.Expr, sp.Expr | None]]

    def place(self, vehicle: Vehicle, name: str) -> sp.Expr:
        """Return the x position of an axle, hinge or body by name."""
        if name in vehicle.axles:
            return self.axles[name]
        if name in vehicle.hinges:
            return self.hinges[name][0]
        return self.bodies[name][0]


def lay_out(vehicle: Vehicle) -> Layout:
    """Follow hinges, carriers and links from the first body to all others.

    Raises
    ------
    InputError
        For a body that nothing connects to the first and that has no `at`.
    """
    bodies: dict[str, tuple[sp.Expr, sp.Expr | None]] = {}
    for index, (name, body) in enumerate(vehicle.bodies.items()):
        if index == 0 or body.at is not None:
            bodies[name] = (to_sympy(body.at) if body.at is not None else sp.S.Zero, sp.S.Zero)
    for connect in (_along_hinges, _along_carriers, _along_links):
        while connect(vehicle, bodies):
            while _along_hinges(vehicle, bodies) or _along_carriers(vehicle, bodies):
                pass
    for name in vehicle.bodies:
        if name not in bodies:
            raise InputError(
                f"nothing connects body {name!r} to {next(iter(vehicle.bodies))!r}; say where it is with `at` "
                "(its COG ahead of the first body's COG, e.g. -12 m)",
                vehicle.position("bodies", name, key=True),
            )
    axles = {name: bodies[axle.body][0] + to_sympy(axle.x) for name, axle in vehicle.axles.items()}
    hinges: dict[str, tuple[sp.Expr, sp.Expr | None]] = {}
    for name, hinge in vehicle.hinges.items():
        body_name, point = hinge.ends[0]
        x, z = bodies[body_name]
        hinges[name] = (x + to_sympy(point.x), None if z is None else z + to_sympy(point.z))
    return Layout(bodies, axles, hinges)


def _along_hinges(vehicle: Vehicle, bodies: dict[str, tuple[sp.Expr, sp.Expr | None]]) -> bool:
    found = False
    for hinge in vehicle.hinges.values():
        for (near, near_point), (far, far_point) in (hinge.ends, hinge.ends[::-1]):
            if near in bodies and far not in bodies:
                x, z = bodies[near]
                height = None if z is None else z + to_sympy(near_point.z) - to_sympy(far_point.z)
                bodies[far] = (x + to_sympy(near_point.x) - to_sympy(far_point.x), height)
                found = True
    return found


def _along_carriers(vehicle: Vehicle, bodies: dict[str, tuple[sp.Expr, sp.Expr | None]]) -> bool:
    found = False
    for name, body in vehicle.bodies.items():
        if body.carried_by is None:
            continue
        carrier, dx, dz = body.carried_by.body, to_sympy(body.carried_by.x), to_sympy(body.carried_by.z)
        if carrier in bodies and name not in bodies:
            x, z = bodies[carrier]
            bodies[name] = (x + dx, None if z is None else z + dz)
            found = True
        elif name in bodies and carrier not in bodies:
            x, z = bodies[name]
            bodies[carrier] = (x - dx, None if z is None else z - dz)
            found = True
    return found


def _along_links(vehicle: Vehicle, bodies: dict[str, tuple[sp.Expr, sp.Expr | None]]) -> bool:
    """Place one body by a link: its two points lie above each other; heights stay unknown."""
    for link in vehicle.links.values():
        for (near, near_point), (far, far_point) in (link.ends, link.ends[::-1]):
            if near != GROUND and far != GROUND and near in bodies and far not in bodies:
                bodies[far] = (bodies[near][0] + to_sympy(near_point.x) - to_sympy(far_point.x), None)
                return True
    return False
