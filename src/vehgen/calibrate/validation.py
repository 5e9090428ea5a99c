"""Validation: simulated against measured on runs that took no part in the calibration."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from vehgen.errors import InputError
from vehgen.fit.trial import Trial
from vehgen.measure import ARTICULATED_BANDS, TWO_AXLE_BANDS, band_rms, record_psd, relative_errors, welch_psd

Array = NDArray[np.float64]
Bands = tuple[tuple[float, float], ...]
SEGMENT = 4.0
"""Length of Welch's segments [s], for runs over rough roads."""
LOUD = 2.0
NOISE_BAND_SHARES = (0.82, 0.94)
"""The top of the band, as shares of the highest frequency."""
LONGEST_RECORD = 3.0
"""A run without a hump that is longer than this many segments is averaged by Welch's method."""


@dataclass(frozen=True)
class ChannelComparison:
    """One channel of one run, measured against simulated.

    `frequency shape (n,)` [Hz], `measured_psd` and `simulated_psd shape (n,)` [unit^2/Hz]; `measured_rms`, `simulated_rms`, `errors` `shape
    (n_bands,)`, errors as Eq. 32 of Wu & Li 2023; `audible` says in which bands the measured RMS stands LOUD times above the noise that the
    top of the band shows: errors elsewhere compare with noise. `time`, `measured`, `simulated` are the histories.
    """

    run: str
    channel: str
    quantity: str
    frequency: Array
    measured_psd: Array
    simulated_psd: Array
    measured_rms: Array
    simulated_rms: Array
    errors: Array
    audible: NDArray[np.bool_]
    time: Array
    measured: Array
    simulated: Array


@dataclass(frozen=True)
class Validation:
    """All channels of all runs, in bands [Hz]."""

    bands: Bands
    channels: tuple[ChannelComparison, ...]

    @property
    def worst(self) -> float:
        """The largest magnitude of a relative band-RMS error of an acceleration, in bands above the noise."""
        errors = [np.abs(item.errors[item.audible]) for item in self.channels if item.quantity == "acceleration"]
        every = np.concatenate(errors) if errors else np.zeros(0)
        return float(np.nanmax(every)) if every.size else float("nan")


def validate(trials: Sequence[Trial], bands: Bands | None = None) -> Validation:
    """Compare simulated with measured on every channel.

    Runs over rough roads are compared by Welch's PSD, hump runs as one record. The vehicle's own values are used: calibrate writes a
    vehicle file that holds them.

    Parameters
    ----------
    trials
        Runs with recordings.
    bands
        Frequency bands [Hz] (default: the paper's, for two axles or for articulated vehicles).
    """
    if bands is None:
        articulated = bool(trials[0].run.vehicle.hinges)
        bands = ARTICULATED_BANDS if articulated else TWO_AXLE_BANDS[:5]
    found = []
    for trial in trials:
        model = trial.simulator.model
        population = np.array([[trial.values[name] for name in model.parameters]])
        result = trial.simulator.run(population, trial.scenario)
        if result.failures:
            raise InputError(f"{trial.name}: {result.failures[0]}")
        rough = not any(entry.hump is not None for entry in trial.run.file.road)
        dt = trial.recording.dt
        for i, channel in enumerate(trial.recording.channels):
            measured, simulated = trial.recording.values[:, i], result.responses[0, :, i]
            densities = []
            for values in (measured, simulated):
                averaged = rough and len(values) * dt > LONGEST_RECORD * SEGMENT
                frequency, density = welch_psd(values, dt, SEGMENT) if averaged else record_psd(values, dt)
                densities.append(density)
            rms = [band_rms(frequency, density, bands) for density in densities]
            found.append(
                ChannelComparison(
                    run=trial.name,
                    channel=channel.name,
                    quantity=channel.quantity,
                    frequency=frequency,
                    measured_psd=densities[0],
                    simulated_psd=densities[1],
                    measured_rms=rms[0],
                    simulated_rms=rms[1],
                    errors=relative_errors(rms[1], rms[0]),
                    audible=rms[0] > LOUD * _noise_rms(frequency, densities[0], bands),
                    time=trial.recording.time,
                    measured=measured,
                    simulated=simulated,
                )
            )
    return Validation(bands, tuple(found))


def _noise_rms(frequency: Array, density: Array, bands: Bands) -> Array:
    """Return the RMS that white noise of the level at the top of the band would have in bands, `shape (n_bands,)`."""
    inside = (frequency >= NOISE_BAND_SHARES[0] * frequency[-1]) & (frequency <= NOISE_BAND_SHARES[1] * frequency[-1])
    level = float(np.median(density[inside]) / np.log(2))
    return np.sqrt(level * np.array([high - low for low, high in bands]))
