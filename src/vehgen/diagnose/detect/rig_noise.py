"""The noise of rigs, which have no quiet road before a hump: sensors', and that of measured forces whose files state none.

Ripple of a drive, or noise of a load cell, shakes a rig as a white force would. How large it is, and how quiet the sensors are, shows in
the upper half of the band in what a fit leaves: what is missing from a model mostly shows below, at the motion's own frequencies. Where
the whole band has less of it than that half allows, that counts. So noise that was overrated, by harmonics above the band, comes down
once the best model is known.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy.optimize
from numpy.typing import NDArray

from vehgen.diagnose.fits.model_fit import ModelFit
from vehgen.fit.misfit import Noises
from vehgen.fit.noise import Noise, RoadAnswer, unstated_forces
from vehgen.fit.trial import Trial

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
SHARES = (1e-5, 0.05)
"""Errors of a force beside it: smaller ones do not count, larger ones are no errors. Of a load cell's noise, beside the loudest run's."""
LESS_LIKELY = 4.0
"""The upper half of the band allows errors of forces by which -2 ln of the likelihood grows by so much (two standard deviations)."""
QUIETEST = 1e-6
"""Sensors may be quieter than the top of the band shows by this factor: it holds the force's error, and harmonics, too."""
STARTS = tuple((share, own) for share in (1e-4, 1e-3, 0.01, 0.03) for own in (0.0, -1.0, -3.0, -6.0, -9.0, -12.0))
"""Where the search may begin: the force's error beside it, and the logarithm of the sensors' noise over the loudest."""


def rig_noises(fit: ModelFit, noises: Noises, quiet: Noises) -> Noises:
    """Return noises with what a fit's runs without a road show; others keep theirs, and so does what run files state.

    Forces have an error that is either the same share of them in all runs with the same channels (ripple) or the same in newtons (a load
    cell's noise), whichever is likelier. `quiet` is the noise of the sensors before any fit, which they do not exceed.
    """
    groups: dict[tuple[str, ...], list[_Left]] = {}
    for part in fit.parts:
        for trial, (lines, answer) in zip(part.misfit.problem.trials, part.misfit.residual_spectrum(part.x), strict=True):
            if not trial.scenario.track.parts:
                left = _Left(trial, lines, answer, answer.frequency >= part.misfit.band[1] / 2)
                groups.setdefault(trial.channels, []).append(left)
    found = dict(noises)
    for runs in groups.values():
        searches = _Search.of(runs, noises, quiet)
        if searches[0].size:
            answers = [item.numbers(runs) for item in searches]
            search, x = min(zip(searches, answers, strict=True), key=lambda pair: pair[0].loss(pair[1], runs))
            found |= {run.trial.name: search.noise(run, x) for run in runs}
    return found


@dataclass(frozen=True)
class _Left:
    """What a fit leaves of a run, lines `shape (n, n_channels)`, the way of roads and forces into them, and which lines are upper ones."""

    trial: Trial
    lines: Complex
    answer: RoadAnswer
    above: NDArray[np.bool_]

    @property
    def upper(self) -> _Left:
        """Its upper lines alone."""
        forced, unstated = (None if item is None else item[self.above] for item in (self.answer.forced, self.answer.unstated))
        gain, along = self.answer.gain[self.above], self.answer.wavenumber[self.above]
        answer = RoadAnswer(self.answer.frequency[self.above], along, gain, self.answer.dt, forced, unstated)
        return _Left(self.trial, self.lines[self.above], answer, self.above[self.above])


@dataclass(frozen=True)
class _Search:
    """Noise of runs with the same channels, by numbers; whether an error of forces is a share of them is told by `forces`.

    They are the logarithm of the forces' error, where there is one, over `forces` [N], `shape (n_unstated,)` by run, and those of the
    `free` channels' noise over the `loudest`, which is that of the quietest run.
    """

    noises: Noises
    quiet: Noises
    loudest: Array
    free: NDArray[np.intp]
    forces: dict[str, Array]

    @classmethod
    def of(cls, runs: Sequence[_Left], noises: Noises, quiet: Noises) -> list[_Search]:
        """Return the searches to try: errors of forces as a share of each run's, and, of several runs, as one size in all of them."""
        free = [i for i, channel in enumerate(runs[0].trial.recording.channels) if channel.noise is None]
        loudest = np.min([quiet[run.trial.name].sigma for run in runs], axis=0)
        sizes = {run.trial.name: _unstated(run.trial) for run in runs}
        largest: dict[str, float] = {}
        for found in sizes.values():
            largest |= {force: max(size, largest.get(force, 0.0)) for force, size in found.items()}
        shares = {run: np.array(list(found.values())) for run, found in sizes.items()}
        alike = {run: np.array([largest[force] for force in found]) for run, found in sizes.items()}
        forms = [shares, alike] if largest and len(runs) > 1 else [shares]
        return [cls(noises, quiet, loudest, np.array(free, dtype=np.intp), forces) for forces in forms]

    @property
    def size(self) -> int:
        """Number of the numbers sought."""
        return self.has_force + len(self.free)

    @property
    def has_force(self) -> bool:
        """Whether an error of forces is sought."""
        return any(len(item) for item in self.forces.values())

    def noise(self, run: _Left, x: Array) -> Noise:
        """Return a run's noise by the numbers `shape (size,)`."""
        sigma = self.quiet[run.trial.name].sigma.copy()
        sigma[self.free] = self.loudest[self.free] * np.exp(x[int(self.has_force) :])
        acting = np.exp(x[0]) * self.forces[run.trial.name] if self.has_force else None
        return replace(self.noises[run.trial.name], acting=acting, sigma=sigma)

    def loss(self, x: Array, runs: Sequence[_Left]) -> float:
        """Return -2 ln of the likelihood of what is left of runs, less a constant."""
        return sum(self.noise(run, x).loss(run.lines, run.answer) for run in runs)

    def numbers(self, runs: Sequence[_Left]) -> Array:
        """Return the numbers that stand: the largest error of forces that both answers allow, and the sensors' quieter noise beside it."""
        parts = ([run.upper for run in runs], runs)
        error = min(self.largest_error(parts[0]), self.likeliest(runs)[0]) if self.has_force else None
        return np.asarray(np.min([self.likeliest(part, error) for part in parts], axis=0))

    def likeliest(self, runs: Sequence[_Left], error: float | None = None) -> Array:
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

    def largest_error(self, runs: Sequence[_Left]) -> float:
        """Return the logarithm of the largest error of forces that is hardly less likely than the likeliest: runs may tell little of it."""
        x = self.likeliest(runs)
        allowed = self.loss(x, runs) + LESS_LIKELY

        def beyond(error: float) -> float:
            return self.loss(np.array([error, *x[1:]]), runs) - allowed

        end = float(np.log(SHARES[1]))
        return float(scipy.optimize.brentq(beyond, x[0], end, xtol=0.02)) if beyond(end) > 0 else end


def _unstated(trial: Trial) -> dict[str, float]:
    """Return the standard deviation of each measured force whose error the run file does not state, by name [N]."""
    return {name: float(size) for name, size in zip(trial.run.file.forces, unstated_forces(trial), strict=True) if size > 0}
