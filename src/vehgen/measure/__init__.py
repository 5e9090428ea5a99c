"""What was recorded? Recordings of runs and how good they are, spectra in one convention, band RMS, standard spectra."""

from vehgen.measure.astm import SPECTRA, Spectrum
from vehgen.measure.bands import ARTICULATED_BANDS, TWO_AXLE_BANDS, band_rms, relative_errors
from vehgen.measure.recording import RecordedChannel, Recording, read_recording
from vehgen.measure.spectra import record_psd, welch_psd

__all__ = [
    "ARTICULATED_BANDS",
    "SPECTRA",
    "TWO_AXLE_BANDS",
    "RecordedChannel",
    "Recording",
    "Spectrum",
    "band_rms",
    "read_recording",
    "record_psd",
    "relative_errors",
    "welch_psd",
]
