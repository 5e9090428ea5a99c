"""What a hinge transmits upwards: by Newton's law the force that the bodies on one side of it need beside all else that acts on them.

Cut at the hinge, and let the bodies on its second body's side rise together by a small way: the only forces whose work does not vanish are
their inertia, their weight, what springs and dampers press on them from outside, the forces applied to them, and the hinge's. Rigidly
carried bodies rise along; a bending shape is free of heave and has no share.
"""

from __future__ import annotations

from collections.abc import Sequence

import sympy as sp

from vehgen.errors import InputError, did_you_mean, shown
from vehgen.mechanics.energies import Element
from vehgen.mechanics.equations_of_motion import Channel
from vehgen.mechanics.kinematics import Kinematics
from vehgen.mechanics.quantities import HINGE_QUANTITIES
from vehgen.mechanics.rows import Row, combine
from vehgen.mechanics.symbols import to_sympy
from vehgen.vehicle.model import Vehicle
from vehgen.vehicle.parts import GROUND


def far_side(vehicle: Vehicle, hinge: str) -> frozenset[str]:
    """Return the bodies that rise with the second-named body of a hinge when it is cut there."""
    _first, second = vehicle.hinges[hinge].points
    joined = [set(item.points) for name, item in vehicle.hinges.items() if name != hinge]
    joined += [{name, body.carried_by.body} for name, body in vehicle.bodies.items() if body.carried_by and "heave" not in body.motions]
    side, wider = {second}, set[str]()
    while side != wider:
        wider = side
        side = side.union(*(pair for pair in joined if pair & side))
    return frozenset(side)


def lifted_travel(vehicle: Vehicle, element: Element, side: frozenset[str]) -> int:
    """Return how the travel of an element (compression positive) changes per unit that the bodies of a side rise together: 1, -1 or 0."""
    if element.kind == "link":
        (low, _), (high, _) = vehicle.links[element.name].ends
        if high == GROUND:
            low, high = high, low
        return (low in side) - (high in side)
    if element.kind in ("suspension", "tyre"):
        axle = vehicle.axles[element.name]
        lowest = "tyre" if axle.suspension is None else "suspension"
        return -int(element.kind == lowest and axle.body in side)
    return 0


def hinge_force_channel(
    name: str, quantity: str, hinge: str, vehicle: Vehicle, motion: Kinematics, elements: Sequence[Element], forces: Sequence[str]
) -> Channel:
    """Return the row of the dynamic part of what the first-named body of a hinge presses upwards on the second [N].

    Parameters
    ----------
    name, quantity, hinge
        Of the channel: `hinge_force` or `hinge_load`; the name of the hinge.
    vehicle, motion, elements
        The vehicle, its kinematics, its springs and dampers.
    forces
        The body on which each applied force acts.

    Raises
    ------
    InputError
        For a hinge that the vehicle lacks.
    """
    if hinge not in vehicle.hinges:
        raise InputError(f"{name}: {shown(hinge)} is no hinge; {did_you_mean(hinge, vehicle.hinges)}")
    side = far_side(vehicle, hinge)
    lifts = {number: sp.Integer(lift) for number, item in enumerate(elements) if (lift := lifted_travel(vehicle, item, side))}
    sprung = [(lift * elements[number].k, elements[number]) for number, lift in lifts.items()]
    damped = [(lift * elements[number].c, elements[number]) for number, lift in lifts.items()]
    applied: Row = {number: sp.S.NegativeOne for number, body in enumerate(forces) if body in side}
    return Channel(
        name,
        quantity,
        HINGE_QUANTITIES[quantity],
        hinge,
        acceleration=combine(*((to_sympy(vehicle.bodies[body].mass), motion.heave[body]) for body in sorted(side))),
        velocity=combine(*((c, item.row) for c, item in damped)),
        displacement=combine(*((k, item.row) for k, item in sprung)),
        input=combine(*((k, item.input_row) for k, item in sprung)),
        input_rate=combine(*((c, item.input_row) for c, item in damped)),
        force=applied,
        laws=lifts,
    )
