"""The noise of rigs, which have no road: sensors', and that of measured forces whose files state none.

Ripple of a drive, or noise of a load cell, shakes a rig as a white force would. It is either the same share of a force in all runs with
the same channels (ripple) or the same in newtons (a load cell's noise), whichever is likelier.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy
from numpy.typing import NDArray

from vehgen.fit.noise import EVEN, Noise
from vehgen.fit.road_answer import RoadAnswer, unstated_forces
from vehgen.fit.trial import Trial

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
Noises = dict[str, Noise]
SHARES = (1e-5, 0.05)
"""Errors of a force beside it: smaller ones do not count, larger ones are no errors. Of a load cell's noise, beside the loudest run's."""
QUIETEST = 1e-6
"""Sensors may be quieter than what is left by this factor: that holds the force's error, and harmonics, too."""
STARTS = tuple((share, own) for share in (1e-4, 1e-3, 0.01, 0.03) for own in (0.0, -1.0, -3.0, -6.0, -9.0, -12.0))
"""Where the search may begin: the force's error beside it, and the logarithm of the sensors' noise over the loudest."""


@dataclass(frozen=True)
class RunResidual:
    """What a fit leaves of a run, lines `shape (n, n_channels)`, and the way of roads and forces into them."""

    trial: Trial
    lines: Complex
    answer: RoadAnswer

    def within(self, inside: NDArray[np.bool_]) -> RunResidual:
        """Return some of its lines."""
        forced, unstated = (None if item is None else item[inside] for item in (self.answer.forced, self.answer.unstated))
        gain, along = self.answer.gain[inside], self.answer.wavenumber[inside]
        answer = RoadAnswer(self.answer.frequency[inside], along, gain, self.answer.dt, forced, unstated)
        return RunResidual(self.trial, self.lines[inside], answer)


@dataclass(frozen=True)
class RigNoiseSearch:
    """Noise of runs with the same channels, by numbers; whether an error of forces is a share of them is told by `forces`.

    They are the logarithm of the forces' error, where there is one, over `forces` [N], `shape (n_unstated,)` by run, and those of the
    `free` channels' noise over the `loudest`, which is that of the quietest run. `noises` keep what they say of roads, `quiet` gives the
    noise of channels that is stated.
    """

    noises: Noises
    quiet: Noises
    loudest: Array
    free: NDArray[np.intp]
    forces: dict[str, Array]

    @classmethod
    def of(cls, runs: Sequence[RunResidual], noises: Noises, quiet: Noises) -> list[RigNoiseSearch]:
        """Return the searches to choose from: errors of forces as shares, and in newtons where several runs may tell them apart."""
        free = [i for i, channel in enumerate(runs[0].trial.recording.channels) if channel.noise is None]
        loudest = np.min([quiet[run.trial.name].sigma for run in runs], axis=0)
        sizes = {run.trial.name: unstated_sizes(run.trial) for run in runs}
        largest: dict[str, float] = {}
        for found in sizes.values():
            largest |= {force: max(size, largest.get(force, 0.0)) for force, size in found.items()}
        shares = {run: np.array(list(found.values())) for run, found in sizes.items()}
        alike = {run: np.array([largest[force] for force in found]) for run, found in sizes.items()}
        forms = [shares, alike] if largest and len(runs) > 1 else [shares]
        return [cls(noises, quiet, loudest, np.array(free, dtype=np.intp), forces) for forces in forms]

    @property
    def size(self) -> int:
        """How many numbers are sought."""
        return self.has_force + len(self.free)

    @property
    def has_force(self) -> bool:
        """Whether a force has an error that no file states."""
        return any(len(item) for item in self.forces.values())

    def noise(self, run: RunResidual, x: Array) -> Noise:
        """Return a run's noise by the numbers `shape (size,)`."""
        sigma = self.quiet[run.trial.name].sigma.copy()
        sigma[self.free] = self.loudest[self.free] * np.exp(x[int(self.has_force) :])
        acting = np.exp(x[0]) * self.forces[run.trial.name] if self.has_force else None
        return replace(self.noises[run.trial.name], acting=acting, sigma=sigma)

    def loss(self, x: Array, runs: Sequence[RunResidual]) -> float:
        """Return -2 ln of the likelihood of what is left of runs, less a constant."""
        return sum(self.noise(run, x).loss(run.lines, run.answer) for run in runs)

    def likeliest(self, runs: Sequence[RunResidual], error: float | None = None) -> Array:
        """Return the most likely numbers, with a given logarithm of the forces' error where there is one."""
        known = [] if error is None else [error]
        sought = int(self.has_force) - len(known)

        def loss(x: Array) -> float:
            return self.loss(np.array([*known, *x]), runs)

        starts = [np.array([*[np.log(share)] * sought, *[own] * len(self.free)]) for share, own in STARTS]
        size = len(starts[0])
        if not size:
            return np.array(known)
        start = min(starts, key=loss)
        bounds = [*[tuple(np.log(SHARES))] * sought, *[(float(np.log(QUIETEST)), 0.0)] * len(self.free)]
        options = {"xatol": 0.02, "fatol": 0.1, "initial_simplex": start + np.vstack([np.zeros(size), 0.7 * np.eye(size)])}
        return np.array([*known, *scipy.optimize.minimize(loss, start, method="Nelder-Mead", bounds=bounds, options=options).x])


def likeliest_noises(runs: Sequence[RunResidual]) -> Noises:
    """Return the most likely noise of runs without a road that have the same channels, by run: sensors are as loud in all of them."""
    power = np.mean([np.mean(np.abs(run.lines) ** 2, axis=0) / (2 * run.answer.dt) for run in runs], axis=0)
    stated = np.array([channel.noise or np.nan for channel in runs[0].trial.recording.channels])
    whole = {run.trial.name: Noise(EVEN, np.where(np.isnan(stated), np.sqrt(power), stated)) for run in runs}
    return whole | likelier_noises(runs, whole, whole, lambda search: search.likeliest(runs))


def likelier_noises(runs: Sequence[RunResidual], noises: Noises, quiet: Noises, answer: Callable[[RigNoiseSearch], Array]) -> Noises:
    """Return the noise of runs with the same channels by the likelier of the searches, each with the numbers of its `answer`.

    Empty where nothing is sought: see :class:`RigNoiseSearch` for `noises` and `quiet`.
    """
    searches = RigNoiseSearch.of(runs, noises, quiet)
    if not searches[0].size:
        return {}
    search, x = min(((item, answer(item)) for item in searches), key=lambda pair: pair[0].loss(pair[1], runs))
    return {run.trial.name: search.noise(run, x) for run in runs}


def unstated_sizes(trial: Trial) -> dict[str, float]:
    """Return the standard deviation of each measured force whose error the run file does not state, by name [N]."""
    return {name: float(size) for name, size in zip(trial.run.file.forces, unstated_forces(trial), strict=True) if size > 0}
