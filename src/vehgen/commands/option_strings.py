"""Options that hold more than one value: `L1:body=tractor,behind=axle1,distance=-0.29`, `half_sine,length=0.5,height=0.03`."""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from vehgen.errors import InputError, did_you_mean, shortened, shown
from vehgen.files.expressions import ExpressionError, parse
from vehgen.files.limits import VEHICLE_LENGTH
from vehgen.files.names import is_identifier
from vehgen.files.tables import read_columns
from vehgen.files.units import LENGTH, NONE, TIME, Dimension
from vehgen.mechanics import Place
from vehgen.phones.csv_table import ColumnMap
from vehgen.phones.options import PhoneSensor, RoadOption
from vehgen.road import Hump, MeasuredProfile
from vehgen.simulate.run_file.entries import HumpEntry
from vehgen.simulate.scenario import check_hump_points
from vehgen.vehicle import Vehicle

_SENSOR_KEYS = ("body", "x", "behind", "distance", "forward", "up", "acceleration_sign", "from", "to")
_HUMP_KEYS = ("length", "height", "ramp", "radius", "file", "distance", "height_column")


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


def read_column_map(text: str) -> ColumnMap:
    """Read `time=t,time_unit=ms,acceleration=az,pitch_rate=-gy,...`, the keys being those of ColumnMap.

    Raises
    ------
    InputError
        For an unknown, repeated or missing key.
    """
    found = split_pairs(text, "--columns", tuple(ColumnMap.__dataclass_fields__))
    for key in ("time", "acceleration"):
        if key not in found:
            raise InputError(f"--columns lacks {key}=COLUMN; expected e.g. time=t,acceleration=az,pitch_rate=q")
    return ColumnMap(**found)


def split_pairs(text: str, option: str, known: tuple[str, ...]) -> dict[str, str]:
    """Split `key=value,key=value` of a command-line option; raises InputError for what is not such a pair, unknown or repeated."""
    found: dict[str, str] = {}
    for part in text.split(","):
        key, sign, value = (item.strip() for item in part.partition("="))
        if not sign or not value:
            raise InputError(f"{option}: expected key=value pairs joined by commas, found {shown(part)}")
        if key not in known:
            raise InputError(f"{option}: unknown key {shown(key)}; {did_you_mean(key, known)}")
        if key in found:
            raise InputError(f"{option}: {key} is given twice")
        found[key] = value
    return found
