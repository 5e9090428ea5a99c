"""Which frequencies a calibration or a diagnosis compares."""

from __future__ import annotations

from collections.abc import Sequence

from vehgen.errors import InputError
from vehgen.fit.trial import Trial

DIAGNOSIS_BAND_HZ = (0.5, 40.0)
"""What is compared [Hz] where the run files do not say: a vehicle's motions from heave to hop."""
CALIBRATION_BAND_HZ = (0.3, 40.0)
"""Frequencies that a calibration compares [Hz]: below, phones drift; above, anti-aliasing filters bite."""


def compared_band(trials: Sequence[Trial]) -> tuple[float, float]:
    """Return the `band` [Hz] of the run files, or DIAGNOSIS_BAND_HZ.

    Raises
    ------
    InputError
        Where run files disagree, or a band reaches beyond what a recording's sampling rate shows.
    """
    bands = {trial.name: trial.run.file.band or DIAGNOSIS_BAND_HZ for trial in trials}
    (first, band), *rest = bands.items()
    for name, other in rest:
        if other != band:
            raise InputError(f"{first} is to be compared from {_words(band)}, {name} from {_words(other)}: give all runs one `band`")
    for trial in trials:
        nyquist = 0.5 / trial.recording.dt
        if trial.run.file.band is not None and band[1] > nyquist:
            place = trial.run.document.find(("band",))
            raise InputError(f"`band` ends at {band[1]:g} Hz, but {trial.name} was sampled for {nyquist:.4g} Hz at most", place)
    return band


def _words(band: tuple[float, float]) -> str:
    return f"{band[0]:g} to {band[1]:g} Hz"
