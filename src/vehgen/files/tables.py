"""Columns of CSV files by name."""

from __future__ import annotations

from array import array
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from vehgen.errors import InputError, Position, did_you_mean
from vehgen.files.csv_rows import csv_rows
from vehgen.files.reading import read_lines

MAX_TABLE_BYTES = 200_000_000
"""No table is larger [bytes]."""
MAX_TABLE_NUMBERS = 20_000_000
"""So many numbers may be asked of a table at once: 160 MB."""
LARGEST_MEASURED = 1e12
"""Beyond it a number was not measured, in whatever unit."""


def read_columns(path: Path, names: tuple[str, ...]) -> tuple[NDArray[np.float64], ...]:
    """Read columns of a CSV file with a header line; the file is read row by row and never held as text.

    Raises
    ------
    InputError
        For a file that is missing, not regular or too large, a missing or repeated column, and at the line and cell of anything that is
        not a number of at most LARGEST.
    """
    rows = csv_rows(read_lines(path, MAX_TABLE_BYTES, "a CSV file"), path)
    header = [cell.strip() for cell in next(rows, (1, []))[1]]
    columns = [array("d") for _ in names]
    places: list[int] = []
    for line, row in rows:
        places = places or [_place(path, header, name) for name in names]
        for name, place, column in zip(names, places, columns, strict=True):
            try:
                number = float(row[place])
            except (ValueError, IndexError):
                number = np.nan
            if not -LARGEST_MEASURED <= number <= LARGEST_MEASURED:
                raise _wrong(row, name, place, path, line)
            column.append(number)
        if len(columns) * len(columns[0]) > MAX_TABLE_NUMBERS:
            raise InputError(
                f"more than {MAX_TABLE_NUMBERS} numbers in {len(columns)} columns; cut the recording to the pass", Position(path, line, 1)
            )
    if not places:
        raise InputError("a header line and at least one line of numbers were expected", Position(path, 1, 1))
    return tuple(np.array(column) for column in columns)


def _place(path: Path, header: list[str], name: str) -> int:
    if name not in header:
        raise InputError(f"no column {name!r}; {did_you_mean(name, header)}", Position(path, 1, 1))
    place = header.index(name)
    if header.count(name) > 1:
        second = header.index(name, place + 1)
        raise InputError(f"two columns are named {name!r}; each needs a name of its own", Position(path, 1, second + 1))
    return place


def _wrong(row: list[str], name: str, place: int, path: Path, line: int) -> InputError:
    text = row[place].strip() if place < len(row) else ""
    position = Position(path, line, min(place, max(len(row) - 1, 0)) + 1)
    try:
        finite = np.isfinite(float(text))
    except ValueError:
        finite = False
    reason = f"beyond {LARGEST_MEASURED:g}, which nothing measures" if finite else "not a finite number"
    return InputError(f"{text[:40]!r} in column {name!r} is {reason}", position)
