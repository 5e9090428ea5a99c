"""The typed vehicle: its parts, its parameters' values, and where everything stands in its file."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import isfinite
from pathlib import Path
from typing import Annotated, Any, ClassVar

from pydantic import Field, PrivateAttr

from vehgen.errors import ArgumentError, InputError, Position, did_you_mean, shortened, shown
from vehgen.files.document import Located, locate_arguments
from vehgen.files.entry import FileModel, called_by_hand_only, file_form, validate
from vehgen.files.expressions import Expression, ExpressionError
from vehgen.files.names import FreeText, Name
from vehgen.files.units import DAMPING, FREQUENCY, INERTIA, LENGTH, MASS, MOMENT, NONE, PITCH_DAMPING, STIFFNESS, Dimension
from vehgen.vehicle.changes import merge
from vehgen.vehicle.parts import Axle, Body, Hinge, Link, Parameter

WarningName = Annotated[str, Field(pattern=r"^\s*[A-Za-z]\w*(\s+[A-Za-z]\w*)?\s*$", max_length=200)]
"""The kind of a warning, alone or with the part that it speaks of."""


class Vehicle(FileModel):
    """A road vehicle, its names, units, connections and values checked.

    Read from a file by :func:`vehgen.vehicle.load_vehicle`, or made of parts, as in
    `Vehicle(name="rig", bodies={"frame": Body(mass="8 t", motions=["heave"])}, axles={"front": Axle(body="frame", tyre=tyre)})`.

    Raises
    ------
    InputError
        Made of parts: what is wrong, with the path of the argument.
    """

    other_keys: ClassVar[tuple[str, ...]] = ("extends",)
    name: Name
    title: FreeText = ""
    source: FreeText = ""
    description: FreeText = ""
    gravity: bool = Field(True, description="false where no weight acts along the motions, as in a rig on a rail")
    parameters: dict[Name, Parameter] = Field(default_factory=dict)
    bodies: dict[Name, Body]
    hinges: dict[Name, Hinge] = Field(default_factory=dict)
    axles: dict[Name, Axle] = Field(default_factory=dict)
    links: dict[Name, Link] = Field(default_factory=dict)
    sets: dict[Name, dict[Name, Expression]] = Field(default_factory=dict)
    silence: tuple[WarningName, ...] = Field((), description="warnings not to be given: `gyration`, or of one part only, `gyration cab`")

    _document: Located = PrivateAttr()
    _files: tuple[Path, ...] = PrivateAttr(())

    @called_by_hand_only
    def __init__(self, /, **data: Any) -> None:
        super().__init__(**data)
        self._finish(locate_arguments(file_form(self), type(self).__name__), ())

    @classmethod
    def from_document(cls, document: Located, files: tuple[Path, ...], default_name: str) -> Vehicle:
        """Return the checked vehicle of a document that extends no other any more.

        Raises
        ------
        InputError
            At the place of the first fault.
        """
        data = document.plain()
        data.setdefault("name", default_name)
        vehicle = validate(cls, data, document)
        vehicle._finish(document, files)
        return vehicle

    def _finish(self, document: Located, files: tuple[Path, ...]) -> None:
        from vehgen.vehicle.checks import check_vehicle

        self._document, self._files = document, files
        check_vehicle(self)

    def with_changes(self, change: Mapping[str, Any] | None = None, /, **parts: Any) -> Vehicle:
        """Return a vehicle with a change laid over it, as a file that extends it would say it.

        Parameters
        ----------
        change
            A mapping in the form of a vehicle file. Its leaves may be texts, numbers and expressions; a typed part replaces the one before
            as a whole, a mapping changes what it names, None removes it.
        parts
            The same by its uppermost keys: `bodies={"cab": Body(...)}`, `parameters={"mass": {"value": "9 t"}}`, `title="laden"`.

        Raises
        ------
        InputError
            For a change that does not fit, with the path of the argument; at the place in the file where what stood there does not fit it.
        """
        for key in parts.keys() & (change or {}).keys():
            raise InputError(f"`{key}` is changed twice: in the mapping and as an argument of its own")
        base = locate_arguments(file_form(self), type(self).__name__, self._document)
        merged = merge(base, locate_arguments({**(change or {}), **parts}, "change"))
        return Vehicle.from_document(merged, self._files, self.name)

    @property
    def files(self) -> tuple[Path, ...]:
        """The files it was read from: its own first, then those it extends."""
        return self._files

    @property
    def document(self) -> Located:
        """What it was validated from, with the places of its values."""
        return self._document

    def position(self, *path: str | int, key: bool = False, offset: int | None = None) -> Position:
        """Return where the value (or key, or character `offset` of a text) at `path` stands in its file."""
        return self._document.find(path, key=key, offset=offset)

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
                definition = self.parameters[name].definition
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
        overrides = None if overrides is None else by_name(overrides)
        values = {name: self.parameters[name].definition.evaluate({}) for name in self.free_parameters}
        if parameter_set is not None:
            if parameter_set not in self.sets:
                raise InputError(f"{self.name} has no parameter set {shown(parameter_set)}; {did_you_mean(parameter_set, self.sets)}")
            values |= {name: expression.evaluate({}) for name, expression in self.sets[parameter_set].items()}
        for name, value in (overrides or {}).items():
            if name in self.parameters and name not in values:
                follows = ", ".join(sorted(self.parameters[name].definition.names))
                raise InputError(
                    f"{self.name}: {shown(name)} has `equals` and follows {follows or 'its file'}; give a value to these instead"
                )
            if name not in values:
                raise InputError(f"{self.name} has no parameter {shown(name)} with a value; {did_you_mean(name, values)}")
            try:
                values[name] = float(value)
            except (TypeError, ValueError) as error:
                raise InputError(f"{self.name}: {name} takes a number in SI units here, found {shortened(repr(value))}") from error
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
                definition = self.parameters[name].definition
                used = {other: value(other) for other in definition.names}
                try:
                    values[name] = definition.evaluate(used)
                except ExpressionError as error:
                    raise InputError(str(error), self.position("parameters", name, "equals")) from error
            return values[name]

        return {name: value(name) for name in self.parameters}

    @property
    def has_laws(self) -> bool:
        """Whether a suspension, tyre, link or hinge carries a force law."""
        axles = [spring for axle in self.axles.values() for spring in (axle.suspension, axle.tyre) if spring is not None]
        return any(spring.laws for spring in (*axles, *self.links.values(), *self.hinges.values()))

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
                yield (*path, "bending", "z"), body.bending.z, LENGTH
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


def by_name(values: Any) -> Mapping[str, float]:
    """Return values by name, of a column of a table, too; raises ArgumentError for anything else."""
    if isinstance(values, Mapping):
        return values
    if not hasattr(values, "items"):
        raise ArgumentError(f"`values`: numbers in SI units by name were expected, found {type(values).__name__}", "values")
    return dict(values.items())


def finite(values: Mapping[str, float]) -> Mapping[str, float]:
    """Return values by name as they are; raises InputError at one that is no finite number, and for what are no values by name."""
    values = by_name(values)
    for name, value in values.items():
        if not isfinite(value):
            raise ArgumentError(f"`values`: {name} must be a finite number, found {value}", "values")
    return values
