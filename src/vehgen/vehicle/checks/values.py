"""Values: finite, within their ranges and physical limits, and inertia for everything that moves."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence

from vehgen.errors import InputError, Position, shown
from vehgen.files.checks import value_of
from vehgen.files.expressions import Expression, ExpressionError
from vehgen.files.limits import VEHICLE_LIMITS
from vehgen.files.units import Dimension
from vehgen.vehicle.model import Vehicle, by_name, finite

Numbers = Mapping[tuple[str, ...], float]
"""Values of a vehicle's quantities [SI] by their path."""


def check_all_values(vehicle: Vehicle) -> None:
    """Check the values in the file, the ranges, and what every set makes of the vehicle; raises InputError at the first fault."""
    for name, parameter in vehicle.parameters.items():
        if parameter.value is not None:
            _check_finite(vehicle, parameter.value, "parameters", name, "value")
        for index, bound in enumerate(parameter.range or ()):
            _check_finite(vehicle, bound, "parameters", name, "range", index)
    for set_name, entries in vehicle.sets.items():
        for name, expression in entries.items():
            _check_finite(vehicle, expression, "sets", set_name, name)
    _check_ranges(vehicle)
    for parameter_set in (None, *vehicle.sets):
        check_values(vehicle, vehicle.values(parameter_set), f" in the set {shown(parameter_set)}" if parameter_set else "")


def _check_finite(vehicle: Vehicle, expression: Expression, *path: str | int) -> None:
    """Refuse a plain quantity without a finite value."""
    if not math.isfinite(value_of(expression, {}, vehicle.document, *path)):
        raise InputError(f"{shown(expression.text)} is not a finite number", vehicle.position(*path))


def _check_ranges(vehicle: Vehicle) -> None:
    values = vehicle.values()
    for name, (low, high) in vehicle.ranges().items():
        place, value = vehicle.position("parameters", name, "range"), values[name]
        if not low < high:
            raise InputError(f"the range of {name} is empty: {low:g} is not below {high:g}", place)
        if not low <= value <= high:
            raise InputError(f"the value of {name}, {value:g}, lies outside its range [{low:g}, {high:g}] (SI units)", place)
        if low < 0 <= value:
            _check_range_end(vehicle, {**values, name: low}, name, place)


def _check_range_end(vehicle: Vehicle, values: Mapping[str, float], name: str, place: Position) -> None:
    """Refuse a range that reaches values that are not physical."""
    try:
        check_values(vehicle, values, " at the end of a range")
    except InputError as error:
        raise InputError(f"the range of {name} reaches what cannot be: {error.message}", place) from error


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
            numbers[path] = expression.evaluate(values)
        except ExpressionError as error:
            raise InputError(f"{error}{where}", vehicle.position(*path)) from error
        if (reason := _refusal(path, numbers[path], dimension, where)) is not None:
            raise InputError(reason, vehicle.position(*path))
    _check_masses(vehicle, numbers, where)
    for name, body in vehicle.bodies.items():
        if "pitch" in body.motions:
            _check_pitch_inertia(vehicle, name, numbers, where)


def complete_values(
    vehicle: Vehicle,
    names: Sequence[str],
    given: Mapping[str, float] | None,
    parameter_set: str | None,
    complete: Callable[[str | None, Mapping[str, float] | None], Mapping[str, float]],
) -> Mapping[str, float]:
    """Return the values [SI] of all `names`: as given where all are, else what `complete` makes of a set and them, checked.

    Raises
    ------
    InputError
        For a value that is no finite number; where not all are given, as :func:`check_values`. Fits give all, many times.
    """
    known = None if given is None else by_name(given)
    if known is not None and parameter_set is None and all(name in known for name in names):
        return finite(known)
    found = finite(complete(parameter_set, known))
    if known:
        check_values(vehicle, {name: found[name] for name in vehicle.free_parameters}, " with the given values")
    return found


def _refusal(path: tuple[str, ...], number: float, dimension: Dimension, where: str) -> str | None:
    """Say what is not physical about one quantity; None where nothing is."""
    what = ".".join(path)
    if not math.isfinite(number):
        return f"{what} is not a finite number{where}"
    if (reason := VEHICLE_LIMITS[dimension].refusal(number)) is not None:
        return f"{what} is out of any scale{where}: {reason}"
    if path[-1] in ("mass", "pitch_inertia", "k", "c") and number < 0:
        return f"negative {path[-1]}: {what} is {number:g}{where}; it must not be below 0"
    if "size" in path and number < 0:
        return f"{what} must not be below 0, found {number:g}{where}"
    if "bending" in path and path[-1] not in ("damping_ratio", "z") and number <= 0:
        return f"{what} must be above 0, found {number:g}{where}"
    return None


def _check_masses(vehicle: Vehicle, numbers: Numbers, where: str) -> None:
    """Refuse axles that hop and bodies that heave with no mass."""
    moving = [("axles", name, f"axle {name!r} hops") for name, axle in vehicle.axles.items() if axle.mass is not None]
    moving += [("bodies", name, f"body {name!r} heaves") for name, body in vehicle.bodies.items() if "heave" in body.motions]
    for kind, name, what in moving:
        if numbers[kind, name, "mass"] == 0:
            message = f"a degree of freedom without inertia: {what} with no mass{where}"
            raise InputError(message, vehicle.position(kind, name, "mass"))


def _check_pitch_inertia(vehicle: Vehicle, name: str, numbers: Numbers, where: str) -> None:
    """Refuse a pitching body without inertia; that of a hinged body may be 0, as it moves other masses when it pitches."""
    body, fault = vehicle.bodies[name], "a degree of freedom without inertia: body"
    if body.pitch_inertia is not None:
        given, inertia = "pitch_inertia", numbers["bodies", name, "pitch_inertia"]
    elif body.size is not None:
        sides = (numbers["bodies", name, "size", side] for side in ("length", "height"))
        given, inertia = "size", numbers["bodies", name, "mass"] * sum(side**2 for side in sides)
    else:
        message = f"{fault} {name!r} pitches; give `pitch_inertia` or `size`, or `motions: [heave]`"
        raise InputError(message, vehicle.position("bodies", name, key=True))
    if inertia == 0 and not any(name in hinge.points for hinge in vehicle.hinges.values()):
        raise InputError(f"{fault} {name!r} pitches with no pitch inertia{where}", vehicle.position("bodies", name, given))
