"""What must hold for a vehicle before its equations are derived; each failure names its place and what would be right."""

from __future__ import annotations

import keyword
import re
from collections.abc import Iterable, Mapping
from itertools import chain

from vehgen.errors import InputError, Position, did_you_mean
from vehgen.vehicle.expressions import Expression, ExpressionError
from vehgen.vehicle.model import GROUND, Joint, Vehicle
from vehgen.vehicle.units import NONE, UNITS, Dimension

_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*\Z")
_RESERVED = {GROUND, "k", "c", "title", "points", "laws"}


def check_vehicle(vehicle: Vehicle) -> None:
    """Check names, connections, symbols, units and values; raises InputError at the first fault."""
    _check_names(vehicle)
    _check_circles(vehicle)
    _check_units(vehicle)
    _check_connections(vehicle)
    _check_tree(vehicle)
    _check_values(vehicle)


def _fail(vehicle: Vehicle, message: str, *path: str | int, key: bool = False, offset: int = 0) -> InputError:
    position = vehicle.position(*path, key=key)
    if position and offset:
        position = Position(position.file, position.line, position.column + offset)
    return InputError(message, position)


def _check_names(vehicle: Vehicle) -> None:
    if not vehicle.bodies:
        raise _fail(vehicle, "a vehicle needs at least one body", "bodies", key=True)
    for name in vehicle.parameters:
        if name in UNITS:
            raise _fail(
                vehicle,
                f"{name!r} is a unit and cannot name a parameter; choose e.g. {name}1 or {name}_body",
                "parameters",
                name,
                key=True,
            )
        _check_name(vehicle, "parameters", name)
    seen: dict[str, str] = {}
    for kind in ("bodies", "hinges", "axles", "links"):
        for name in getattr(vehicle, kind):
            _check_name(vehicle, kind, name)
            if name in _RESERVED:
                raise _fail(vehicle, f"{name!r} has a meaning of its own and cannot be a name", kind, name, key=True)
            if name in seen:
                raise _fail(vehicle, f"duplicate name {name!r}: it is already in `{seen[name]}`", kind, name, key=True)
            seen[name] = kind


def _check_name(vehicle: Vehicle, kind: str, name: str) -> None:
    if not _NAME.match(name) or keyword.iskeyword(name):
        raise _fail(
            vehicle,
            f"{name!r} cannot be a name: a letter, then letters, digits and underscores were expected",
            kind,
            name,
            key=True,
        )


def _check_circles(vehicle: Vehicle) -> None:
    """Refuse unknown symbols in `equals`, and chains of `equals` that bite their tail."""
    done: set[str] = set()

    def visit(name: str, trail: tuple[str, ...]) -> None:
        if name in trail:
            circle = " -> ".join((*trail[trail.index(name) :], name))
            raise _fail(vehicle, f"circular `equals`: {circle}", "parameters", trail[-1], "equals")
        definition = vehicle.parameters[name].equals
        if name in done or definition is None:
            return
        for other in sorted(definition.names):
            if other not in vehicle.parameters:
                raise _fail(
                    vehicle,
                    f"unknown symbol {other!r}; {did_you_mean(other, vehicle.parameters)}",
                    "parameters",
                    name,
                    "equals",
                )
            visit(other, (*trail, name))
        done.add(name)

    for name in vehicle.parameters:
        visit(name, ())


def _check_units(vehicle: Vehicle) -> None:
    for name, parameter in vehicle.parameters.items():
        for entry, expression in (("value", parameter.value), *((("range", item)) for item in parameter.range or ())):
            if expression is not None and expression.names:
                raise _fail(
                    vehicle,
                    f"`{entry}` is a plain quantity; to follow other parameters write `equals: {expression}`",
                    "parameters",
                    name,
                    entry,
                )
        definition, entry = (parameter.value, "value") if parameter.value is not None else (parameter.equals, "equals")
        assert definition is not None
        _dimension(vehicle, definition, _dimensions_so_far(vehicle, definition), "parameters", name, entry)
    dimensions = vehicle.dimensions
    for name, parameter in vehicle.parameters.items():
        for index, bound in enumerate(parameter.range or ()):
            _expect(vehicle, bound, dimensions[name], {}, "parameters", name, "range", index)
    for set_name, entries in vehicle.sets.items():
        for name, expression in entries.items():
            if name not in vehicle.free_parameters:
                raise _fail(
                    vehicle,
                    f"a set changes parameters that have a `value`; {name!r} is none; {did_you_mean(name, vehicle.free_parameters)}",
                    "sets",
                    set_name,
                    name,
                    key=True,
                )
            if expression.names:
                raise _fail(vehicle, "a set lists plain quantities, not expressions of parameters", "sets", set_name, name)
            _expect(vehicle, expression, dimensions[name], {}, "sets", set_name, name)
    for path, expression, expected in vehicle.quantities():
        _expect(vehicle, expression, expected, dimensions, *path)


def _dimensions_so_far(vehicle: Vehicle, expression: Expression) -> dict[str, Dimension]:
    """Dimensions of the names an expression uses, found through their definitions."""
    found: dict[str, Dimension] = {}
    for name in expression.names & vehicle.parameters.keys():
        definition = vehicle.parameters[name].value or vehicle.parameters[name].equals
        assert definition is not None
        entry = "value" if vehicle.parameters[name].value is not None else "equals"
        found[name] = _dimension(vehicle, definition, _dimensions_so_far(vehicle, definition), "parameters", name, entry)
    return found


def _dimension(vehicle: Vehicle, expression: Expression, dimensions: Mapping[str, Dimension], *path: str | int) -> Dimension:
    try:
        return expression.dimension(dimensions)
    except ExpressionError as error:
        raise _fail(vehicle, str(error), *path, offset=error.offset) from error


def _expect(vehicle: Vehicle, expression: Expression, expected: Dimension, dimensions: Mapping[str, Dimension], *path: str | int) -> None:
    found = _dimension(vehicle, expression, dimensions, *path)
    if found == expected or (not expression.names and expression.evaluate({}) == 0.0):
        return
    what = ".".join(str(part) for part in path)
    message = f"{what} must be in {expected}, found {found} in {expression.text!r}"
    if found == NONE:
        unitless = [name for name in sorted(expression.names) if dimensions[name] == NONE]
        where = f"; give {unitless[0]!r} its unit" if unitless else f"; write e.g. '{expression.text} {expected}'"
        message = f"missing unit: {message}{where}"
    raise _fail(vehicle, message, *path)


def _check_connections(vehicle: Vehicle) -> None:
    def known(name: str, allowed: Iterable[str], *path: str | int, key: bool = False) -> None:
        if name not in allowed:
            raise _fail(vehicle, f"no body {name!r}; {did_you_mean(name, allowed)}", *path, key=key)

    for name, axle in vehicle.axles.items():
        known(axle.body, vehicle.bodies, "axles", name, "body")
    for name, body in vehicle.bodies.items():
        if body.carried_by is not None:
            known(body.carried_by.body, vehicle.bodies, "bodies", name, "carried_by", "body")
        elif not body.motions:
            raise _fail(
                vehicle,
                f"body {name!r} has no motions and nothing carries it; give it `carried_by`",
                "bodies",
                name,
                key=True,
            )
        if len(set(body.motions)) != len(body.motions):
            raise _fail(vehicle, "a motion is listed twice", "bodies", name, "motions")
    for name, link in vehicle.links.items():
        for end in link.points:
            known(end, {*vehicle.bodies, GROUND}, "links", name, end, key=True)
    for name, hinge in vehicle.hinges.items():
        for end in hinge.points:
            known(end, vehicle.bodies, "hinges", name, end, key=True)
            body = vehicle.bodies[end]
            if set(body.motions) != {"heave", "pitch"} or body.carried_by is not None:
                raise _fail(
                    vehicle,
                    f"a hinged body needs heave and pitch of its own and no carrier; {end!r} has not",
                    "hinges",
                    name,
                    end,
                    key=True,
                )


def _check_tree(vehicle: Vehicle) -> None:
    """Refuse loops of hinges and of carriers."""
    group = {name: name for name in vehicle.bodies}

    def root(name: str) -> str:
        while group[name] != name:
            name = group[name]
        return name

    for name, hinge in vehicle.hinges.items():
        first, second = (root(end) for end in hinge.points)
        if first == second:
            ends = " and ".join(repr(end) for end in hinge.points)
            raise _fail(
                vehicle,
                f"a loop of hinges: {ends} are already joined through other hinges; use a link instead",
                "hinges",
                name,
                key=True,
            )
        group[second] = first
    for name in vehicle.bodies:
        trail = [name]
        while (carrier := vehicle.bodies[trail[-1]].carried_by) is not None:
            if carrier.body in trail:
                raise _fail(
                    vehicle,
                    f"bodies carry each other in a circle: {' -> '.join((*trail, carrier.body))}",
                    "bodies",
                    name,
                    "carried_by",
                )
            trail.append(carrier.body)


def _check_values(vehicle: Vehicle) -> None:
    for name, (low, high) in vehicle.ranges().items():
        value = vehicle.values()[name]
        if not low < high:
            raise _fail(vehicle, f"the range of {name} is empty: {low:g} is not below {high:g}", "parameters", name, "range")
        if not low <= value <= high:
            raise _fail(
                vehicle,
                f"the value of {name}, {value:g}, lies outside its range [{low:g}, {high:g}] (SI units)",
                "parameters",
                name,
                "range",
            )
    for parameter_set in (None, *vehicle.sets):
        check_values(vehicle, vehicle.values(parameter_set), f" in the set {parameter_set!r}" if parameter_set else "")


def check_values(vehicle: Vehicle, free: Mapping[str, float], where: str = "") -> None:
    """Check that masses and inertias are positive and stiffness and damping not negative for these values [SI].

    Raises
    ------
    InputError
        At the quantity that is not physical; `where` is added to its message.

    """
    try:
        values = vehicle.all_values(free)
        numbers = {path: expression.evaluate(values) for path, expression, _ in vehicle.quantities()}
    except ExpressionError as error:
        raise InputError(f"{error}{where}") from error
    for path, number in numbers.items():
        if number != number or abs(number) == float("inf"):
            raise _fail(vehicle, f"{'.'.join(path)} is not a finite number{where}", *path)
        if path[-1] in ("mass", "pitch_inertia", "k", "c") and number < 0:
            raise _fail(vehicle, f"negative {path[-1]}: {'.'.join(path)} is {number:g}{where}; it must not be below 0", *path)
    for name, axle in vehicle.axles.items():
        if axle.mass is not None and numbers["axles", name, "mass"] == 0:
            raise _fail(
                vehicle,
                f"a degree of freedom without inertia: axle {name!r} hops with no mass{where}",
                "axles",
                name,
                "mass",
            )
    for name, body in vehicle.bodies.items():
        carried = chain(body.motions, [] if body.carried_by is None else ["heave", "pitch"])
        if "heave" in carried and numbers["bodies", name, "mass"] == 0 and "heave" in body.motions:
            raise _fail(
                vehicle,
                f"a degree of freedom without inertia: body {name!r} heaves with no mass{where}",
                "bodies",
                name,
                "mass",
            )
        if "pitch" in body.motions:
            if body.pitch_inertia is None and body.size is None:
                raise _fail(
                    vehicle,
                    f"a degree of freedom without inertia: body {name!r} pitches; give `pitch_inertia` or `size`, or `motions: [heave]`",
                    "bodies",
                    name,
                    key=True,
                )
            if numbers.get(("bodies", name, "pitch_inertia"), 1.0) == 0 and not _is_hinged(vehicle.hinges, name):
                raise _fail(
                    vehicle,
                    f"a degree of freedom without inertia: body {name!r} pitches with no pitch inertia{where}",
                    "bodies",
                    name,
                    "pitch_inertia",
                )


def _is_hinged(hinges: Mapping[str, Joint], body: str) -> bool:
    return any(body in hinge.points for hinge in hinges.values())
