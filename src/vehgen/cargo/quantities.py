"""Fields of cargo and frame files that are plain quantities: written with a unit, held in SI units, within any sane scale."""

from __future__ import annotations

from typing import Annotated

from pydantic import BeforeValidator, Field

from vehgen.files.quantities import read_quantity
from vehgen.files.units import DAMPING, FORCE, INERTIA, LENGTH, MASS, NONE, STIFFNESS, Dimension

LARGEST_QUANTITY = 1e18
"""What no quantity of a cargo reaches in SI units; vehicle files refuse 1e20."""
AREA = LENGTH * LENGTH
SECOND_MOMENT = AREA * AREA
PRESSURE = FORCE / AREA
DENSITY = MASS / (AREA * LENGTH)


def _read(dimension: Dimension) -> BeforeValidator:
    return BeforeValidator(lambda value: read_quantity(value, dimension))


_POSITIVE = Field(gt=0, lt=LARGEST_QUANTITY, allow_inf_nan=False)
_NOT_NEGATIVE = Field(ge=0, lt=LARGEST_QUANTITY, allow_inf_nan=False)
_ANY = Field(gt=-LARGEST_QUANTITY, lt=LARGEST_QUANTITY, allow_inf_nan=False)

Distance = Annotated[float, _ANY, _read(LENGTH)]
PositiveLength = Annotated[float, _POSITIVE, _read(LENGTH)]
Mass = Annotated[float, _POSITIVE, _read(MASS)]
OptionalMass = Annotated[float, _NOT_NEGATIVE, _read(MASS)]
Stiffness = Annotated[float, _POSITIVE, _read(STIFFNESS)]
Damping = Annotated[float, _NOT_NEGATIVE, _read(DAMPING)]
DampingRatio = Annotated[float, Field(ge=0, lt=1), _read(NONE)]
Inertia = Annotated[float, _NOT_NEGATIVE, _read(INERTIA)]
Modulus = Annotated[float, _NOT_NEGATIVE, _read(PRESSURE)]
Density = Annotated[float, _NOT_NEGATIVE, _read(DENSITY)]
Poisson = Annotated[float, Field(ge=0, lt=0.5), _read(NONE)]
Area = Annotated[float, _POSITIVE, _read(AREA)]
SecondMoment = Annotated[float, _POSITIVE, _read(SECOND_MOMENT)]
