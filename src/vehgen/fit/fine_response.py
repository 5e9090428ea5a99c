"""What a fitted model shows between the samples of a recording, and up to which frequency sampling folds next to nothing."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from vehgen.codegen.decimation import Phases, decimate
from vehgen.fit.misfit import Misfit
from vehgen.fit.noise import Noise
from vehgen.fit.road_answer import road_answer
from vehgen.fit.trial import Trial
from vehgen.fit.window import taper
from vehgen.measure.acquisition import AcquisitionChain
from vehgen.simulate.acquired import extended, kept_stride

Array = NDArray[np.float64]
LOOK_AHEAD_S = 0.6
"""How far beyond the recording's end responses are computed, for chains that look ahead [s]."""
MAX_FOLDED_SHARE = 0.1
"""Folded energy beyond this share of the noise's power spoils a spectral line: chi grows by 5 %."""
SMOOTHED_HZ = 1.0
"""Width over which folded energy is averaged [Hz]."""


@dataclass(frozen=True)
class FineResponse:
    """A response between the samples of a recording.

    Attributes
    ----------
    values
        `shape (n_fine, n_channels)`, `ratio` of them a sample, beyond the recording's end.
    dt
        Their spacing [s].
    ratio
        How many of them lie from one sample to the next.
    count
        Number of the recording's samples.
    skipped
        Number of samples before the recording's first.
    """

    values: Array
    dt: float
    ratio: int
    count: int
    skipped: int = 0

    def acquired(self, chains: Sequence[AcquisitionChain]) -> Array:
        """Return the samples that chains, one a channel, make of it, `shape (count, n_channels)`."""
        phases = Phases.of([chain.taps(self.dt) for chain in chains], self.ratio)
        return np.asarray(decimate(self.values[None], phases, self.skipped + self.count, threads=1)[0][self.skipped :])


def fine_response(misfit: Misfit, x: Array, number: int) -> FineResponse:
    """Return what the channels of trial `number` show at unknowns x before any recorder, its adjustments of sensors left out."""
    trial = misfit.problem.trials[number]
    unit, scenario = misfit.split(x)[0], misfit.scenario(x, number)
    stride = kept_stride(scenario)
    ratio = scenario.decimation // stride
    longer = extended(scenario, int(np.ceil(LOOK_AHEAD_S / (scenario.dt * scenario.decimation))))
    fine = replace(longer, decimation=stride, chains={}, skipped=0)
    values = np.array(misfit.problem.respond(misfit.problem.space.values(unit)[None], trial, fine)[0][0])
    return FineResponse(values, fine.dt * stride, ratio, len(trial.recording.time), scenario.skipped)


def trusted_band(trial: Trial, fine: FineResponse, noise: Noise) -> float:
    """Return the frequency [Hz] up to which energy folded from above half the sampling rate stays under MAX_FOLDED_SHARE of the noise.

    Parameters
    ----------
    trial
        A trial, whose recorder may have let everything pass.
    fine
        Its response before any recorder, of :func:`fine_response`.
    noise
        Its noise.
    """
    dt, n = trial.recording.dt, fine.count
    fine_n = n * fine.ratio
    grid = np.arange(fine_n) / fine.ratio
    window = np.interp(grid, np.arange(n), taper(n, dt, trial.fade_in))
    values = np.zeros((fine_n, fine.values.shape[1]))
    kept = fine.values[fine.skipped * fine.ratio :][:fine_n]
    values[: len(kept)] = kept
    tapered = values * window[:, None]
    frequency = np.asarray(np.fft.rfftfreq(n, dt), dtype=np.float64)
    inside = (frequency > 0) & (frequency < 0.5 / dt)
    whole = np.fft.rfft(tapered, axis=0)[: len(frequency)] / fine.ratio
    folded = (np.fft.rfft(tapered[:: fine.ratio], axis=0) - whole)[inside]
    power = np.abs(folded) ** 2 * 2 * dt / float((window[:: fine.ratio] ** 2).sum())
    answer = road_answer(trial, frequency[inside], trial.values)
    density = np.diagonal(noise.density(answer), axis1=1, axis2=2).real
    width = max(1, round(SMOOTHED_HZ / float(frequency[1])))
    share = np.apply_along_axis(np.convolve, 0, power / density, np.ones(width) / width, "same").max(axis=1)
    spoilt = np.flatnonzero(share > MAX_FOLDED_SHARE)
    return float(frequency[inside][spoilt[0]]) if len(spoilt) else 0.5 / dt
