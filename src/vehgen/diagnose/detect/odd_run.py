"""Whether runs over humps agree on the vehicle: what one of them gains by parameters of its own.

A base model that fits all runs within the noise may hide what is missing: recalibrated parameters and the errors of runs share it out
among them. A run that was made with another load, or in which an effect that grows with travel shows most, asks for other parameters than
the rest. To the first order about the fit to all runs it can be told, run by run, by how much -2 ln L would fall if only that run had
parameters of its own. Errors of recorders and drivers hardly look like it: healthy runs gain about as many as there are parameters.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from vehgen.diagnose.detect.road_error import measured_profiles
from vehgen.diagnose.fits.model_fit import BASE_PRIOR_SIGMA, refine
from vehgen.fit.least_squares import LeastSquaresFit
from vehgen.fit.linearisation import linearise

if TYPE_CHECKING:
    from vehgen.diagnose.detect.detection import Detection

Array = NDArray[np.float64]
ODD_AMONG = 3
"""So many runs there must be: of two nobody can say which is odd."""
ODD_FACTOR, ODD_MARGIN = 4.0, 60.0
"""So many times what chance gives, and so much more, an odd run gains at least; healthy runs of an independent world gained 62 at most."""


@dataclass(frozen=True)
class OddRun:
    """A run that asks for a vehicle of its own: -2 ln L would fall by `gain`, where chance gives about `by_chance`."""

    run: str
    gain: float
    by_chance: float


def odd_run(detection: Detection) -> OddRun | None:
    """Return the run over humps that disagrees most with the others on the vehicle; None where all agree as well as chance lets them.

    Measured roads have errors of their own and are left out; so are rigs.
    """
    trials = detection.trials
    judged = [trial.name for trial in trials if trial.scenario.track.parts and not measured_profiles(trial)]
    if len(trials) < ODD_AMONG or not judged:
        return None
    joint = _fit_all(detection)
    found = max((item for item in _own_parameters(joint) if item.run in judged), key=lambda item: item.gain)
    return found if found.gain > ODD_MARGIN + ODD_FACTOR * found.by_chance else None


def _fit_all(detection: Detection) -> LeastSquaresFit:
    """Return the base fitted to all runs, validation runs too."""
    fit, parts = detection.base.least_squares, detection.base.parts
    return refine(fit.misfit.problem.with_trials(detection.trials), fit, fit.x, (), fit.misfit.noises, known_errors=parts)


def _own_parameters(fit: LeastSquaresFit) -> list[OddRun]:
    """Return what every run gains by parameters of its own that have the base's priors about the common ones."""
    misfit = fit.misfit
    n, space = misfit.n_parameters, misfit.problem.space
    lines, linear = misfit.whitened_spectrum(fit.x), linearise(misfit, fit.x, one_sided=True)
    prior = 1 / BASE_PRIOR_SIGMA**2
    information, gradient = linear.normal(lines, fit.x)
    information[:n, :n] += prior * np.eye(n)
    gradient[:n] += prior * (fit.x[:n] - space.unit(space.start))
    inverse = np.linalg.pinv(information, hermitian=True)
    found = []
    for trial, block, columns, line in zip(misfit.problem.trials, linear.blocks, linear.columns, lines, strict=True):
        rows = np.ascontiguousarray(block).view(np.float64).reshape(len(block), 2 * line.size)
        cross = np.zeros((n, len(information)))
        cross[:, columns] = 2 * rows[:n] @ rows.T
        own = cross[:, :n] + prior * np.eye(n) - cross @ inverse @ cross.T
        pull = 2 * rows[:n] @ np.ascontiguousarray(line).ravel().view(np.float64) - cross @ inverse @ gradient
        found.append(OddRun(trial.name, float(pull @ np.linalg.solve(own, pull)), n))
    return found
