"""Tables as text: separated by comma, semicolon or tab, with a decimal point or, where the comma separates nothing, a decimal comma."""

from __future__ import annotations

import csv
import itertools
import re
from collections.abc import Iterator
from pathlib import Path

from vehgen.files.reading import read_lines
from vehgen.files.tables.columns import MAX_TABLE_BYTES, TableColumns
from vehgen.files.tables.csv_rows import csv_rows
from vehgen.files.tables.headings import name_and_unit
from vehgen.files.tables.rows import read_rows

_QUOTED = re.compile(r'"[^"]*"')


def read_csv(path: Path, names: tuple[str, ...]) -> TableColumns:
    """Read columns of a CSV file with a header line; the file is read row by row and never held as text.

    Raises
    ------
    InputError
        For a file that is missing, not regular or too large, and as :func:`vehgen.files.tables.rows.read_rows`.
    """
    lines = read_lines(path, MAX_TABLE_BYTES, "a CSV file")
    first = next(lines, "")
    separator = _separator(first, names)
    rows: Iterator[tuple[int, list[str]]] = csv_rows(itertools.chain([first], lines), path, separator)
    header = [cell.strip() for cell in next(rows, (1, []))[1]]
    return read_rows(path, header, ((line, list(row)) for line, row in rows), names, comma=separator != ",")


def _separator(first: str, names: tuple[str, ...]) -> str:
    """Return what separates cells: what cuts the wanted names out of the first line, else the rarest sign that stands in it."""
    for sign in (",", ";", "\t"):
        cells = [cell.strip() for cell in next(csv.reader([first], delimiter=sign), [])] if len(first) < csv.field_size_limit() else []
        if set(names) <= {*cells, *(name_and_unit(cell)[0] for cell in cells)}:
            return sign
    bare = _QUOTED.sub("", first)
    return next((sign for sign in ("\t", ";") if sign in bare), ",")
