"""What was recorded? Recordings of runs, spectra in one convention, band RMS, standard spectra."""

from vehgen.measure.astm import SPECTRA, Spectrum
from vehgen.measure.bands import ARTICULATED_BANDS, TWO_AXLE_BANDS, band_rms, relative_errors
from vehgen.measure.recording import MeasuredChannel, Measurement, read_measurement
from vehgen.measure.spectra import record_psd, welch_psd

__all__ = [
    "ARTICULATED_BANDS",
    "SPECTRA",
    "TWO_AXLE_BANDS",
    "MeasuredChannel",
    "Measurement",
    "Spectrum",
    "band_rms",
    "read_measurement",
    "record_psd",
    "relative_errors",
    "welch_psd",
]
