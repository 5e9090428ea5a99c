"""Columns out of rows of cells, which are read one by one and never held: of a CSV file, or of an Excel sheet."""

from __future__ import annotations

import math
from array import array
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from vehgen.errors import InputError, Position, shown
from vehgen.files.tables.columns import LARGEST_MEASURED, MAX_TABLE_NUMBERS, TableColumns, plain_float, unmeasured
from vehgen.files.tables.headings import check_cells, declared_unit, find_heading, is_unit, may_be_word, name_and_unit
from vehgen.files.tables.moments import form_of

Cell = str | float
MISSING_CELLS = {"", "nan", "null", "na", "n/a", "-"}
"""What stands where a number is missing, capitals aside."""
Rows = Iterator[tuple[int, list[Cell]]]


def read_rows(path: Path, header: Sequence[str], rows: Rows, names: tuple[str, ...], comma: bool = False, first: int = 1) -> TableColumns:
    """Read columns of numbers below their headings; a row of units may stand between them.

    Parameters
    ----------
    path
        The file, for places.
    header, rows
        The headings, and every further row with its line.
    names
        The columns wanted.
    comma
        Whether a comma may be the decimal sign.
    first
        The headings' line.

    Raises
    ------
    InputError
        For a missing or repeated column, and at the line and cell of anything that is not a number of at most LARGEST_MEASURED.
    """
    columns = [array("d") for _ in names]
    lines = array("q")
    places: list[int] = []
    units: list[str | None] = []
    below: list[str | None] | None = None
    units_line, doubtful = 1, frozenset[int]()
    signs: set[str] = set()
    for line, row in rows:
        if not any(map(_text, row)):
            continue  # a blank line, as editors and loggers leave one at the end
        if not places:
            places = [find_heading(path, header, name, first) for name in names]
            units = [name_and_unit(header[place])[1] for place in places]
            doubtful = frozenset(i for i, place in enumerate(places) if may_be_word(header[place]))
            if (below := units_row(row, places)) is not None:
                units_line = line
                continue
        check_cells(path, line, row, len(header))
        for name, place, column in zip(names, places, columns, strict=True):
            number = _number(row[place], signs if comma else None) if place < len(row) else np.nan
            if not -LARGEST_MEASURED <= number <= LARGEST_MEASURED:
                text = _text(row[place]) if place < len(row) else ""
                position = Position(path, line, min(place, max(len(row) - 1, 0)) + 1)
                cure = _cure_of_missing(path, text) if text.lower() in MISSING_CELLS else ""
                cure = "; `vehgen import` reads the times of day of a recording" if form_of(text) else cure
                raise InputError(f"{shown(text)} in column {shown(name)} is {unmeasured(number)}{cure}", position)
            if len(signs) > 1:
                raise InputError(
                    f"{shown(row[place])} in column {shown(name)}: a decimal comma and a decimal point in one table; one was expected",
                    Position(path, line, place + 1),
                )
            column.append(number)
        lines.append(line)
        if len(columns) * len(columns[0]) > MAX_TABLE_NUMBERS:
            raise InputError(
                f"more than {MAX_TABLE_NUMBERS} numbers in {len(columns)} columns; cut the recording to the pass", Position(path, line, 1)
            )
    if not len(lines):
        raise InputError("a header line and at least one line of numbers were expected", Position(path, 1, 1))
    cells = tuple(place + 1 for place in places)
    values = tuple(np.array(column) for column in columns)
    found = TableColumns(path, names, values, cells, np.array(lines, dtype=np.int64), tuple(units), doubtful=doubtful, first=first)
    return found if below is None else _with_units(found, below, units_line)


def _cure_of_missing(path: Path, text: str) -> str:
    if not text and path.suffix.lower() == ".xlsx":
        return "; a formula has its value once Excel or LibreOffice has saved the workbook"
    return "; `vehgen import` bridges gaps of a recording, and points of a road may lie farther apart: leave the row out"


def _with_units(table: TableColumns, below: list[str | None], line: int) -> TableColumns:
    """Return a table with the units of a row of its own; where that has none, those of the headings stay."""
    units = tuple(own or other for own, other in zip(below, table.units, strict=True))
    unit_lines = tuple(line if own else table.first for own in below)
    return replace(table, units=units, unit_lines=unit_lines, doubtful=frozenset(i for i in table.doubtful if not below[i]))


def _text(cell: Cell) -> str:
    return str(cell).strip()


def units_row(row: Sequence[Cell], places: Sequence[int]) -> list[str | None] | None:
    """Return the units of columns where a row holds one at least and no number, what is no unit among them; else None."""
    texts = [_text(row[place]) if place < len(row) else "" for place in places]
    if not any(declared_unit(text) is not None and is_unit(text) for text in texts) or any(_may_be_number(text) for text in texts):
        return None
    return [declared_unit(text) for text in texts]


def _may_be_number(text: str) -> bool:
    return text[:1].isdigit() or not math.isnan(_number(text, set())) or text.lower().lstrip("+-") == "nan"


def _number(cell: Cell, signs: set[str] | None) -> float:
    """Return a cell's number, NaN where it is none; where a comma may be decimal, `signs` takes up which sign it was."""
    try:
        number = plain_float(cell)
        if signs is not None and isinstance(cell, str) and "." in cell:
            signs.add(".")
        return number
    except ValueError:
        if signs is None or not isinstance(cell, str) or cell.count(",") != 1 or "." in cell:
            return float("nan")
    signs.add(",")
    try:
        return plain_float(cell.replace(",", "."))
    except ValueError:
        return float("nan")
