"""Lagrange's equations for any vehicle: energies in, EquationsOfMotion out.

With T = sum 1/2 m (a.q')^2, V = sum 1/2 k (b.q + d.w)^2 + sum m g (a.q) and D = sum 1/2 c (b.q' + d.w')^2, Lagrange's equations
d/dt dT/dq' + dD/dq' + dV/dq = F f are linear; each term of an energy contributes the outer product of its row. The fore-aft
coordinate of a group of bodies appears in T alone: it is ignorable, its momentum is constant (zero), and eliminating it (Routh) leaves
    sum m h h^T - v v^T / sum m,   v = sum m h,
where h is a body's fore-aft row relative to its group.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TypeVar

import sympy as sp

from vehgen.errors import ArgumentError, shown
from vehgen.mechanics.energies import Energies, Inertia, write_energies
from vehgen.mechanics.equations_of_motion import GRAVITY, EquationsOfMotion
from vehgen.mechanics.kinematics import derive_kinematics
from vehgen.mechanics.layout import lay_out
from vehgen.mechanics.outputs import ElementOutput, Output, Place, PointOutput, element_channel, point_channel
from vehgen.mechanics.rows import Row, SparseMatrix, add_outer, combine
from vehgen.mechanics.symbols import number, parameter, to_sympy
from vehgen.vehicle import Vehicle, VehicleLike, as_vehicle
from vehgen.vehicle.checks import complete_values

Item = TypeVar("Item", PointOutput | ElementOutput, Place)


def derive(vehicle: VehicleLike, outputs: Iterable[Output] = (), forces: Iterable[Place] = ()) -> EquationsOfMotion:
    """Derive the equations of motion of a vehicle.

    Parameters
    ----------
    vehicle
        A vehicle, its file, or the name of a bundled model.
    outputs
        What to compute: quantities at points of bodies, and of suspensions, tyres and links.
    forces
        Where vertical forces act (upwards positive).

    Raises
    ------
    InputError
        For an output or force at a place that the vehicle lacks, or a vehicle whose parts are nowhere.
    """
    vehicle = as_vehicle(vehicle)
    outputs = _listed("outputs", outputs, (PointOutput, ElementOutput))
    forces = _listed("forces", forces, (Place,))
    layout = lay_out(vehicle)
    motion = derive_kinematics(vehicle)
    energies, inputs = write_energies(vehicle, motion)
    damping: SparseMatrix = {}
    stiffness: SparseMatrix = {}
    input_entries: SparseMatrix = {}
    input_rate_entries: SparseMatrix = {}
    for element in energies.elements:
        add_outer(stiffness, element.k, element.row, element.row)
        add_outer(damping, element.c, element.row, element.row)
        add_outer(input_entries, -element.k, element.row, element.input_row)
        add_outer(input_rate_entries, -element.c, element.row, element.input_row)
    force_entries: SparseMatrix = {}
    for column, place in enumerate(forces):
        for index, coefficient in motion.rise(place.body, place.locate(vehicle, layout)).items():
            force_entries[index, column] = coefficient
    places = {output.place.name: output.place for output in outputs if isinstance(output, PointOutput)}
    shifts = tuple(place.shift for place in (*places.values(), *forces))
    channels = tuple(
        point_channel(output, vehicle, layout, motion, energies)
        if isinstance(output, PointOutput)
        else element_channel(output, vehicle, layout, motion, energies, forces)
        for output in outputs
    )
    return EquationsOfMotion(
        vehicle=vehicle,
        layout=layout,
        motion=motion,
        energies=energies,
        parameters=(*vehicle.free_parameters, *shifts),
        defaults=dict.fromkeys(shifts, 0.0),
        definitions=_definitions(vehicle),
        inputs=inputs,
        forces=tuple(place.name for place in forces),
        channels=channels,
        mass_entries=mass_matrix(energies),
        damping_entries=damping,
        stiffness_entries=stiffness,
        input_entries=input_entries,
        input_rate_entries=input_rate_entries,
        force_entries=force_entries,
        weight_entries=weight(energies) if vehicle.gravity else {},
    )


def _listed(argument: str, items: Iterable[Item], kinds: tuple[type, ...]) -> tuple[Item, ...]:
    """Return the items of an argument; raises ArgumentError where it is no list, has an item of none of some kinds, or two of one name."""
    expected = f"a list of {' or '.join(kind.__name__ for kind in kinds)} was expected"
    if not isinstance(items, Iterable):
        raise ArgumentError(f"`{argument}`: {expected}, found {type(items).__name__}", argument)
    found = tuple(items)
    for item in found:
        if not isinstance(item, kinds):
            raise ArgumentError(f"`{argument}`: {expected}, found {type(item).__name__}", argument)
        if not (isinstance(item.name, str) and item.name):
            raise ArgumentError(f"`{argument}`: a name was expected, found {shown(item.name)}", argument)
    names = [item.name for item in found]
    if double := next((name for name in names if names.count(name) > 1), None):
        raise ArgumentError(f"`{argument}`: two are named {shown(double)}; each needs a name of its own", argument)
    return found


def mass_matrix(energies: Energies) -> SparseMatrix:
    """Return the mass matrix: independent inertias, and the fore-aft inertia that is left when its coordinate is eliminated."""
    entries: SparseMatrix = {}
    for term in energies.inertias:
        add_outer(entries, term.inertia, term.row, term.row)
    for group in energies.fore_aft.values():
        _add_fore_aft(entries, group)
    return entries


def _add_fore_aft(entries: SparseMatrix, group: tuple[Inertia, ...]) -> None:
    if not any(term.row for term in group):
        return
    momentum: Row = combine(*((term.inertia, term.row) for term in group))
    for term in group:
        add_outer(entries, term.inertia, term.row, term.row)
    add_outer(entries, -1 / sp.Add(*(term.inertia for term in group)), momentum, momentum)


def weight(energies: Energies) -> Row:
    """Return the generalised gravity force -dV/dq [N, N m]."""
    return combine(*((-number(GRAVITY) * term.inertia, term.row) for term in energies.weights))


def _definitions(vehicle: Vehicle) -> tuple[tuple[sp.Symbol, sp.Expr], ...]:
    """Return the dependent parameters, each after those it uses."""
    ordered: dict[str, sp.Expr] = {}

    def define(name: str) -> None:
        equals = vehicle.parameters[name].equals
        if equals is None or name in ordered:
            return
        for other in sorted(equals.names):
            define(other)
        ordered[name] = to_sympy(equals)

    for name in vehicle.parameters:
        define(name)
    return tuple((parameter(name), expression) for name, expression in ordered.items())


ModelLike = EquationsOfMotion | VehicleLike
"""Equations of motion, or a vehicle to derive them of."""


def as_model(model: ModelLike, outputs: Iterable[Output] = ()) -> EquationsOfMotion:
    """Return the equations of motion that an argument means; those of a vehicle are derived, with `outputs`."""
    return model if isinstance(model, EquationsOfMotion) else derive(model, outputs)


def all_values(
    model: EquationsOfMotion, values: Mapping[str, float] | None = None, parameter_set: str | None = None
) -> Mapping[str, float]:
    """Return the values [SI] of all of a model's parameters: those given, then those of the set, then those of the file.

    Raises
    ------
    InputError
        For a parameter or a set that the vehicle does not have, a value that is no finite number, and values of some of the parameters
        that make a mass, a stiffness or a damping negative. Values of all of them are not looked at again: fits ask for many.
    """
    return complete_values(model.vehicle, model.parameters, values, parameter_set, model.values)
