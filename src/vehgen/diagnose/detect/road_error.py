"""What a measured profile holds that the road does not: a profiler's own error shakes stiff tyres harder than a sensor's noise.

A profiler's error is white from point to point, and drifts. Its displacement spectrum over wavenumber n is

    G(n) = D n0^2/n^2 + W sinc(n d)^4

with the level D of the drift (as of a road of ISO 8608, n0 = 0.1 cycles/m), W = 2 d e^2 for an error e of points d apart, between which the
profile runs straight. Both, and how much louder a sensor is on such a run than at rest, are those most likely for what a fit leaves of the
run; no error is larger than MOST_ERROR_M, so that a wrong model does not pass for a wrong profile. The road under a hump, too, is not quite
as rough as the one before it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy
from numpy.typing import NDArray

from vehgen.diagnose.fits.model_fit import ModelFit
from vehgen.fit.misfit import Noises
from vehgen.fit.noise import EVEN, LARGEST_LEVEL, SMALLEST_LEVEL, Noise
from vehgen.fit.parallel import one_blas_thread
from vehgen.fit.road_answer import KNOT_WAVENUMBERS, RoadAnswer
from vehgen.fit.trial import Trial
from vehgen.road import MeasuredProfile
from vehgen.road.iso8608 import REFERENCE_CYCLES_PER_M

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
MOST_ERROR_M = 1e-3
"""A profiler's points are off by so much at most [m] ..."""
MOST_DRIFT = 16e-6
"""... and its drift is no rougher than an even road, of class A [m^3]."""
UNDER_HUMP = (0.6, 1.6)
"""The road under a hump is so many times as rough (as a level) as the one before it."""
LOUDEST = 3.0
"""A sensor's noise grows so many times at most on a rough road."""
LEAST_ERROR_M = 1e-6


@dataclass(frozen=True)
class ProfileError:
    """The error of a profile's points [m], `spacing` [m] apart, the level of its drift [m^3], and the growth of the sensors' noise."""

    points: float
    drift: float
    growth: float
    spacing: float

    def noise(self, lead: Noise) -> Noise:
        """Return the noise of the run, given that of the sensors at rest."""
        white = 2 * self.spacing * self.points**2 * np.sinc(KNOT_WAVENUMBERS * self.spacing) ** 4
        levels = lead.levels + self.drift + white * (KNOT_WAVENUMBERS / REFERENCE_CYCLES_PER_M) ** 2
        return replace(lead, levels=np.clip(levels, SMALLEST_LEVEL, LARGEST_LEVEL), sigma=self.growth * lead.sigma)


def measured_profiles(trial: Trial) -> Sequence[MeasuredProfile]:
    """Return the measured profiles that a run drives over."""
    return [part for part in trial.scenario.track.parts if isinstance(part, MeasuredProfile)]


def road_noises(base: ModelFit, noises: Noises, lead: Noises) -> Noises:
    """Return the noise of all runs with what a model's fit says of their roads.

    Of runs over measured profiles that is the profile's error: a sensor at rest is as loud as in the lead-ins of the runs that have one, or
    else as on the run itself. Of other runs it is how much rougher the road under the hump is than the one before it, whose noise is
    `lead`: within UNDER_HUMP, no more.
    """
    found = dict(noises)
    for fit in base.parts:
        for trial, (lines, answer) in zip(fit.misfit.problem.trials, fit.misfit.residual_spectrum(fit.x), strict=True):
            if measured_profiles(trial):
                at_rest = _at_rest(trial, base, lead)
                found[trial.name] = find_profile_error(trial, lines, answer, at_rest).noise(at_rest)
            elif np.any(lead[trial.name].levels > 2 * SMALLEST_LEVEL):
                found[trial.name] = under_hump(lines, answer, lead[trial.name])
    return found


def under_hump(lines: Complex, answer: RoadAnswer, lead: Noise) -> Noise:
    """Return a run's noise with the most likely roughness, as so many times that of its lead-in.

    `lines shape (n, n_channels)` are what a fit leaves of the run, `answer` the road's way into them.
    """
    bounds = (float(np.log(UNDER_HUMP[0])), float(np.log(UNDER_HUMP[1])))
    found = scipy.optimize.minimize_scalar(
        lambda x: lead.rougher(float(np.exp(x))).loss(lines, answer), bounds=bounds, method="bounded", options={"xatol": 0.02}
    )
    return lead.rougher(float(np.exp(found.x)))


def _at_rest(trial: Trial, base: ModelFit, noises: Noises) -> Noise:
    """Return the noise of a run's sensors in the quietest run without a profile that has the same channels, or in the run itself."""
    others = [other for fit in base.parts for other in fit.misfit.problem.trials if other.channels == trial.channels]
    quiet = [noises[other.name] for other in others if not measured_profiles(other)]
    own = noises[trial.name]
    if not quiet:
        return replace(own, levels=EVEN)
    return replace(own, sigma=np.min([item.sigma for item in quiet], axis=0), slope=quiet[0].slope, levels=EVEN)


def find_profile_error(trial: Trial, lines: Complex, answer: RoadAnswer, lead: Noise) -> ProfileError:
    """Return the most likely error of a run's profile.

    Parameters
    ----------
    trial
        A run over a measured profile.
    lines, answer
        What a fit leaves of it, `shape (n_lines, n_channels)`, and the road's way into it.
    lead
        The sensors' noise at rest.
    """
    spacing = float(np.median(np.diff(measured_profiles(trial)[0].distance)))

    def read(x: Array) -> ProfileError:
        return ProfileError(float(np.exp(x[0])), float(np.exp(x[1])), float(np.exp(x[2])), spacing)

    def loss(x: Array) -> float:
        return read(x).noise(lead).loss(lines, answer)

    bounds = [
        (np.log(LEAST_ERROR_M), np.log(MOST_ERROR_M)),
        (np.log(SMALLEST_LEVEL), np.log(MOST_DRIFT)),
        (0.0, np.log(LOUDEST)),
    ]
    starts = [np.array([np.log(error), np.log(drift), 0.0]) for error, drift in ((1e-5, 1e-9), (2e-4, 1e-7))]
    with one_blas_thread():
        found = [scipy.optimize.minimize(loss, start, method="L-BFGS-B", bounds=bounds, options={"maxiter": 30}) for start in starts]
    return read(min(found, key=lambda item: float(item.fun)).x)
