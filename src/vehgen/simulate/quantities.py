"""Fields of a run file that are plain quantities: written with a unit, held in SI units."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import BeforeValidator, WithJsonSchema
from pydantic_core import PydanticCustomError

from vehgen.errors import shortened, shown
from vehgen.vehicle.expressions import ExpressionError, parse
from vehgen.vehicle.units import FORCE, FREQUENCY, LENGTH, NONE, SPEED, TIME, Dimension


def read_quantity(value: Any, dimension: Dimension) -> float:
    """Read `2.0 m/s` or the like as a float in SI units; raises a pydantic error that says which unit was expected."""
    if isinstance(value, bool) or not isinstance(value, (int, float, str)):
        raise PydanticCustomError("quantity", "expected a number in {unit}", {"unit": str(dimension)})
    try:
        expression = parse(str(value))
        if expression.names:
            raise ExpressionError(f"expected a plain quantity in {dimension}, found a symbol in {shown(value)}")
        found, number = expression.dimension({}), expression.evaluate({})
    except ExpressionError as error:
        raise PydanticCustomError("quantity", "{reason}", {"reason": str(error)}) from error
    if found != dimension and number != 0.0:
        hint = f"; write e.g. '{shortened(str(value))} {dimension}'" if found == NONE else ""
        raise PydanticCustomError("quantity", "{reason}", {"reason": f"expected {dimension}, found {found} in {shown(value)}{hint}"})
    return number


def _positive(value: float) -> float:
    if not 0 < value < float("inf"):
        raise PydanticCustomError("quantity", "expected a finite number above 0, found {value}", {"value": value})
    return value


def _schema(dimension: Dimension) -> WithJsonSchema:
    return WithJsonSchema({"type": ["string", "number"], "description": f"a number in {dimension}, with its unit"})


Length = Annotated[float, BeforeValidator(lambda value: read_quantity(value, LENGTH)), _schema(LENGTH)]
PositiveLength = Annotated[float, BeforeValidator(lambda value: _positive(read_quantity(value, LENGTH))), _schema(LENGTH)]
PositiveTime = Annotated[float, BeforeValidator(lambda value: _positive(read_quantity(value, TIME))), _schema(TIME)]
PositiveSpeed = Annotated[float, BeforeValidator(lambda value: _positive(read_quantity(value, SPEED))), _schema(SPEED)]
Frequency = Annotated[float, BeforeValidator(lambda value: _positive(read_quantity(value, FREQUENCY))), _schema(FREQUENCY)]
Force = Annotated[float, BeforeValidator(lambda value: read_quantity(value, FORCE)), _schema(FORCE)]
PositiveForce = Annotated[float, BeforeValidator(lambda value: _positive(read_quantity(value, FORCE))), _schema(FORCE)]
Angle = Annotated[float, BeforeValidator(lambda value: read_quantity(value, NONE)), _schema(NONE)]
