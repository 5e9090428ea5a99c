"""Columns of CSV files by name, with the place of every number, so that what is wrong with one can be said where it stands."""

from __future__ import annotations

from array import array
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from vehgen.errors import InputError, Position, did_you_mean, shown
from vehgen.files.csv_rows import csv_rows
from vehgen.files.limits import Limit
from vehgen.files.reading import read_lines

MAX_TABLE_BYTES = 200_000_000
"""No table is larger [bytes]."""
MAX_TABLE_NUMBERS = 20_000_000
"""So many numbers may be asked of a table at once: 160 MB."""
LARGEST_MEASURED = 1e12
"""Beyond it a number was not measured, in whatever unit."""


@dataclass(frozen=True)
class TableColumns:
    """Columns of a table: `values`, one `shape (n_rows,)` each, and where they stand.

    `cells` are the numbers of their cells in a row, `lines shape (n_rows,)` the file's lines; both count from 1.
    """

    path: Path
    names: tuple[str, ...]
    values: tuple[NDArray[np.float64], ...]
    cells: tuple[int, ...]
    lines: NDArray[np.int64]

    def place(self, row: int, column: int = 0) -> Position:
        """Return the place of a number: `row` counts from 0, negative ones from the end; `column` is its index in `names`."""
        return Position(self.path, int(self.lines[row]), self.cells[column])

    def heading(self, column: int) -> Position:
        """Return the place of a column's heading."""
        return Position(self.path, 1, self.cells[column])

    def check_ascending(self, least: int = 2) -> None:
        """Raise InputError where the numbers of the first column do not ascend, and for fewer than `least` rows."""
        first = self.values[0]
        stuck = np.flatnonzero(~(np.diff(first) > 0))
        if len(stuck):
            row = int(stuck[0]) + 1
            raise InputError(f"{shown(self.names[0])} must ascend; {first[row]:g} comes after {first[row - 1]:g}", self.place(row))
        if len(first) < least:
            raise InputError(f"{len(first)} rows of numbers; at least {least} were expected", self.place(-1))

    def check_limit(self, column: int, limit: Limit) -> None:
        """Raise InputError at the first number of a column that lies outside a limit."""
        wrong = np.flatnonzero((np.abs(self.values[column]) < limit.low) | (np.abs(self.values[column]) > limit.high))
        for row in wrong:
            if (reason := limit.refusal(float(self.values[column][row]))) is not None:
                raise InputError(reason, self.place(int(row), column))


def read_columns(path: Path, names: tuple[str, ...]) -> TableColumns:
    """Read columns of a CSV file with a header line; the file is read row by row and never held as text.

    Raises
    ------
    InputError
        For a file that is missing, not regular or too large, a missing or repeated column, and at the line and cell of anything that is
        not a number of at most LARGEST_MEASURED.
    """
    rows = csv_rows(read_lines(path, MAX_TABLE_BYTES, "a CSV file"), path)
    header = [cell.strip() for cell in next(rows, (1, []))[1]]
    columns = [array("d") for _ in names]
    lines = array("q")
    places: list[int] = []
    for line, row in rows:
        places = places or [_place(path, header, name) for name in names]
        if any(cell.strip() for cell in row[len(header) :]):
            raise InputError(f"{len(row)} cells below {len(header)} headings", Position(path, line, len(header) + 1))
        for name, place, column in zip(names, places, columns, strict=True):
            try:
                number = float(row[place])
            except (ValueError, IndexError):
                number = np.nan
            if not -LARGEST_MEASURED <= number <= LARGEST_MEASURED:
                raise _wrong(row, name, place, path, line)
            column.append(number)
        lines.append(line)
        if len(columns) * len(columns[0]) > MAX_TABLE_NUMBERS:
            raise InputError(
                f"more than {MAX_TABLE_NUMBERS} numbers in {len(columns)} columns; cut the recording to the pass", Position(path, line, 1)
            )
    if not places:
        raise InputError("a header line and at least one line of numbers were expected", Position(path, 1, 1))
    cells = tuple(place + 1 for place in places)
    return TableColumns(path, names, tuple(np.array(column) for column in columns), cells, np.array(lines, dtype=np.int64))


def _place(path: Path, header: list[str], name: str) -> int:
    if name not in header:
        raise InputError(f"no column {shown(name)}; {did_you_mean(name, header)}", Position(path, 1, 1))
    place = header.index(name)
    if header.count(name) > 1:
        second = header.index(name, place + 1)
        raise InputError(f"two columns are named {shown(name)}; each needs a name of its own", Position(path, 1, second + 1))
    return place


def _wrong(row: list[str], name: str, place: int, path: Path, line: int) -> InputError:
    text = row[place].strip() if place < len(row) else ""
    position = Position(path, line, min(place, max(len(row) - 1, 0)) + 1)
    try:
        finite = np.isfinite(float(text))
    except ValueError:
        finite = False
    reason = f"beyond {LARGEST_MEASURED:g}, which nothing measures" if finite else "not a finite number"
    return InputError(f"{shown(text)} in column {shown(name)} is {reason}", position)
