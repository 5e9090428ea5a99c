"""Which app an export came from, recognised by its headers and first bytes, never by file names: those of the apps collide."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path, PurePosixPath

from vehgen.errors import ArgumentError, InputError, shown
from vehgen.phones.archive import read_members
from vehgen.phones.csv_table import ColumnMap, Table, read_plain, read_table
from vehgen.phones.export import PhoneExport
from vehgen.phones.matlab import is_matlab, read_matlab
from vehgen.phones.phyphox import is_phyphox, read_phyphox
from vehgen.phones.sensor_logger import is_sensor_logger, read_sensor_logger


def read_export(path: str | Path, columns: ColumnMap | None = None) -> PhoneExport:
    """Read what a phone exported: a zip, a folder, a CSV file, an Excel workbook or a MATLAB file.

    Parameters
    ----------
    path
        The export.
    columns
        Which columns are which, for a plain table of no known app.

    Raises
    ------
    InputError
        For what cannot be read, and for what is of no known app where `columns` does not help.
    """
    path = Path(path)
    if is_matlab(path):
        return read_matlab(path)
    tables: list[Table] = []
    refused: list[InputError] = []
    for name, data in read_members(path).items():
        try:
            tables.append(read_table(data, name, str(path)))
        except InputError as error:
            refused.append(error)
    if not tables:
        raise refused[0]
    for is_of, read in ((is_sensor_logger, read_sensor_logger), (is_phyphox, read_phyphox)):
        if own := [table for table in tables if is_of(table)]:
            _check_one_recording(path, [table.file for table in own])
            return _with_passed_over(read(own), refused)
    if len(tables) > 1 and columns is not None:
        raise ArgumentError(f"{path} holds {len(tables)} tables; with `columns`, give the one table", "columns")
    return read_plain(tables[0], columns)


def _check_one_recording(path: Path, members: Iterable[str]) -> None:
    """Refuse files of one name in two folders: exports of two recordings, whose samples would be mixed."""
    known: dict[str, str] = {}
    for name in members:
        other = known.setdefault(PurePosixPath(name).name.lower(), name)
        if other != name:
            raise InputError(f"{path} holds {shown(other)} and {shown(name)}: the export of one recording was expected")


def _with_passed_over(export: PhoneExport, refused: list[InputError]) -> PhoneExport:
    """Return an export without streams that hold nothing, and with a note of these and of each file that could not be read."""
    empty = [name for name, stream in export.streams.items() if not len(stream.time)]
    notes = [f"no sample of {name.replace('_', ' ')} was recorded" for name in empty]
    notes += [f"a file was passed over: {error}" for error in refused]
    kept = {name: stream for name, stream in export.streams.items() if name not in empty}
    return replace(export, streams=kept, notes=(*export.notes, *notes))
