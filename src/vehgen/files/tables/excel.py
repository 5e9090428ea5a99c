"""Excel workbooks (.xlsx): a table is the first sheet, headings in its first row, a row of units below them if there is one."""

from __future__ import annotations

import re
import zipfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from vehgen.errors import InputError, Position
from vehgen.files.tables.columns import MAX_TABLE_BYTES, TableColumns
from vehgen.files.tables.csv_rows import MOST_ROWS
from vehgen.files.tables.foreign import faults_of, library
from vehgen.files.tables.rows import Cell, Rows, read_rows

EXCEL_KIND = "an Excel workbook (.xlsx)"
MAX_WORKBOOK_BYTES = 5 * MAX_TABLE_BYTES
"""Sheets are XML, packed to a tenth [bytes]."""
MOST_WORKBOOK_PARTS = 1000
WORKBOOK_PART = "xl/workbook.xml"
"""The part by which an archive is a workbook."""
_ENTITIES = (b"<!DOCTYPE", b"<!ENTITY")
_COMMENT, _ELEMENT = re.compile(rb"<!--.*?-->", re.DOTALL), re.compile(rb"<[A-Za-z_]")
_ENCODING = re.compile(rb"""<\?xml[^>]*?encoding\s*=\s*["']([^"']*)""")
_OTHER_ENCODINGS = (b"\xff\xfe", b"\xfe\xff", b"<\x00", b"\x00<")
HEAD_BYTES = 65536
"""The first element of every part of a workbook begins within so many bytes: nothing can be declared after it."""


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
    _check_parts(path)
    openpyxl = library("openpyxl", "tables", path)
    with faults_of(path, EXCEL_KIND):
        book = openpyxl.load_workbook(path, read_only=True, data_only=True, keep_links=False)
        try:
            yield {sheet.title: _rows(sheet.iter_rows(values_only=True), path) for sheet in book.worksheets}
        finally:
            book.close()


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


def _check_parts(path: Path) -> None:
    """Refuse an archive that is no workbook, unpacks to too much, or whose XML declares entities, before anything reads it."""
    with faults_of(path, EXCEL_KIND), zipfile.ZipFile(path) as archive:
        parts = archive.infolist()
        if WORKBOOK_PART not in archive.namelist():
            raise InputError("a zip archive that is no Excel workbook; unpack the table first", Position(path, 1, 1))
        if len(parts) > MOST_WORKBOOK_PARTS or sum(part.file_size for part in parts) > MAX_WORKBOOK_BYTES:
            raise InputError(f"the workbook would unpack to more than {MAX_WORKBOOK_BYTES} bytes", Position(path, 1, 1))
        for part in parts:
            with archive.open(part) as stream:
                if not _is_plain(stream.read(HEAD_BYTES)):
                    raise InputError("the workbook declares entities, which no program writes", Position(path, 1, 1))


def _is_plain(head: bytes) -> bool:
    """Return whether a part is no XML, or XML in UTF-8 whose first element begins within its head with no declaration before it."""
    start = head.removeprefix(b"\xef\xbb\xbf").lstrip()
    if start[:2] in _OTHER_ENCODINGS:
        return False
    if not start.startswith(b"<"):
        return True
    encoding = _ENCODING.match(start)
    if encoding is not None and encoding[1].lower() not in (b"utf-8", b"us-ascii"):
        return False
    before = _COMMENT.sub(b"", start)
    element = _ELEMENT.search(before)
    return element is not None and not any(mark in before[: element.start()] for mark in _ENTITIES)
