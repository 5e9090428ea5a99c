"""The sheets of an Excel workbook, as the CSV files that the same app would have exported.

phyphox writes a sheet a sensor, with the headings of its CSV files, and the sheets `Metadata Device` and `Metadata Time`.
"""

from __future__ import annotations

import csv
import io
import zipfile
from pathlib import Path

from vehgen.errors import InputError, shown
from vehgen.files.reading import short_path
from vehgen.files.tables.excel import open_sheets
from vehgen.files.tables.workbook_parts import WORKBOOK_PART

MAX_SHEETS = 100


def is_workbook(archive: zipfile.ZipFile) -> bool:
    """Say whether a zip archive is an Excel workbook."""
    return WORKBOOK_PART in archive.namelist()


def read_sheets(path: Path, most: int) -> dict[str, bytes]:
    """Return the sheets of a workbook as CSV text by their names, a line for each row.

    Parameters
    ----------
    path
        The workbook.
    most
        So many bytes of text are read at most, of all sheets together.

    Raises
    ------
    InputError
        For a damaged or hostile workbook, one that is too large, and where the library that reads it lacks.
    """
    found: dict[str, bytes] = {}
    left = most
    with open_sheets(path) as sheets:
        if len(sheets) > MAX_SHEETS:
            raise InputError(f"{short_path(path)} holds {len(sheets)} sheets; at most {MAX_SHEETS} were expected")
        for name, rows in sheets.items():
            text, written = io.StringIO(newline=""), 0
            writer = csv.writer(text, quoting=csv.QUOTE_NONNUMERIC, lineterminator="\n")
            for number, cells in rows:
                text.write("\n" * (number - written - 1))
                writer.writerow([" ".join(cell.split()) if isinstance(cell, str) else cell for cell in cells])
                written = number
                if text.tell() > left:
                    raise InputError(f"{short_path(path)}: sheet {shown(name)} holds more than {most >> 20} MB of text; cut the recording")
            found[name] = text.getvalue().encode(errors="replace")
            left -= text.tell()
    return found
