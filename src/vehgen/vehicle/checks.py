"""What must hold for a vehicle before its equations are derived; each failure names its place and what would be right."""

from __future__ import annotations

import keyword
import math
from collections.abc import Iterable, Mapping
from itertools import chain

from vehgen.errors import InputError, did_you_mean, shortened, shown, trail_text
from vehgen.files.expressions import Expression, ExpressionError
from vehgen.files.limits import MOST_PARTS, VEHICLE_LIMITS
from vehgen.files.names import is_identifier
from vehgen.files.units import NONE, UNITS, Dimension
from vehgen.vehicle.model import GROUND, Joint, Vehicle

_RESERVED = {GROUND, "k", "c", "title", "points", "laws"}
MAX_CHAIN = 100


def check_vehicle(vehicle: Vehicle) -> None:
    """Check numbers of parts, names, connections, symbols, units and values; raises InputError at the first fault."""
    for kind, most in MOST_PARTS.items():
        if (count := len(getattr(vehicle, kind))) > most:
            raise _fail(vehicle, f"{count} {kind}; a vehicle has at most {most}", kind, key=True)
    _check_names(vehicle)
    _check_circles(vehicle)
    _check_units(vehicle)
    _check_connections(vehicle)
    _check_tree(vehicle)
    _check_values(vehicle)


def _fail(vehicle: Vehicle, message: str, *path: str | int, key: bool = False, offset: int | None = None) -> InputError:
    return InputError(message, vehicle.position(*path, key=key, offset=offset))


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
    if not is_identifier(name) or keyword.iskeyword(name):
        raise _fail(
            vehicle,
            f"{shown(name)} cannot be a name: a letter, then letters, digits and underscores were expected (of ASCII)",
            kind,
            name,
            key=True,
        )


def _check_circles(vehicle: Vehicle) -> None:
    """Refuse unknown symbols in `equals`, and chains of `equals` that bite their tail or are very long."""
    depths: dict[str, int] = {}

    def visit(name: str, trail: tuple[str, ...]) -> int:
        if name in trail:
            raise _fail(vehicle, f"circular `equals`: {trail_text((*trail[trail.index(name) :], name))}", "parameters", trail[-1], "equals")
        definition = vehicle.parameters[name].equals
        if name in depths or definition is None:
            return depths.get(name, 0)
        too_long = f"more than {MAX_CHAIN} parameters follow one another through `equals`"
        if len(trail) >= MAX_CHAIN:
            raise _fail(vehicle, too_long, "parameters", name, "equals")
        depths_below = [0]
        for symbol in definition.symbols:
            if symbol.name not in vehicle.parameters:
                raise _fail(
                    vehicle,
                    f"unknown symbol {shown(symbol.name)}; {did_you_mean(symbol.name, vehicle.parameters)}",
                    "parameters",
                    name,
                    "equals",
                    offset=symbol.offset,
                )
            depths_below.append(visit(symbol.name, (*trail, name)))
        depths[name] = 1 + max(depths_below)
        if depths[name] > MAX_CHAIN:
            raise _fail(vehicle, too_long, "parameters", name, "equals")
        return depths[name]

    for name in vehicle.parameters:
        visit(name, ())


def _check_units(vehicle: Vehicle) -> None:
    for name, parameter in vehicle.parameters.items():
        for entry, expression in (("value", parameter.value), *((("range", item)) for item in parameter.range or ())):
            if expression is not None and expression.names:
                raise _fail(
                    vehicle,
                    f"`{entry}` is a plain quantity; to follow other parameters write `equals: {shortened(str(expression))}`",
                    "parameters",
                    name,
                    entry,
                )
    dimensions: dict[str, Dimension] = {}
    for name in vehicle.parameters:
        _find_dimension(vehicle, name, dimensions)
    for path, expression, expected in vehicle.quantities():
        _expect(vehicle, expression, expected, dimensions, *path)
    for name, parameter in vehicle.parameters.items():
        for index, bound in enumerate(parameter.range or ()):
            _expect(vehicle, bound, dimensions[name], {}, "parameters", name, "range", index)
    for set_name, entries in vehicle.sets.items():
        for name, expression in entries.items():
            if name not in vehicle.free_parameters:
                raise _fail(
                    vehicle,
                    f"a set changes parameters that have a `value`; {shown(name)} is none; {did_you_mean(name, vehicle.free_parameters)}",
                    "sets",
                    set_name,
                    name,
                    key=True,
                )
            if expression.names:
                raise _fail(vehicle, "a set lists plain quantities, not expressions of parameters", "sets", set_name, name)
            _expect(vehicle, expression, dimensions[name], {}, "sets", set_name, name)


def _find_dimension(vehicle: Vehicle, name: str, dimensions: dict[str, Dimension]) -> None:
    """Add a parameter's dimension, and those it follows from, to `dimensions`."""
    if name in dimensions:
        return
    parameter = vehicle.parameters[name]
    definition, entry = (parameter.value, "value") if parameter.value is not None else (parameter.equals, "equals")
    assert definition is not None
    for symbol in definition.symbols:
        _find_dimension(vehicle, symbol.name, dimensions)
    dimensions[name] = _dimension(vehicle, definition, dimensions, "parameters", name, entry)


def _dimension(vehicle: Vehicle, expression: Expression, dimensions: Mapping[str, Dimension], *path: str | int) -> Dimension:
    try:
        return expression.dimension(dimensions)
    except ExpressionError as error:
        raise _fail(vehicle, str(error), *path, offset=error.offset) from error


def _expect(vehicle: Vehicle, expression: Expression, expected: Dimension, dimensions: Mapping[str, Dimension], *path: str | int) -> None:
    found = _dimension(vehicle, expression, dimensions, *path)
    if found == expected or _is_zero(expression):
        return
    what = ".".join(str(part) for part in path)
    message = f"{what} must be in {expected}, found {found} in {shown(expression.text)}"
    if found == NONE:
        unitless = [name for name in sorted(expression.names) if dimensions[name] == NONE]
        where = f"; give {unitless[0]!r} its unit" if unitless else f"; write e.g. '{shortened(expression.text)} {expected}'"
        message = f"missing unit: {message}{where}"
    raise _fail(vehicle, message, *path)


def _is_zero(expression: Expression) -> bool:
    try:
        return not expression.names and expression.evaluate({}) == 0.0
    except ExpressionError:
        return False


def _check_connections(vehicle: Vehicle) -> None:
    def known(name: str, allowed: Iterable[str], *path: str | int, key: bool = False) -> None:
        if name not in allowed:
            raise _fail(vehicle, f"no body {shown(name)}; {did_you_mean(name, allowed)}", *path, key=key)

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
    """Refuse loops of hinges and of carriers, and `at` for a body that is already placed."""
    group = {name: name for name in vehicle.bodies}

    def root(name: str) -> str:
        while group[name] != name:
            name = group[name]
        return name

    def join(first: str, second: str) -> None:
        group[root(second)] = root(first)

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
        join(first, second)
    for name in vehicle.bodies:
        trail = [name]
        while (carrier := vehicle.bodies[trail[-1]].carried_by) is not None:
            if carrier.body in trail:
                raise _fail(
                    vehicle,
                    f"bodies carry each other in a circle: {trail_text((*trail, carrier.body))}",
                    "bodies",
                    name,
                    "carried_by",
                )
            trail.append(carrier.body)
    for name, body in vehicle.bodies.items():
        if body.carried_by is not None:
            join(body.carried_by.body, name)
    for link in vehicle.links.values():
        if GROUND not in link.points:
            join(*link.points)
    placed = {root(next(iter(vehicle.bodies)))}
    for name, body in vehicle.bodies.items():
        if body.at is not None:
            if root(name) in placed:
                message = f"body {name!r} is placed already, by what connects it to the first body (or to one that has `at`); remove `at`"
                raise _fail(vehicle, message, "bodies", name, "at", key=True)
            placed.add(root(name))


def _check_values(vehicle: Vehicle) -> None:
    for name, parameter in vehicle.parameters.items():
        _check_number(vehicle, parameter.value, "parameters", name, "value")
        for index, bound in enumerate(parameter.range or ()):
            _check_number(vehicle, bound, "parameters", name, "range", index)
    for set_name, entries in vehicle.sets.items():
        for name, expression in entries.items():
            _check_number(vehicle, expression, "sets", set_name, name)
    values = vehicle.values()
    for name, (low, high) in vehicle.ranges().items():
        value = values[name]
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
        check_values(vehicle, vehicle.values(parameter_set), f" in the set {shown(parameter_set)}" if parameter_set else "")


def _check_number(vehicle: Vehicle, expression: Expression | None, *path: str | int) -> None:
    """Refuse a plain quantity without a finite value."""
    if expression is None:
        return
    try:
        number = expression.evaluate({})
    except ExpressionError as error:
        raise _fail(vehicle, str(error), *path) from error
    if not math.isfinite(number):
        raise _fail(vehicle, f"{shown(expression.text)} is not a finite number", *path)


def check_values(vehicle: Vehicle, free: Mapping[str, float], where: str = "") -> None:
    """Check that masses and inertias are positive and stiffness and damping not negative for these values [SI].

    Raises
    ------
    InputError
        At the quantity that is not physical; `where` is added to its message.

    """
    try:
        values = vehicle.all_values(free)
    except InputError as error:
        raise InputError(f"{error.message}{where}", error.position) from error
    numbers: dict[tuple[str, ...], float] = {}
    for path, expression, dimension in vehicle.quantities():
        try:
            number = numbers[path] = expression.evaluate(values)
        except ExpressionError as error:
            raise _fail(vehicle, f"{error}{where}", *path) from error
        if not math.isfinite(number):
            raise _fail(vehicle, f"{'.'.join(path)} is not a finite number{where}", *path)
        if (reason := VEHICLE_LIMITS[dimension].refusal(number)) is not None:
            raise _fail(vehicle, f"{'.'.join(path)} is out of any scale{where}: {reason}", *path)
        if path[-1] in ("mass", "pitch_inertia", "k", "c") and number < 0:
            raise _fail(vehicle, f"negative {path[-1]}: {'.'.join(path)} is {number:g}{where}; it must not be below 0", *path)
        if "bending" in path and path[-1] != "damping_ratio" and number <= 0:
            raise _fail(vehicle, f"{'.'.join(path)} must be above 0, found {number:g}{where}", *path)
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
            given = "size" if body.pitch_inertia is None else "pitch_inertia"
            if given == "pitch_inertia":
                inertia = numbers["bodies", name, "pitch_inertia"]
            else:
                sides = (numbers["bodies", name, "size", side] for side in ("length", "height"))
                inertia = numbers["bodies", name, "mass"] * sum(side**2 for side in sides)
            if inertia == 0 and not _is_hinged(vehicle.hinges, name):
                raise _fail(
                    vehicle,
                    f"a degree of freedom without inertia: body {name!r} pitches with no pitch inertia{where}",
                    "bodies",
                    name,
                    given,
                )


def _is_hinged(hinges: Mapping[str, Joint], body: str) -> bool:
    return any(body in hinge.points for hinge in hinges.values())
