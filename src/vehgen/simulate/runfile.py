"""The run file: which vehicle, how fast, over which road, with what other inputs, sensors and outputs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from vehgen.errors import InputError, did_you_mean, shown
from vehgen.files import note_read
from vehgen.files.document import Located, read_document
from vehgen.files.expressions import Expression, ExpressionError
from vehgen.files.limits import LARGEST_SEED, MOST_CHANNELS, MOST_ROADS, VEHICLE_LENGTH
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
from vehgen.files.units import LENGTH
from vehgen.mechanics.outputs import AXLE_QUANTITIES, LINK_QUANTITIES, POINT_QUANTITIES, ElementOutput, Output, Place, PointOutput
from vehgen.vehicle.checks import check_values
from vehgen.vehicle.loading import load_vehicle, validate
from vehgen.vehicle.model import FileModel, Vehicle

DEFAULT_STEP = 1e-3
DEFAULT_DECIMATION = 10
DEFAULT_SPEED = 1.0
"""What stands for the speed [m/s] of a rig without wheels; nothing depends on it."""
MAX_STEPS = 10_000_000
TIME_COLUMN = "t"
"""The heading of the time in recordings and responses."""


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
    """A recorded column: its unit where it is not SI, its sign where its axis is reversed, the standard deviation of its white noise."""

    column: Column
    unit: str | None = None
    sign: Literal[1, -1] = 1
    noise: str | float | None = None


def _default_channels() -> dict[str, Column | ChannelEntry]:
    return {"acceleration": "", "pitch_rate": ""}


class SensorEntry(PlaceEntry):
    """A sensor: a place, and the column of each quantity it records."""

    channels: dict[Name, Column | ChannelEntry] = Field(default_factory=_default_channels)

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
    sensors: dict[Name, SensorEntry] = Field(default_factory=dict)
    outputs: dict[Name, OutputEntry] = Field(default_factory=dict)
    recording: FileName | None = None
    band: tuple[Frequency, Frequency] | None = None


@dataclass(frozen=True)
class Run:
    """A run file with the vehicle it names and the folder its own files are relative to."""

    file: RunFile
    vehicle: Vehicle
    folder: Path
    document: Located

    @property
    def decimation(self) -> int:
        """Every how many steps a sample is kept."""
        return DEFAULT_DECIMATION if self.file.sample is None else round(self.file.sample / self.file.step)

    def values(self) -> dict[str, float]:
        """Return the vehicle's free parameters in this run [SI]: file, then set, then the run's own."""
        own = {name: expression.evaluate({}) for name, expression in self.file.parameters.items()}
        return self.vehicle.values(self.file.set, own)

    def outputs(self) -> tuple[Output, ...]:
        """Return every channel the run asks for; with no sensor and no output, the acceleration of every body's COG."""
        found: list[Output] = []
        for name, sensor in self.file.sensors.items():
            place = sensor.place(name)
            found += [PointOutput(sensor.channel(name, quantity), place, quantity) for quantity in sensor.channels]
        for name, output in self.file.outputs.items():
            found.append(ElementOutput(name, output.axle or output.link or "", output.quantity))
        if not found:
            found = [PointOutput(f"{name}_acceleration", Place(name, name), "acceleration") for name in self.vehicle.bodies]
        return tuple(found)

    def forces(self) -> tuple[Place, ...]:
        """Return the places of the applied forces."""
        return tuple(entry.place(name) for name, entry in self.file.forces.items())


def load_run(path: str | Path, vehicle: Vehicle | None = None) -> Run:
    """Read a run file and the vehicle it names, or take another vehicle in its place.

    Raises
    ------
    InputError
        With file, line and column, what is wrong and what would be right.

    """
    path = Path(path)
    document = read_document(path)
    if not isinstance(document.value, dict):
        raise InputError("a file of `key: value` lines was expected", document.position)
    file = validate(RunFile, document.plain(), document)
    try:
        vehicle = vehicle or load_vehicle(file.vehicle, path.parent)
    except InputError as error:
        if error.position is None:
            raise InputError(error.message, document.find(("vehicle",))) from error
        raise
    if file.recording is not None:
        note_read(path.parent / file.recording)  # no result may replace it, even where only its name is read
    run = Run(file, vehicle, path.parent, document)
    _check(run)
    return run


def _check_channel_names(run: Run) -> None:
    """Refuse a channel that is called as the time is, or as another channel, where it is named."""
    named = [
        (sensor.channel(name, quantity), ("sensors", name, "channels", quantity, "column"))
        for name, sensor in run.file.sensors.items()
        for quantity in sensor.channels
    ]
    seen: set[str] = set()
    for name, path in (*named, *((name, ("outputs", name)) for name in run.file.outputs)):
        where = run.document.find(path, key=True)
        if name == TIME_COLUMN:
            raise InputError(f"a channel cannot be named {name!r}, as the column of the time is; choose another name", where)
        if name in seen:
            raise InputError(f"two channels are named {shown(name)}; each column needs a name of its own", where)
        seen.add(name)


def _check(run: Run) -> None:
    file, vehicle, document = run.file, run.vehicle, run.document

    def known(kind: str, name: str, allowed: Mapping[str, object] | list[str], *place: str, key: bool = False) -> None:
        if name not in allowed:
            raise InputError(f"{vehicle.name} has no {kind} {shown(name)}; {did_you_mean(name, allowed)}", document.find(place, key=key))

    if vehicle.axles and "speed" not in file.model_fields_set:
        raise InputError(f"the file lacks the key 'speed': {vehicle.name} has wheels", document.position)
    if file.band is not None and not file.band[0] < file.band[1]:
        raise InputError("`band` is [lowest, highest] frequency compared; the first must be the lower one", document.find(("band",)))
    dimensions = vehicle.dimensions
    if file.set is not None:
        known("parameter set", file.set, vehicle.sets, "set")
    for name, expression in file.parameters.items():
        known("parameter with a value", name, list(vehicle.free_parameters), "parameters", name, key=True)
        try:
            if expression.names:
                raise ExpressionError(f"expected a plain quantity in {dimensions[name]}, found a symbol in {shown(expression.text)}")
            found, number = expression.dimension({}), expression.evaluate({})
        except ExpressionError as error:
            raise InputError(str(error), document.find(("parameters", name), offset=error.offset)) from error
        if found != dimensions[name] and number != 0.0:
            raise InputError(f"{name} must be in {dimensions[name]}, found {found}", document.find(("parameters", name)))
    try:
        check_values(vehicle, run.values(), " in this run")
    except InputError as error:
        place = document.find(("parameters" if file.parameters else "set" if file.set else "vehicle",), key=True)
        raise InputError(f"{error.message} ({error.position})" if error.position else error.message, place) from error
    for kind, entries in (("forces", file.forces), ("sensors", file.sensors)):
        for name, entry in entries.items():
            known("body", entry.body, vehicle.bodies, kind, name, "body")
            if entry.behind is not None:
                known(
                    "axle, hinge or body",
                    entry.behind,
                    {**vehicle.axles, **vehicle.hinges, **vehicle.bodies},
                    kind,
                    name,
                    "behind",
                )
            if entry.x is not None:
                try:
                    found = entry.x.dimension(dimensions)
                    number = entry.x.evaluate(vehicle.all_values(run.values()))
                except ExpressionError as error:
                    raise InputError(str(error), document.find((kind, name, "x"), offset=error.offset)) from error
                if found != LENGTH and (entry.x.names or number != 0.0):
                    raise InputError(f"x must be in m, found {found}", document.find((kind, name, "x")))
                if (reason := VEHICLE_LENGTH.refusal(number)) is not None:
                    raise InputError(reason, document.find((kind, name, "x")))
    grounded = [name for name, link in vehicle.links.items() if "ground" in link.points]
    for name in file.displacements:
        known("link to the ground", name, grounded, "displacements", name, key=True)
    for name, sensor in file.sensors.items():
        for quantity in sensor.channels:
            if quantity not in POINT_QUANTITIES:
                raise InputError(
                    f"unknown quantity {shown(quantity)} of a sensor; {did_you_mean(quantity, POINT_QUANTITIES)}",
                    document.find(("sensors", name, "channels", quantity), key=True),
                )
    for name, output in file.outputs.items():
        known(
            "axle" if output.axle else "link",
            output.axle or output.link or "",
            vehicle.axles if output.axle else vehicle.links,
            "outputs",
            name,
            "axle" if output.axle else "link",
        )
        quantities = AXLE_QUANTITIES if output.axle else LINK_QUANTITIES
        if output.quantity not in quantities:
            owner = "an axle" if output.axle else "a link"
            raise InputError(
                f"unknown quantity {shown(output.quantity)} of {owner}; {did_you_mean(output.quantity, quantities)}",
                document.find(("outputs", name, "quantity")),
            )
    if (count := len(run.outputs())) > MOST_CHANNELS:
        raise InputError(f"{count} channels; a run has at most {MOST_CHANNELS}", document.find(("sensors",), key=True))
    _check_channel_names(run)
    if file.duration is not None and file.duration > MAX_STEPS * file.step:
        raise InputError(
            f"a run has at most {MAX_STEPS} steps; {file.duration:g} s in steps of {file.step:g} s are more",
            document.find(("duration",)),
        )
    if file.sample is not None and (run.decimation < 1 or abs(run.decimation * file.step - file.sample) > 1e-9 * file.sample):
        raise InputError(
            f"`sample` must be a whole number of steps of {file.step:g} s, found {file.sample:g} s",
            document.find(("sample",)),
        )
