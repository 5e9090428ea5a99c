"""What is measured where: places on bodies, sensors with their channels, and outputs of axles, links and hinges."""

from __future__ import annotations

from dataclasses import replace
from typing import Literal

from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from vehgen.errors import InputError, Position, shown
from vehgen.files.checks import unit_factor
from vehgen.files.entry import FileModel
from vehgen.files.expressions import Expression
from vehgen.files.names import Column, Name, is_name
from vehgen.files.quantities import PlaceLength, read_quantity
from vehgen.files.units import read_unit
from vehgen.mechanics.outputs import DISTANCE_ALONE, ElementOutput, Output, Place, PointOutput
from vehgen.mechanics.quantities import AXLE_MOTIONS, AXLE_QUANTITIES, HINGE_QUANTITIES, LINK_QUANTITIES, POINT_QUANTITIES
from vehgen.simulate.run_file.acquisition import AcquisitionEntry

ElementGroup = Literal["axles", "links", "hinges"]
ELEMENT_QUANTITIES_OF: dict[ElementGroup, dict[str, str]] = {"axles": AXLE_QUANTITIES, "links": LINK_QUANTITIES, "hinges": HINGE_QUANTITIES}
"""What is computed of springs, tyres and pins, with SI units, by where a vehicle has them."""


class PlaceEntry(FileModel):
    """A place on a body: `x` from its COG, or `distance` behind an axle, hinge or body."""

    body: str
    x: Expression | None = None
    behind: str | None = None
    distance: PlaceLength = 0.0

    @model_validator(mode="after")
    def _one_way(self) -> PlaceEntry:
        if self.x is not None and self.behind is not None:
            raise PydanticCustomError("joint", "a place has `x`, or `behind` with `distance`, not both")
        if self.distance and self.behind is None:
            raise PydanticCustomError("joint", DISTANCE_ALONE, {"ahead": f"{-self.distance:g}"})
        return self

    def place(self, name: str) -> Place:
        """Return the place under its name."""
        return Place(name, self.body, self.x, self.behind, self.distance)


class ChannelEntry(FileModel):
    """A recorded column: its unit where it is not SI, its sign where its axis is reversed, the deviation of its noise, its recorder."""

    column: Column
    unit: str | None = None
    sign: Literal[1, -1] = 1
    noise: str | float | None = None
    acquisition: str | AcquisitionEntry | None = None


def _default_channels() -> dict[str, Column | ChannelEntry]:
    return {"acceleration": "", "pitch_rate": ""}


class OfElement(FileModel):
    """What belongs to an axle, a link or a hinge."""

    axle: str | None = None
    link: str | None = None
    hinge: str | None = None

    @property
    def element(self) -> tuple[ElementGroup, str] | None:
        """The group in which a vehicle has it, and its name there."""
        named: dict[ElementGroup, str | None] = {"axles": self.axle, "links": self.link, "hinges": self.hinge}
        return next(((group, name) for group, name in named.items() if name is not None), None)

    @property
    def n_elements(self) -> int:
        """How many are named."""
        return sum(item is not None for item in (self.axle, self.link, self.hinge))


class SensorEntry(PlaceEntry, OfElement):
    """A sensor: a place, its height above the body's COG, the column of each quantity it records, and what acquires them.

    In place of a body an axle, a link or a hinge, whose forces, travels and motions it records.
    """

    body: str = ""
    height: PlaceLength = 0.0
    channels: dict[Name, Column | ChannelEntry] = Field(default_factory=_default_channels)
    acquisition: str | AcquisitionEntry | None = None

    @model_validator(mode="after")
    def _one_place(self) -> SensorEntry:
        if bool(self.body) + self.n_elements != 1:
            raise PydanticCustomError("joint", "a sensor sits on a `body`, or belongs to an `axle`, a `link` or a `hinge`")
        if not self.body and (self.x is not None or self.behind is not None or "channels" not in self.model_fields_set):
            raise PydanticCustomError("joint", "a sensor of an axle, link or hinge has `channels`, and no place along a body")
        return self

    @property
    def quantities(self) -> dict[str, str]:
        """What it may record, with SI units."""
        if self.element is None:
            return POINT_QUANTITIES
        group, _ = self.element
        return {**AXLE_QUANTITIES, **AXLE_MOTIONS} if group == "axles" else ELEMENT_QUANTITIES_OF[group]

    def place(self, name: str) -> Place:
        """Return the place under its name."""
        return replace(super().place(name), height=self.height)

    def output(self, name: str, quantity: str) -> Output:
        """Return what stands for a quantity in a simulation; `name` is the sensor's."""
        channel = self.channel(name, quantity)
        if self.element is None:
            return PointOutput(channel, self.place(name), quantity)
        return ElementOutput(channel, self.element[1], quantity)

    def column(self, name: str, quantity: str) -> str:
        """Return the column that holds a quantity; `name` is the sensor's."""
        entry = self.channels[quantity]
        return (entry if isinstance(entry, str) else entry.column) or f"{name}_{quantity}"

    def unit(self, quantity: str) -> str:
        """Return the unit of a quantity's column."""
        entry = self.channels[quantity]
        return self.quantities[quantity] if isinstance(entry, str) or entry.unit is None else entry.unit

    def factor(self, quantity: str) -> float:
        """Return what a reading of a quantity's column is worth in SI units, its sign included."""
        entry = self.channels[quantity]
        sign = 1 if isinstance(entry, str) else entry.sign
        return sign * unit_factor(self.unit(quantity), self.quantities[quantity], quantity, None)

    def noise(self, quantity: str, place: Position | None = None) -> float | None:
        """Return the noise that is stated of a quantity [SI]; raises InputError at `place` for what is no number above 0 in its unit."""
        entry = self.channels[quantity]
        if isinstance(entry, str) or entry.noise is None:
            return None
        unit = read_unit(self.quantities[quantity])
        assert unit is not None
        try:
            number = read_quantity(entry.noise, unit[1])
        except PydanticCustomError as error:
            raise InputError(error.message(), place) from error
        if not 0 < number < float("inf"):
            raise InputError(f"a noise above 0 was expected, found {shown(entry.noise)}", place)
        return number

    def channel(self, name: str, quantity: str) -> str:
        """Return what the channel of a quantity is called: as its column where that is a name, else SENSOR_QUANTITY."""
        column = self.column(name, quantity)
        return column if is_name(column) else f"{name}_{quantity}"


class OutputEntry(OfElement):
    """A travel or force of an axle's suspension or tyre, of a link or of a hinge."""

    quantity: str

    @model_validator(mode="after")
    def _one_owner(self) -> OutputEntry:
        if self.n_elements != 1:
            raise PydanticCustomError("joint", "an output belongs to an `axle`, a `link` or a `hinge`")
        return self

    @property
    def quantities(self) -> dict[str, str]:
        """What it may be, with SI units."""
        return ELEMENT_QUANTITIES_OF[self.element[0]] if self.element else {}

    def output(self, name: str) -> ElementOutput:
        """Return what stands for it in a simulation, under its name."""
        return ElementOutput(name, self.element[1] if self.element else "", self.quantity)
