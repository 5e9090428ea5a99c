"""A misfit linearised at a point: the derivatives of its whitened spectra, as a value that may serve again nearby.

Derivatives are differences of simulated responses. Those by the nuisances of runs (clock, speed, height) cost a simulation each and change
little along a fit, so that one linearisation may take them from another.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from vehgen.fit.misfit import Array, Complex, Misfit, flatten
from vehgen.fit.trial import Trial

UNIT_DIFFERENCE = 1e-6
"""Step of the differences to each side, in the unit cube and in units of a nuisance's uncertainty: so short that jumps of a response
seldom cross a sample."""


@dataclass(frozen=True)
class Linearisation:
    """Derivatives of a misfit's whitened spectra at a point.

    `spectra` holds a trial's derivatives each, `shape (n_unknowns, n_lines, n_channels)`; `nuisance_slopes` those of its response by its
    nuisances, `shape (n_nuisances, n_samples, n_channels)`, before whitening; `n_priors` counts the nuisances of all trials.
    """

    spectra: tuple[Complex, ...]
    nuisance_slopes: tuple[Array, ...]
    n_priors: int

    @property
    def jacobian(self) -> Array:
        """The derivatives of :meth:`Misfit.residuals`, `shape (n_residuals, n_unknowns)`, the nuisances' priors last."""
        n_unknowns = self.spectra[0].shape[0]
        prior = np.zeros((self.n_priors, n_unknowns))
        prior[:, n_unknowns - self.n_priors :] = np.eye(self.n_priors)
        return np.vstack([*(flatten(lines, first=1).T for lines in self.spectra), prior])


Lineariser = Callable[[Array], Linearisation]
"""Linearises one misfit at unknowns x."""


def linearise(misfit: Misfit, x: Array, *, one_sided: bool = False, nuisances_of: Linearisation | None = None) -> Linearisation:
    """Return a misfit's linearisation at x, by differences.

    Parameters
    ----------
    misfit, x
        The misfit, and its unknowns `shape (n_unknowns,)`.
    one_sided
        Take differences to one side, which takes half of the time.
    nuisances_of
        A linearisation of the same misfit nearby whose derivatives by nuisances serve again (default: compute them).
    """
    unit, errors = misfit.split(x)
    numbers, n, s, k = misfit.adjusted(x), misfit.n_parameters, len(misfit.shared), len(misfit.nuisances.names)
    moved = np.vstack([np.eye(n), np.zeros((1, n)) if one_sided else -np.eye(n)])
    values = misfit.problem.space.values(unit + moved * UNIT_DIFFERENCE)
    middle = misfit.problem.space.values(unit)[None]
    spectra, kept = [], []
    for t, (trial, error) in enumerate(zip(misfit.problem.trials, errors, strict=True)):
        derived = np.zeros((misfit.n_unknowns, len(trial.recording.time), len(trial.channels)))
        responses = misfit.respond(trial, values, numbers, error) if len(values) else np.zeros((0, *derived.shape[1:]))
        centre = responses[n] if one_sided else None
        if n and one_sided:
            derived[:n] = (responses[:n] - responses[n]) / UNIT_DIFFERENCE
        elif n:
            derived[:n] = (responses[:n] - responses[n:]) / (2 * UNIT_DIFFERENCE)
        for j, item in enumerate(misfit.shared):
            step = UNIT_DIFFERENCE * item.scale * np.eye(s)[j]
            derived[n + j] = _slope(misfit, trial, middle, (numbers, step), (error, np.zeros(k)), centre)
        if nuisances_of is None:
            slopes = np.zeros((k, *derived.shape[1:]))
            for j, step in enumerate(UNIT_DIFFERENCE * np.eye(k)):
                slopes[j] = _slope(misfit, trial, middle, (numbers, np.zeros(s)), (error, step), centre)
        else:
            slopes = nuisances_of.nuisance_slopes[t]
        kept.append(slopes)
        derived[n + s + t * k : n + s + (t + 1) * k] = slopes
        spectra.append(-misfit.whitened_signal(t, derived))
    return Linearisation(tuple(spectra), tuple(kept), len(misfit.problem.trials) * k)


def lineariser(misfit: Misfit, refresh: int = 1) -> Lineariser:
    """Return what linearises a misfit again and again, as a fit asks for it.

    Parameters
    ----------
    misfit
        What is linearised.
    refresh
        Every how many linearisations the derivatives by nuisances are computed anew; beyond 1 all derivatives are one-sided, too.
    """
    fresh: Linearisation | None = None
    count = 0

    def linearise_again(x: Array) -> Linearisation:
        nonlocal fresh, count
        found = linearise(misfit, x, one_sided=refresh > 1, nuisances_of=fresh if count % refresh else None)
        fresh, count = found, count + 1
        return found

    return linearise_again


def _slope(
    misfit: Misfit, trial: Trial, values: Array, numbers: tuple[Array, Array], error: tuple[Array, Array], centre: Array | None
) -> Array:
    """Return the change of a trial's response per UNIT_DIFFERENCE, when numbers and errors (value, step) are moved by their steps."""
    ahead = misfit.respond(trial, values, numbers[0] + numbers[1], error[0] + error[1])[0]
    if centre is not None:
        return np.asarray((ahead - centre) / UNIT_DIFFERENCE)
    behind = misfit.respond(trial, values, numbers[0] - numbers[1], error[0] - error[1])[0]
    return np.asarray((ahead - behind) / (2 * UNIT_DIFFERENCE))
