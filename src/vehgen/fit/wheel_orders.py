"""What turns with the wheels of an axle: an untrue, worn or unbalanced one shakes it once and several times a turn.

The wheel's angle is the distance travelled over its rolling radius, which is searched; at an order k the axle feels the road rise and fall
as a cos(k angle + phase). A run does not know at which angle it starts: amplitudes and phases of all orders are least squares of what the
rest of the model leaves, run by run. What the sensors show of them follows from the linear model at the frequency of the moment.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from vehgen.fit.adjustments import RunState
from vehgen.fit.misfit import Misfit
from vehgen.fit.shaking import Shaking, in_two_phases
from vehgen.fit.trial import Trial
from vehgen.simulate.frequency import maxwell_branches, transfer_functions

Array = NDArray[np.float64]
ORDERS = (1, 2, 3)
"""So many times a turn wheels are untrue; what comes more often is too short for a tyre to feel."""
FREQUENCY_STEP_HZ, MOST_FREQUENCIES = 0.1, 400
"""Frequency responses are computed so far apart, so many of them at most, and interpolated as the speed changes."""
FINENESS, APART = 0.001, 0.02
"""Radii are tried at steps of such a share; the second likeliest differs from the first by another one at least."""

NUMBERS_AT_ONCE = 1_000_000
"""So many complex numbers are held at once where radii are looked for: 16 MB."""


@dataclass(frozen=True)
class WheelOrders(Shaking):
    """What turns with the wheels of the axle `place`: its number is their rolling radius [m]; its amplitude is the first order's [m]."""

    def vehicles(self, trial: Trial, state: RunState) -> Sequence[Mapping[str, float]]:
        """Return the parameters [SI] of the vehicles whose wheels these are: near resonances they decide what sensors show."""
        return state.vehicles or [trial.values]

    def columns(self, trial: Trial, numbers: Array, values: Mapping[str, float], state: RunState) -> Array:
        """Return what the sensors read of heights under the axle, `shape (2 n_orders, n_samples, n_channels)`: each in two phases."""
        time = trial.recording.time
        angle = state.scenario.speed.distance(time) / float(numbers[0])
        turns = np.gradient(angle, time) / (2 * np.pi)
        grid = _grid(ORDERS[0] * float(turns.min()), ORDERS[-1] * float(turns.max()))
        model = trial.simulator.model
        displaced, _ = transfer_functions(model.numeric(values), grid, maxwell_branches(model, values))
        answer = displaced[:, :, list(model.vehicle.axles).index(self.place)] * trial.channel_factors(grid)
        turning = [_between(grid, answer, order * turns) * np.exp(1j * order * angle)[:, None] for order in ORDERS]
        return in_two_phases(np.stack(turning, axis=2))


def _grid(low: float, high: float) -> Array:
    """Return frequencies [Hz] from a little below `low` to a little above `high`."""
    low, high = max(low - FREQUENCY_STEP_HZ, 0.0), high + FREQUENCY_STEP_HZ
    return np.linspace(low, high, min(int((high - low) / FREQUENCY_STEP_HZ) + 2, MOST_FREQUENCIES))


def _between(grid: Array, lines: NDArray[np.complex128], frequency: Array) -> NDArray[np.complex128]:
    """Return lines `shape (n_grid, n_channels)` at frequencies `shape (n,)` [Hz] in between."""
    place = np.clip((frequency - grid[0]) / (grid[1] - grid[0]), 0.0, len(grid) - 1 - 1e-9)
    before = place.astype(int)
    share = (place - before)[:, None]
    return np.asarray(lines[before] * (1 - share) + lines[before + 1] * share)


def find_rolling_radii(misfit: Misfit, x: Array, lowest: float, highest: float, most: int = 2) -> list[float]:
    """Return the `most` likeliest rolling radii [m], between two, of a wheel that shakes the runs.

    Whitened, what a fit leaves has an even spectrum where nothing is missing. A wheel's orders stand out of it at multiples of one turn a
    circumference, in every run, whatever its speed: the radius is that by which spectra along the way hold most at its orders.
    """
    count = int(np.log(highest / lowest) / FINENESS) + 2
    radii = np.geomspace(lowest, highest, count)
    per_metre = np.geomspace(ORDERS[0] / highest, ORDERS[-1] / lowest, int(np.log(ORDERS[-1] * highest / lowest) / FINENESS) + 2)
    power = np.zeros_like(per_metre)
    for number, lines in enumerate(misfit.whitened_spectrum(x)):
        trial = misfit.problem.trials[number]
        way = misfit.scenario(x, number).speed.distance(trial.recording.time)
        white = _in_time(misfit.frequency(number), lines, len(trial.recording.time), trial.recording.dt)
        parts = np.array_split(per_metre, math.ceil(len(per_metre) * len(way) / NUMBERS_AT_ONCE))  # a long run would fill the memory
        power += np.concatenate([(np.abs(np.exp(-1j * np.outer(part, way)) @ white) ** 2).sum(axis=1) for part in parts])
    held = np.sum([np.interp(order / radii, per_metre, power) for order in ORDERS], axis=0)
    found = []
    for _ in range(most):
        best = int(np.argmax(held))
        found.append(float(radii[best]))
        held[np.abs(np.log(radii / radii[best])) < APART] = 0.0
    return found


def _in_time(frequency: Array, lines: NDArray[np.complex128], n_samples: int, dt: float) -> Array:
    """Return the signals `shape (n_samples, n_channels)` of spectral lines `shape (n_lines, n_channels)` at frequencies [Hz]; none else."""
    spectrum = np.zeros((n_samples // 2 + 1, lines.shape[1]), dtype=np.complex128)
    spectrum[np.rint(frequency * n_samples * dt).astype(int)] = lines
    return np.asarray(np.fft.irfft(spectrum, n_samples, axis=0))


__all__ = ["WheelOrders", "find_rolling_radii"]
