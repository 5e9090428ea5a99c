"""How is it measured? What a recorder makes of a motion, the quality of its channels, spectra in one convention, band RMS, standards."""

from vehgen.measure.astm import SPECTRA, Spectrum
from vehgen.measure.bands import ARTICULATED_BANDS, TWO_AXLE_BANDS, band_rms, relative_errors
from vehgen.measure.spectra import record_psd, welch_psd

__all__ = [
    "ARTICULATED_BANDS",
    "SPECTRA",
    "TWO_AXLE_BANDS",
    "Spectrum",
    "band_rms",
    "record_psd",
    "relative_errors",
    "welch_psd",
]
