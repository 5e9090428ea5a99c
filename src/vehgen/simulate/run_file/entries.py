"""The entries of a run file: which vehicle, how fast, over which road, with what other inputs, sensors and outputs."""

from __future__ import annotations

from typing import Literal

from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from vehgen.files.entry import FileModel
from vehgen.files.expressions import Expression
from vehgen.files.limits import LARGEST_SEED, MOST_ROADS
from vehgen.files.names import Column, FreeText, Name
from vehgen.files.quantities import (
    Displacement,
    Duration,
    EdgeRadius,
    FileName,
    Footprint,
    Force,
    Frequency,
    HumpHeight,
    HumpLength,
    Phase,
    PositiveForce,
    RoadPosition,
    Sample,
    Speed,
    Step,
    TimeOfFile,
)
from vehgen.simulate.run_file.acquisition import AcquisitionEntry
from vehgen.simulate.run_file.knowledge import InitialEntry, UncertaintyEntry
from vehgen.simulate.run_file.sensors import OutputEntry, PlaceEntry, SensorEntry

DEFAULT_STEP = 1e-3
DEFAULT_SPEED = 1.0
"""What stands for the speed [m/s] of a rig without wheels; nothing depends on it."""


_SHAPES_OF: dict[str, tuple[str, ...]] = {
    **dict.fromkeys(("length", "height"), ("half_sine", "versine", "trapezoid", "rectangle")),
    **dict.fromkeys(("file", "distance", "height_column", "distance_unit", "unit"), ("points",)),
    "ramp": ("trapezoid",),
    "radius": ("rectangle",),
}
"""The shapes of humps that have a key."""


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
    distance_unit: str | None = None
    unit: str | None = None

    @model_validator(mode="after")
    def _complete(self) -> HumpEntry:
        needed = ("file",) if self.shape == "points" else ("length", "height", *(("radius",) if self.shape == "rectangle" else ()))
        for key in needed:
            if getattr(self, key) is None:
                raise PydanticCustomError("joint", "a {shape} hump lacks the key {key}", {"shape": self.shape, "key": key})
        for key, shapes_of in _SHAPES_OF.items():
            if key in self.model_fields_set and self.shape not in shapes_of:
                shapes = {"key": key, "shape": self.shape, "shapes": " or ".join(shapes_of)}
                raise PydanticCustomError("joint", "the key {key} belongs to a hump of the shape {shapes}, not to {shape}", shapes)
        return self


class IsoEntry(FileModel):
    """A random road of an ISO 8608 class."""

    class_: Literal["A", "B", "C", "D", "E", "F", "G", "H"] = Field(alias="class")
    seed: int = Field(0, strict=True, ge=0, le=LARGEST_SEED)


class ProfileEntry(FileModel):
    """A measured profile: a table with columns of distance and height, in m, in the units that it gives itself or in those stated here.

    The first wheel stands at the distance `start` of the file as the run begins (default: at its 0); rows after `end` do not count.
    """

    file: FileName
    distance: Column = "distance"
    height: Column = "height"
    distance_unit: str | None = None
    unit: str | None = None
    start: RoadPosition | None = None
    end: RoadPosition | None = None


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
    """A speed history: a table with columns of time and speed, in s and m/s, or in other units; or a GPX or NMEA track.

    The run begins at the time `start` of the file (default: at its 0); rows before it and after `end` do not count.
    """

    file: FileName
    time: Column = "t"
    speed: Column = "speed"
    time_unit: str | None = None
    unit: str | None = None
    start: TimeOfFile | None = None
    end: TimeOfFile | None = None


class ForceHarmonic(FileModel):
    """amplitude * sin(2 pi frequency t + phase)."""

    amplitude: Force
    frequency: Frequency
    phase: Phase = 0.0


class DisplacementHarmonic(FileModel):
    """amplitude * sin(2 pi frequency t + phase)."""

    amplitude: Displacement
    frequency: Frequency
    phase: Phase = 0.0


class ForceEntry(PlaceEntry):
    """A vertical force on a body, upwards positive: harmonic, or measured in a table, its columns in s and in `unit`.

    `noise` is the standard deviation of what acts besides, white at the recording's samples [N].
    """

    harmonic: ForceHarmonic | None = None
    file: FileName | None = None
    time: Column = "t"
    force: Column = "force"
    time_unit: str | None = None
    unit: str | None = None
    noise: PositiveForce | None = None

    @model_validator(mode="after")
    def _one_source(self) -> ForceEntry:
        if (self.harmonic is None) == (self.file is None):
            raise PydanticCustomError("joint", "either `harmonic` or `file` was expected")
        return self


class DisplacementEntry(FileModel):
    """How the ground end of a link moves: harmonic, or measured in a table, its columns in s and in `unit`."""

    harmonic: DisplacementHarmonic | None = None
    file: FileName | None = None
    time: Column = "t"
    displacement: Column = "displacement"
    time_unit: str | None = None
    unit: str | None = None

    @model_validator(mode="after")
    def _one_source(self) -> DisplacementEntry:
        if (self.harmonic is None) == (self.file is None):
            raise PydanticCustomError("joint", "either `harmonic` or `file` was expected")
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
