"""How loud is nothing? The noise of every channel, from the quiet lead-in of hump runs and from the top of the band.

The lead-in is what a run recorded before its first wheel met the hump. Where its noise is more than DIFFERENT times that of the top of the
band, something shakes the vehicle that is no noise (an engine's line, say), and the top of the band is believed. Sensors' noise passes a
recorder's low-pass, too: what that takes off the top of the band is put back first. A recording of what the vehicle does over a rough road
has no quiet stretch; it takes the noise of the others, or that of the top of its band. Noise that the run files state is believed before
any of this.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy
from numpy.typing import NDArray

from vehgen.diagnose.fits.model_fit import NUISANCES, ModelFit
from vehgen.fit.band import CALIBRATION_BAND_HZ
from vehgen.fit.lead_in import lead_in
from vehgen.fit.misfit import Noises
from vehgen.fit.noise import COLOUR_AT, EVEN, LOUDER_HZ, SMALLEST_LEVEL, Noise, estimate_noise
from vehgen.fit.road_answer import RoadAnswer, road_answer
from vehgen.fit.trial import Trial
from vehgen.fit.window import transform
from vehgen.measure import record_psd

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
TOP_BAND_RATIO = (1.025, 1.175)
"""The top of the band lies just above what is compared: so many times its highest frequency (41 to 47 Hz above 40 Hz)."""
END_OF_BAND = 0.75
"""The end of the band, beside its top, begins at this share of its highest frequency."""
CLEARLY_CUT = 2.0
"""A recorder's low-pass takes noise off the top of the band where that has less than the end by so many standard deviations."""
DIFFERENT = 1.3
SLOPES = (0.0, 0.25, 0.5, 0.75, 1.0, 1.5)
"""Slopes of coloured noise that are tried."""
COLOURED = 12.0
"""Gain in -2 ln of the likelihood of the lead-ins beyond which noise counts as coloured."""
SITES_DIFFER = 1.0
"""Standard deviation of the logarithm of how much rougher one run's site is than the others'."""
LEAST = 0.5
"""A lead-in that tells of less than this share of what its own top of the band shows has let the road's roughness take the noise."""
CLEARLY_LOUDER = 3.0
"""Lead-ins are louder than their noise where their power in a band is so many standard deviations above it."""
LINE_STANDS_OUT = 20.0
"""A spectral line of more than so many times the median power of its band is none of them."""
SAME_SQUARES, SAME_SHIFT = 0.1, 10.0
"""Noises are the same by which what a fit leaves of a run has mean squares whose logarithms differ by less, and whose shifts differ by a
smaller sum of squares, in units of the noise.
"""
LARGEST_RATIO = 4.0
"""The top of the band of a loud run may hold its motion too: it counts at most this much more than the lead-in's variance."""


@dataclass(frozen=True)
class NoiseFloor:
    """Noise by run (`quiet`: as the lead-ins show it, before any fit).

    What the lead-in (`lead`) and the top of the band (`top`) say of each `run: channel`, and where they disagree.
    """

    noises: Noises
    lead: dict[str, float]
    top: dict[str, float]
    corrected: tuple[str, ...]
    quiet: Noises


def find_noise_floor(trials: Sequence[Trial], band: tuple[float, float] = CALIBRATION_BAND_HZ) -> NoiseFloor:
    """Return the noise of all runs.

    A channel's variance is taken as a + b rms^2 over the runs, a >= 0 and b >= 0: what a phone adds by itself, and what grows with what
    it records. One run alone has the variance that it shows.
    """
    noises: Noises = {}
    lead: dict[str, float] = {}
    top: dict[str, float] = {}
    corrected: list[str] = []
    for channels in dict.fromkeys(trial.channels for trial in trials):
        group = [trial for trial in trials if trial.channels == channels]
        quiet = [part for trial in group if (part := lead_in(trial)) is not None]
        rough = np.sqrt(np.mean([top_of_band(part, band) ** 2 for part in (quiet or group)], axis=0))
        shared = _coloured(quiet, rough, band) if quiet else Noise(EVEN, rough)
        colour = (sum(TOP_BAND_RATIO) / 2 * band[1] / COLOUR_AT) ** (shared.slope / 2) / np.sqrt(_kept_at_top(quiet, shared, band))
        variance, weight = np.zeros((len(group), len(channels))), np.zeros((len(group), len(channels)))
        for i, trial in enumerate(group):
            high = colour * top_of_band(trial, band)
            part = lead_in(trial)
            low = None
            if part is not None:
                found = _from_lead_in([part], high, band, shared.slope, shared.levels)[0].sigma
                own = colour * top_of_band(part, band)
                low = np.where(found < LEAST * own, own, found)
            for j, channel in enumerate(channels):
                name = f"{trial.name}: {channel}"
                top[name] = float(high[j])
                duration = trial.recording.dt * len(trial.recording.time)
                variance[i, j], weight[i, j] = high[j] ** 2, (TOP_BAND_RATIO[1] - TOP_BAND_RATIO[0]) * band[1] * duration / 2
                if low is not None and part is not None:
                    lead[name] = float(low[j])
                    if low[j] > DIFFERENT * high[j]:
                        corrected.append(name)
                    else:
                        lines = (band[1] - band[0]) * part.recording.dt * len(part.recording.time)
                        both = weight[i, j] + lines
                        variance[i, j] = (min(variance[i, j], LARGEST_RATIO * low[j] ** 2) * weight[i, j] + low[j] ** 2 * lines) / both
                        weight[i, j] = both
        power = np.array([np.mean(trial.recording.values**2, axis=0) for trial in group])
        stated = np.array([[channel.noise or np.nan for channel in trial.recording.channels] for trial in group])
        sigma = np.where(np.isnan(stated), np.sqrt(_smooth(variance, weight, power)), stated)
        for i, trial in enumerate(group):
            own_noise = Noise(shared.levels, sigma[i], shared.slope if np.isnan(stated).any() else 0.0)
            noises[trial.name] = _with_own_level(lead_in(trial), own_noise, band)
        if quiet:
            louder = _louder([(part, noises[part.name]) for part in quiet], band)
            noises |= {trial.name: replace(noises[trial.name], louder=louder) for trial in group}
    return NoiseFloor(noises, lead, top, tuple(corrected), noises)


def _kept_at_top(quiet: Sequence[Trial], noise: Noise, band: tuple[float, float]) -> float:
    """Return the share of the noise's power that a recorder's low-pass leaves at the top of a band; 1 where it clearly takes nothing off.

    The lead-ins tell it: their power at the top over that at the end of the band below, both over what their noise has there.
    """
    found: list[tuple[Array, Array]] = []
    for part in quiet:
        lines, answer = lead_in_lines(part, (END_OF_BAND * band[1], TOP_BAND_RATIO[1] * band[1]))
        power = _power_over_noise(lines, answer, noise)
        found.append((power[answer.frequency >= TOP_BAND_RATIO[0] * band[1]], power[answer.frequency <= band[1]]))
    top, end = (np.concatenate([np.zeros(0), *(item[i].ravel() for item in found)]) for i in range(2))
    if not len(top) or not len(end):
        return 1.0
    kept = float(_usual(top) / _usual(end))
    error = kept * float(np.sqrt(1 / len(top) + 1 / len(end)))
    return kept if kept + CLEARLY_CUT * error < 1 else 1.0


def _power_over_noise(lines: Complex, answer: RoadAnswer, noise: Noise) -> Array:
    """Return the power of lines over what noise has of it, `shape (n, n_channels)`."""
    return np.asarray(np.abs(lines) ** 2 / np.diagonal(noise.density(answer), axis1=1, axis2=2).real)


def _usual(power: Array) -> Array:
    """Return the mean power of lines, `shape (n, ...)`, without those that stand out: an engine's line is no noise."""
    return np.asarray(np.mean(power, axis=0, where=power <= LINE_STANDS_OUT * np.median(power, axis=0)))


def _louder(quiet: Sequence[tuple[Trial, Noise]], band: tuple[float, float]) -> Array | None:
    """Return how much louder lead-ins are than their noise has them, `shape (len(LOUDER_HZ), n_channels)`; None where they are not.

    Laws make harmonics: what a rough road makes of a vehicle with laws is no answer of a linear one.
    """
    frequency, power = [], []
    for part, noise in quiet:
        lines, answer = lead_in_lines(part, band)
        frequency.append(answer.frequency)
        power.append(_power_over_noise(lines, answer, noise))
    number, powers = np.searchsorted(LOUDER_HZ, np.concatenate(frequency), side="right") - 1, np.concatenate(power)
    found = np.ones((len(LOUDER_HZ), powers.shape[1]))
    for i in range(len(LOUDER_HZ)):
        inside = powers[number == i]
        if len(inside):
            usual = _usual(inside)
            found[i] = np.where(usual > 1 + CLEARLY_LOUDER / np.sqrt(len(inside)), usual, 1.0)
    return found if found.max() > 1 else None


def _with_own_level(part: Trial | None, noise: Noise, band: tuple[float, float]) -> Noise:
    """Return a run's noise with the roughness that its own lead-in shows, as so many times that of all runs: sites differ."""
    if part is None or np.all(noise.levels <= 2 * SMALLEST_LEVEL):
        return noise
    lines, answer = lead_in_lines(part, band)

    def loss(log_factor: float) -> float:
        return noise.rougher(float(np.exp(log_factor))).loss(lines, answer) + (log_factor / SITES_DIFFER) ** 2

    found = scipy.optimize.minimize_scalar(loss, bounds=(-3.0, 3.0), method="bounded", options={"xatol": 0.05})
    return noise.rougher(float(np.exp(found.x)))


def lead_in_lines(part: Trial, band: tuple[float, float]) -> tuple[Complex, RoadAnswer]:
    """Return the spectral lines within a band [Hz] of a lead-in without its mean, and the road's way into them; none that is no noise."""
    frequency = np.asarray(np.fft.rfftfreq(len(part.recording.time), part.recording.dt), dtype=np.float64)
    inside = (frequency >= max(band[0], 1.0)) & (frequency <= band[1]) & part.beside_lines(frequency)
    lines = transform(part.recording.values - part.recording.values.mean(axis=0), part.recording.dt, inside)
    return lines, road_answer(part, frequency[inside], part.values, NUISANCES.speed_spread(part))


def _smooth(variance: Array, weight: Array, power: Array) -> Array:
    """Return variances a + b power, a, b >= 0, by least squares of relative errors; all `shape (n_runs, n_channels)`.

    None is less than the quietest run shows: where louder runs hold harmonics, b alone would fit them, and leave a quiet run no noise.
    """
    if len(variance) < 3:
        return variance
    found = np.empty_like(variance)
    for j in range(variance.shape[1]):
        scale = np.sqrt(weight[:, j]) / variance[:, j]
        columns = np.column_stack([np.ones(len(variance)), power[:, j]])
        coefficients, _ = scipy.optimize.nnls(columns * scale[:, None], variance[:, j] * scale)
        found[:, j] = np.maximum(columns @ coefficients, variance[:, j].min())
    return found


def _coloured(quiet: Sequence[Trial], sigma: Array, band: tuple[float, float]) -> Noise:
    """Return the noise of the lead-ins with the slope that suits them best; white unless another slope does clearly better."""
    tried = [_from_lead_in(quiet, sigma, band, slope) for slope in SLOPES]
    best = min(range(len(SLOPES)), key=lambda i: tried[i][1])
    if tried[0][1] - tried[best][1] < COLOURED:
        return tried[0][0]
    near = [i for i in (best - 1, best, best + 1) if 0 <= i < len(SLOPES)]
    if len(near) == 3:
        a, b, _ = np.polyfit([SLOPES[i] for i in near], [tried[i][1] for i in near], 2)
        return _from_lead_in(quiet, sigma, band, float(-b / (2 * a)))[0]
    return tried[best][0]


def _from_lead_in(
    quiet: Sequence[Trial], sigma: Array, band: tuple[float, float], slope: float, levels: Array | None = None
) -> tuple[Noise, float]:
    """Return the noise of lead-ins for a slope, and -2 ln of its likelihood."""
    residuals = [lead_in_lines(part, band) for part in quiet]
    start = Noise(np.full(len(EVEN), 100 * SMALLEST_LEVEL) if levels is None else levels, sigma, slope)
    noise = estimate_noise(residuals, start, same_road=True)[0]
    return noise, sum(noise.loss(lines, answer) for lines, answer in residuals)


def top_of_band(trial: Trial, band: tuple[float, float] = CALIBRATION_BAND_HZ) -> Array:
    """Return the standard deviation of white noise that the top of a band [Hz] shows, `shape (n_channels,)`."""
    values = trial.recording.values if trial.scenario.track.parts else scipy.signal.detrend(trial.recording.values, axis=0)
    frequency, density = record_psd(values, trial.recording.dt, axis=0)
    top = min(TOP_BAND_RATIO[1] * band[1], frequency[-1])  # a slow recording shows less
    inside = (frequency >= top * TOP_BAND_RATIO[0] / TOP_BAND_RATIO[1]) & (frequency <= top)
    # the median of an exponential variable is ln 2 of its mean; it forgives a line within the band
    return np.asarray(np.sqrt(np.median(density[inside], axis=0) / np.log(2) / (2 * trial.recording.dt)))


def are_same_noises(noises: Noises, others: Noises, fit: ModelFit) -> bool:
    """Return whether what a fit leaves of every run is as large by one noise as by another, and as little of it shifted."""
    for part in fit.parts:
        for i, (lines, answer) in enumerate(part.misfit.residual_spectrum(part.x)):
            trial = part.misfit.problem.trials[i]
            squares = [np.mean(np.abs(item[trial.name].whitener(answer) @ lines[:, :, None]) ** 2) for item in (noises, others)]
            ours, theirs = (item[trial.name].unshifted(trial.recording.values) for item in (noises, others))
            moved = 2 * np.sum(np.abs(part.misfit.whitened_signal(i, ours - theirs)) ** 2)
            if abs(np.log(squares[0] / squares[1])) > SAME_SQUARES or moved > SAME_SHIFT:
                return False
    return True
