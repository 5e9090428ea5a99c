"""Columns of a table by name, with their units and the place of every number: what is wrong with one is said where it stands."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from vehgen.errors import InputError, Position, shown
from vehgen.files.checks import unit_factor
from vehgen.files.limits import Limit
from vehgen.files.units import factor_to_si, parse_unit

MAX_TABLE_BYTES = 200_000_000
"""No table is larger [bytes]."""
MAX_TABLE_NUMBERS = 20_000_000
"""So many numbers may be asked of a table at once: 160 MB."""
LARGEST_MEASURED = 1e12
"""Beyond it a number was not measured, in whatever unit."""


@dataclass(frozen=True)
class TableColumns:
    """Columns of a table: `values`, one `shape (n_rows,)` each, the `units` that the file itself gives to them, and where they stand.

    `cells` are the numbers of their cells in a row, `lines shape (n_rows,)` the file's lines or rows; both count from 1. `unit_lines` are
    those in which the units stand (default: `first`, the headings' line). The units of `doubtful` columns may be words: they count where
    they fit.
    """

    path: Path
    names: tuple[str, ...]
    values: tuple[NDArray[np.float64], ...]
    cells: tuple[int, ...]
    lines: NDArray[np.int64]
    units: tuple[str | None, ...]
    unit_lines: tuple[int, ...] = ()
    doubtful: frozenset[int] = frozenset()
    first: int = 1

    def place(self, row: int, column: int = 0) -> Position:
        """Return the place of a number: `row` counts from 0, negative ones from the end; `column` is its index in `names`."""
        return Position(self.path, int(self.lines[row]), self.cells[column])

    def heading(self, column: int) -> Position:
        """Return the place of a column's heading."""
        return Position(self.path, self.first, self.cells[column])

    def unit_place(self, column: int) -> Position:
        """Return the place of a column's unit, or of its heading where it has none."""
        return Position(self.path, self.unit_lines[column] if self.unit_lines else self.first, self.cells[column])

    def in_si(self, column: int, usual: str, quantity: str, stated: str | None = None, place: Position | None = None) -> TableColumns:
        """Return the table with a column in SI units.

        Parameters
        ----------
        column
            Its index in `names`.
        usual, quantity
            The SI unit of what it holds, and what errors call that.
        stated, place
            The unit that another file states for it, and where: needed where the table gives none and its numbers are not in `usual`.

        Raises
        ------
        InputError
            For a unit that there is not, of another quantity, or two that contradict each other.
        """
        own = self.units[column]
        if own is not None and column in self.doubtful and factor_to_si(own, parse_unit(usual)[1]) is None:
            own = None
        factor = unit_factor(stated or own or usual, usual, quantity, place if stated else self.unit_place(column))
        if own is not None and stated is not None and _contradicts(own, usual, factor):
            what = f"the column {shown(self.names[column])} is in {shown(own)} as its file says ({self.unit_place(column)})"
            raise InputError(f"{what}, and in {shown(stated)} as stated here; leave `unit` out, or correct one of them", place)
        return self if factor == 1 else self.scaled(column, factor)

    def scaled(self, column: int, factor: float) -> TableColumns:
        """Return the table with a column times a factor."""
        values = (*self.values[:column], self.values[column] * factor, *self.values[column + 1 :])
        return replace(self, values=values)

    def between(self, low: float, high: float) -> TableColumns:
        """Return the rows in which the first column lies from `low` to `high`."""
        kept = (self.values[0] >= low) & (self.values[0] <= high)
        return replace(self, values=tuple(column[kept] for column in self.values), lines=self.lines[kept])

    def check_ascending(self, least: int = 2, cure: str = "") -> None:
        """Raise InputError where the numbers of the first column do not ascend, with a `cure`, and for fewer than `least` rows."""
        first = self.values[0]
        stuck = np.flatnonzero(~(np.diff(first) > 0))
        if len(stuck):
            row = int(stuck[0]) + 1
            raise InputError(
                f"{shown(self.names[0])} must ascend; {first[row]:.12g} comes after {first[row - 1]:.12g}{cure}", self.place(row)
            )
        if len(first) < least:
            place = self.place(-1) if len(first) else self.heading(0)
            raise InputError(f"{len(first)} rows of numbers; at least {least} were expected", place)

    def check_limit(self, column: int, limit: Limit) -> None:
        """Raise InputError at the first number of a column that lies outside a limit."""
        wrong = np.flatnonzero((np.abs(self.values[column]) < limit.low) | (np.abs(self.values[column]) > limit.high))
        for row in wrong:
            if (reason := limit.refusal(float(self.values[column][row]))) is not None:
                raise InputError(reason, self.place(int(row), column))


def plain_float(text: str | float) -> float:
    """Return the number that a text is; raises ValueError for none, and for `1_000`, which only Python takes for one."""
    if isinstance(text, str) and "_" in text:
        raise ValueError(text)
    return float(text)


def unmeasured(number: float) -> str:
    """Return what is wrong with a number that no sensor measured."""
    return f"beyond {LARGEST_MEASURED:g}, which nothing measures" if np.isfinite(number) else "not a finite number"


def _contradicts(own: str, usual: str, factor: float) -> bool:
    """Return whether a table's own unit is not worth `factor` of the usual one; what is no unit at all says nothing."""
    theirs = factor_to_si(own, parse_unit(usual)[1])
    if theirs is not None:
        return abs(theirs / factor - 1) > 1e-9
    try:
        parse_unit(own)
    except InputError:
        return False
    return True
