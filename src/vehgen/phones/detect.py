"""Which app an export came from, recognised by its headers and first bytes, never by file names: those of the apps collide."""

from __future__ import annotations

from pathlib import Path

from vehgen.errors import ArgumentError, InputError
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
    if any(is_sensor_logger(table) for table in tables):
        return read_sensor_logger([table for table in tables if is_sensor_logger(table)])
    if any(is_phyphox(table) for table in tables):
        return read_phyphox([table for table in tables if is_phyphox(table)])
    if len(tables) > 1 and columns is not None:
        raise ArgumentError(f"{path} holds {len(tables)} tables; with `columns`, give the one table", "columns")
    return read_plain(tables[0], columns)
