"""Tables that run files name, in SI units: speeds, profiles, humps, forces and displacements, each a pair of columns."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from vehgen.errors import InputError, Position
from vehgen.files.limits import DISPLACEMENT, FORCE_LIMIT, HUMP_HEIGHT, HUMP_LENGTH, PROFILE_HEIGHT, SPEED_LIMIT
from vehgen.files.tables import TableColumns, read_columns
from vehgen.simulate.run_file.entries import DisplacementEntry, ForceEntry, HumpEntry, ProfileEntry, SpeedFile

Finder = Callable[[str], Position | None]
"""Where an entry's key stands."""


@dataclass(frozen=True)
class _Column:
    """A column that an entry names: its heading, what it holds and in which SI unit, the key of the entry that states another, and that."""

    name: str
    quantity: str
    usual: str
    key: str
    unit: str | None


def nowhere(key: str) -> None:
    """Say that an entry's key stands in no file."""


def speed_table(path: Path, entry: SpeedFile, find: Finder = nowhere) -> TableColumns:
    """Return times from the run's begin [s] and speeds [m/s]; raises InputError at the row of a standstill, and outside of limits."""
    time, speed = _Column(entry.time, "time", "s", "time_unit", entry.time_unit), _Column(entry.speed, "speed", "m/s", "unit", entry.unit)
    found = _pair(path, time, speed, find)
    found.check_ascending()
    found = _cut(found, entry, "s", find)
    if (stands := np.flatnonzero(found.values[1] <= 0)).size:
        cut = "; `start` and `end` of the entry cut a track to the pass"
        raise InputError(f"every speed of a history must be above 0{cut}", found.place(int(stands[0]), 1))
    found.check_limit(1, SPEED_LIMIT)
    return found


def profile_table(path: Path, entry: ProfileEntry, find: Finder = nowhere) -> TableColumns:
    """Return distances from where the run begins and heights of a measured profile [m]."""
    found = _pair(path, *_road_columns(entry.distance, entry.distance_unit, entry.height, entry.unit), find)
    found.check_ascending()
    found = _cut(found, entry, "m", find)
    found.check_limit(1, PROFILE_HEIGHT)
    return found


def hump_table(path: Path, entry: HumpEntry, find: Finder = nowhere) -> TableColumns:
    """Return distances and heights of a hump's points [m]; raises InputError at the row that is wrong."""
    points = _pair(path, *_road_columns(entry.distance, entry.distance_unit, entry.height_column, entry.unit), find)
    points.check_ascending()
    points.check_limit(1, HUMP_HEIGHT)
    length = float(np.ptp(points.values[0]))
    if (reason := HUMP_LENGTH.refusal(length)) is not None:
        raise InputError(reason, points.place(-1))
    return points


def input_table(path: Path, entry: ForceEntry | DisplacementEntry, find: Finder = nowhere) -> TableColumns:
    """Return times [s] and a measured force [N] or displacement [m]."""
    if isinstance(entry, ForceEntry):
        value = _Column(entry.force, "force", "N", "unit", entry.unit)
    else:
        value = _Column(entry.displacement, "displacement", "m", "unit", entry.unit)
    time = _Column(entry.time, "time", "s", "time_unit", entry.time_unit)
    found = _pair(path, time, value, find)
    found.check_ascending(least=1)
    found.check_limit(1, FORCE_LIMIT if isinstance(entry, ForceEntry) else DISPLACEMENT)
    return found


def _cut(found: TableColumns, entry: SpeedFile | ProfileEntry, unit: str, find: Finder) -> TableColumns:
    """Return the rows that an entry's `start` and `end` enclose, those about them included; the first column counts from `start`."""
    if entry.start is None and entry.end is None:
        return found
    column = found.values[0]
    first, last = column[[0, -1]]
    start, end = first if entry.start is None else entry.start, last if entry.end is None else entry.end
    if not first <= start < end <= last:
        key = "start" if entry.start is not None else "end"
        raise InputError(f"`start` and `end` must lie within {first:g} {unit} to {last:g} {unit} of the file, the start first", find(key))
    kept = found.between(column[column <= start][-1], column[column >= end][0])
    return kept if entry.start is None else replace(kept, values=(kept.values[0] - start, *kept.values[1:]))


def _road_columns(distance: str, distance_unit: str | None, height: str, unit: str | None) -> tuple[_Column, _Column]:
    return _Column(distance, "distance", "m", "distance_unit", distance_unit), _Column(height, "height", "m", "unit", unit)


def _pair(path: Path, first: _Column, second: _Column, find: Finder) -> TableColumns:
    """Return two columns of a table in SI units."""
    found = read_columns(path, (first.name, second.name))
    for number, column in enumerate((first, second)):
        found = found.in_si(number, column.usual, column.quantity, column.unit, find(column.key) if column.unit else None)
    return found
