"""What did the phone record? Exports of phones turned upright, put on one clock and written as a run file with its recording."""

from vehgen.phones.api import import_phones
from vehgen.phones.csv_table import ColumnMap
from vehgen.phones.detect import read_export
from vehgen.phones.export import EpochMap, PhoneExport, Stream
from vehgen.phones.importing import Imported, read_pass
from vehgen.phones.plan import PhoneSensor, Plan, RoadOption
from vehgen.phones.resampling import resample
from vehgen.phones.result import PhoneImport
from vehgen.phones.run_text import write_import

__all__ = [
    "ColumnMap",
    "EpochMap",
    "Imported",
    "PhoneExport",
    "PhoneImport",
    "PhoneSensor",
    "Plan",
    "RoadOption",
    "Stream",
    "import_phones",
    "read_export",
    "read_pass",
    "resample",
    "write_import",
]
