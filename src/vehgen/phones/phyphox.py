"""Exports of phyphox (phyphox.org): zip, folder or workbook, one experiment's `Raw Data.csv` or a file or sheet a sensor.

The app translates its headers, so columns are recognised by their units: `Time (s)`, then `... x (m/s^2)`, `... x (rad/s)`, `... (m/s)`.
On iOS, too, phyphox writes accelerations as Android does: flat and face up, z reads +9.8 m/s^2.
"""

from __future__ import annotations

import re

import numpy as np

from vehgen.errors import InputError
from vehgen.files.units import STANDARD_GRAVITY
from vehgen.phones.csv_table import Table
from vehgen.phones.export import (
    ACCELERATION_STREAM,
    LINEAR_ACCELERATION_STREAM,
    ROTATION_STREAM,
    SPEED_STREAM,
    EpochMap,
    PhoneExport,
    Stream,
    acceleration_kind,
)

_COLUMN_HEAD = re.compile(r"(?P<words>.*?)\s*\((?P<unit>[^()]*)\)\s*\Z")
_AXIS = re.compile(r"(?:.*\s)?([xyz])\Z", re.IGNORECASE)
_PHYPHOX_UNITS = {
    "m/s^2": ("m/s^2", 1.0),
    "m/s²": ("m/s^2", 1.0),
    "g": ("m/s^2", STANDARD_GRAVITY),
    "rad/s": ("rad/s", 1.0),
    "°/s": ("rad/s", np.pi / 180),
    "deg/s": ("rad/s", np.pi / 180),
    "m/s": ("m/s", 1.0),
    "°": ("deg", 1.0),
}
"""What columns are read in, and by which factor; experiments of users' own write more units than the app's."""
_DEVICE, _ACCELEROMETER = ("property", "value"), "accelerometer name"
_EVENTS = ("event", "experiment time", "system time")


def is_phyphox(table: Table) -> bool:
    """Say whether a header is one that phyphox writes: of its clock, of the device, or columns with units, the first a time."""
    return (
        _is_clock(table)
        or _is_device(table)
        or (
            len(table.header) > 1
            and (first := _COLUMN_HEAD.match(table.header[0])) is not None
            and first["unit"] == "s"
            and all(_COLUMN_HEAD.match(item) for item in table.header)
        )
    )


def read_phyphox(tables: list[Table]) -> PhoneExport:
    """Read the tables of a phyphox export.

    Raises
    ------
    InputError
        Without acceleration, and for what is not a number.
    """
    streams: dict[str, Stream] = {}
    notes: list[str] = []
    epoch = chip = None
    for table in tables:
        if _is_clock(table):
            epoch = _read_clock(table, notes)
        elif _is_device(table):
            chip = dict(zip((item.lower() for item in table.text(0)), table.text(1), strict=True)).get(_ACCELEROMETER)
        elif is_phyphox(table):
            for name, stream in _read_sensors(table):
                if name in streams:
                    notes.append(f"{table.name}: a second {name.replace('_', ' ')} was passed over")
                else:
                    streams[name] = stream
    if not {ACCELERATION_STREAM, LINEAR_ACCELERATION_STREAM} & set(streams):
        raise InputError(f"{tables[0].name}: this phyphox export holds no acceleration; record with the experiment 'Acceleration (with g)'")
    return PhoneExport("phyphox", streams, epoch, tuple(notes), acceleration_sign=1, accelerometer=chip)


def _is_clock(table: Table) -> bool:
    return tuple(item.lower() for item in table.header[:3]) == _EVENTS


def _is_device(table: Table) -> bool:
    return tuple(item.lower() for item in table.header) == _DEVICE


def _read_clock(table: Table, notes: list[str]) -> EpochMap | None:
    events, (moments, epochs) = table.text(0), table.columns(1, 2).T
    starts = [i for i, event in enumerate(events) if event.upper() == "START" and np.isfinite([moments[i], epochs[i]]).all()]
    if not starts or (np.diff(moments[starts]) < 0).any():
        notes.append(f"{table.name} has no usable START row; the clock of this phone is unknown")
        return None
    if len(starts) > 1:
        notes.append(f"recording was paused {len(starts) - 1} times")
    return EpochMap(moments[starts], epochs[starts])


def _read_sensors(table: Table) -> list[tuple[str, Stream]]:
    heads = [_COLUMN_HEAD.match(item) for item in table.header]
    units, factors = zip(*(_PHYPHOX_UNITS.get(head["unit"] if head else "", ("", 1.0)) for head in heads), strict=True)
    found = []
    for unit in ("m/s^2", "rad/s"):
        axes: dict[str, int] = {}
        for i, head in enumerate(heads):
            axis = _AXIS.match(head["words"]) if head and units[i] == unit else None
            if axis:
                axes.setdefault(axis[1].lower(), i)
        if len(axes) == 3:
            numbers = table.columns(0, *(axes[axis] for axis in "xyz"))
            values = numbers[:, 1:] * [factors[axes[axis]] for axis in "xyz"]
            try:
                name = acceleration_kind(values) if unit == "m/s^2" else ROTATION_STREAM
            except InputError as error:
                raise InputError(f"{table.name}: {error.message}") from error
            found.append((name, Stream(numbers[:, 0], values, ("x", "y", "z"), unit)))
    if "m/s" in units and units.count("deg") >= 2:
        numbers = table.columns(0, units.index("m/s"))
        found.append((SPEED_STREAM, Stream(numbers[:, 0], numbers[:, 1:], ("speed",), "m/s")))
    return found
