"""A line in the spectrum that an engine drives: its frequency and drift are searched, its amplitude and phase follow linearly.

The force at a body turns with the phase 2 pi (f t + d f t^2 / (2 T)) over a run of T seconds: f at its start, f (1 + d) at its end. A run
does not know the phase at which it starts, so in every run the in-phase and quadrature parts of a vertical force at the body's COG and of a
pitch moment are least squares of what the rest of the model leaves. What the sensors show of them follows from the linear model at the
frequency of the moment: the drift is slow.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from vehgen.fit.adjustments import Adjustment, RunState
from vehgen.fit.misfit import Misfit
from vehgen.fit.shaking import Shaking, in_two_phases
from vehgen.fit.trial import Trial
from vehgen.mechanics.rows import Row
from vehgen.simulate.frequency import force_response

Array = NDArray[np.float64]
MIN_LINE_FREQUENCY_HZ, MAX_LINE_FREQUENCY_HZ = 5.0, 40.0
"""Frequencies at which lines are looked for [Hz]."""
DRIFTS = np.linspace(-0.03, 0.03, 61)
"""Drifts at which lines are looked for."""
SMOOTH_CYCLES = 0.5
"""Width over which the residual's power is averaged in the search for a line [Hz]."""


@dataclass(frozen=True)
class Harmonic(Shaking):
    """An engine's line at the body `place`: its number is the frequency [Hz], the next one the drift (see the head of this file).

    Its amplitude is that of the vertical force [N], at the vehicle's parameters: a heavier body needs a larger force.
    """

    def columns(self, trial: Trial, numbers: Array, values: Mapping[str, float], state: RunState) -> Array:
        """Return what the sensors read of unit forces, `shape (2 n_forces, n_samples, n_channels)`: heave in two phases, then pitch."""
        frequency, drift = float(numbers[0]), float(numbers[1])
        time = trial.recording.time - trial.recording.time[0]
        duration = max(float(time[-1]), 1e-9)
        ends = np.array([frequency, frequency * (1.0 + drift)])
        answers = force_response(trial.simulator.model, values, _rows(trial, self.place), ends) * trial.channel_factors(ends)[:, :, None]
        share = (time / duration)[:, None, None]
        answer = answers[0] * (1 - share) + answers[1] * share
        return in_two_phases(answer * np.exp(1j * _phase(time, frequency, drift))[:, None, None])


def _rows(trial: Trial, body: str) -> list[Row]:
    motion = trial.simulator.model.motion
    return [row for row in (motion.heave.get(body, {}), motion.pitch.get(body, {})) if row]


def _phase(time: Array, frequency: float, drift: float) -> Array:
    duration = max(float(time[-1]), 1e-9)
    return np.asarray(2 * np.pi * frequency * (time + drift * time**2 / (2 * duration)))


def find_line(
    misfit: Misfit, x: Array, most: int = 2, lowest: float = MIN_LINE_FREQUENCY_HZ, highest: float = MAX_LINE_FREQUENCY_HZ
) -> list[tuple[float, float]]:
    """Return the frequencies [Hz] and drifts of the `most` strongest lines, between two frequencies [Hz], in what a fit leaves.

    Peaks of the whitened power of all runs, averaged over SMOOTH; about each, the frequency and drift that collect most of it.
    """
    grid = np.arange(lowest, highest, 0.05)
    power = np.zeros_like(grid)
    lines = misfit.whitened_spectrum(x)
    for t, line in enumerate(lines):
        frequency = misfit.frequency(t)
        own = (np.abs(line) ** 2).sum(axis=1)
        width = max(1, round(SMOOTH_CYCLES / (frequency[1] - frequency[0])))
        power += np.interp(grid, frequency, np.convolve(own, np.ones(width) / width, mode="same"))
    found = []
    for _ in range(most):
        top = int(np.argmax(power))
        found.append(_refine(misfit, x, float(grid[top])))
        power[np.abs(grid - grid[top]) < 2 * SMOOTH_CYCLES] = 0.0
    return found


def _refine(misfit: Misfit, x: Array, about: float) -> tuple[float, float]:
    frequencies = np.arange(about - 1.2, about + 1.2, 0.02)
    energy = np.zeros((len(DRIFTS), len(frequencies)))
    for i, (trial, simulated) in enumerate(zip(misfit.problem.trials, misfit.simulate(x), strict=True)):
        time = trial.recording.time - trial.recording.time[0]
        left = (misfit.recorded(i) - simulated) / misfit.noises[trial.name].sigma
        duration = max(float(time[-1]), 1e-9)
        turning = np.exp(-2j * np.pi * np.outer(frequencies, time))
        for i, rate in enumerate(DRIFTS):
            chirped = left * np.exp(-1j * np.pi * about * rate * time**2 / duration)[:, None]
            energy[i] += (np.abs(turning @ chirped) ** 2).sum(axis=1) / len(time)
    drift, frequency = np.unravel_index(int(np.argmax(energy)), energy.shape)
    return float(frequencies[frequency]), float(DRIFTS[drift])


def harmonic_adjustments(
    body: str, noises: Mapping[str, Array], low: float = MIN_LINE_FREQUENCY_HZ, high: float = MAX_LINE_FREQUENCY_HZ + 5.0
) -> Sequence[Adjustment]:
    """Return the two adjustments of a line at a body: its frequency, `low` to `high` [Hz], weighed by the `noises`, and its drift."""
    line = Harmonic(body, 0.05, 25.0, low, high, dict(noises))
    return line, Adjustment(f"{body} drift", 0.002, 0.0, -0.05, 0.05)


__all__ = ["Harmonic", "find_line", "harmonic_adjustments"]
