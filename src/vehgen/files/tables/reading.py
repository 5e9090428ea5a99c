"""Which reader a table needs: told by its first bytes, so that a file with a wrong ending is read as what it is."""

from __future__ import annotations

import re
from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from typing import cast

from vehgen.errors import InputError, Position
from vehgen.files.reading import open_regular, short_path
from vehgen.files.tables.columns import MAX_TABLE_BYTES, TableColumns
from vehgen.files.tables.csv_table import read_csv

Reader = Callable[[Path, tuple[str, ...]], TableColumns]
_FIRST_BYTES = 4096
_TABLE_READERS: tuple[tuple[re.Pattern[bytes], str], ...] = (
    (re.compile(rb"PAR1"), "parquet"),
    (re.compile(rb"PK\x03\x04"), "excel"),
    (re.compile(rb"MDF     |UnFinMF "), "mdf"),
    (re.compile(rb"MATLAB 5\.0 MAT-file"), "matlab"),
    (re.compile(rb"\s*-1\s*\r?\n"), "uff"),
    (re.compile(rb"(\xef\xbb\xbf)?\s*<(\?xml|gpx|!)"), "gpx"),
    (re.compile(rb"([^\n]*\n){0,20}\$(CT|ROAD_CRG)\b"), "crg"),
    (re.compile(rb"(![^\n]*\n|\s)*\$[A-Z]{2}[A-Z]{3},"), "nmea"),
)
"""How a file begins, and the module of this box that reads it with its function `read`."""
_REFUSED_TABLES: tuple[tuple[bytes, str], ...] = (
    (bytes.fromhex("d0cf11e0a1b11ae1"), "an Excel file of the old form (.xls); save it as .xlsx or CSV"),
    (b"\x89HDF", "an HDF5 file, as MATLAB writes with -v7.3; in MATLAB: save('file.mat', ..., '-v7')"),
    (b"MATLAB 7.3 MAT-file", "a MATLAB file of version 7.3; in MATLAB: save('file.mat', ..., '-v7')"),
    (b"\x1f\x8b", "packed (gzip); unpack it first"),
)


def first_bytes(path: Path) -> bytes:
    """Return how a file begins; raises InputError for one that is missing, not regular, too large or unreadable."""
    with open_regular(path, MAX_TABLE_BYTES, "a table") as stream:
        try:
            return stream.read(_FIRST_BYTES)
        except OSError as error:
            raise InputError(f"cannot read {short_path(path)}: {error.strerror}") from error


def read_columns(path: Path, names: tuple[str, ...]) -> TableColumns:
    """Read columns of a table: CSV in any dialect, Parquet, Excel, MDF 4, UFF 58, MATLAB, OpenCRG; `t` and `speed` of GPX and NMEA.

    A unit that the file gives to a column, with it or in brackets in its heading, is in `units`; the numbers are those of the file.

    Raises
    ------
    InputError
        For a file that is missing, not regular, too large, of no such format or damaged, where a library is lacking, for a missing or
        repeated column, and at the place of anything that is not a number of at most LARGEST_MEASURED.
    """
    head = first_bytes(path)
    for mark, what in _REFUSED_TABLES:
        if head.startswith(mark):
            raise InputError(f"the table is {what}", Position(path, 1, 1))
    name = next((module for pattern, module in _TABLE_READERS if pattern.match(head)), None)
    if name is None:
        return read_csv(path, names)
    reader = cast("Reader", import_module(f"vehgen.files.tables.{name}").read)
    return reader(path, names)
