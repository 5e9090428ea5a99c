"""What shakes a vehicle at phases that no run knows: its in-phase and quadrature parts follow linearly, run by run.

An engine turns, and so does a wheel: a few numbers of theirs are searched, and in every run amplitudes and phases are least squares of what
the rest of the model leaves.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from vehgen.fit.adjustments import Adjustment, RunState, shifted
from vehgen.fit.trial import Trial

Array = NDArray[np.float64]
SHARED_OUT = 1e-9
"""What two parts show alike is shared out between them: this share of the mean square of all is added to each."""


@dataclass(frozen=True)
class Shaking(Adjustment, ABC):
    """What shakes the vehicle at the `place`: its number, and those after it, say how fast.

    `sigma` is the standard deviation of every channel's noise by trial, `shape (n_channels,)`, by which channels are weighed.
    """

    sigma: Mapping[str, Array] = field(default_factory=dict)

    @abstractmethod
    def columns(self, trial: Trial, numbers: Array, values: Mapping[str, float], state: RunState) -> Array:
        """Return what the sensors read of unit amplitudes, `shape (n_parts, n_samples, n_channels)`: each in two phases.

        `numbers` and `state` are as for :meth:`response`, `values` the vehicle's parameters [SI].
        """

    def vehicles(self, trial: Trial, state: RunState) -> Sequence[Mapping[str, float]]:
        """Return the parameters [SI] of the vehicles that are shaken, one for each response, or one for all: as filed."""
        return [trial.values]

    def response(self, trial: Trial, response: Array, numbers: Array, state: RunState | None = None) -> Array:
        """Return the readings with the parts that suit them best added; without them for a trial whose noise is not known."""
        if trial.name not in self.sigma:
            return response
        state = state or RunState(trial.scenario)
        added = []
        vehicles = self.vehicles(trial, state)
        for own, values in zip(np.split(response, len(vehicles)), vehicles, strict=True):
            columns = self.columns(trial, numbers, values, state)
            added.append(np.einsum("knc,...k->...nc", columns, self._solve(trial, columns, own, state)))
        return np.asarray(response + np.concatenate(added))

    def amplitude(self, trial: Trial, response: Array, numbers: Array, values: Mapping[str, float], state: RunState) -> float:
        """Return the amplitude of the first part in a run, from the readings without it `shape (n_samples, n_channels)`."""
        coefficients = self._solve(trial, self.columns(trial, numbers, values, state), response, state)
        return float(np.hypot(coefficients[0], coefficients[1]))

    def _solve(self, trial: Trial, columns: Array, response: Array, state: RunState) -> Array:
        left = (_on_time(trial, state.late) - response) / self.sigma[trial.name]
        weighed = (columns / self.sigma[trial.name]).reshape(len(columns), -1)
        normal = weighed @ weighed.T
        ridge = SHARED_OUT * np.trace(normal) / len(normal) * np.eye(len(normal))
        projected = np.einsum("km,...m->...k", weighed, left.reshape(*left.shape[:-2], -1))
        return np.asarray(np.linalg.solve(normal + ridge, projected[..., None])[..., 0])


def _on_time(trial: Trial, late: Array | None) -> Array:
    """Return a recording with every channel so much earlier as its clock is late [s], `shape (n_samples, n_channels)`."""
    values = trial.recording.values
    return values if late is None or not np.any(late) else shifted(values, trial.recording.dt, -late)


def in_two_phases(turning: NDArray[np.complex128]) -> Array:
    """Return the in-phase and the quadrature part of each of several signals `shape (n_samples, n_channels, n)`, in turn."""
    return np.array([part for j in range(turning.shape[2]) for part in (turning[:, :, j].real, -turning[:, :, j].imag)])
