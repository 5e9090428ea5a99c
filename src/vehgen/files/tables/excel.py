"""Excel workbooks (.xlsx): a table is the first sheet, headings in its first row, a row of units below them if there is one."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import closing, contextmanager
from pathlib import Path
from typing import Any

from vehgen.errors import InputError, Position
from vehgen.files.tables.columns import TableColumns
from vehgen.files.tables.csv_table import MOST_ROWS
from vehgen.files.tables.foreign import faults_of, items_of, library, without_warnings
from vehgen.files.tables.rows import Cell, Rows, read_rows
from vehgen.files.tables.workbook_parts import EXCEL_KIND, check_parts


def read(path: Path, names: tuple[str, ...]) -> TableColumns:
    """Read columns of the first sheet of a workbook; raises InputError for a damaged or hostile one, and as :func:`read_rows`."""
    with open_sheets(path) as sheets:
        rows = next(iter(sheets.values()))
        header = [str(cell).strip() for cell in next(rows, (1, []))[1]]
        return read_rows(path, header, rows, names)


@contextmanager
def open_sheets(path: Path) -> Iterator[dict[str, Rows]]:
    """Yield the sheets of a workbook by name: of every row that is not blank its number, from 1 on, and its cells.

    Raises
    ------
    InputError
        For a damaged or hostile workbook, one with too many rows, and where the library that reads it lacks.
    """
    check_parts(path)
    openpyxl = library("openpyxl", "tables", path)
    with faults_of(path, EXCEL_KIND):
        book = openpyxl.load_workbook(path, read_only=True, data_only=True, keep_links=False)
    with closing(book), without_warnings():
        with faults_of(path, EXCEL_KIND):
            sheets = {sheet.title: sheet.iter_rows(values_only=True) for sheet in book.worksheets}
            if not sheets:
                raise InputError("the workbook has no sheet; one with a table was expected", Position(path, 1, 1))
        yield {name: _rows(items_of(rows, path, EXCEL_KIND), path) for name, rows in sheets.items()}


def _rows(rows: Iterator[tuple[Any, ...]], path: Path) -> Iterator[tuple[int, list[Cell]]]:
    """Yield the number and the cells of every row that is not blank, without blanks at its end."""
    for number, row in enumerate(rows, 1):
        if number > MOST_ROWS:
            raise InputError(f"more than {MOST_ROWS} rows; cut the recording to the pass", Position(path, number, 1))
        cells: list[Cell] = [_cell(value) for value in row]
        while cells and cells[-1] == "":
            cells.pop()
        if cells:
            yield number, cells


def _cell(value: object) -> Cell:
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        return float(value)
    return "" if value is None else str(value)
