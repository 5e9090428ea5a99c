"""The noise of rigs in a diagnosis, where a fit leaves what is missing beside it.

How large the errors of measured forces are, and how quiet the sensors, shows in the upper half of the band in what a fit leaves: what is
missing from a model mostly shows below, at the motion's own frequencies. Where the whole band has less of it than that half allows, that
counts. So noise that was overrated, by harmonics above the band, comes down once the best model is known.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

import numpy as np
import scipy
from numpy.typing import NDArray

from vehgen.diagnose.fits.model_fit import ModelFit
from vehgen.fit.misfit import Noises
from vehgen.fit.rig_noise import SHARES, RigNoiseSearch, RunResidual, likelier_noises

Array = NDArray[np.float64]
LESS_LIKELY = 4.0
"""The upper half of the band allows errors of forces by which -2 ln of the likelihood grows by so much (two standard deviations)."""


def rig_noises(fit: ModelFit, noises: Noises, quiet: Noises) -> Noises:
    """Return noises with what a fit's runs without a road show; others keep theirs, and so does what run files state.

    `quiet` is the noise of the sensors before any fit, which they do not exceed.
    """
    groups: dict[tuple[str, ...], list[RunResidual]] = {}
    for part in fit.parts:
        for trial, (lines, answer) in zip(part.misfit.problem.trials, part.misfit.residual_spectrum(part.x), strict=True):
            if not trial.scenario.track.parts:
                groups.setdefault(trial.channels, []).append(RunResidual(trial, lines, answer))
    found = dict(noises)
    for runs in groups.values():
        upper = [run.within(run.answer.frequency >= fit.parts[0].misfit.band[1] / 2) for run in runs]
        found |= likelier_noises(runs, noises, quiet, partial(_numbers, runs=runs, upper=upper))
    return found


def _numbers(search: RigNoiseSearch, *, runs: Sequence[RunResidual], upper: Sequence[RunResidual]) -> Array:
    """Return the numbers that stand: the largest error of forces that both answers allow, and the sensors' quieter noise beside it."""
    error = min(_largest_error(search, upper), search.likeliest(runs)[0]) if search.has_force else None
    return np.asarray(np.min([search.likeliest(part, error) for part in (upper, runs)], axis=0))


def _largest_error(search: RigNoiseSearch, runs: Sequence[RunResidual]) -> float:
    """Return the logarithm of the largest error of forces that is hardly less likely than the likeliest: runs may tell little of it."""
    x = search.likeliest(runs)
    allowed = search.loss(x, runs) + LESS_LIKELY

    def beyond(error: float) -> float:
        return search.loss(np.array([error, *x[1:]]), runs) - allowed

    end = float(np.log(SHARES[1]))
    return float(scipy.optimize.brentq(beyond, x[0], end, xtol=0.02)) if beyond(end) > 0 else end
