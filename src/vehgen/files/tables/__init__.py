"""How is a table read? By its columns' names, with their units and the place of every number, whatever wrote it.

One file a format: CSV in any dialect, Parquet, Excel, MDF 4, UFF 58, MATLAB, GPX and NMEA; all give the same columns.
"""

from vehgen.files.tables.columns import LARGEST_MEASURED, MAX_TABLE_BYTES, MAX_TABLE_NUMBERS, TableColumns
from vehgen.files.tables.reading import read_columns

__all__ = ["LARGEST_MEASURED", "MAX_TABLE_BYTES", "MAX_TABLE_NUMBERS", "TableColumns", "read_columns"]
