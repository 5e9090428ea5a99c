"""Logs of GPS receivers (NMEA 0183): `t` since the first fix [s] and `speed` [m/s], of the RMC sentences with a valid fix."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta
from functools import reduce
from pathlib import Path

import numpy as np

from vehgen.errors import InputError, Position, shown
from vehgen.files.reading import read_lines
from vehgen.files.tables.columns import MAX_TABLE_BYTES, TableColumns, plain_float
from vehgen.files.tables.csv_table import MOST_ROWS
from vehgen.files.tables.sheet import Sheet

KNOT = 1852.0 / 3600.0
"""A knot [m/s]."""
_VALID_FIX = "A"
_TIME_FIELD, _STATUS_FIELD, _SPEED_FIELD, _DATE_FIELD = 1, 2, 7, 9
"""Fields of an RMC sentence."""


def read(path: Path, names: tuple[str, ...]) -> TableColumns:
    """Read `t` and `speed` of a log; raises InputError at the line of a damaged RMC sentence, and for fewer than two fixes."""
    times: list[float] = []
    speeds: list[float] = []
    lines: list[int] = []
    for number, line in enumerate(read_lines(path, MAX_TABLE_BYTES, "an NMEA log"), 1):
        text = line.strip()
        if text[:1] != "$" or text[3:7] != "RMC,":
            continue
        fields = _checked(text, Position(path, number, 1)).split(",")
        if len(fields) <= _DATE_FIELD or fields[_STATUS_FIELD] != _VALID_FIX:
            continue
        time, speed = _fix(fields, Position(path, number, 1))
        if times and time <= times[-1]:
            raise InputError("the times of a log must ascend", Position(path, number, 1))
        times.append(time)
        speeds.append(speed)
        lines.append(number)
        if len(lines) > MOST_ROWS:
            raise InputError(f"more than {MOST_ROWS} fixes; cut the log to the pass", Position(path, number, 1))
    if len(lines) < 2:
        raise InputError("a log with at least two valid RMC sentences was expected", Position(path, 1, 1))
    columns = np.array(times) - times[0], np.array(speeds)
    return Sheet(path, ("t", "speed"), ("s", "m/s"), columns.__getitem__, len(lines), np.array(lines, dtype=np.int64)).select(names)


def _checked(text: str, place: Position) -> str:
    """Return a sentence without its check sum; raises InputError where that is wrong."""
    body, star, told = text[1:].partition("*")
    found = reduce(lambda one, other: one ^ other, body.encode("utf-8", "replace"), 0)
    if star and told[:2].upper() != f"{found:02X}":
        raise InputError(f"the check sum of the sentence is {shown(told[:2])}, its text has {found:02X}: the log is damaged", place)
    return body


def _fix(fields: list[str], place: Position) -> tuple[float, float]:
    """Return time [s] and speed [m/s] of a sentence's fields."""
    clock, day = fields[_TIME_FIELD], fields[_DATE_FIELD]
    try:
        whole = datetime.strptime(f"{day} {clock[:6]}", "%d%m%y %H%M%S").replace(tzinfo=UTC)
        time = (whole + timedelta(seconds=plain_float(f"0{clock[6:]}"))).timestamp()
        return time, plain_float(fields[_SPEED_FIELD]) * KNOT
    except (ValueError, OverflowError) as error:
        raise InputError(
            f"date, time and speed were expected, found {shown(day)}, {shown(clock)}, {shown(fields[_SPEED_FIELD])}", place
        ) from error
