"""Fields of cargo and frame files that are plain quantities: written with a unit, held in SI units, within physical limits."""

from __future__ import annotations

from typing import Annotated

from pydantic import BeforeValidator, Field, WithJsonSchema

from vehgen.errors import InputError, Position
from vehgen.files.limits import VEHICLE_LIMITS, Limit
from vehgen.files.quantities import limited, quantity_schema
from vehgen.files.units import DAMPING, FORCE, INERTIA, LENGTH, MASS, NONE, STIFFNESS, Dimension

AREA = LENGTH * LENGTH
SECOND_MOMENT = AREA * AREA
PRESSURE = FORCE / AREA
DENSITY = MASS / (AREA * LENGTH)

DISTANCE = Limit("a distance to a cargo", 0.0, 200.0, LENGTH)
SIDE = Limit("a side of a cargo or of what it is made of", 1e-5, 100.0, LENGTH)
MODULUS = Limit("a modulus of elasticity", 1.0, 1e13, PRESSURE)
DENSITY_LIMIT = Limit("a density", 1e-3, 1e5, DENSITY)
SECTION_AREA = Limit("the area of a section", 1e-10, 100.0, AREA)
SECTION_MOMENT = Limit("a second moment of a section", 1e-20, 100.0, SECOND_MOMENT)
RATIO = Limit("a damping ratio", 1e-9, 1.0, NONE)


def _positive(limit: Limit) -> tuple[BeforeValidator, WithJsonSchema]:
    return limited(limit, above=0.0), quantity_schema(limit.dimension)


def _not_negative(limit: Limit) -> tuple[BeforeValidator, WithJsonSchema]:
    return limited(limit, least=0.0), quantity_schema(limit.dimension)


Distance = Annotated[float, limited(DISTANCE), quantity_schema(DISTANCE.dimension)]
PositiveLength = Annotated[float, *_positive(SIDE)]
Mass = Annotated[float, *_positive(VEHICLE_LIMITS[MASS])]
OptionalMass = Annotated[float, *_not_negative(VEHICLE_LIMITS[MASS])]
Stiffness = Annotated[float, *_positive(VEHICLE_LIMITS[STIFFNESS])]
Damping = Annotated[float, *_not_negative(VEHICLE_LIMITS[DAMPING])]
DampingRatio = Annotated[float, Field(lt=1), *_not_negative(RATIO)]
Inertia = Annotated[float, *_not_negative(VEHICLE_LIMITS[INERTIA])]
Modulus = Annotated[float, *_not_negative(MODULUS)]
Density = Annotated[float, *_not_negative(DENSITY_LIMIT)]
Poisson = Annotated[float, Field(lt=0.5), *_not_negative(Limit("Poisson's ratio", 0.0, 0.5, NONE))]
Area = Annotated[float, *_positive(SECTION_AREA)]
SecondMoment = Annotated[float, *_positive(SECTION_MOMENT)]


def check_derived(number: float, dimension: Dimension, what: str, place: Position) -> None:
    """Raise InputError for a quantity of a vehicle that follows from others, where no vehicle can have it [SI]."""
    if (reason := VEHICLE_LIMITS[dimension].refusal(number)) is not None:
        raise InputError(f"{what} that follows is out of any scale: {reason}", place)
