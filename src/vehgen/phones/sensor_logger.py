"""Exports of Sensor Logger (tszheichoi.com/sensorlogger): zip or folder, a file a sensor.

The files of all sensors have one header, `time,seconds_elapsed,z,y,x` (z first), with `time` in ns since 1970; only the file's name says
which sensor it is of. `Accelerometer` is without gravity, `TotalAcceleration` with. iPhones read accelerations the other way round unless
"Standardise Units & Frames" was on; `Metadata.csv` tells (github.com/tszheichoi/awesome-sensor-logger, COORDINATES.md).
"""

from __future__ import annotations

from pathlib import PurePosixPath

import numpy as np

from vehgen.errors import InputError
from vehgen.phones.csv_table import Table
from vehgen.phones.export import (
    ACCELERATION_STREAM,
    GRAVITY_STREAM,
    LINEAR_ACCELERATION_STREAM,
    ROTATION_STREAM,
    SPEED_STREAM,
    EpochMap,
    PhoneExport,
    Stream,
)

_SENSORS = {
    "accelerometer": (LINEAR_ACCELERATION_STREAM, "m/s^2"),
    "totalacceleration": (ACCELERATION_STREAM, "m/s^2"),
    "gravity": (GRAVITY_STREAM, "m/s^2"),
    "gyroscope": (ROTATION_STREAM, "rad/s"),
}
_FIRST_EPOCH, _LAST_EPOCH = 1e9, 5e9


def is_sensor_logger(table: Table) -> bool:
    """Say whether a header is one that Sensor Logger writes."""
    return {"time", "seconds_elapsed"} <= set(table.header) or {"platform", "standardisation"} <= set(table.header)


def read_sensor_logger(tables: list[Table]) -> PhoneExport:
    """Read the tables of a Sensor Logger export.

    Raises
    ------
    InputError
        Without acceleration, and for what is not a number.
    """
    streams: dict[str, Stream] = {}
    notes: list[str] = []
    epoch = sign = None
    for table in tables:
        if {"platform", "standardisation"} <= set(table.header):
            sign = _sign(table, notes)
        if not {"time", "seconds_elapsed"} <= set(table.header):
            continue
        stem = PurePosixPath(table.file).stem.lower()
        elapsed = table.column(table.find("seconds_elapsed"))
        if stem in _SENSORS and {"x", "y", "z"} <= set(table.header):
            name, unit = _SENSORS[stem]
            values = table.columns(*(table.find(axis) for axis in "xyz"))
            streams[name] = Stream(elapsed, values, ("x", "y", "z"), unit)
            epoch = epoch or _epoch(table, elapsed)
        elif "speed" in table.header:
            streams[SPEED_STREAM] = Stream(elapsed, table.column(table.find("speed"))[:, None], ("speed",), "m/s")
    if not {ACCELERATION_STREAM, LINEAR_ACCELERATION_STREAM} & set(streams):
        raise InputError(
            f"{tables[0].name}: this Sensor Logger export holds neither TotalAcceleration.csv nor Accelerometer.csv (the names say which "
            "sensor a file is of)"
        )
    return PhoneExport("Sensor Logger", streams, epoch, tuple(notes), acceleration_sign=sign)


def _epoch(table: Table, elapsed: np.ndarray) -> EpochMap | None:
    stamps = table.column(table.find("time")) * 1e-9
    both = np.flatnonzero(np.isfinite(stamps) & np.isfinite(elapsed))
    if not len(both) or not _FIRST_EPOCH < stamps[both[0]] < _LAST_EPOCH:
        return None
    return EpochMap(elapsed[both[:1]], stamps[both[:1]])


def _sign(table: Table, notes: list[str]) -> int | None:
    platform = (table.text(table.find("platform")) or [""])[0].lower()
    standardised = (table.text(table.find("standardisation")) or [""])[0].lower()
    if platform == "android" or (platform == "ios" and standardised in ("true", "1", "yes", "on")):
        return 1
    if platform == "ios" and standardised in ("false", "0", "no", "off"):
        notes.append("recorded on iOS without 'Standardise Units & Frames': the sign of the acceleration was reversed")
        return -1
    return None
