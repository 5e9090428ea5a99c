"""Whether an effect does more than the base parameters that its fit sets free.

A candidate that searches a damping within the file's whole range fits well wherever that damping is merely far from the file's value. The
base model with the same freedom, and without the effect, tells the two apart. So does one with the freedom of those parameters that its
refit ends at the edge with: a stiffness that the file has wrong by a factor looks like an effect somewhere else.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from vehgen.diagnose import thresholds as limit
from vehgen.diagnose.fits.candidate import Candidate, freed_alone
from vehgen.diagnose.fits.model_fit import ModelFit
from vehgen.diagnose.select.estimates import p_value
from vehgen.diagnose.select.ranking import merit, own_numbers

FAR_BEHIND = 2.0
"""Beside a fit that leaves noise, those that leave so many times its mean square are not asked: nothing hangs on them."""

FitOne = Callable[[Candidate], ModelFit | None]
"""Fits one candidate on top of the current model."""
FitWithout = Callable[[ModelFit], ModelFit | None]
"""Fits what a fit's last effect set free, without that effect, from where the fit ended."""


def split_idle(
    fits: Sequence[ModelFit], fit_one: FitOne, count: int, edge: tuple[str, ...] = (), fit_without: FitWithout | None = None
) -> tuple[list[ModelFit], list[ModelFit]]:
    """Return the fits whose effects do something, in their order, and those of freed base parameters alone that do as well, best first.

    Parameters
    ----------
    fits
        Best first; they are tested until `count` have been found to do something, the rest are returned as they are.
    fit_one
        Fits a candidate on top of the model that they were added to.
    count
        How many are needed.
    edge
        Base parameters that the current model has at the edge of its bounds.
    fit_without
        Where an edge is given, freed base parameters are sought from where each fit ended, too.
    """
    alone: dict[tuple[str, ...], ModelFit | None] = {}
    kept: list[ModelFit] = []
    idle: dict[tuple[str, ...], ModelFit] = {}
    for fit in fits:
        does_nothing, asked = False, len(kept) < count and not _is_far_behind(fit, kept)
        for names in dict.fromkeys((fit.last.freed, edge)) if asked else ():
            if names and names not in alone:
                alone[names] = fitted_freed(names, fit_one)
            freed = alone.get(names)
            if freed is not None and _does_as_well(freed, fit):
                idle[names] = freed
                does_nothing = True
        if edge and fit_without is not None and not does_nothing and asked:
            freed = idle_instead(fit, fit_without)
            if freed is not None:
                idle[freed.last.freed] = freed
                does_nothing = True
        if not does_nothing:
            kept.append(fit)
    return kept, sorted(idle.values(), key=_price)


def _is_far_behind(fit: ModelFit, kept: Sequence[ModelFit]) -> bool:
    return any(item.training <= limit.NOISE_FLOOR**2 and fit.training > FAR_BEHIND * item.training for item in kept[:1])


def idle_instead(fit: ModelFit, fit_without: FitWithout) -> ModelFit | None:
    """Return the freed base parameters that do as well as the effect whose fit freed them, sought from where that ended; None if none do.

    From where fits usually begin, those of a base that hangs on its bounds may end elsewhere, and an effect pass for what they do.
    """
    freed = fit_without(fit) if fit.last.freed else None
    return freed if freed is not None and _does_as_well(freed, fit) else None


def fitted_freed(names: tuple[str, ...], fit_one: FitOne) -> ModelFit | None:
    """Return the fit of base parameters that are set free, without an effect."""
    return fit_one(freed_alone(names))


def freed_ratios(freed: ModelFit) -> dict[str, float]:
    """Return the fitted value over the file's of every base parameter that was set free."""
    space = freed.least_squares.misfit.problem.space
    ratios = dict(zip(space.names, (freed.least_squares.values / space.start).tolist(), strict=True))
    return {name: ratios[name] for name in freed.last.freed if name in ratios}


def _price(freed: ModelFit) -> float:
    """Return what ranks freed base parameters: -2 ln of the likelihood on the training runs, with the price of each (BIC)."""
    total = sum(freed.counts.values())
    return freed.training * total + len(freed.last.freed) * float(np.log(total))


def _does_as_well(freed: ModelFit, fit: ModelFit) -> bool:
    """Return whether freed base parameters leave what a fit leaves: by chance, or less than twice its excess.

    Where they leave noise alone, an effect has to do as much more as one that chi does not show.
    """
    if freed.training <= limit.NOISE_FLOOR**2:
        return merit(freed) - merit(fit) < limit.FAINT_FALL
    before, after = (max(item.training - 1, 0.0) for item in (freed, fit))
    return after > limit.AT_LEAST * before or p_value(freed, fit, own_numbers(fit)) > limit.SIGNIFICANT
