"""Tables of numbers as text in the dialects that phones and people write: separators , ; and tab, decimal point or decimal comma.

A plain CSV of columns that are already in the vehicle's axes is read here too, with a map from quantities to columns.
"""

from __future__ import annotations

import io
import itertools
import math
import re
from array import array
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from vehgen.errors import ArgumentError, InputError, Position, did_you_mean, shortened, shown
from vehgen.files.reading import split_lines
from vehgen.files.tables.csv_table import csv_rows, without_comments
from vehgen.files.tables.headings import check_cells, name_and_unit
from vehgen.files.tables.moments import OF_DAY, form_of, seconds
from vehgen.files.tables.rows import MISSING_CELLS, units_row
from vehgen.files.units import ACCELERATION, FREQUENCY, TIME, Dimension, factor_to_si, parse_unit
from vehgen.files.units import SPEED as SPEED_DIMENSION
from vehgen.phones.export import PITCH_RATE_STREAM, SPEED_STREAM, VERTICAL_ACCELERATION_STREAM, PhoneExport, Stream

Array = NDArray[np.float64]
MAX_COLUMNS = 200
LARGEST_EXPORTED = 1e20
"""Beyond it a number was not measured; times in ns since 1970 are the largest that are."""
DAY_S = 86_400.0
SAME_UNIT = 1e-9
"""Two units are the same whose factors to SI differ by no larger share."""
_DECIMAL_COMMA = re.compile(r'^"?[+-]?\d*,\d+(?:[eE][+-]?\d+)?"?$')
_NUMBER_CELL = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?", re.ASCII)


@dataclass(frozen=True)
class Table:
    """A table of text: `name` for errors, `file` within its export, `header`; its bytes are read row by row when numbers are asked for.

    Headings take up the units of a row below them, where there is one: `has_units_row`.
    """

    name: str
    file: str
    header: tuple[str, ...]
    data: bytes
    encoding: str
    delimiter: str
    decimal_comma: bool = False
    has_units_row: bool = False

    def rows(self) -> Iterator[tuple[int, list[str]]]:
        """Yield the line and the cells of every row below the header that is not blank.

        Raises InputError for what is no table, and for a row of more cells than headings.
        """
        for line, row in itertools.islice(_rows(self.data, self.encoding, self.delimiter, self.name), 1 + self.has_units_row, None):
            check_cells(self.name, line, row, len(self.header))
            yield line, row

    def column(self, index: int) -> Array:
        """Return a column as numbers `shape (n,)`; missing ones are NaN. Raises InputError as :meth:`columns`."""
        return self.columns(index)[:, 0]

    def columns(self, *indices: int) -> Array:
        """Return columns as numbers `shape (n, n_columns)`, from one passage through the rows; missing ones are NaN.

        Raises
        ------
        InputError
            At the line and column of a text that is no number.
        """
        found = array("d")
        for line, row in self.rows():
            for index in indices:
                found.append(self._number(row, index, line))
        return np.array(found).reshape(-1, len(indices))

    def _number(self, row: list[str], index: int, line: int) -> float:
        text = row[index].strip() if index < len(row) else ""
        if self.decimal_comma:
            text = text.replace(",", ".")
        number = float(text) if _NUMBER_CELL.fullmatch(text) else math.nan
        if math.isfinite(number) and abs(number) > LARGEST_EXPORTED:
            raise InputError(
                f"{shown(text)} in column {shown(self.header[index])} is beyond {LARGEST_EXPORTED:g}, which nothing measures",
                Position(self.name, line, index + 1),
            )
        if math.isnan(number) and text.lower() not in MISSING_CELLS:
            raise InputError(
                f"expected a number in column {shown(self.header[index])}, found {shown(text)}", Position(self.name, line, index + 1)
            )
        return number if math.isfinite(number) else math.nan

    def form_of_moments(self, index: int) -> str | None:
        """Return the form of the moments that a column holds, by its first cell; None for one of numbers.

        Raises InputError where that cell is neither, but has a colon as times have.
        """
        cells = ((line, row[index].strip()) for line, row in self.rows() if index < len(row))
        line, first = next(((line, text) for line, text in cells if text.lower() not in MISSING_CELLS), (0, ""))
        form = form_of(first)
        if form is None and ":" in first:
            raise self._no_moment(index, line, first, "seconds, or a time")
        return form

    def moments(self, index: int, form: str) -> Array:
        """Return a column of moments of one form, in seconds since the first, `shape (n,)`; missing ones are NaN.

        Times of day go on beyond midnight. Raises InputError at the line and column of a text that has another form.
        """
        found = array("d")
        for line, row in self.rows():
            text = row[index].strip() if index < len(row) else ""
            try:
                found.append(math.nan if text.lower() in MISSING_CELLS else seconds(text, form))
            except ValueError as error:
                raise self._no_moment(index, line, text, f"{form} as above") from error
        times = np.array(found)
        known = np.isfinite(times)
        if form == OF_DAY:
            times[known] = np.unwrap(times[known], period=DAY_S)
        return np.asarray(times - times[known][0])

    def _no_moment(self, index: int, line: int, text: str, expected: str) -> InputError:
        message = f"expected {expected}, such as 12:00:00.25 or 2024-05-01T12:00:00.25, in column {shown(self.header[index])}"
        return InputError(f"{message}, found {shown(text)}", Position(self.name, line, index + 1))

    def text(self, index: int) -> list[str]:
        """Return a column as text."""
        return [row[index].strip() if index < len(row) else "" for _, row in self.rows()]

    def find(self, name: str) -> int:
        """Return the index of a column by its heading, or by that without a unit in brackets, capitals aside.

        Raises InputError naming the nearest, and for a name that repeats.
        """
        whole = [item.lower() for item in self.header]
        lower = whole if name.lower() in whole else [name_and_unit(item)[0].lower() for item in self.header]
        if name.lower() not in lower:
            raise InputError(f"{self.name} has no column {shown(name)}; {did_you_mean(name, self.header)}")
        if lower.count(name.lower()) > 1:
            raise InputError(f"{self.name} has two columns {shown(name)}; each needs a name of its own")
        return lower.index(name.lower())


def read_table(data: bytes, file: str, export: str = "") -> Table:
    """Read the text of a table with a header line; `file` is its name within an `export`.

    Raises
    ------
    InputError
        For bytes that are no text, no header line, no row, or no table.
    """
    name = f"{export}: {shortened(file)}" if export and not export.endswith(file) else export or shortened(file)
    encodings = ("utf-8-sig", "utf-16") if data[:2] in (b"\xff\xfe", b"\xfe\xff") else ("utf-8-sig", "cp1252")
    encoding = next((item for item in encodings if _is_text(data, item)), None)
    if encoding is None:
        raise InputError(f"{name} is not text; a CSV file was expected")
    first = next((line for line in _lines(data, encoding, name) if line.strip("\r\n")), "")
    bare = re.sub(r'"[^"]*"', "", first)
    delimiter = next((sign for sign in ("\t", ";") if sign in bare), ",")
    rows = [row for _, row in itertools.islice(_rows(data, encoding, delimiter, name), 50)]
    if not rows:
        raise InputError(f"{name} is empty; a header line and rows of numbers were expected")
    header = tuple("".join(sign if sign.isprintable() else " " for sign in cell).strip() for cell in rows[0])
    if len(header) > MAX_COLUMNS:
        raise InputError(f"{name} has {len(header)} columns; at most {MAX_COLUMNS} were expected")
    units = units_row(rows[1], range(len(header))) if len(rows) > 1 else None
    if units is not None:
        header = tuple(f"{name_and_unit(own)[0]} [{unit}]" if unit else own for own, unit in zip(header, units, strict=True))
    decimal_comma = delimiter != "," and any(_DECIMAL_COMMA.match(cell.strip()) for row in rows[1:] for cell in row)
    return Table(name, file, header, data, encoding, delimiter, decimal_comma, units is not None)


def _text(data: bytes, encoding: str) -> io.TextIOWrapper:
    return io.TextIOWrapper(io.BytesIO(data), encoding=encoding, newline="")


def _lines(data: bytes, encoding: str, name: str) -> Iterator[str]:
    return without_comments(split_lines(_text(data, encoding), name))


def _is_text(data: bytes, encoding: str) -> bool:
    """Say whether bytes are text of this encoding, without holding it."""
    try:
        return not any("\0" in block for block in iter(partial(_text(data, encoding).read, 1 << 16), ""))
    except UnicodeDecodeError:
        return False


def _rows(data: bytes, encoding: str, delimiter: str, name: str) -> Iterator[tuple[int, list[str]]]:
    """Yield the line and the cells of every row that is not blank."""
    for line, row in csv_rows(_lines(data, encoding, name), name, delimiter):
        if any(cell.strip() for cell in row):
            yield line, row


@dataclass(frozen=True)
class ColumnMap:
    """Which columns of a plain CSV hold what; a column written `-name` counts with its sign reversed.

    Units are those of the headings, `az [g]`, where they are not stated; without either they are s, m/s^2, rad/s and m/s.
    """

    time: str
    acceleration: str
    pitch_rate: str | None = None
    speed: str | None = None
    time_unit: str | None = None
    acceleration_unit: str | None = None
    pitch_rate_unit: str | None = None
    speed_unit: str | None = None


ColumnMaps = ColumnMap | Sequence[ColumnMap] | None
"""Maps of one export or more: one for all of them, or one for each in their order; none where no export is a plain CSV."""


def maps_of_exports(columns: ColumnMaps, n_exports: int) -> list[ColumnMap | None]:
    """Return the map of each export; raises InputError where there are several, and not one for each."""
    if columns is None or isinstance(columns, ColumnMap):
        return [columns] * n_exports
    if len(columns) not in (1, n_exports):
        raise ArgumentError(
            f"{len(columns)} maps of columns and {n_exports} exports: give one for all, or one for each in the same order", "columns"
        )
    return [*columns] * (n_exports // len(columns))


def read_plain(table: Table, columns: ColumnMap | None) -> PhoneExport:
    """Read a plain CSV whose columns are named by a map.

    Raises
    ------
    InputError
        Without a map, for missing columns, and for units that do not fit.
    """
    if columns is None:
        shown = ", ".join(repr(item) for item in table.header[:12])
        message = f"{table.name} is of no app that vehgen knows (its columns: {shown}); say which columns are which with `columns`: "
        raise ArgumentError(f"{message}time=...,acceleration=...,pitch_rate=...", "columns")
    time = _times(table, columns)
    wanted = (
        (VERTICAL_ACCELERATION_STREAM, columns.acceleration, columns.acceleration_unit, ACCELERATION, "m/s^2"),
        (PITCH_RATE_STREAM, columns.pitch_rate, columns.pitch_rate_unit, FREQUENCY, "rad/s"),
        (SPEED_STREAM, columns.speed, columns.speed_unit, SPEED_DIMENSION, "m/s"),
    )
    streams = {}
    for name, column, unit, dimension, si in wanted:
        if column is not None:
            streams[name] = Stream(time, _in_si(table, column, unit, dimension, si)[:, None], (column,), si)
    return PhoneExport("plain CSV", streams)


def _times(table: Table, columns: ColumnMap) -> Array:
    """Return the times of a table's rows [s], `shape (n,)`, written as numbers or as moments."""
    reversed_sign = columns.time.startswith("-") and columns.time not in table.header
    form = None if reversed_sign else table.form_of_moments(table.find(columns.time))
    if form is not None:
        if columns.time_unit is not None:
            message = f"the column {shown(columns.time)} of {table.name} holds times of day, which have no unit; leave `time_unit` out"
            raise ArgumentError(message, "columns")
        return table.moments(table.find(columns.time), form)
    return _in_si(table, columns.time, columns.time_unit, TIME, "s")


def _in_si(table: Table, name: str, stated: str | None, dimension: Dimension, si: str) -> Array:
    """Return a column in its SI unit, `shape (n,)`, by the unit that is stated, else by its heading's."""
    reversed_sign = name.startswith("-") and name not in table.header
    index = table.find(name[1:] if reversed_sign else name)
    own = name_and_unit(table.header[index])[1]
    factor = unit_factor(stated or own or si, dimension, f"`columns` {name}")
    if stated is not None and own is not None and abs(unit_factor(own, dimension, f"`columns` {name}") / factor - 1) > SAME_UNIT:
        message = f"the heading {shown(table.header[index])} of {table.name} says {own}, `columns` {stated}; correct one of them"
        raise ArgumentError(message, "columns")
    return table.column(index) * (-factor if reversed_sign else factor)


def unit_factor(unit: str, dimension: Dimension, where: str) -> float:
    """Return the factor from a unit to SI; `g` is the standard acceleration where an acceleration is asked for, `ns` a nanosecond."""
    extra = {("ns", TIME): 1e-9, ("us", TIME): 1e-6}
    factor = extra.get((unit, dimension), factor_to_si(unit, dimension))
    if factor is None:
        parse_unit(unit)
        raise ArgumentError(f"{where}: expected a unit of {dimension}, found {shown(unit)}", "columns")
    return factor
