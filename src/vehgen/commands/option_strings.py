"""Values of options that hold several things: `L1:body=tractor,behind=axle1,distance=-0.29`, `half_sine,length=0.5`, `0.3,40`."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING, Any

from vehgen.errors import InputError, did_you_mean, shortened, shown

if TYPE_CHECKING:
    from vehgen.phones import ColumnMap, PhoneSensor

PLACE_KEYS = ("body", "x", "behind", "distance")
_SENSOR_KEYS = (*PLACE_KEYS, "forward", "up", "acceleration_sign", "from", "to")


def split_list(text: str | None) -> tuple[str, ...]:
    """Split `A,B,C`; nothing for None and for blanks."""
    return tuple(part.strip() for part in text.split(",") if part.strip()) if text else ()


def split_pairs(text: str, option: str, known: tuple[str, ...]) -> dict[str, str]:
    """Split `key=value,key=value`; raises InputError for what is not such a pair, unknown or repeated."""
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


def read_speed(text: str) -> float:
    """Return a speed [m/s] from a number or a quantity such as `36 km/h`; raises InputError for what is neither."""
    from vehgen.files.units import SPEED
    from vehgen.phones.plan import number_of

    return number_of(text, SPEED, "--speed", "speed")


def read_sensor(text: str, *, needs_body: bool = True, option: str = "--sensor", keys: tuple[str, ...] = _SENSOR_KEYS) -> PhoneSensor:
    """Read `NAME:body=...,behind=...,distance=...[,forward=y][,up=z][,acceleration_sign=-1][,from=SECONDS][,to=SECONDS]`.

    Without `needs_body` the place may be left out, as where no vehicle is told; the body is then called "". Errors name `option`; it
    knows `keys`.

    Raises
    ------
    InputError
        For a malformed text.
    """
    from vehgen.files.names import is_identifier
    from vehgen.files.units import LENGTH, TIME
    from vehgen.phones.plan import PhoneSensor, number_of

    name, colon, rest = text.partition(":")
    name, where = name.strip(), f"{option} {shortened(name.strip())}"
    if not colon or not is_identifier(name):
        raise InputError(f"{option}: expected NAME:body=BODY,behind=AXLE,distance=METRES, found {shown(text)}")
    found = split_pairs(rest, where, keys)
    if needs_body and "body" not in found:
        raise InputError(f"{where} lacks body=, the body that it is on")
    if "distance" in found and "behind" not in found:
        raise InputError(f"{where}: distance= needs behind=")
    if "acceleration_sign" in found and found["acceleration_sign"] not in ("1", "+1", "-1"):
        raise InputError(f"{where}: acceleration_sign is 1 or -1, found {shown(found['acceleration_sign'])}")
    return PhoneSensor(
        name,
        found.get("body", ""),
        found.get("x"),
        found.get("behind"),
        number_of(found.get("distance", "0"), LENGTH, f"{where} distance", "sensors"),
        found.get("forward"),
        found.get("up"),
        int(found["acceleration_sign"]) if "acceleration_sign" in found else None,
        number_of(found["from"], TIME, f"{where} from", "sensors") if "from" in found else -math.inf,
        number_of(found["to"], TIME, f"{where} to", "sensors") if "to" in found else math.inf,
    )


def read_hump(text: str) -> dict[str, Any]:
    """Read `SHAPE,length=...,height=...` with the shapes and keys of the run file; raises InputError for a malformed text."""
    from vehgen.phones.plan import HUMP_KEYS

    shape, _, rest = text.partition(",")
    return {"shape": shape.strip(), **(split_pairs(rest, "--hump", HUMP_KEYS[1:]) if rest else {})}


def read_profile(text: str) -> dict[str, str]:
    """Read `FILE[,distance=COLUMN][,height=COLUMN][,unit=UNIT]`, a measured profile; raises InputError for a malformed text."""
    from vehgen.phones.plan import PROFILE_KEYS

    file, _, rest = text.partition(",")
    return {"file": file, **(split_pairs(rest, "--profile", PROFILE_KEYS[1:]) if rest else {})}


def read_column_map(text: str) -> ColumnMap:
    """Read `time=t,time_unit=ms,acceleration=az,pitch_rate=-gy,...`, the keys being those of ColumnMap.

    Raises
    ------
    InputError
        For an unknown, repeated or missing key.
    """
    from vehgen.phones.csv_table import ColumnMap

    found = split_pairs(text, "--columns", tuple(ColumnMap.__dataclass_fields__))
    for key in ("time", "acceleration"):
        if key not in found:
            raise InputError(f"--columns lacks {key}=COLUMN; expected e.g. time=t,acceleration=az,pitch_rate=q")
    return ColumnMap(**found)


def read_band(text: str) -> tuple[float, float]:
    """Read `LOW,HIGH` [Hz]; raises InputError for what are not two numbers."""
    try:
        low, high = (float(part) for part in text.split(","))
    except ValueError:
        raise InputError(f"--band wants two frequencies in Hz, e.g. 0.3,40; found {shown(text)}") from None
    return low, high


def read_bands(text: str) -> tuple[tuple[float, float], ...]:
    """Read `A,B,C`, the edges of bands [Hz]; raises InputError for what are not numbers."""
    try:
        edges = [float(part) for part in text.split(",")]
    except ValueError:
        raise InputError(f"--bands wants frequencies in Hz, e.g. 2,5,8,12; found {shown(text)}") from None
    return tuple(pairwise(edges))
