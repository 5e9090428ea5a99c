"""Tables as text, read row by row: separated by comma, semicolon or tab, with a decimal point or, where it separates nothing, a comma."""

from __future__ import annotations

import csv
import itertools
import re
from collections.abc import Iterable, Iterator
from pathlib import Path

from vehgen.errors import InputError, Position
from vehgen.files.reading import LONGEST_LINE, OLD_WINDOWS, read_lines
from vehgen.files.tables.columns import MAX_TABLE_BYTES, TableColumns
from vehgen.files.tables.headings import name_and_unit
from vehgen.files.tables.rows import read_rows

MOST_ROWS = 2_000_000
"""No table is longer: at 200 samples a second, two and three quarter hours."""
_FOR_EXCEL = re.compile(r'\ufeff?"?sep=[^\r\n]"?\s*\Z', re.IGNORECASE)
_NUMBER = re.compile(r'[\s"]*[-+.]*\d')
_QUOTED = re.compile(r'"[^"]*"')


def read_csv(path: Path, names: tuple[str, ...]) -> TableColumns:
    """Read columns of a CSV file with a header line; the file is read row by row and never held as text.

    Raises
    ------
    InputError
        For a file that is missing, not regular or too large, and as :func:`vehgen.files.tables.rows.read_rows`.
    """
    lines = without_comments(read_lines(path, MAX_TABLE_BYTES, "a CSV file", undecodable=OLD_WINDOWS))
    above, first = next(((above, line) for above, line in enumerate(lines) if line.strip()), (0, ""))
    separator = _separator(first, names)
    rows = csv_rows(itertools.chain(itertools.repeat("\n", above), [first], lines), path, separator)
    header = [cell.strip() for cell in next((row for _, row in rows if row), [])]
    return read_rows(path, header, ((line, list(row)) for line, row in rows), names, comma=separator != ",", first=above + 1)


def without_comments(lines: Iterable[str]) -> Iterator[str]:
    """Yield lines, comments (`# ...`) above the heading as empty ones, and `sep=;`, by which Excel is told what separates columns.

    What numbers follow is the heading, though it begins with `#`.
    """
    above = True
    for line, after in itertools.pairwise(itertools.chain(lines, [""])):
        above = above and (line.lstrip()[:1] in ("", "#") or _FOR_EXCEL.match(line) is not None) and not _NUMBER.match(after)
        yield "\n" if above else line


def csv_rows(lines: Iterable[str], where: Path | str, delimiter: str = ",") -> Iterator[tuple[int, list[str]]]:
    """Yield each row of a CSV text with the number of its last line, which counts from 1.

    Parameters
    ----------
    lines
        The text's lines with their ends.
    where
        What errors call the text.
    delimiter
        What stands between cells.

    Raises
    ------
    InputError
        At a row beyond MOST_ROWS or of more than LONGEST_LINE characters, and at what is no CSV.
    """
    pending = 0

    def counted() -> Iterator[str]:
        nonlocal pending
        for line in lines:
            pending += len(line)
            if pending > LONGEST_LINE:
                raise InputError(
                    f"a row of more than {LONGEST_LINE} characters: is a quote not closed?", Position(where, reader.line_num + 1, 1)
                )
            yield line

    reader = csv.reader(counted(), delimiter=delimiter)
    try:
        for count, row in enumerate(reader):
            if count > MOST_ROWS:
                raise InputError(f"more than {MOST_ROWS} rows; cut the recording to the pass", Position(where, reader.line_num, 1))
            yield reader.line_num, row
            pending = 0
    except csv.Error as error:
        raise InputError(f"not a CSV table: {error}", Position(where, max(reader.line_num, 1), 1)) from error


def _separator(first: str, names: tuple[str, ...]) -> str:
    """Return what separates cells: what cuts the wanted names out of the first line, else the rarest sign that stands in it."""
    for sign in (",", ";", "\t"):
        cells = [cell.strip() for cell in next(csv.reader([first], delimiter=sign), [])] if len(first) < csv.field_size_limit() else []
        if set(names) <= {*cells, *(name_and_unit(cell)[0] for cell in cells)}:
            return sign
    bare = _QUOTED.sub("", first)
    return next((sign for sign in ("\t", ";") if sign in bare), ",")
