"""The energies of a vehicle, term by term: what Lagrange's equations start from."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import sympy as sp

from vehgen.mechanics.kinematics import Kinematics
from vehgen.mechanics.law_terms import LawTerm, read_laws
from vehgen.mechanics.laws import Kind
from vehgen.mechanics.rows import Row, combine
from vehgen.mechanics.symbols import to_sympy
from vehgen.vehicle.model import Vehicle
from vehgen.vehicle.parts import GROUND, Body


@dataclass(frozen=True)
class Inertia:
    """A kinetic energy 1/2 * inertia * (row . velocities)^2."""

    owner: str
    inertia: sp.Expr
    row: Row


@dataclass(frozen=True)
class Element:
    """A spring and damper between moving points: travel = row . q + input_row . w.

    Potential energy k*travel^2/2, dissipation function c*rate^2/2. Travel is positive in compression: the wheel rises
    against its body, the road against the wheel, a link's first-named end (the ground always counts as first) against its second.
    """

    name: str
    kind: Kind | Literal["bending"]
    k: sp.Expr
    c: sp.Expr
    row: Row
    input_row: Row
    laws: tuple[LawTerm, ...] = ()


@dataclass(frozen=True)
class Energies:
    """All terms: inertias with independent motion, fore-aft masses per group, springs and dampers, weights."""

    inertias: tuple[Inertia, ...]
    fore_aft: dict[str, tuple[Inertia, ...]]
    elements: tuple[Element, ...]
    weights: tuple[Inertia, ...]

    def eliminated(self, group: str) -> Row:
        """Return a group's eliminated fore-aft coordinate: it moves so that the group's momentum stays zero, -sum m h/sum m."""
        terms = self.fore_aft[group]
        total = sp.Add(*(term.inertia for term in terms))
        return combine(*((-term.inertia / total, term.row) for term in terms))


def pitch_inertia(body: Body) -> sp.Expr:
    """Return a body's pitch inertia: as given, or that of a uniform box of its `size`, m (l^2 + h^2)/12 [kg m^2]."""
    if body.pitch_inertia is not None:
        return to_sympy(body.pitch_inertia)
    if body.size is None:
        return sp.S.Zero
    return to_sympy(body.mass) * (to_sympy(body.size.length) ** 2 + to_sympy(body.size.height) ** 2) / 12


def bending_mass(body: Body) -> sp.Expr:
    """Return the modal mass of a body's bending, the integral of its shape squared over a uniform beam: a fifth of its mass [kg]."""
    return to_sympy(body.mass) / 5


def write_energies(vehicle: Vehicle, motion: Kinematics) -> tuple[Energies, tuple[str, ...]]:
    """Write down every energy term; also returns the names of the displacement inputs (`road.AXLE`, `ground.LINK`)."""
    inertias: list[Inertia] = []
    fore_aft: dict[str, list[Inertia]] = {}
    for name, body in vehicle.bodies.items():
        mass = to_sympy(body.mass)
        inertias.append(Inertia(name, mass, motion.heave[name]))
        inertias.append(Inertia(name, pitch_inertia(body), motion.pitch[name]))
        fore_aft.setdefault(motion.groups[name], []).append(Inertia(name, mass, motion.fore_aft[name]))
    weights = list(inertias[::2])
    for name, mode in motion.bending.items():
        inertias.append(Inertia(name, bending_mass(vehicle.bodies[name]), mode.row))
    for name, axle in vehicle.axles.items():
        if axle.mass is not None:
            hop = Inertia(name, to_sympy(axle.mass), motion.hop[name])
            inertias.append(hop)
            weights.append(hop)
    elements, inputs = _elements(vehicle, motion)
    energies = Energies(
        tuple(item for item in inertias if item.inertia != 0 and item.row),
        {group: tuple(items) for group, items in fore_aft.items()},
        elements,
        tuple(weights),
    )
    return energies, inputs


def _elements(vehicle: Vehicle, motion: Kinematics) -> tuple[tuple[Element, ...], tuple[str, ...]]:
    grounded = [name for name, link in vehicle.links.items() if GROUND in link.points]
    inputs = (*(f"road.{name}" for name in vehicle.axles), *(f"ground.{name}" for name in grounded))
    one, down = sp.S.One, sp.S.NegativeOne
    elements: list[Element] = []
    for index, (name, axle) in enumerate(vehicle.axles.items()):
        body_rise = motion.rise(axle.body, to_sympy(axle.x))
        wheel = motion.hop.get(name, body_rise)
        if axle.suspension is not None:
            spring = axle.suspension
            row = combine((one, wheel), (down, body_rise))
            elements.append(
                Element(name, "suspension", to_sympy(spring.k), to_sympy(spring.c), row, {}, read_laws(vehicle, "suspension", name))
            )
        row = combine((down, wheel))
        elements.append(
            Element(name, "tyre", to_sympy(axle.tyre.k), to_sympy(axle.tyre.c), row, {index: one}, read_laws(vehicle, "tyre", name))
        )
    for name, link in vehicle.links.items():
        (first, first_point), (second, second_point) = link.ends
        if second == GROUND:
            (first, first_point), (second, second_point) = link.ends[::-1]
        row = combine((one, motion.rise(first, to_sympy(first_point.x))), (down, motion.rise(second, to_sympy(second_point.x))))
        input_row = {inputs.index(f"ground.{name}"): one} if first == GROUND else {}
        elements.append(Element(name, "link", to_sympy(link.k), to_sympy(link.c), row, input_row, read_laws(vehicle, "link", name)))
    for name, hinge in vehicle.hinges.items():
        (first, first_point), (second, second_point) = hinge.ends
        row = combine((one, motion.turn(second, to_sympy(second_point.x))), (down, motion.turn(first, to_sympy(first_point.x))))
        elements.append(Element(name, "hinge", to_sympy(hinge.k), to_sympy(hinge.c), row, {}, read_laws(vehicle, "hinge", name)))
    for name, mode in motion.bending.items():
        bending = vehicle.bodies[name].bending
        assert bending is not None
        omega, mass = 2 * sp.Float(math.pi) * to_sympy(bending.frequency), bending_mass(vehicle.bodies[name])
        elements.append(Element(name, "bending", mass * omega**2, 2 * to_sympy(bending.damping_ratio) * mass * omega, mode.row, {}))
    return tuple(elements), inputs
