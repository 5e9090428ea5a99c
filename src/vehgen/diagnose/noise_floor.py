"""How loud is nothing? The noise of every channel, from the quiet lead-in of hump runs and from the top of the band.

The lead-in is what a run recorded before its first wheel met the hump. Where its noise is more than DIFFERENT times that of the top of the
band, something shakes the vehicle that is no noise (an engine's line, say), and the top of the band is believed. A recording of what the
vehicle does over a rough road has no quiet stretch; it takes the noise of the others, or that of the top of its band.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from vehgen.identify.misfit import Noises
from vehgen.identify.noise import EVEN, SMALLEST_LEVEL, Noise, estimate_noise, road_answer, transform
from vehgen.identify.objective import BAND
from vehgen.identify.trial import Trial
from vehgen.measure import record_psd
from vehgen.road import Hump

Array = NDArray[np.float64]
SHORTEST = 0.8
"""A lead-in shorter than this [s] tells nothing."""
MARGIN = 0.1
"""How long before the hump the lead-in ends [s]."""
TOP = (41.0, 47.0)
"""The top of the band [Hz]."""
DIFFERENT = 1.3


@dataclass(frozen=True)
class NoiseFloor:
    """Noise by set of channels, the lead-in's `sigma` before the top of the band corrected it, and the channels where it did."""

    noises: Noises
    lead_in: dict[str, float]
    top: dict[str, float]
    corrected: tuple[str, ...]


def find_noise_floor(trials: Sequence[Trial], band: tuple[float, float] = BAND) -> NoiseFloor:
    """Return the noise of all channels."""
    noises: Noises = {}
    lead, top, corrected = {}, {}, []
    for channels in dict.fromkeys(trial.channels for trial in trials):
        group = [trial for trial in trials if trial.channels == channels]
        quiet = [part for trial in group if (part := lead_in(trial)) is not None]
        loud = np.array([top_of_band(part) for part in (quiet or group)])
        weight = np.array([len(part.measurement.time) for part in (quiet or group)], dtype=np.float64)
        sigma = np.sqrt((loud**2 * weight[:, None]).sum(axis=0) / weight.sum())
        noise = Noise(EVEN, sigma)
        if quiet:
            noise = _from_lead_in(quiet, sigma, band)
            for i, channel in enumerate(channels):
                lead[channel] = float(noise.sigma[i])
                if noise.sigma[i] > DIFFERENT * sigma[i]:
                    corrected.append(channel)
            noise = Noise(noise.levels, np.where(noise.sigma > DIFFERENT * sigma, sigma, noise.sigma))
        noises[channels] = noise
        top |= {channel: float(value) for channel, value in zip(channels, sigma, strict=True)}
    return NoiseFloor(noises, lead, top, tuple(corrected))


def _from_lead_in(quiet: Sequence[Trial], sigma: Array, band: tuple[float, float]) -> Noise:
    residuals = []
    for part in quiet:
        frequency = np.asarray(np.fft.rfftfreq(len(part.measurement.time), part.measurement.dt), dtype=np.float64)
        inside = (frequency >= max(band[0], 1.0)) & (frequency <= band[1])
        lines = transform(part.measurement.values - part.measurement.values.mean(axis=0), part.measurement.dt, inside)
        residuals.append((lines, road_answer(part, frequency[inside], part.values)))
    return estimate_noise(residuals, Noise(np.full(len(EVEN), 100 * SMALLEST_LEVEL), sigma))


def lead_in(trial: Trial) -> Trial | None:
    """Return what a run recorded before its first wheel met the first hump, or None where that is too short or unknown."""
    humps = [part for part in trial.scenario.track.parts if isinstance(part, Hump)]
    if not humps or len(humps) < len(trial.scenario.track.parts):
        return None
    first = min(hump.at for hump in humps) - trial.scenario.track.footprint
    time = trial.measurement.time
    quiet = trial.scenario.speed.distance(time + MARGIN) < first
    count = int(quiet.sum())
    if count * trial.measurement.dt < SHORTEST:
        return None
    measurement = replace(trial.measurement, time=time[:count], values=trial.measurement.values[:count])
    return replace(trial, measurement=measurement)


def top_of_band(trial: Trial) -> Array:
    """Return the standard deviation of white noise that the top of the band shows, `shape (n_channels,)`."""
    frequency, density = record_psd(trial.measurement.values, trial.measurement.dt, axis=0)
    inside = (frequency >= TOP[0]) & (frequency <= TOP[1])
    # the median of an exponential variable is ln 2 of its mean; it forgives a line within the band
    return np.asarray(np.sqrt(np.median(density[inside], axis=0) / np.log(2) / (2 * trial.measurement.dt)))
