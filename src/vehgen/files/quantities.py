"""Fields of a run file that are plain quantities: written with a unit, held in SI units."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated, Any

from pydantic import BeforeValidator, Field, WithJsonSchema
from pydantic_core import PydanticCustomError

from vehgen.errors import shortened, shown
from vehgen.files import limits
from vehgen.files.expressions import ExpressionError, parse
from vehgen.files.limits import Limit
from vehgen.files.units import MASS, NONE, Dimension, counts_turns, example_of, without_gravities


def read_quantity(value: Any, dimension: Dimension) -> float:
    """Read `2.0 m/s` or the like as a float in SI units; raises a pydantic error that says which unit was expected."""
    if isinstance(value, bool) or not isinstance(value, (int, float, str)):
        raise PydanticCustomError("quantity", "expected a number in {unit}", {"unit": str(dimension)})
    try:
        expression = parse(without_gravities(str(value), dimension))
        if expression.names:
            raise ExpressionError(f"expected a plain quantity in {dimension}, found a symbol in {shown(value)}")
        found, number = expression.dimension({}), expression.evaluate({})
    except ExpressionError as error:
        raise PydanticCustomError("quantity", "{reason}", {"reason": str(error)}) from error
    if found != dimension and number != 0.0:
        hint = f"; write e.g. {example_of(shortened(str(value)), dimension)}" if found == NONE else ""
        raise PydanticCustomError("quantity", "{reason}", {"reason": f"expected {dimension}, found {found} in {shown(value)}{hint}"})
    return number


def _within(limit: Limit, value: Any, above: float | None, least: float | None) -> float:
    """Read a quantity; raises a pydantic error where it is not finite, not above or below what it must be, or outside its limit."""
    number = read_quantity(value, limit.dimension)
    if limit is limits.PITCH_RATE and counts_turns(str(value)):
        raise PydanticCustomError("quantity", "expected rad/s or deg/s, found turns in {value}", {"value": shown(value)})
    wrong = not math.isfinite(number) or (above is not None and number <= above) or (least is not None and number < least)
    if wrong:
        bound = "" if above is None and least is None else f" above {above:g}" if above is not None else f" of at least {least:g}"
        raise PydanticCustomError("quantity", "expected a finite number{bound}, found {value}", {"bound": bound, "value": number})
    if (reason := limit.refusal(number)) is not None:
        raise PydanticCustomError("quantity", "{reason}", {"reason": reason})
    return number


def limited(limit: Limit, above: float | None = None, least: float | None = None) -> BeforeValidator:
    """Return what reads a quantity within a limit; `above` and `least` bound the number itself, not its magnitude."""
    return BeforeValidator(lambda value: _within(limit, value, above, least))


def _any(limit: Limit) -> tuple[BeforeValidator, WithJsonSchema]:
    return limited(limit), quantity_schema(limit.dimension)


def _positive(limit: Limit) -> tuple[BeforeValidator, WithJsonSchema]:
    return limited(limit, above=0.0), quantity_schema(limit.dimension)


def quantity_schema(dimension: Dimension) -> WithJsonSchema:
    """Return what editors are told of a quantity."""
    return WithJsonSchema({"type": ["string", "number"], "description": f"a number in {dimension}, with its unit"})


HumpLength = Annotated[float, *_positive(limits.HUMP_LENGTH)]
HumpHeight = Annotated[float, *_any(limits.HUMP_HEIGHT)]
EdgeRadius = Annotated[float, *_positive(limits.EDGE_RADIUS)]
RoadPosition = Annotated[float, *_any(limits.ROAD_POSITION)]
Footprint = Annotated[float, *_positive(limits.FOOTPRINT)]
PlaceLength = Annotated[float, *_any(limits.VEHICLE_LENGTH)]
Displacement = Annotated[float, *_any(limits.DISPLACEMENT)]
PositiveDisplacement = Annotated[float, *_positive(limits.DISPLACEMENT)]
PositiveVelocity = Annotated[float, *_positive(limits.VELOCITY_LIMIT)]
PositivePitchRate = Annotated[float, *_positive(limits.PITCH_RATE)]
PositiveAngle = Annotated[float, *_positive(limits.ANGLE)]
Duration = Annotated[float, *_positive(limits.DURATION)]
Step = Annotated[float, *_positive(limits.STEP)]
TimeOfFile = Annotated[float, *_any(limits.TIME_OF_FILE)]
Sample = Annotated[float, *_positive(limits.SAMPLE)]
Speed = Annotated[float, *_positive(limits.SPEED_LIMIT)]
Frequency = Annotated[float, *_positive(limits.FREQUENCY_LIMIT)]
Force = Annotated[float, *_any(limits.FORCE_LIMIT)]
Mass = Annotated[float, *_positive(limits.VEHICLE_LIMITS[MASS])]
PositiveForce = Annotated[float, *_positive(limits.FORCE_LIMIT)]
RecorderDelay = Annotated[float, *_any(limits.RECORDER_DELAY)]
Velocity = Annotated[float, *_any(limits.VELOCITY_LIMIT)]
PitchRate = Annotated[float, *_any(limits.PITCH_RATE)]
Angle = Annotated[float, *_any(limits.ANGLE)]
Phase = Annotated[float, *_any(limits.PHASE)]
FileName = Annotated[str, Field(max_length=limits.LONGEST_PATH)]


@dataclass(frozen=True)
class Spread:
    """A standard deviation: a share of what it is of, or in the SI unit of it."""

    value: float
    is_share: bool

    def share_of(self, size: float) -> float:
        """Return it as a share of a size in the SI unit."""
        return self.value if self.is_share else self.value / size


def _spread(value: Any, dimension: Dimension) -> Spread:
    """Read a standard deviation, a plain share up to 1 or a quantity; raises a pydantic error for what is neither."""
    try:
        share = read_quantity(value, NONE)
    except PydanticCustomError:
        if dimension == NONE:
            raise
        return Spread(_from(value, dimension, math.inf), False)
    return Spread(_bounded(share, 1.0, "a share" if dimension == NONE else "a share, or a standard deviation with its unit,"), True)


def _from(value: Any, dimension: Dimension, most: float) -> float:
    return _bounded(read_quantity(value, dimension), most, "a standard deviation")


def _bounded(number: float, most: float, what: str) -> float:
    if not 0 <= number <= most or not math.isfinite(number):
        bound = f" up to {most:g}" if math.isfinite(most) else ""
        raise PydanticCustomError(
            "quantity", "expected {what} from 0{bound}, found {value}", {"what": what, "bound": bound, "value": f"{number:g}"}
        )
    return number


def _spread_of(dimension: Dimension) -> tuple[BeforeValidator, WithJsonSchema]:
    text = "a share up to 1" + ("" if dimension == NONE else f", or a number in {dimension} with its unit")
    return BeforeValidator(lambda value: _spread(value, dimension)), WithJsonSchema({"type": ["string", "number"], "description": text})


ShareSpread = Annotated[Spread, *_spread_of(NONE)]
SpeedSpread = Annotated[Spread, *_spread_of(limits.SPEED_LIMIT.dimension)]
ForceSpread = Annotated[Spread, *_spread_of(limits.FORCE_LIMIT.dimension)]
LengthSpread = Annotated[Spread, *_spread_of(limits.HUMP_LENGTH.dimension)]
TimeDeviation = Annotated[
    float, BeforeValidator(lambda value: _from(value, limits.DURATION.dimension, 10.0)), quantity_schema(limits.DURATION.dimension)
]
LengthDeviation = Annotated[
    float,
    BeforeValidator(lambda value: _from(value, limits.VEHICLE_LENGTH.dimension, 1.0)),
    quantity_schema(limits.VEHICLE_LENGTH.dimension),
]
AngleDeviation = Annotated[float, BeforeValidator(lambda value: _from(value, NONE, 1.0)), quantity_schema(NONE)]
