"""Which frequencies a calibration or a diagnosis compares."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import scipy

from vehgen.errors import InputError
from vehgen.fit.trial import Trial

DIAGNOSIS_BAND_HZ = (0.5, 40.0)
"""What is compared [Hz] where the run files do not say: a vehicle's motions from heave to hop."""
CALIBRATION_BAND_HZ = (0.3, 40.0)
"""Frequencies that a calibration compares [Hz]: below, phones drift; above, anti-aliasing filters bite."""
SLOW_SHARE = 0.1
"""A rig moves slowly where more than this share of what a channel recorded lies below DIAGNOSIS_BAND_HZ ..."""
SLOWEST_CYCLES = 0.6
"""... and is then compared from so many cycles a recording on."""


def compared_band(trials: Sequence[Trial]) -> tuple[float, float]:
    """Return the `band` [Hz] of the run files, or DIAGNOSIS_BAND_HZ, which begins lower for a rig that moves slowly.

    Raises
    ------
    InputError
        Where run files disagree, or a band reaches beyond what a recording's sampling rate shows.
    """
    usual = (min(map(_slowest, trials)), DIAGNOSIS_BAND_HZ[1])
    bands = {trial.name: trial.run.file.band or usual for trial in trials}
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


def _slowest(trial: Trial) -> float:
    """Return from which frequency on a run is compared where its file does not say [Hz]."""
    if trial.scenario.track.parts:
        return DIAGNOSIS_BAND_HZ[0]
    values = scipy.signal.detrend(trial.recording.values, axis=0)
    power = np.abs(np.fft.rfft(values, axis=0)) ** 2
    slow = np.fft.rfftfreq(len(values), trial.recording.dt) < DIAGNOSIS_BAND_HZ[0]
    share = power[slow].sum(axis=0) / np.maximum(power.sum(axis=0), 1e-300)
    return SLOWEST_CYCLES / (len(values) * trial.recording.dt) if share.max() > SLOW_SHARE else DIAGNOSIS_BAND_HZ[0]


def _words(band: tuple[float, float]) -> str:
    return f"{band[0]:g} to {band[1]:g} Hz"
