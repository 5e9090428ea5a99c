"""An import in one call: phone exports of one pass in, channels on one clock out, and a run file with its recording."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from vehgen.errors import ArgumentError, did_you_mean, shown
from vehgen.files.limits import FOOTPRINT, ROAD_POSITION, SPEED_LIMIT
from vehgen.files.units import SPEED
from vehgen.phones.csv_table import ColumnMap, ColumnMaps
from vehgen.phones.importing import read_pass, with_forward
from vehgen.phones.plan import PhoneSensor, Plan, RoadOption, check_limit, hump_road, number_of, profile_road
from vehgen.phones.result import PhoneImport, summarise_import
from vehgen.phones.run_text import import_files, write_import
from vehgen.vehicle import Vehicle, VehicleLike, as_vehicle

BY_AXLES = "axles"
"""The speed that the axles' marks fit best."""


def import_phones(
    exports: Sequence[str | os.PathLike[str]],
    *,
    vehicle: VehicleLike,
    sensors: Sequence[PhoneSensor],
    hump: Mapping[str, Any] | None = None,
    profile: Mapping[str, str] | str | os.PathLike[str] | None = None,
    out: str | os.PathLike[str] | None = None,
    parameter_set: str | None = None,
    speed: float | str | None = None,
    forward: str | None = None,
    lead: float | None = None,
    footprint: float = 0.0,
    rate: float = 100.0,
    top: float = 25.0,
    columns: ColumnMap | Mapping[str, str] | Sequence[ColumnMap | Mapping[str, str]] | None = None,
) -> PhoneImport:
    """Turn phone exports of one pass into channels on one even clock, and into a run file with its recording.

    Parameters
    ----------
    exports
        Files of phyphox, Sensor Logger, MATLAB Mobile, or CSV files: one a phone.
    vehicle
        What the phones lay in: itself, its file, or the name of a bundled model.
    sensors
        Where each phone lay, in the exports' order.
    hump
        The hump that was crossed, with the keys of a run file: `{"shape": "half_sine", "length": 0.5, "height": 0.03}` [m].
    profile
        Instead of a hump a measured road: a table, or `{"file": ..., "distance": ..., "height": ...}` with its columns and units.
    out
        The run file to write, its recording beside it (default: nothing is written).
    parameter_set
        One of the vehicle's sets.
    speed
        Of the pass [m/s] (default: the median of the GPS), or `axles`: by when the axles crossed.
    forward
        The phones' axis that pointed forward, where a sensor does not say: x, y (top edge), z, -x, -y or -z.
    lead
        From the front wheel at t = 0 to the hump [m] (default: 3 s of driving).
    footprint
        Length of the tyres' contact [m]; 0 is a point.
    rate, top
        Rate of the recording [Hz]; top of the band that matters [Hz]: phones need twice that.
    columns
        Which columns of plain CSV files hold what: of all, or a list, of each export.

    Raises
    ------
    InputError
        For arguments and exports that cannot be used; it says what would help.
    """
    own = as_vehicle(vehicle)
    if isinstance(speed, str) and speed.isalpha() and speed != BY_AXLES:
        raise ArgumentError(f"`speed`: expected a number in m/s or {BY_AXLES!r}, found {shown(speed)}", "speed")
    number = None if speed is None or speed == BY_AXLES else number_of(speed, SPEED, "`speed`", "speed")
    for name, value, limit in (("speed", number, SPEED_LIMIT), ("lead", lead, ROAD_POSITION), ("footprint", footprint, FOOTPRINT)):
        if value is not None and not (value > 0 or (value == 0 and name == "footprint")):
            raise ArgumentError(f"`{name}` must be a positive number, found {value}", name)
        check_limit(limit, value or 0.0, f"`{name}`", name)
    plan = Plan(
        own,
        _road(hump, profile),
        _sensors(sensors, own, forward),
        parameter_set,
        number,
        speed == BY_AXLES,
        lead,
        rate,
        top,
        footprint=footprint,
        columns=_columns(columns),
    )
    if out is None:
        return summarise_import(read_pass(exports, plan))
    import_files(Path(out))
    if isinstance(vehicle, Vehicle) and not vehicle.files:
        raise ArgumentError(f"`vehicle`: {vehicle.name} was not read from a file, which the run file could name", "vehicle")
    imported = read_pass(exports, plan)
    written = write_import(imported, vehicle, Path(out))
    return summarise_import(imported, tuple(str(path) for path in written))


def _road(hump: Mapping[str, Any] | None, profile: Mapping[str, str] | str | os.PathLike[str] | None) -> RoadOption:
    if hump is not None and profile is not None:
        raise ArgumentError("either `hump` or `profile` was expected, found both", "hump", "profile")
    if hump is None and profile is None:
        raise ArgumentError(
            "a run needs a road: `hump` or `profile` was expected, neither was found. A drive over a rough road that nobody measured is "
            "for `vehgen transmissibility`, which compares two phones at two places with each other; to calibrate, record one pass over a "
            "known hump",
            "hump",
            "profile",
        )
    if hump is not None:
        return hump_road(hump)
    assert profile is not None
    return profile_road(profile if isinstance(profile, Mapping) else {"file": os.fspath(profile)})


def _sensors(sensors: Sequence[PhoneSensor], vehicle: Vehicle, forward: str | None) -> tuple[PhoneSensor, ...]:
    for sensor in sensors:
        if not isinstance(sensor, PhoneSensor):
            raise ArgumentError(f"`sensors`: a list of PhoneSensor was expected, found {type(sensor).__name__}", "sensors")
        sensor.check(vehicle)
    return with_forward(sensors, forward)


def _columns(columns: ColumnMap | Mapping[str, str] | Sequence[ColumnMap | Mapping[str, str]] | None) -> ColumnMaps:
    if columns is None or isinstance(columns, ColumnMap | Mapping):
        return None if columns is None else _column_map(columns)
    return [_column_map(each) for each in columns]


def _column_map(columns: ColumnMap | Mapping[str, str]) -> ColumnMap:
    if isinstance(columns, ColumnMap):
        return columns
    known = tuple(ColumnMap.__dataclass_fields__)
    for key in columns:
        if key not in known:
            raise ArgumentError(f"`columns`: unknown key {shown(key)}; {did_you_mean(key, known)}", "columns")
    for key in ("time", "acceleration"):
        if key not in columns:
            raise ArgumentError(f"`columns` lacks the key {key}", "columns")
    return ColumnMap(**columns)
