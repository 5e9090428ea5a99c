"""The entries of a run file: which vehicle, how fast, over which road, with what other inputs, sensors and outputs."""

from __future__ import annotations

from dataclasses import replace
from typing import Literal

from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from vehgen.files.entry import FileModel
from vehgen.files.expressions import Expression
from vehgen.files.limits import LARGEST_SEED, MOST_ROADS
from vehgen.files.names import Column, FreeText, Name, is_name
from vehgen.files.quantities import (
    Angle,
    Displacement,
    Duration,
    EdgeRadius,
    FileName,
    Footprint,
    Force,
    Frequency,
    HumpHeight,
    HumpLength,
    PlaceLength,
    PositiveForce,
    RoadPosition,
    Sample,
    Speed,
    Step,
)
from vehgen.mechanics.outputs import (
    AXLE_MOTIONS,
    AXLE_QUANTITIES,
    LINK_QUANTITIES,
    POINT_QUANTITIES,
    ElementOutput,
    Output,
    Place,
    PointOutput,
)
from vehgen.simulate.run_file.acquisition import AcquisitionEntry
from vehgen.simulate.run_file.knowledge import InitialEntry, UncertaintyEntry

DEFAULT_STEP = 1e-3
DEFAULT_SPEED = 1.0
"""What stands for the speed [m/s] of a rig without wheels; nothing depends on it."""


class HumpEntry(FileModel):
    """A hump on the road."""

    shape: Literal["half_sine", "versine", "trapezoid", "rectangle", "points"]
    length: HumpLength | None = None
    height: HumpHeight | None = None
    at: RoadPosition
    ramp: float | None = Field(None, gt=0, le=0.5)
    radius: EdgeRadius | None = None
    file: FileName | None = None
    distance: Column = "distance"
    height_column: Column = "height"

    @model_validator(mode="after")
    def _complete(self) -> HumpEntry:
        needed = ("file",) if self.shape == "points" else ("length", "height", *(("radius",) if self.shape == "rectangle" else ()))
        for key in needed:
            if getattr(self, key) is None:
                raise PydanticCustomError("joint", "a {shape} hump lacks the key {key}", {"shape": self.shape, "key": key})
        return self


class IsoEntry(FileModel):
    """A random road of an ISO 8608 class."""

    class_: Literal["A", "B", "C", "D", "E", "F", "G", "H"] = Field(alias="class")
    seed: int = Field(0, ge=0, le=LARGEST_SEED)


class ProfileEntry(FileModel):
    """A measured profile: a CSV file with columns of distance and height [m]."""

    file: FileName
    distance: Column = "distance"
    height: Column = "height"


class RoadEntry(FileModel):
    """One of hump, iso8608, profile."""

    hump: HumpEntry | None = None
    iso8608: IsoEntry | None = None
    profile: ProfileEntry | None = None

    @model_validator(mode="after")
    def _one(self) -> RoadEntry:
        if sum(item is not None for item in (self.hump, self.iso8608, self.profile)) != 1:
            raise PydanticCustomError("joint", "a road entry is one of hump, iso8608, profile")
        return self


class SpeedFile(FileModel):
    """A speed history: a CSV file with columns of time [s] and speed [m/s]."""

    file: FileName
    time: Column = "t"
    speed: Column = "speed"


class ForceHarmonic(FileModel):
    """amplitude * sin(2 pi frequency t + phase)."""

    amplitude: Force
    frequency: Frequency
    phase: Angle = 0.0


class DisplacementHarmonic(FileModel):
    """amplitude * sin(2 pi frequency t + phase)."""

    amplitude: Displacement
    frequency: Frequency
    phase: Angle = 0.0


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
        return self

    def place(self, name: str) -> Place:
        """Return the place under its name."""
        return Place(name, self.body, self.x, self.behind, self.distance)


class ForceEntry(PlaceEntry):
    """A vertical force on a body, upwards positive: harmonic, or measured in a CSV file (columns in s and N).

    `noise` is the standard deviation of what acts besides, white at the recording's samples [N].
    """

    harmonic: ForceHarmonic | None = None
    file: FileName | None = None
    time: Column = "t"
    force: Column = "force"
    noise: PositiveForce | None = None

    @model_validator(mode="after")
    def _one_source(self) -> ForceEntry:
        if (self.harmonic is None) == (self.file is None):
            raise PydanticCustomError("joint", "either `harmonic` or `file` was expected")
        return self


class DisplacementEntry(FileModel):
    """How the ground end of a link moves: harmonic, or measured in a CSV file (columns in s and m)."""

    harmonic: DisplacementHarmonic | None = None
    file: FileName | None = None
    time: Column = "t"
    displacement: Column = "displacement"

    @model_validator(mode="after")
    def _one_source(self) -> DisplacementEntry:
        if (self.harmonic is None) == (self.file is None):
            raise PydanticCustomError("joint", "either `harmonic` or `file` was expected")
        return self


class ChannelEntry(FileModel):
    """A recorded column: its unit where it is not SI, its sign where its axis is reversed, the deviation of its noise, its recorder."""

    column: Column
    unit: str | None = None
    sign: Literal[1, -1] = 1
    noise: str | float | None = None
    acquisition: str | AcquisitionEntry | None = None


def _default_channels() -> dict[str, Column | ChannelEntry]:
    return {"acceleration": "", "pitch_rate": ""}


class SensorEntry(PlaceEntry):
    """A sensor: a place, its height above the body's COG, the column of each quantity it records, and what acquires them.

    In place of a body an axle or a link, whose forces, travels and motions it records.
    """

    body: str = ""
    axle: str | None = None
    link: str | None = None
    height: PlaceLength = 0.0
    channels: dict[Name, Column | ChannelEntry] = Field(default_factory=_default_channels)
    acquisition: str | AcquisitionEntry | None = None

    @model_validator(mode="after")
    def _one_place(self) -> SensorEntry:
        if bool(self.body) + (self.axle is not None) + (self.link is not None) != 1:
            raise PydanticCustomError("joint", "a sensor sits on a `body`, or belongs to an `axle` or a `link`")
        if not self.body and (self.x is not None or self.behind is not None or "channels" not in self.model_fields_set):
            raise PydanticCustomError("joint", "a sensor of an axle or link has `channels`, and no place along a body")
        return self

    @property
    def quantities(self) -> dict[str, str]:
        """What it may record, with SI units."""
        if self.body:
            return POINT_QUANTITIES
        return {**AXLE_QUANTITIES, **AXLE_MOTIONS} if self.axle is not None else LINK_QUANTITIES

    def place(self, name: str) -> Place:
        """Return the place under its name."""
        return replace(super().place(name), height=self.height)

    def output(self, name: str, quantity: str) -> Output:
        """Return what stands for a quantity in a simulation; `name` is the sensor's."""
        channel = self.channel(name, quantity)
        if self.body:
            return PointOutput(channel, self.place(name), quantity)
        return ElementOutput(channel, self.axle or self.link or "", quantity)

    def column(self, name: str, quantity: str) -> str:
        """Return the column that holds a quantity; `name` is the sensor's."""
        entry = self.channels[quantity]
        return (entry if isinstance(entry, str) else entry.column) or f"{name}_{quantity}"

    def channel(self, name: str, quantity: str) -> str:
        """Return what the channel of a quantity is called: as its column where that is a name, else SENSOR_QUANTITY."""
        column = self.column(name, quantity)
        return column if is_name(column) else f"{name}_{quantity}"


class OutputEntry(FileModel):
    """A travel or force of an axle's suspension or tyre, or of a link."""

    quantity: str
    axle: str | None = None
    link: str | None = None

    @model_validator(mode="after")
    def _one_owner(self) -> OutputEntry:
        if (self.axle is None) == (self.link is None):
            raise PydanticCustomError("joint", "an output belongs to an `axle` or a `link`")
        return self


class RunFile(FileModel):
    """A run as its file declares it, quantities in SI units."""

    vehicle: FileName
    title: FreeText = ""
    set: str | None = None
    parameters: dict[Name, Expression] = Field(default_factory=dict)
    speed: Speed | SpeedFile = Field(DEFAULT_SPEED, union_mode="left_to_right")
    duration: Duration | None = None
    step: Step = DEFAULT_STEP
    sample: Sample | None = None
    road: list[RoadEntry] = Field(default_factory=list, max_length=MOST_ROADS)
    footprint: Footprint | None = None
    forces: dict[Name, ForceEntry] = Field(default_factory=dict)
    displacements: dict[Name, DisplacementEntry] = Field(default_factory=dict)
    initial: dict[Name, InitialEntry] = Field(default_factory=dict)
    sensors: dict[Name, SensorEntry] = Field(default_factory=dict)
    acquisition: str | AcquisitionEntry | None = None
    outputs: dict[Name, OutputEntry] = Field(default_factory=dict)
    recording: FileName | None = None
    band: tuple[Frequency, Frequency] | None = None
    uncertainty: UncertaintyEntry | None = None
