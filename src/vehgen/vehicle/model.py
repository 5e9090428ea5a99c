"""The typed vehicle: bodies, hinges, axles, links and their parameters."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, ClassVar, Literal

from pydantic import Field, PrivateAttr, model_validator
from pydantic_core import PydanticCustomError

from vehgen.errors import InputError, Position, did_you_mean, shortened, shown
from vehgen.files.document import Located
from vehgen.files.entry import FileModel
from vehgen.files.expressions import Expression, ExpressionError, parse
from vehgen.files.names import FreeText, Name
from vehgen.files.units import DAMPING, FREQUENCY, INERTIA, LENGTH, MASS, MOMENT, NONE, PITCH_DAMPING, STIFFNESS, Dimension

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
    """

    length: Expression
    frequency: Expression = Field(description="natural frequency of the free body")
    damping_ratio: Expression = ZERO


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


class Vehicle(FileModel):
    """A road vehicle as its file declares it.

    Made by :func:`vehgen.vehicle.load_vehicle`, which has checked names, units, connections and values.
    """

    other_keys: ClassVar[tuple[str, ...]] = ("extends",)
    name: Name
    title: FreeText = ""
    source: FreeText = ""
    description: FreeText = ""
    parameters: dict[Name, Parameter] = Field(default_factory=dict)
    bodies: dict[Name, Body]
    hinges: dict[Name, Hinge] = Field(default_factory=dict)
    axles: dict[Name, Axle] = Field(default_factory=dict)
    links: dict[Name, Link] = Field(default_factory=dict)
    sets: dict[Name, dict[Name, Expression]] = Field(default_factory=dict)

    _document: Located | None = PrivateAttr(None)
    _files: tuple[Path, ...] = PrivateAttr(())

    @property
    def files(self) -> tuple[Path, ...]:
        """The files it was read from: its own first, then those it extends."""
        return self._files

    def position(self, *path: str | int, key: bool = False, offset: int | None = None) -> Position | None:
        """Return where the value (or key, or character `offset` of a text) at `path` stands in its file."""
        return self._document.find(path, key=key, offset=offset) if self._document else None

    @property
    def free_parameters(self) -> tuple[str, ...]:
        """Names of the parameters that have a `value`, in the file's order; the columns of a population."""
        return tuple(name for name, parameter in self.parameters.items() if parameter.equals is None)

    @property
    def dimensions(self) -> dict[str, Dimension]:
        """Dimension of every parameter."""
        found: dict[str, Dimension] = {}

        def dimension(name: str) -> Dimension:
            if name not in found:
                definition = self.parameters[name].value or self.parameters[name].equals
                assert definition is not None
                found[name] = definition.dimension({other: dimension(other) for other in definition.names})
            return found[name]

        for name in self.parameters:
            dimension(name)
        return found

    def values(self, parameter_set: str | None = None, overrides: Mapping[str, float] | None = None) -> dict[str, float]:
        """Return the value of every free parameter in SI units.

        Parameters
        ----------
        parameter_set
            One of `sets`, or None for the values in the file.
        overrides
            SI values that replace them, by name.

        Raises
        ------
        InputError
            For a set or parameter that the vehicle does not have.

        """
        values: dict[str, float] = {}
        for name in self.free_parameters:
            definition = self.parameters[name].value
            assert definition is not None
            values[name] = definition.evaluate({})
        if parameter_set is not None:
            if parameter_set not in self.sets:
                raise InputError(f"{self.name} has no parameter set {shown(parameter_set)}; {did_you_mean(parameter_set, self.sets)}")
            values |= {name: expression.evaluate({}) for name, expression in self.sets[parameter_set].items()}
        for name, value in (overrides or {}).items():
            if name not in values:
                raise InputError(f"{self.name} has no parameter {shown(name)} with a value; {did_you_mean(name, values)}")
            values[name] = float(value)
        return values

    def all_values(self, free: Mapping[str, float]) -> dict[str, float]:
        """Return the values of all parameters, those given by `equals` included [SI].

        Raises
        ------
        InputError
            Where an `equals` has no value for these, such as 1/0.

        """
        values = dict(free)

        def value(name: str) -> float:
            if name not in values:
                definition = self.parameters[name].equals
                assert definition is not None
                used = {other: value(other) for other in definition.names}
                try:
                    values[name] = definition.evaluate(used)
                except ExpressionError as error:
                    raise InputError(str(error), self.position("parameters", name, "equals")) from error
            return values[name]

        return {name: value(name) for name in self.parameters}

    def ranges(self) -> dict[str, tuple[float, float]]:
        """Return what calibration may search, in SI units, by parameter name."""
        return {
            name: (parameter.range[0].evaluate({}), parameter.range[1].evaluate({}))
            for name, parameter in self.parameters.items()
            if parameter.range is not None
        }

    def quantities(self) -> Iterator[tuple[tuple[str, ...], Expression, Dimension]]:
        """Yield every expression of bodies, hinges, axles and links: its path in the file, itself, the dimension it must have."""
        for name, body in self.bodies.items():
            path: tuple[str, ...] = ("bodies", name)
            yield (*path, "mass"), body.mass, MASS
            if body.pitch_inertia is not None:
                yield (*path, "pitch_inertia"), body.pitch_inertia, INERTIA
            if body.carried_by is not None:
                yield (*path, "carried_by", "x"), body.carried_by.x, LENGTH
                yield (*path, "carried_by", "z"), body.carried_by.z, LENGTH
            if body.size is not None:
                yield (*path, "size", "length"), body.size.length, LENGTH
                yield (*path, "size", "height"), body.size.height, LENGTH
            if body.bending is not None:
                yield (*path, "bending", "length"), body.bending.length, LENGTH
                yield (*path, "bending", "frequency"), body.bending.frequency, FREQUENCY
                yield (*path, "bending", "damping_ratio"), body.bending.damping_ratio, NONE
            if body.at is not None:
                yield (*path, "at"), body.at, LENGTH
        for kind, joints, stiffness, damping in (
            ("hinges", self.hinges, MOMENT, PITCH_DAMPING),
            ("links", self.links, STIFFNESS, DAMPING),
        ):
            for name, joint in joints.items():
                for body_name, point in joint.points.items():
                    yield (kind, name, body_name, "x"), point.x, LENGTH
                    yield (kind, name, body_name, "z"), point.z, LENGTH
                yield (kind, name, "k"), joint.k, stiffness
                yield (kind, name, "c"), joint.c, damping
        for name, axle in self.axles.items():
            path = ("axles", name)
            yield (*path, "x"), axle.x, LENGTH
            if axle.mass is not None:
                yield (*path, "mass"), axle.mass, MASS
            for part, spring in (("suspension", axle.suspension), ("tyre", axle.tyre)):
                if spring is not None:
                    yield (*path, part, "k"), spring.k, STIFFNESS
                    yield (*path, part, "c"), spring.c, DAMPING
