"""Checks that all file formats share: names that must be known, and the dimensions and values of expressions."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from vehgen.errors import InputError, Position, did_you_mean, shortened, shown
from vehgen.files.document import Located
from vehgen.files.expressions import Expression, ExpressionError
from vehgen.files.units import NONE, Dimension, counts_turns, example_of, factor_to_si, parse_unit, units_of


def check_known(name: str, allowed: Iterable[str], lacking: str, document: Located, *path: str | int, key: bool = False) -> None:
    """Refuse a name that is not one of `allowed`, with the nearest ones.

    Parameters
    ----------
    name, allowed
        What a file says, and what it may say.
    lacking
        How the error begins, e.g. `tractor5 has no body`.
    document, path, key
        Where the name stands: as a value, or as a key.
    """
    if name not in (known := list(allowed)):
        raise InputError(f"{lacking} {shown(name)}; {did_you_mean(name, known)}", document.find(path, key=key))


def dimension_of(expression: Expression, dimensions: Mapping[str, Dimension], document: Located, *path: str | int) -> Dimension:
    """Return the dimension of the expression at a path; raises InputError for unknown names and units that do not fit together."""
    try:
        return expression.dimension(dimensions)
    except ExpressionError as error:
        raise InputError(str(error), document.find(path, offset=error.offset)) from error


def value_of(expression: Expression, values: Mapping[str, float], document: Located, *path: str | int) -> float:
    """Return the value of the expression at a path [SI]; raises InputError where it is undefined, as 1/0."""
    try:
        return expression.evaluate(values)
    except ExpressionError as error:
        raise InputError(str(error), document.find(path)) from error


def check_dimension(
    expression: Expression,
    expected: Dimension,
    dimensions: Mapping[str, Dimension],
    document: Located,
    *path: str | int,
    what: str | None = None,
) -> None:
    """Refuse the expression at a path where its dimension is another one, or a plain one without value; a plain 0 has all dimensions.

    Parameters
    ----------
    expression, expected
        The expression and the dimension that it must have.
    dimensions
        The dimensions of the names that it may use.
    document, path
        Where it stands.
    what
        What errors call it (default: the last part of the path).
    """
    found = dimension_of(expression, dimensions, document, *path)
    if found == expected and not expression.names:
        value_of(expression, {}, document, *path)
    if found == expected or _is_zero(expression):
        return
    message = f"{path[-1] if what is None else what} must be in {expected}, found {found} in {shown(expression.text)}"
    if found == NONE:
        unitless = [name for name in sorted(expression.names) if dimensions[name] == NONE]
        where = f"; give {unitless[0]!r} its unit" if unitless else f"; write e.g. {example_of(shortened(expression.text), expected)}"
        message = f"missing unit: {message}{where}"
    place, declared = document.find(path), _declared(expression, document)
    if declared is None:
        raise InputError(message, place)
    if declared.file == place.file:
        raise InputError(f"{message}; line {declared.line} declares it", place)
    raise InputError(f"{message} at {place}", declared)  # the file that is extended was right before


def _declared(expression: Expression, document: Located) -> Position | None:
    """Return where a file declares the only parameter that an expression names, None where it names more, or none of its own."""
    parameters = document.child("parameters")
    if parameters is None or len(expression.names) != 1:
        return None
    parameter = parameters.child(*expression.names)
    return None if parameter is None or parameter.position.is_argument else parameter.find(("value",))


def _is_zero(expression: Expression) -> bool:
    try:
        return not expression.names and expression.evaluate({}) == 0.0
    except ExpressionError:
        return False


def plain_quantity(expression: Expression, expected: Dimension, document: Located, *path: str | int, what: str | None = None) -> float:
    """Return the value [SI] of the expression at a path, which may use no names and must have a dimension."""
    if expression.names:
        message = f"expected a plain quantity in {expected}, found a symbol in {shown(expression.text)}"
        raise InputError(message, document.find(path, offset=0))
    check_dimension(expression, expected, {}, document, *path, what=what)
    return value_of(expression, {}, document, *path)


def unit_factor(unit: str, usual: str, quantity: str, place: Position | None) -> float:
    """Return what a column's unit is worth in the `usual` SI unit of its quantity.

    Raises
    ------
    InputError
        At `place`, for a unit that there is not, and for one of another quantity.
    """
    expected = parse_unit(usual)[1]
    try:
        factor = factor_to_si(unit, expected)
        found = None if factor is not None else parse_unit(unit)[1]
    except InputError as error:
        usable = ", ".join(dict.fromkeys((usual, *(name for name in units_of(expected) if "rad" not in usual or not counts_turns(name)))))
        raise InputError(f"{error.message} ({quantity} is measured in {usable})", place) from error
    if factor is None:
        what = "an angle or a pure number" if str(found) == "no unit" else f"a unit of {found}"
        raise InputError(f"{quantity} is measured in {usual}, found {shown(unit)}, {what}", place)
    if "rad" in usual and counts_turns(unit):
        raise InputError(f"{quantity} is measured in {usual}, found {shown(unit)}, turns, not radians", place)
    return factor
