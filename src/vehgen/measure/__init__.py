"""What was recorded: recordings, spectra, band RMS, and phone exports turned into recordings."""

from vehgen.measure.astm import SPECTRA, Spectrum
from vehgen.measure.bands import ARTICULATED_BANDS, TWO_AXLE_BANDS, band_rms, relative_errors
from vehgen.measure.csv_table import ColumnMap, read_column_map
from vehgen.measure.detect import read_export
from vehgen.measure.export import EpochMap, PhoneExport, Stream
from vehgen.measure.importing import Imported, import_phones
from vehgen.measure.measurement import MeasuredChannel, Measurement, read_measurement
from vehgen.measure.options import PhoneSensor, Plan, RoadOption, read_hump, read_profile, read_sensor
from vehgen.measure.resampling import resample
from vehgen.measure.run_text import write_import
from vehgen.measure.spectra import record_psd, welch_psd

__all__ = [
    "ARTICULATED_BANDS",
    "SPECTRA",
    "TWO_AXLE_BANDS",
    "ColumnMap",
    "EpochMap",
    "Imported",
    "MeasuredChannel",
    "Measurement",
    "PhoneExport",
    "PhoneSensor",
    "Plan",
    "RoadOption",
    "Spectrum",
    "Stream",
    "band_rms",
    "import_phones",
    "read_column_map",
    "read_export",
    "read_hump",
    "read_measurement",
    "read_profile",
    "read_sensor",
    "record_psd",
    "relative_errors",
    "resample",
    "welch_psd",
    "write_import",
]
