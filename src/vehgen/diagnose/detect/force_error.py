"""Errors of measured forces whose files state none: ripple of a drive, noise of a load cell. They shake the rig as a white force would.

How large they are shows in the upper half of the band, where sensors and forces share what a fit leaves by how the rig answers: what is
missing from a model mostly shows below, at the motion's own frequencies.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import scipy.optimize
from numpy.typing import NDArray

from vehgen.diagnose.fits.model_fit import ModelFit
from vehgen.fit.misfit import Noises
from vehgen.fit.noise import Noise, RoadAnswer

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
SHARES = (1e-5, 0.3)
"""Errors of a force beside it: smaller ones do not count, larger ones are no errors."""
QUIETEST = 1e-4
"""The sensors may be quieter than the top of the band shows by this factor: it holds the force's error, too."""


def force_noises(fit: ModelFit, noises: Noises, quiet: Noises) -> Noises:
    """Return noises with the errors of measured forces that a fit's runs show, the same share of the force in all of them.

    `quiet` is the noise of the sensors before any fit, which they do not exceed.

    Runs without such forces keep theirs.
    """
    runs: list[tuple[str, Complex, RoadAnswer]] = []
    for part in fit.parts:
        for trial, (lines, answer) in zip(part.misfit.problem.trials, part.misfit.residual_spectrum(part.x), strict=True):
            if answer.unstated is not None:
                upper = answer.frequency >= part.misfit.band[1] / 2
                runs.append((trial.name, lines[upper], _within(answer, upper)))
    if not runs:
        return noises
    n_channels = len(noises[runs[0][0]].sigma)
    low, high = (np.array([np.log(share), *[np.log(own)] * n_channels]) for share, own in zip(SHARES, (QUIETEST, 1.0), strict=True))

    def noise(name: str, x: Array) -> Noise:
        return replace(noises[name], acting=float(np.exp(x[0])), sigma=quiet[name].sigma * np.exp(x[1:]))

    def loss(x: Array) -> float:
        return sum(noise(name, x).loss(lines, answer) for name, lines, answer in runs)

    starts = (np.array([np.log(share), *[own] * n_channels]) for share, own in ((1e-4, 0.0), (0.03, -3.0)))
    found = [scipy.optimize.minimize(loss, start, method="L-BFGS-B", bounds=list(zip(low, high, strict=True))) for start in starts]
    best = min(found, key=lambda item: float(item.fun))
    return noises | {name: noise(name, best.x) for name, _, _ in runs}


def _within(answer: RoadAnswer, inside: NDArray[np.bool_]) -> RoadAnswer:
    """Return the answer at some of its lines."""
    forced, unstated = (None if item is None else item[inside] for item in (answer.forced, answer.unstated))
    return RoadAnswer(answer.frequency[inside], answer.wavenumber[inside], answer.gain[inside], answer.dt, forced, unstated)
