"""Columns of CSV files by name."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from vehgen.errors import InputError, Position, did_you_mean, shown
from vehgen.files import note_read


def read_columns(path: Path, names: tuple[str, ...]) -> tuple[NDArray[np.float64], ...]:
    """Read columns of a CSV file with a header line.

    Raises
    ------
    InputError
        For a missing file or column, and at the line and column of anything that is not a finite number.
    """
    note_read(path)
    try:
        with path.open(newline="", encoding="utf-8-sig") as stream:
            rows = list(csv.reader(stream))
    except FileNotFoundError as error:
        raise InputError(f"no file {path}") from error
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise InputError(f"{path} cannot be read as CSV: {error}") from error
    if len(rows) < 2:
        raise InputError("a header line and at least one line of numbers were expected", Position(path, 1, 1))
    header = [cell.strip() for cell in rows[0]]
    places = []
    for name in names:
        if name not in header:
            raise InputError(f"no column {shown(name)}; {did_you_mean(name, header)}", Position(path, 1, 1))
        places.append(header.index(name))
    columns = np.empty((len(places), len(rows) - 1))
    for line, row in enumerate(rows[1:], start=2):
        for index, place in enumerate(places):
            text = row[place].strip() if place < len(row) else ""
            try:
                columns[index, line - 2] = float(text)
            except ValueError:
                columns[index, line - 2] = np.nan
            if not np.isfinite(columns[index, line - 2]):
                raise InputError(f"{shown(text)} in column {shown(names[index])} is not a finite number", Position(path, line, place + 1))
    return tuple(columns)
