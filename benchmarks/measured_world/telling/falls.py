"""What a law takes off -2 ln of the likelihood, beside what the base model takes off with the same freedom."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vehgen.diagnose.detect.detection import Detection
from vehgen.diagnose.fits.candidate import Candidate, freed_alone
from vehgen.diagnose.fits.model_fit import ModelFit, base_priors
from vehgen.diagnose.fits.multi_start import fit_candidate
from vehgen.diagnose.select.criteria import passes
from vehgen.diagnose.select.estimates import fitted_numbers, p_value
from vehgen.diagnose.select.fitter import Fitter
from vehgen.diagnose.select.ranking import own_numbers
from vehgen.diagnose.select.validation import gain_interval
from vehgen.effects.evidence import StartingPoint
from vehgen.fit.least_squares import WEAK_PRIOR_SIGMA

Array = NDArray[np.float64]
Data = dict[str, Any]
STUCK = 1.5
"""A true law that leaves more than this mean square is fitted to slow motions first, too, as the diagnosis does it."""
END = 0.01
"""This share of a number's range is left out at its ends, where fits may begin."""


def cost(fit: ModelFit) -> float:
    """Return -2 ln of the likelihood on the training runs and of all that has a prior, less a constant."""
    found = fit.least_squares
    space, unit = found.misfit.problem.space, found.misfit.split(found.x)[0]
    n = len(unit) - fit.n_effect_parameters
    sigma = np.concatenate([base_priors(space.names[:n], fit.effects), np.full(len(unit) - n, WEAK_PRIOR_SIGMA)])
    return float(found.loss + (((unit - space.unit(space.start)) / sigma) ** 2).sum())


def price(added: int, n_residuals: int) -> float:
    """Return what a law's numbers cost, as the diagnosis ranks laws (BIC)."""
    return added * float(np.log(n_residuals))


class Falls:
    """Measures falls on what was detected.

    Parameters
    ----------
    detection
        Of the diagnosis.
    tried
        How many candidates the library has.
    truth
        True parameters of the vehicle [SI], where fits of the true law begin, too.
    """

    def __init__(self, detection: Detection, tried: int, truth: Mapping[str, float] | None = None) -> None:
        self.detection, self.tried, self.base = detection, tried, detection.base
        self.fitter = Fitter(detection, detection.base, ())
        self._bases: dict[tuple[str, ...], list[ModelFit]] = {}
        space = self.fitter.current.problem.space
        known = np.array([(truth or {}).get(name, start) for name, start in zip(space.names, space.start, strict=True)])
        self.true_origin: StartingPoint = space.unit(np.clip(known, space.lower, space.upper)), self.fitter.current.errors

    def fit(self, candidate: Candidate, start: tuple[float, ...] | None = None) -> ModelFit | None:
        """Return a candidate's fit from its own starts and from the true one, with validation runs simulated."""
        fitter = self.fitter
        usual = candidate.effect.starts(candidate.place, fitter.locator, fitter.residual)
        origins = candidate.effect.origins(fitter.origins)
        found = self._fitted(candidate, [*origins, fitter.origins.fitted], [*usual, *self._ends(candidate, usual[0])])
        if start is not None:
            true = self._fitted(candidate, [self.true_origin, fitter.origins.fitted], [start])
            found = min((fit for fit in (found, true) if fit is not None), key=cost, default=None)
            if found is None or found.training > STUCK:
                slow = fitter.fit(candidate, [start])
                slow = slow if slow is None or np.isfinite(slow.validation) else fitter.fit_again(slow)
                found = min((fit for fit in (found, slow) if fit is not None), key=cost, default=None)
        return found

    def _ends(self, candidate: Candidate, usual: tuple[float, ...]) -> list[tuple[float, ...]]:
        """Return starts at either end of a law's first number, at one of which it does least."""
        if candidate.shared:
            return [tuple(item.neutral for item in candidate.shared)]
        first = candidate.effect.search_dimensions(candidate.place, self.fitter.locator)[:1]
        ends = [end for item in first for end in (item.low + END * (item.high - item.low), item.high - END * (item.high - item.low))]
        ends += [1.1 * item.low for item in first if item.low > 0]
        return [(end, *usual[1:]) for end in ends]

    def _fitted(self, candidate: Candidate, origins: Sequence[StartingPoint], starts: Sequence[tuple[float, ...]]) -> ModelFit | None:
        fitter, detection = self.fitter, self.detection
        fit = fit_candidate(
            candidate,
            fitter.current,
            detection.validation_runs,
            detection.floor.noises,
            detection.band,
            fitter.locator,
            fitter.simulators,
            list({id(item): item for item in origins}.values()),
            starts,
            slow_first=False,
        )
        return fit if fit is None or np.isfinite(fit.validation) or not detection.validation_runs else fitter.fit_again(fit)

    def beside(self, fit: ModelFit) -> ModelFit:
        """Return the lowest fit of the base that may move what a law's fit may, begun where that one ended, too."""
        freed = fit.last.freed
        n = self.fitter.current.problem.space.size
        if freed not in self._bases:
            values = self.fitter.current.problem.space.unit(
                np.clip(fit.least_squares.values[:n], self.fitter.current.problem.space.lower, self.fitter.current.problem.space.upper)
            )
            ended = values, fit.least_squares.misfit.split(fit.least_squares.x)[1]
            alone = freed_alone(freed)
            other = self._fitted(alone, [self.fitter.origins.fitted, ended], [()])
            self._bases[freed] = [self.base, *([] if other is None else [other])]
        return min(self._bases[freed], key=cost)

    def measured(self, fit: ModelFit) -> Data:
        """Return what a law's fit takes off, beside the base of the same freedom, and what the diagnosis would make of it."""
        base, held = self.beside(fit), [trial.name for trial in self.detection.validation_runs]
        added = own_numbers(fit)
        numbers = dict(zip([item.name for item in fit.last.effect.parameters], fitted_numbers(fit, fit.last), strict=False))
        checked, other = fit.validation_fit, base.validation_fit
        return {
            "name": fit.last.effect.name,
            "place": fit.last.place,
            "numbers": numbers,
            "added": added,
            "fall": cost(base) - cost(fit),
            "beyond_price": cost(base) - cost(fit) - price(added, fit.n_residuals),
            "fall_of_base": cost(self.base) - cost(base),
            "squares": (base.training - fit.training) * fit.n_residuals,
            "validation_fall": None if checked is None or other is None else other.loss - checked.loss,
            "training": fit.training,
            "validation": fit.validation,
            "p": min(1.0, self.tried * p_value(self.base, fit, added)),
            "passes": bool(passes(fit, self.base)),
            "gain_interval": gain_interval(self.base, fit, held),
            "freed": list(fit.last.freed),
            "on_bound": list(fit.least_squares.on_bound),
        }
