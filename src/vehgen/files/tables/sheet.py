"""A table as other programs' files hold it, column by column, before columns are asked of it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vehgen.errors import InputError, Position, shown
from vehgen.files.tables.columns import LARGEST_MEASURED, MAX_TABLE_NUMBERS, TableColumns, unmeasured
from vehgen.files.tables.csv_table import MOST_ROWS
from vehgen.files.tables.headings import declared_unit, find_heading, may_be_word, name_and_unit


@dataclass(frozen=True)
class Sheet:
    """A table: `headings` and `units` of its columns, how one is read, and how many rows it has.

    `lines shape (n_rows,)` are the numbers of its rows in errors (default: from 1).
    """

    path: Path
    headings: tuple[str, ...]
    units: tuple[str | None, ...]
    column: Callable[[int], Any]
    n_rows: int
    lines: NDArray[np.int64] | None = None

    def select(self, names: tuple[str, ...]) -> TableColumns:
        """Return columns by their names; raises InputError for missing ones, for too many numbers, and at a number that is none."""
        check_size(self.path, self.n_rows, len(names))
        cells = [find_heading(self.path, self.headings, name) for name in names]
        units = [declared_unit(self.units[cell]) or name_and_unit(self.headings[cell])[1] for cell in cells]
        lines = np.arange(1, self.n_rows + 1, dtype=np.int64) if self.lines is None else self.lines
        values = tuple(self._numbers(cell, name, lines) for cell, name in zip(cells, names, strict=True))
        doubtful = frozenset(
            i for i, cell in enumerate(cells) if declared_unit(self.units[cell]) is None and may_be_word(self.headings[cell])
        )
        return TableColumns(self.path, names, values, tuple(cell + 1 for cell in cells), lines, tuple(units), doubtful=doubtful)

    def _numbers(self, cell: int, name: str, lines: NDArray[np.int64]) -> NDArray[np.float64]:
        found = np.asarray(self.column(cell))
        if found.dtype.kind not in "fiu" or found.shape != (self.n_rows,):
            what = f"{found.dtype} of shape {found.shape}"
            raise InputError(
                f"{shown(name)} holds {what}; a column of {self.n_rows} numbers was expected", Position(self.path, 1, cell + 1)
            )
        numbers = found.astype(np.float64)
        wrong = np.flatnonzero(~(np.abs(numbers) <= LARGEST_MEASURED))
        if len(wrong):
            row = int(wrong[0])
            said = f"{numbers[row]:g} in column {shown(name)} is {unmeasured(numbers[row])}"
            raise InputError(said, Position(self.path, int(lines[row]), cell + 1))
        return numbers


def check_size(path: Path, n_rows: int, n_columns: int) -> None:
    """Refuse a table with no row, and one with more rows or numbers than any recording, before it is read."""
    if n_rows < 1:
        raise InputError("a table with at least one row of numbers was expected", Position(path, 1, 1))
    if n_rows > MOST_ROWS or n_rows * n_columns > MAX_TABLE_NUMBERS:
        raise InputError(
            f"{n_rows} rows of {n_columns} columns; at most {MOST_ROWS} rows; cut the recording to the pass", Position(path, 1, 1)
        )
