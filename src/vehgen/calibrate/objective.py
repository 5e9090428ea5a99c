"""The objective of hump calibration (Wu & Li 2023, Eq. 5, doi:10.3390/s23249691).

    FD = sum over channels of  integral |PSD_s(f) - PSD_m(f)| df / integral PSD_m(f) df

over the vertical accelerations and pitch rates of all sensors and runs in use. It does not see phase, so neither the hump's time of arrival
nor the recordings' clocks matter to it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy
from numpy.typing import NDArray

from vehgen.errors import InputError
from vehgen.fit.band import CALIBRATION_BAND_HZ
from vehgen.fit.problem import Problem
from vehgen.measure import record_psd

Array = NDArray[np.float64]


class PsdObjective:
    """Eq. 5 over a problem's trials, for whole populations.

    Parameters
    ----------
    problem
        Trials and searched parameters.
    band
        Frequencies compared [Hz].
    """

    def __init__(self, problem: Problem, band: tuple[float, float] = CALIBRATION_BAND_HZ) -> None:
        self.problem = problem
        self.band = band
        self._measured: list[tuple[NDArray[np.bool_], Array]] = []
        for trial in problem.trials:
            frequency, density = record_psd(trial.recording.values, trial.recording.dt, axis=0)
            inside = (frequency >= band[0]) & (frequency <= band[1])
            if inside.sum() < 4:
                raise InputError(f"{trial.name}: fewer than 4 spectral lines lie within {band[0]:g}-{band[1]:g} Hz")
            self._measured.append((inside, density[inside]))

    def __call__(self, unit: Array) -> Array:
        """Return the objective at points of the unit cube `shape (n, n_parameters)`: `shape (n,)`, inf where an individual failed."""
        return np.asarray(self.terms(self.problem.space.values(unit)).sum(axis=1))

    def quick(self, unit: Array) -> Array:
        """Return the objective as a search needs it, to tell better points from worse ones: in single precision where that is safe."""
        values = self.problem.space.values(unit)
        total = np.zeros(len(values))
        for trial, (inside, density) in zip(self.problem.trials, self._measured, strict=True):
            area = QuickArea.between(inside, density, trial.recording.dt, len(trial.recording.values))
            found, failed = self.problem.rank(values, trial, area)
            total += np.where(failed, np.inf, found)
        return total

    def terms(self, values: Array) -> Array:
        """Return the objective's terms at searched values `shape (n, n_parameters)` [SI]: `shape (n, channels of all trials)`."""
        parts = []
        for trial, (inside, density) in zip(self.problem.trials, self._measured, strict=True):
            responses, failed = self.problem.respond(values, trial)
            if failed.any():
                responses = np.where(failed[:, None, None], 0.0, responses)
            parts.append(_terms(responses, trial.recording.dt, inside, density))
            parts[-1][failed] = np.inf
        return np.concatenate(parts, axis=1)

    def compare(self, responses: Sequence[Array]) -> Array:
        """Return the terms `shape (channels of all trials,)` of responses of all trials, `shape (n_samples, n_channels)` each."""
        pairs = zip(self.problem.trials, self._measured, responses, strict=True)
        return np.concatenate([_terms(response[None], trial.recording.dt, *measured)[0] for trial, measured, response in pairs])


@dataclass(frozen=True)
class QuickArea:
    """Eq. 5 of one trial, in the precision of the responses: lines `first` to `last` of their PSD against measured ones.

    `scales shape (n_lines, 1)` make a PSD of squared transforms; `density shape (n_lines, n_channels)` is the measured PSD, `weights
    shape (n_lines n_channels,)` one over its sum over the lines.
    """

    first: int
    last: int
    scales: Array
    density: Array
    weights: Array

    @classmethod
    def between(cls, inside: NDArray[np.bool_], density: Array, dt: float, n: int) -> QuickArea:
        """Return it for a measured PSD at the lines `inside` a band of records of n samples, `dt` [s] apart."""
        lines = np.flatnonzero(inside)
        sided = np.where((lines == 0) | (2 * lines == n), 1.0, 2.0)
        weights = np.tile(1 / density.sum(axis=0), len(lines))
        return cls(int(lines[0]), int(lines[-1]) + 1, (sided * dt / n)[:, None], density, weights)

    def __call__(self, responses: NDArray[Any]) -> Array:
        """Return the sums of all channels' terms `shape (n,)` of responses `shape (n, n_samples, n_channels)`."""
        with np.errstate(over="ignore", invalid="ignore"):  # of those that fail
            lines = scipy.fft.rfft(responses, axis=1)[:, self.first : self.last]
            power = np.square(lines.real)
            power += np.square(lines.imag)
            power *= self.scales.astype(power.dtype)
            power -= self.density.astype(power.dtype)
            found = np.abs(power, out=power).reshape(len(power), -1) @ self.weights.astype(power.dtype)
        return np.asarray(found, dtype=np.float64)


def _terms(responses: Array, dt: float, inside: NDArray[np.bool_], measured: Array) -> Array:
    """Return the terms `shape (n, n_channels)` of responses `shape (n, n_samples, n_channels)`, against measured PSDs in the band."""
    simulated = record_psd(responses, dt, axis=1)[1][:, inside, :]
    return np.asarray(np.abs(simulated - measured).sum(axis=1) / measured.sum(axis=0))
