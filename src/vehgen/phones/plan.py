"""What a person says about a pass: the vehicle, where its phones lay, which hump or road, how fast."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, get_args

from pydantic import ValidationError

from vehgen.errors import ArgumentError, did_you_mean, shown
from vehgen.files.expressions import Expression, ExpressionError, parse
from vehgen.files.limits import VEHICLE_LENGTH, Limit
from vehgen.files.names import is_identifier
from vehgen.files.units import LENGTH, NONE, Dimension
from vehgen.mechanics import Place, PointOutput
from vehgen.phones.csv_table import ColumnMaps
from vehgen.road import Hump, MeasuredProfile, Profile
from vehgen.simulate.measured_tables import hump_table, profile_table
from vehgen.simulate.run_file.entries import HumpEntry, ProfileEntry
from vehgen.vehicle import Vehicle

HUMP_KEYS = ("shape", "length", "height", "ramp", "radius", "file", "distance", "height_column", "distance_unit", "unit")
PROFILE_KEYS = ("file", "distance", "height", "distance_unit", "unit", "start", "end")


@dataclass(frozen=True)
class PhoneSensor:
    """Where a phone lay, which of its axes point forward and up, and its accelerations' sign where it must be told.

    On a `body`: `x` ahead of its COG (a number [m], or a length with symbols of the vehicle), or `distance` [m] behind an axle, hinge or
    body named `behind`. `forward` and `up` are axes of the phone: x, y (top edge), z, -x, -y or -z. `start` and `end` [s] on the phone's
    own clock cut its recording.
    """

    name: str
    body: str
    x: float | str | None = None
    behind: str | None = None
    distance: float = 0.0
    forward: str | None = None
    up: str | None = None
    acceleration_sign: int | None = None
    start: float = -math.inf
    end: float = math.inf

    @cached_property
    def place(self) -> Place:
        """The place as in a run file.

        Raises
        ------
        InputError
            For an `x` that is no length.
        """
        return Place(self.name, self.body, None if self.x is None else self._length(self.x), self.behind, self.distance)

    def _length(self, x: float | str) -> Expression:
        text = str(x)
        try:
            return parse(text if re.search(r"[A-Za-z]", text) else f"{text} m")
        except ExpressionError as error:
            raise ArgumentError(f"`sensors` {self.name}: x={text}: {error}", "sensors") from error

    def check(self, vehicle: Vehicle) -> None:
        """Check the place against the vehicle that it is on.

        Raises
        ------
        InputError
            For names that the vehicle lacks, with the nearest that it has, and what does not fit together.
        """
        where = f"`sensors` {self.name}"
        if not is_identifier(self.name):
            raise ArgumentError(
                f"`sensors`: {shown(self.name)} cannot name a sensor; a letter, then letters and digits were expected", "sensors"
            )
        if self.body not in vehicle.bodies:
            raise ArgumentError(f"{where}: {vehicle.name} has no body {self.body!r}; {did_you_mean(self.body, vehicle.bodies)}", "sensors")
        known = {**vehicle.axles, **vehicle.hinges, **vehicle.bodies}
        if self.behind is not None and self.behind not in known:
            near = did_you_mean(self.behind, known)
            raise ArgumentError(f"{where}: {vehicle.name} has nothing named {self.behind!r} to be behind of; {near}", "sensors")
        if self.behind is not None and self.x is not None:
            raise ArgumentError(f"{where}: a place has x=, or behind= with distance=, not both", "sensors")
        if self.distance and self.behind is None:
            raise ArgumentError(f"{where}: distance= needs behind=", "sensors")
        if self.acceleration_sign not in (None, 1, -1):
            raise ArgumentError(f"{where}: acceleration_sign is 1 or -1, found {self.acceleration_sign!r}", "sensors")
        check_limit(VEHICLE_LENGTH, self.distance, f"{where} distance", "sensors")
        if self.place.x is not None:
            try:
                if self.place.x.dimension(vehicle.dimensions) != LENGTH:
                    raise ExpressionError("it must be a length")
            except ExpressionError as error:
                raise ArgumentError(f"{where}: x={self.x}: {error}", "sensors") from error

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
    columns: ColumnMaps = None


def number_of(value: float | str, dimension: Dimension, where: str, argument: str) -> float:
    """Return a number in SI units, from itself or a text in which a unit may stand with it; `argument` stands in `where`.

    Raises
    ------
    InputError
        For a text that is none, and a number that is not finite.
    """
    try:
        expression = parse(str(value))
        if expression.names:
            raise ExpressionError(f"found a symbol in {value!r}")
        found, number = expression.dimension({}), expression.evaluate({})
    except ExpressionError as error:
        raise ArgumentError(f"{where}: expected a number in {dimension}; {error}", argument) from error
    if found not in (dimension, NONE) or not math.isfinite(number):
        raise ArgumentError(f"{where}: expected a finite number in {dimension}, found {value!r}", argument)
    return number


def check_limit(limit: Limit, number: float, where: str, argument: str) -> None:
    """Raise ArgumentError for a number outside its limits; `argument` stands in `where`."""
    if (reason := limit.refusal(number)) is not None:
        raise ArgumentError(f"{where}: {reason}", argument)


def hump_road(hump: Mapping[str, Any]) -> RoadOption:
    """Return a hump from the keys of a run file (all but `at`); numbers without a unit are metres.

    Raises
    ------
    InputError
        For an unknown shape or key, one that is missing, and dimensions that do not fit.
    """
    found = _known_keys(hump, "hump", HUMP_KEYS)
    shape = found.pop("shape", "")
    shapes = get_args(HumpEntry.model_fields["shape"].annotation)
    if shape not in shapes:
        raise ArgumentError(f"`hump`: unknown shape {shown(shape)}; {did_you_mean(str(shape), shapes)}", "hump")
    for key in ("length", "height", "radius"):
        if key in found:
            found[key] = f"{number_of(found[key], LENGTH, f'`hump` {key}', 'hump'):.10g} m"
    if "ramp" in found:
        found["ramp"] = number_of(found["ramp"], NONE, "`hump` ramp", "hump")
    try:
        entry = HumpEntry.model_validate({"shape": shape, **found, "at": "0 m"})
    except ValidationError as error:
        raise ArgumentError(f"`hump`: {error.errors()[0]['msg']}", "hump") from error
    written = {"shape": entry.shape, **found}
    if entry.file is not None:
        points = hump_table(Path(entry.file), entry)
        return RoadOption("hump", written, hump=Hump.from_points(0.0, *points.values))
    assert entry.length is not None
    assert entry.height is not None
    extra = {key: value for key, value in (("ramp", entry.ramp), ("radius", entry.radius)) if value is not None}
    return RoadOption("hump", written, hump=Hump.from_shape(entry.shape, 0.0, entry.length, entry.height, **extra))


def profile_road(profile: Mapping[str, str]) -> RoadOption:
    """Return a measured profile from the keys of a run file; raises InputError for a file or columns that are not there."""
    found = {"distance": "distance", "height": "height", **_known_keys(profile, "profile", PROFILE_KEYS)}
    if "file" not in found:
        raise ArgumentError("`profile` lacks the key file, a table with columns of distance and height", "profile")
    try:
        points = profile_table(Path(found["file"]), ProfileEntry.model_validate(found))
    except ValidationError as error:
        raise ArgumentError(f"`profile`: {error.errors()[0]['msg']}", "profile") from error
    entry = {key: found[key] for key in PROFILE_KEYS if key in found}
    return RoadOption("profile", entry, profile=MeasuredProfile(*points.values).met_from(0.0))


def _known_keys(data: Mapping[str, Any], argument: str, known: tuple[str, ...]) -> dict[str, Any]:
    """Return a mapping's items; raises ArgumentError for what is no mapping, or has other keys."""
    if not isinstance(data, Mapping):
        raise ArgumentError(f"`{argument}`: the keys of a run file were expected, e.g. {known[0]}, found {shown(data)}", argument)
    for key in data:
        if key not in known:
            raise ArgumentError(f"`{argument}`: unknown key {shown(key)}; {did_you_mean(str(key), known)}", argument)
    return dict(data)
