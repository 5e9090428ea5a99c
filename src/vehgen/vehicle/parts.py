"""The typed parts of a vehicle: parameters, bodies, hinges, axles and links."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar, Literal

from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from vehgen.errors import shortened
from vehgen.files.entry import FileModel
from vehgen.files.expressions import Expression, parse
from vehgen.files.names import FreeText, Name

GROUND = "ground"
BodyMotion = Literal["heave", "pitch"]
ZERO = parse("0")
LawEntry = dict[Name, Expression | dict[Name, Expression]]
"""Parameters of a force law; of an own `law`, its `force` and its `parameters`."""


class Parameter(FileModel):
    """A symbol: a value in SI units with what calibration may search, or an expression of other parameters."""

    value: Expression | None = Field(None, description="a number with its unit")
    equals: Expression | None = Field(None, description="an expression of other parameters")
    range: tuple[Expression, Expression] | None = Field(None, description="[low, high] that calibration may search")
    meaning: FreeText = ""

    @model_validator(mode="after")
    def _one_definition(self) -> Parameter:
        if (self.value is None) == (self.equals is None):
            raise PydanticCustomError("parameter", "a parameter has either `value` or `equals`")
        if self.equals is not None and self.range is not None:
            raise PydanticCustomError("parameter", "a parameter with `equals` follows others; its `range` belongs to them")
        return self

    @property
    def definition(self) -> Expression:
        """Its `value` or `equals`."""
        found = self.equals if self.value is None else self.value
        assert found is not None
        return found


class CarriedBy(FileModel):
    """Where a body rides on another, seen from the carrier's COG [m]."""

    body: str
    x: Expression = ZERO
    z: Expression = ZERO


class Size(FileModel):
    """Length and height of a box centred on the COG [m]."""

    length: Expression
    height: Expression


class Bending(FileModel):
    """The first bending mode of a long body, as of a uniform free beam about its COG.

    Its shape is the parabola (3 s^2 - 1)/2 with s = 1 at both ends: free of heave and pitch, with the modal mass of a fifth of the body's.
    Points on its neutral axis, `z` above the COG, move fore-aft as if it were rigid; a loaded frame's lies below the COG.
    """

    length: Expression
    frequency: Expression = Field(description="natural frequency of the free body")
    damping_ratio: Expression = ZERO
    z: Expression = Field(ZERO, description="height of its neutral axis above the COG")


class Body(FileModel):
    """A rigid body with the motions it has of its own, and its bending where it is long and limber."""

    mass: Expression
    pitch_inertia: Expression | None = None
    motions: tuple[BodyMotion, ...] = ("heave", "pitch")
    carried_by: CarriedBy | None = None
    size: Size | None = None
    bending: Bending | None = None
    at: Expression | None = Field(None, description="COG ahead of the first body's COG, for unconnected bodies")
    title: FreeText = ""


class Point(FileModel):
    """A point of a body, from its COG: x ahead, z above [m]."""

    x: Expression = ZERO
    z: Expression = ZERO


class Spring(FileModel):
    """A linear spring and damper in parallel, and the force laws beside them."""

    k: Expression = ZERO
    c: Expression = ZERO
    laws: tuple[dict[Name, LawEntry], ...] = Field((), description="force laws in parallel with k and c, each `{name: {parameter: value}}`")


class Joint(Spring):
    """What joins two bodies: the keys that are not its own are the bodies' names."""

    gathered: ClassVar[tuple[str, ...]] = ("points",)
    points: dict[Name, Point] = Field(default_factory=dict)
    title: FreeText = ""

    @model_validator(mode="before")
    @classmethod
    def _gather_points(cls, data: Any) -> Any:
        if not isinstance(data, Mapping):
            return data
        own = {key: value for key, value in data.items() if key in cls.model_fields or "points" in data}
        points = own.pop("points", {key: ({} if value is None else value) for key, value in data.items() if key not in own})
        if not isinstance(points, Mapping):
            return data
        if len(points) != 2:
            named = ", ".join(points) or "none"
            raise PydanticCustomError(
                "joint", "a hinge or link joins two bodies, each named with its point; found {named}", {"named": shortened(named)}
            )
        return {**own, "points": points}

    @property
    def ends(self) -> tuple[tuple[str, Point], tuple[str, Point]]:
        """The two (body name, point) in the file's order."""
        first, second = self.points.items()
        return first, second


class Hinge(Joint):
    """A pin between two bodies; k and c act on their relative pitch [N m/rad, N m s/rad]."""


class Link(Joint):
    """A vertical spring and damper between points of two bodies, or of a body and the ground."""


class Axle(FileModel):
    """A wheel on the road: with `mass` and `suspension` it hops by itself, without both it sits on its body."""

    body: str
    x: Expression = ZERO
    mass: Expression | None = None
    suspension: Spring | None = None
    tyre: Spring
    title: FreeText = ""

    @model_validator(mode="after")
    def _both_or_none(self) -> Axle:
        if (self.mass is None) != (self.suspension is None):
            missing = "suspension" if self.suspension is None else "mass"
            raise PydanticCustomError(
                "axle",
                "an axle has `mass` and `suspension`, or neither (then its wheel sits on the body); {missing} is missing",
                {"missing": missing},
            )
        return self
