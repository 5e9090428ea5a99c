"""The force laws of a vehicle's suspensions, tyres, links and hinges: names, parameters and units checked."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import sympy as sp

from vehgen.errors import InputError, did_you_mean
from vehgen.mechanics.laws import LAWS, Kind, Law, custom_law
from vehgen.mechanics.symbols import number, to_sympy
from vehgen.vehicle.expressions import Expression, ExpressionError
from vehgen.vehicle.model import LawEntry, Spring, Vehicle
from vehgen.vehicle.units import FORCE, LENGTH, MOMENT, NONE, TIME, Dimension


@dataclass(frozen=True)
class LawTerm:
    """A force law with its parameters as expressions of the vehicle's symbols [SI]."""

    law: Law
    parameters: Mapping[str, sp.Expr]


def read_laws(vehicle: Vehicle, kind: Kind, name: str) -> tuple[LawTerm, ...]:
    """Return the laws of an axle's suspension or tyre, a link, or a hinge.

    Raises
    ------
    InputError
        For an unknown law or parameter, a missing one, or a wrong unit, at its place in the file.
    """
    path, spring = _find(vehicle, kind, name)
    terms = []
    for index, entry in enumerate(spring.laws):
        for law_name, given in entry.items():
            terms.append(_read(vehicle, kind, (*path, "laws", index, law_name), law_name, given))
    return tuple(terms)


def _find(vehicle: Vehicle, kind: Kind, name: str) -> tuple[tuple[str | int, ...], Spring]:
    if kind == "link":
        return ("links", name), vehicle.links[name]
    if kind == "hinge":
        return ("hinges", name), vehicle.hinges[name]
    axle = vehicle.axles[name]
    spring = axle.suspension if kind == "suspension" else axle.tyre
    assert spring is not None
    return ("axles", name, kind), spring


def _read(vehicle: Vehicle, kind: Kind, path: tuple[str | int, ...], name: str, given: LawEntry) -> LawTerm:
    if name == "law":
        return _read_custom(vehicle, kind, path, given)
    if name not in LAWS:
        raise InputError(f"unknown force law {name!r}; {did_you_mean(name, [*LAWS, 'law'])}", vehicle.position(*path, key=True))
    law = LAWS[name]
    if kind not in law.attaches_to:
        raise InputError(f"{name} belongs on a {' or '.join(law.attaches_to)}, not on a {kind}", vehicle.position(*path, key=True))
    known = {parameter.name: parameter for parameter in law.parameters}
    for key in given:
        if key not in known:
            raise InputError(f"{name} has no parameter {key!r}; {did_you_mean(key, known)}", vehicle.position(*path, key, key=True))
    values = {}
    for key, parameter in known.items():
        expression = given.get(key)
        if expression is None:
            if parameter.default is None:
                raise InputError(f"{name} lacks its parameter {key!r}: {parameter.meaning}", vehicle.position(*path, key=True))
            values[key] = number(parameter.default)
            continue
        if not isinstance(expression, Expression):
            raise InputError(f"{key} is a quantity, not a mapping", vehicle.position(*path, key))
        _expect(vehicle, expression, parameter.dimension(kind), vehicle.dimensions, *path, key)
        values[key] = to_sympy(expression)
    return LawTerm(law, values)


def _read_custom(vehicle: Vehicle, kind: Kind, path: tuple[str | int, ...], given: LawEntry) -> LawTerm:
    force, own = given.get("force"), given.get("parameters", {})
    unknown = [key for key in given if key not in ("force", "parameters")]
    if unknown:
        raise InputError(f"an own law has `force` and `parameters`, not {unknown[0]!r}", vehicle.position(*path, unknown[0], key=True))
    if not isinstance(force, Expression) or not isinstance(own, dict):
        raise InputError(
            "an own law has `force`, an expression of d, v and its `parameters` {name: value}", vehicle.position(*path, key=True)
        )
    dimensions = dict(vehicle.dimensions)
    for key, expression in own.items():
        if key in ("d", "v"):
            raise InputError(
                f"{key!r} is the law's travel or rate and cannot be a parameter", vehicle.position(*path, "parameters", key, key=True)
            )
        dimensions[key] = _dimension(vehicle, expression, vehicle.dimensions, *path, "parameters", key)
    travel, moment = (NONE, MOMENT) if kind == "hinge" else (LENGTH, FORCE)
    dimensions |= {"d": travel, "v": travel / TIME}
    _expect(vehicle, force, moment, dimensions, *path, "force")
    return LawTerm(custom_law(to_sympy(force), {key: to_sympy(value) for key, value in own.items()}), {})


def _expect(vehicle: Vehicle, expression: Expression, expected: Dimension, dimensions: Mapping[str, Dimension], *path: str | int) -> None:
    found = _dimension(vehicle, expression, dimensions, *path)
    if found != expected and (expression.names or _value(vehicle, expression, *path) != 0.0):
        raise InputError(f"{path[-1]} must be in {expected}, found {found} in {expression.text!r}", vehicle.position(*path))


def _value(vehicle: Vehicle, expression: Expression, *path: str | int) -> float:
    try:
        return expression.evaluate({})
    except ExpressionError as error:
        raise InputError(str(error), vehicle.position(*path)) from error


def _dimension(vehicle: Vehicle, expression: Expression, dimensions: Mapping[str, Dimension], *path: str | int) -> Dimension:
    try:
        return expression.dimension(dimensions)
    except ExpressionError as error:
        raise InputError(str(error), vehicle.position(*path)) from error
