"""Errors of measured forces whose files state none: ripple of a drive, noise of a load cell. They shake the rig as a white force would.

How large they are shows in the upper half of the band, where sensors and forces share what a fit leaves by how the rig answers: what is
missing from a model mostly shows below, at the motion's own frequencies. Where the whole band has less of them, that counts.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy.optimize
from numpy.typing import NDArray

from vehgen.diagnose.fits.model_fit import ModelFit
from vehgen.fit.misfit import Noises
from vehgen.fit.noise import Noise, RoadAnswer

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
SHARES = (1e-5, 0.05)
"""Errors of a force beside it: smaller ones do not count, larger ones are no errors."""
QUIETEST = 1e-6
"""The sensors may be quieter than the top of the band shows by this factor: it holds the force's error, too."""
STARTS = tuple((share, own) for share in (1e-4, 1e-3, 0.01, 0.03) for own in (0.0, -3.0, -6.0, -9.0, -12.0))
"""Where the search for both may begin: the force's error beside it, and the logarithm of the sensors' noise over the loudest."""


def force_noises(fit: ModelFit, noises: Noises, quiet: Noises) -> Noises:
    """Return noises with the errors of measured forces that a fit's runs show, the same share of the force in all of them.

    `quiet` is the noise of the sensors before any fit, which they do not exceed.

    Runs without such forces keep theirs.
    """
    runs: list[_Left] = []
    for part in fit.parts:
        for trial, (lines, answer) in zip(part.misfit.problem.trials, part.misfit.residual_spectrum(part.x), strict=True):
            if answer.unstated is not None:
                runs.append(_Left(trial.name, lines, answer, answer.frequency >= part.misfit.band[1] / 2))
    if not runs:
        return noises
    found = np.min([_likeliest(part, noises, quiet) for part in ([run.upper for run in runs], runs)], axis=0)
    return noises | {run.name: _noise(run.name, found, noises, quiet) for run in runs}


@dataclass(frozen=True)
class _Left:
    """What a fit leaves of a run, lines `shape (n, n_channels)`, the way of roads and forces into them, and which lines are upper ones."""

    name: str
    lines: Complex
    answer: RoadAnswer
    above: NDArray[np.bool_]

    @property
    def upper(self) -> _Left:
        """Its upper lines alone."""
        forced, unstated = (None if item is None else item[self.above] for item in (self.answer.forced, self.answer.unstated))
        gain, along = self.answer.gain[self.above], self.answer.wavenumber[self.above]
        answer = RoadAnswer(self.answer.frequency[self.above], along, gain, self.answer.dt, forced, unstated)
        return _Left(self.name, self.lines[self.above], answer, self.above[self.above])


def _noise(name: str, x: Array, noises: Noises, quiet: Noises) -> Noise:
    """Return a run's noise, by the logarithms of the force's error and of its sensors' noise, as shares of what they are at most."""
    return replace(noises[name], acting=float(np.exp(x[0])), sigma=quiet[name].sigma * np.exp(x[1:]))


def _likeliest(runs: Sequence[_Left], noises: Noises, quiet: Noises) -> Array:
    """Return the most likely numbers of :func:`_noise`, `shape (1 + n_channels,)`."""
    n_channels = len(quiet[runs[0].name].sigma)
    bounds = [tuple(np.log(SHARES)), *[(float(np.log(QUIETEST)), 0.0)] * n_channels]

    def loss(x: Array) -> float:
        return sum(_noise(run.name, x, noises, quiet).loss(run.lines, run.answer) for run in runs)

    start = min((np.array([np.log(share), *[own] * n_channels]) for share, own in STARTS), key=loss)
    options = {"xatol": 0.02, "fatol": 0.1, "initial_simplex": start + np.vstack([np.zeros(len(start)), 0.7 * np.eye(len(start))])}
    return np.asarray(scipy.optimize.minimize(loss, start, method="Nelder-Mead", bounds=bounds, options=options).x)
