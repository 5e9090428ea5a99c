"""The rows of a CSV text one by one, so that a large file never stands in memory as cells."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Iterator
from pathlib import Path

from vehgen.errors import InputError, Position
from vehgen.files.reading import LONGEST_LINE

MOST_ROWS = 2_000_000
"""No table is longer: at 200 samples a second, two and three quarter hours."""


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
