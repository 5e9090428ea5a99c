"""Logs of MATLAB Mobile: sensorlog_*.mat with the timetables Acceleration, AngularVelocity (X, Y, Z) and Position (speed).

MATLAB stores timetables in a way that scipy.io cannot read; the optional package mat-io can (`pip install 'vehgen[matlab]'`).
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vehgen.errors import InputError
from vehgen.files.reading import open_regular
from vehgen.files.tables.foreign import faults_of, library
from vehgen.files.tables.matlab import MATLAB_KIND, VERSION_5, check_unpacked
from vehgen.phones.archive import MAX_FILE, MAX_TOTAL
from vehgen.phones.export import ROTATION_STREAM, SPEED_STREAM, EpochMap, PhoneExport, Stream, acceleration_kind

_MARKS = (VERSION_5, b"MATLAB 7.3 MAT-file", b"\x89HDF")
_TABLES = ("Acceleration", "AngularVelocity", "Position")


def is_matlab(path: Path) -> bool:
    """Say whether a file begins as MATLAB's files do."""
    try:
        with open_regular(path, MAX_FILE) as stream:
            return stream.read(19).startswith(_MARKS)
    except (InputError, OSError):  # what cannot be read is no MATLAB file; the reader that comes next says why
        return False


def read_matlab(path: Path) -> PhoneExport:
    """Read a log of MATLAB Mobile.

    Raises
    ------
    InputError
        Without mat-io, for a file that it cannot read, and for one without acceleration.
    """
    check_unpacked(path, MAX_FILE, MAX_TOTAL)
    matio = library("matio", "matlab", path)
    with faults_of(path, MATLAB_KIND):
        found: dict[str, Any] = matio.load_from_mat(str(path), variable_names=list(_TABLES))
    tables = {name: found[name] for name in _TABLES if hasattr(found.get(name), "columns")}
    if "Acceleration" not in tables:
        raise InputError(f"{path} holds no timetable Acceleration; turn the sensor on in MATLAB Mobile and log again")
    clocks = {name: _clock(table, f"{path}: {name}") for name, table in tables.items()}
    zero = min(float(clock[0]) for clock in clocks.values())
    values = _columns(tables["Acceleration"], ("X", "Y", "Z"), f"{path}: Acceleration")
    streams = {acceleration_kind(values): Stream(clocks["Acceleration"] - zero, values, ("x", "y", "z"), "m/s^2")}
    if "AngularVelocity" in tables:
        rates = _columns(tables["AngularVelocity"], ("X", "Y", "Z"), f"{path}: AngularVelocity")
        streams[ROTATION_STREAM] = Stream(clocks["AngularVelocity"] - zero, rates, ("x", "y", "z"), "rad/s")
    if "Position" in tables:
        speed = _columns(tables["Position"], ("speed",), f"{path}: Position")
        streams[SPEED_STREAM] = Stream(clocks["Position"] - zero, speed, ("speed",), "m/s")
    epoch = EpochMap(np.array([0.0]), np.array([zero])) if zero > 1e9 else None
    note = "MATLAB Mobile stamps without a time zone: clocks of phones in different zones differ by hours"
    return PhoneExport("MATLAB Mobile", streams, epoch, (note,) if epoch else ())


def _clock(table: Any, name: str) -> NDArray[np.float64]:
    stamps = np.asarray(table.index)
    if stamps.dtype.kind not in "mM" or not len(stamps):  # mat-io may hand the row times on as the first column
        stamps = np.asarray(table.iloc[:, 0])
    if stamps.dtype.kind not in "mM" or not len(stamps):
        raise InputError(f"{name} has no row times; a timetable was expected")
    return np.asarray(stamps.astype(stamps.dtype.str[:2] + "8[ns]").astype(np.int64) * 1e-9)


def _columns(table: Any, names: tuple[str, ...], where: str) -> NDArray[np.float64]:
    known = {str(column).lower(): column for column in table.columns}
    for name in names:
        if name.lower() not in known:
            raise InputError(f"{where} lacks the column {name}; found {', '.join(map(str, table.columns))}")
    try:
        return np.column_stack([np.asarray(table[known[name.lower()]], dtype=np.float64) for name in names])
    except (TypeError, ValueError) as error:
        raise InputError(f"{where} holds what is no number") from error
