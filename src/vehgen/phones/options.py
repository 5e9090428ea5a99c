"""What a person says about phones and road: `L1:body=tractor,behind=axle1,distance=-0.29` and `half_sine,length=0.5,height=0.03`."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from vehgen.errors import InputError, did_you_mean, shortened, shown
from vehgen.files.expressions import ExpressionError, parse
from vehgen.files.limits import VEHICLE_LENGTH
from vehgen.files.names import is_identifier
from vehgen.files.tables import read_columns
from vehgen.files.units import LENGTH, NONE, TIME, Dimension
from vehgen.mechanics import Place, PointOutput
from vehgen.phones.csv_table import ColumnMap, split_pairs
from vehgen.road import Hump, MeasuredProfile, Profile
from vehgen.simulate.runfile import HumpEntry
from vehgen.simulate.scenario import check_hump_points
from vehgen.vehicle import Vehicle

_SENSOR_KEYS = ("body", "x", "behind", "distance", "forward", "up", "acceleration_sign", "from", "to")
_HUMP_KEYS = ("length", "height", "ramp", "radius", "file", "distance", "height_column")


@dataclass(frozen=True)
class PhoneSensor:
    """Where a phone lay: a place as in a run file, which of its axes point forward and up, its accelerations' sign where it must be told.

    `start` and `end` [s] on the phone's own clock cut its recording.
    """

    name: str
    place: Place
    forward: str | None = None
    up: str | None = None
    acceleration_sign: int | None = None
    start: float = -math.inf
    end: float = math.inf

    def outputs(self, pitch: bool) -> tuple[PointOutput, ...]:
        """Return the channels: NAME_az, and NAME_q where the pitch rate was recorded."""
        found = (PointOutput(f"{self.name}_az", self.place, "acceleration"),)
        return (*found, PointOutput(f"{self.name}_q", self.place, "pitch_rate")) if pitch else found


@dataclass(frozen=True)
class RoadOption:
    """A hump or a measured profile: how a run file writes it (all but `at`), what it is, and how long [m]."""

    kind: str
    entry: dict[str, Any]
    hump: Hump | None = None
    profile: MeasuredProfile | None = None

    @property
    def length(self) -> float:
        """Its length along the road [m]."""
        return self.hump.length if self.hump else self.profile.end if self.profile else 0.0

    def at(self, distance: float) -> Profile:
        """Return the road with its begin moved to `distance` [m]; a measured profile stays where it was measured."""
        if self.hump is not None:
            return Hump(distance, self.hump.length, self.hump.shape)
        assert self.profile is not None
        return self.profile


@dataclass(frozen=True)
class Plan:
    """What a person says about a pass.

    `speed` [m/s] where it is not the GPS's; `by_axles` to take the speed that the axles' marks fit best, near that; `lead` [m] from the
    front wheel at t = 0 to the hump; `rate` [Hz] of the recording; `top` [Hz] of the band that matters; `after` [s] recorded when the last
    wheel has left the hump; `footprint` [m] of the tyres.
    """

    vehicle: Vehicle
    road: RoadOption
    sensors: tuple[PhoneSensor, ...]
    parameter_set: str | None = None
    speed: float | None = None
    by_axles: bool = False
    lead: float | None = None
    rate: float = 100.0
    top: float = 25.0
    after: float = 3.0
    footprint: float = 0.0
    columns: ColumnMap | None = None


def quantity(text: str, dimension: Dimension, where: str) -> float:
    """Read a number, in SI units unless one stands with it; raises InputError."""
    try:
        expression = parse(text)
        if expression.names:
            raise ExpressionError(f"found a symbol in {shown(text)}")
        found, value = expression.dimension({}), expression.evaluate({})
    except ExpressionError as error:
        raise InputError(f"{where}: expected a number in {dimension}; {error}") from error
    if found not in (dimension, NONE) or not math.isfinite(value):
        raise InputError(f"{where}: expected a finite number in {dimension}, found {shown(text)}")
    return value


def read_sensor(text: str, vehicle: Vehicle) -> PhoneSensor:
    """Read `NAME:body=...,behind=...,distance=...[,forward=y][,up=z][,acceleration_sign=-1][,from=SECONDS][,to=SECONDS]`.

    Raises
    ------
    InputError
        For a malformed text, and names that the vehicle lacks, with the nearest that it has.
    """
    name, colon, rest = text.partition(":")
    name, where = name.strip(), f"--sensor {shortened(name.strip())}"
    if not colon or not is_identifier(name):
        raise InputError(f"--sensor: expected NAME:body=BODY,behind=AXLE,distance=METRES, found {shown(text)}")
    found = split_pairs(rest, where, _SENSOR_KEYS)
    if "body" not in found:
        raise InputError(f"{where} lacks body=; {did_you_mean('', vehicle.bodies)}")
    if found["body"] not in vehicle.bodies:
        raise InputError(f"{where}: {vehicle.name} has no body {shown(found['body'])}; {did_you_mean(found['body'], vehicle.bodies)}")
    behind = found.get("behind")
    known = {**vehicle.axles, **vehicle.hinges, **vehicle.bodies}
    if behind is not None and behind not in known:
        raise InputError(f"{where}: {vehicle.name} has nothing named {shown(behind)} to be behind of; {did_you_mean(behind, known)}")
    if behind is not None and "x" in found:
        raise InputError(f"{where}: a place has x=, or behind= with distance=, not both")
    if "distance" in found and behind is None:
        raise InputError(f"{where}: distance= needs behind=")
    if "acceleration_sign" in found and found["acceleration_sign"] not in ("1", "+1", "-1"):
        raise InputError(f"{where}: acceleration_sign is 1 or -1, found {shown(found['acceleration_sign'])}")
    try:
        x = parse(found["x"] if _has_unit(found["x"]) else f"{found['x']} m") if "x" in found else None
        if x is not None and x.dimension(vehicle.dimensions) != LENGTH:
            raise ExpressionError("it must be a length")
    except ExpressionError as error:
        raise InputError(f"{where}: x={shortened(found['x'])}: {error}") from error
    distance = quantity(found.get("distance", "0"), LENGTH, f"{where} distance")
    VEHICLE_LENGTH.check(distance, f"{where} distance")
    return PhoneSensor(
        name,
        Place(name, found["body"], x, behind, distance),
        found.get("forward"),
        found.get("up"),
        int(found["acceleration_sign"]) if "acceleration_sign" in found else None,
        quantity(found["from"], TIME, f"{where} from") if "from" in found else -math.inf,
        quantity(found["to"], TIME, f"{where} to") if "to" in found else math.inf,
    )


def _has_unit(text: str) -> bool:
    return re.search(r"[A-Za-z]", text) is not None


def read_hump(text: str) -> RoadOption:
    """Read `SHAPE,length=...,height=...` with the shapes and keys of the run file; numbers without a unit are metres.

    Raises
    ------
    InputError
        For an unknown shape or key, one that is missing, and dimensions that do not fit.
    """
    shape, _, rest = text.partition(",")
    found: dict[str, Any] = dict(split_pairs(rest, "--hump", _HUMP_KEYS)) if rest else {}
    shapes = HumpEntry.model_fields["shape"].annotation.__args__  # type: ignore[union-attr]
    if shape.strip() not in shapes:
        raise InputError(f"--hump: unknown shape {shown(shape.strip())}; {did_you_mean(shape.strip(), shapes)}")
    for key in ("length", "height", "radius"):
        if key in found:
            found[key] = f"{quantity(found[key], LENGTH, f'--hump {key}'):.10g} m"
    if "ramp" in found:
        found["ramp"] = quantity(found["ramp"], NONE, "--hump ramp")
    try:
        entry = HumpEntry.model_validate({"shape": shape.strip(), **found, "at": "0 m"})
    except ValidationError as error:
        raise InputError(f"--hump: {error.errors()[0]['msg']}") from error
    written = {"shape": entry.shape, **found}
    if entry.file is not None:
        points = read_columns(Path(entry.file), (entry.distance, entry.height_column))
        check_hump_points(points)
        return RoadOption("hump", written, hump=Hump.from_points(0.0, *points.values))
    assert entry.length is not None
    assert entry.height is not None
    extra = {key: value for key, value in (("ramp", entry.ramp), ("radius", entry.radius)) if value is not None}
    return RoadOption("hump", written, hump=Hump.from_shape(entry.shape, 0.0, entry.length, entry.height, **extra))


def read_profile(text: str) -> RoadOption:
    """Read `FILE[,distance=COLUMN][,height=COLUMN]`, a measured profile; raises InputError for a file or columns that are not there."""
    file, _, rest = text.partition(",")
    found = split_pairs(rest, "--profile", ("distance", "height")) if rest else {}
    names = found.get("distance", "distance"), found.get("height", "height")
    points = read_columns(Path(file), names)
    points.check_ascending()
    return RoadOption("profile", {"file": file, "distance": names[0], "height": names[1]}, profile=MeasuredProfile(*points.values))
