"""Even and odd harmonics, where a run is driven at one frequency: on a shaker or a rig.

A linear vehicle answers at the driving frequency alone. A law that is odd (a cubic spring, dry friction) adds odd multiples of it, one that
treats compression and extension differently (a stop on one side, an asymmetric damper) even ones.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from vehgen.diagnose.detect.detection import Detection
from vehgen.fit.trial import Trial

Array = NDArray[np.float64]
HIGHEST_HARMONIC = 5
"""Multiples of the driving frequency that are looked at."""
PERIODS = 5
"""A run must show so many periods after its first SETTLED share."""
SETTLED_SHARE = 0.4


@dataclass(frozen=True)
class Distortion:
    """Harmonics of a channel in a run driven at `frequency` [Hz].

    `even` and `odd` are the root sums of squares of the amplitudes at the multiples 2, 4 and 3, 5 over the amplitude at the driving
    frequency; `noise` is what noise alone would show there.
    """

    run: str
    channel: str
    frequency: float
    even: float
    odd: float
    noise: float


def driving_frequency(trial: Trial) -> float | None:
    """Return the frequency that drives a run [Hz]; None where it is not one, or where a road drives it besides."""
    file = trial.run.file
    harmonics = [entry.harmonic for entry in file.forces.values()] + [entry.harmonic for entry in file.displacements.values()]
    found = {item.frequency for item in harmonics if item is not None}
    if file.road or len(found) != 1 or None in harmonics:
        return None
    return float(found.pop())


def distortions(detection: Detection) -> list[Distortion]:
    """Return the harmonics of all channels of runs that are driven at one frequency, by least squares of sines."""
    found = []
    for trial in detection.trials:
        frequency = driving_frequency(trial)
        time = trial.recording.time
        late = time >= SETTLED_SHARE * time[-1]
        if frequency is None or (time[-1] - time[late][0]) * frequency < PERIODS:
            continue
        highest = min(HIGHEST_HARMONIC, int(0.45 / (trial.recording.dt * frequency)))
        turns = 2 * np.pi * frequency * np.outer(time[late], np.arange(1, highest + 1))
        columns = np.hstack([np.ones((len(turns), 1)), np.cos(turns), np.sin(turns)])
        factors = np.linalg.lstsq(columns, trial.recording.values[late], rcond=None)[0]
        amplitudes = np.hypot(factors[1 : highest + 1], factors[highest + 1 :])
        sigma = detection.floor.noises[trial.name].sigma
        for i, channel in enumerate(trial.channels):
            first = max(float(amplitudes[0, i]), 1e-300)
            even = float(np.sqrt((amplitudes[1::2, i] ** 2).sum())) / first
            odd = float(np.sqrt((amplitudes[2::2, i] ** 2).sum())) / first
            # two harmonics, each with the variance 4 sigma^2/n of its amplitude's square
            noise = float(np.sqrt(8 / late.sum()) * sigma[i]) / first
            found.append(Distortion(trial.name, channel, frequency, even, odd, noise))
    return found
