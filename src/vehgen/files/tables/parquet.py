"""Parquet files: columns with their units in the metadata of their fields (`unit`) or in brackets in their names."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import closing
from pathlib import Path
from typing import Any

from vehgen.errors import InputError, Position
from vehgen.files.tables.columns import MAX_TABLE_BYTES, TableColumns
from vehgen.files.tables.foreign import faults_of, library
from vehgen.files.tables.sheet import Sheet, check_size

PARQUET_KIND = "a Parquet file"
_UNIT_KEYS = (b"unit", b"units")


def read(path: Path, names: tuple[str, ...]) -> TableColumns:
    """Read columns of a Parquet file; raises InputError for one that is damaged, and as :meth:`Sheet.select`."""
    parquet = library("pyarrow.parquet", "tables", path)
    with faults_of(path, PARQUET_KIND):
        file = parquet.ParquetFile(str(path), memory_map=False)
    with closing(file):
        with faults_of(path, PARQUET_KIND):
            fields = [file.schema_arrow.field(i) for i in range(len(file.schema_arrow.names))]
            groups = [file.metadata.row_group(i) for i in range(file.metadata.num_row_groups)]
        headings, units = tuple(str(field.name) for field in fields), tuple(_unit(field.metadata) for field in fields)
        n_rows = int(file.metadata.num_rows)
        check_size(path, n_rows, len(names))
        _check_unpacked(path, groups)

        def column(index: int) -> Any:
            with faults_of(path, PARQUET_KIND):
                return file.read(columns=[headings[index]]).column(0).to_numpy(zero_copy_only=False)

        return Sheet(path, headings, units, column, n_rows).select(names)


def _unit(metadata: Any) -> str | None:
    found = next((metadata[key] for key in _UNIT_KEYS if metadata and key in metadata), None)
    return None if found is None else found.decode("utf-8", "replace")


def _check_unpacked(path: Path, groups: Sequence[Any]) -> None:
    """Refuse what would unpack to more than any table."""
    size = sum(int(group.total_byte_size) for group in groups)
    if not 0 <= size <= 10 * MAX_TABLE_BYTES:
        raise InputError(f"the table would unpack to {size} bytes; at most {10 * MAX_TABLE_BYTES} were expected", Position(path, 1, 1))
