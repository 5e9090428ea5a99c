"""How far the simulation itself may be off: its time step, and the road between the points of a measured profile.

Neither is a missing effect. Each is told by doing it otherwise: half the step, and a spline instead of straight lines.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import scipy
from numpy.typing import NDArray

from vehgen.fit.misfit import Misfit
from vehgen.fit.resolution import halved
from vehgen.fit.trial import Trial
from vehgen.road import MeasuredProfile

Array = NDArray[np.float64]
Variant = Callable[[Trial], Trial]
"""Returns a trial simulated otherwise; the trial itself where nothing changes."""
OF_THE_STEP = 16 / 9
"""Mean square of a second-order step's error over that of its change with half the step: 1/(1 - 1/4)^2."""


@dataclass(frozen=True)
class SmoothedProfile:
    """A measured profile with a cubic spline through its points in the place of straight lines."""

    measured: MeasuredProfile

    @property
    def end(self) -> float:
        """Where the profile ends [m]."""
        return self.measured.end

    @cached_property
    def _spline(self) -> scipy.interpolate.CubicSpline:
        return scipy.interpolate.CubicSpline(self.measured.distance, self.measured.heights)

    def height(self, s: Array) -> Array:
        """Return the height above the first point [m] at positions s [m]."""
        inside = np.clip(s, self.measured.distance[0], self.measured.distance[-1])
        return np.asarray(self._spline(inside) - self.measured.heights[0])


def smooth_road(trial: Trial) -> Trial:
    """Return a trial over splines through the points of its measured profiles; a trial without any as it is."""
    track = trial.scenario.track
    if not trial.scenario.over_measured_road:
        return trial
    parts = tuple(SmoothedProfile(part) if isinstance(part, MeasuredProfile) else part for part in track.parts)
    return replace(trial, scenario=replace(trial.scenario, track=replace(track, parts=parts)))


MOST_ADDED = 0.3
"""A run's floor rises by no more: where a simulation errs by more, its step or its road is not fit for any verdict."""


def numerical_floor(misfit: Misfit, x: Array, more: Sequence[Variant] = ()) -> dict[str, float]:
    """Return by how much the simulation's own error may raise the mean square of every run's whitened lines (noise alone: 1).

    Parameters
    ----------
    misfit, x
        A fit.
    more
        Further ways in which its trials might as well be simulated, such as through another filter that the recorder may have.
    """
    values, numbers = misfit.problem.space.values(misfit.split(x)[0])[None], misfit.adjusted(x)
    found = {}
    for number, trial in enumerate(misfit.problem.trials):
        error = misfit.errors_of(x, number)
        plain = misfit.respond(number, values, numbers, error)[0]
        total = 0.0
        for variant, share in ((halved, OF_THE_STEP), *((item, 1.0) for item in (smooth_road, *more))):
            other = variant(trial)
            if other is not trial:
                moved = misfit.whitened_signal(number, misfit.respond(number, values, numbers, error, other)[0] - plain)
                total += share * float(np.mean(np.abs(moved) ** 2))
        found[trial.name] = min(total, MOST_ADDED)
    return found
