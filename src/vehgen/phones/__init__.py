"""What did the phone record? Exports of phones turned upright, put on one clock and written as a run file with its recording."""

from vehgen.phones.csv_table import ColumnMap
from vehgen.phones.detect import read_export
from vehgen.phones.export import EpochMap, PhoneExport, Stream
from vehgen.phones.importing import Imported, import_phones
from vehgen.phones.options import PhoneSensor, Plan, RoadOption
from vehgen.phones.resampling import resample
from vehgen.phones.run_text import write_import

__all__ = [
    "ColumnMap",
    "EpochMap",
    "Imported",
    "PhoneExport",
    "PhoneSensor",
    "Plan",
    "RoadOption",
    "Stream",
    "import_phones",
    "read_export",
    "resample",
    "write_import",
]
