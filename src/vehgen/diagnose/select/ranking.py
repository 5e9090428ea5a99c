"""Rounds of fits, and what ranks them: of effects that do as well a special case goes first, as its general case always does as well."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from vehgen.diagnose import thresholds as limit
from vehgen.diagnose.fits.model_fit import ModelFit
from vehgen.diagnose.localise.unknown_force import PlaceResult


@dataclass(frozen=True)
class SearchRound:
    """One search for one effect: what the `current` model leaves, the places tested and passed, and the candidates fitted, best first.

    `idle` are fits of freed base parameters alone that do as well as an effect whose fit freed them, and which is left out. `stopped` tells
    that Ctrl-C ended it before all candidates were fitted, `faint` that candidates are judged by falls of -2 ln L, as chi shows no gap.
    """

    current: ModelFit
    places: tuple[PlaceResult, ...]
    passed: tuple[PlaceResult, ...]
    fits: tuple[ModelFit, ...]
    idle: tuple[ModelFit, ...] = ()
    stopped: bool = False
    faint: bool = False


def merit(fit: ModelFit) -> float:
    """Return what ranks fits: -2 ln of the likelihood on the training runs and of the errors it supposes, with the price of its numbers.

    That price is BIC's for the last effect's numbers. Errors count because of two effects that do as well, the one that needs a phone's
    clock to be 30 ms off in every run is the less likely one.
    """
    return fit.squares + price_of_numbers(fit)


def price_of_numbers(fit: ModelFit) -> float:
    """Return what the last effect's numbers have to gain, by BIC, for the fit to be the likelier one."""
    return own_numbers(fit) * float(np.log(fit.n_residuals))


def own_numbers(fit: ModelFit) -> int:
    """Return how many numbers the last effect of a fit added."""
    return fit.last.effect.n_numbers(len(fit.least_squares.misfit.problem.trials))


def numbers_at_ends(fit: ModelFit) -> list[str]:
    """Return the parameters of the last effect of a fit that are at an end of their range: it may stand in for what it is not."""
    found, last, named = fit.least_squares, fit.last, fit.last.effect.parameters
    held = {(type(item), item.place) for item in found.adjusted_to_bounds}
    searched = [item.name for item, symbol in zip(named, last.parameters, strict=False) if symbol in found.on_bound]
    return searched + [item.name for item, own in zip(named, last.shared, strict=False) if (type(own), own.place) in held]


def does_as_well(mean_square: float, best: float, before: float) -> bool:
    """Return whether a mean square is within the slack of TIE of the best one, where an excess of `before` was to be explained."""
    floor = limit.NOISE_FLOOR**2 - 1
    near = max(0.02 * before, 0.5 * floor)
    return mean_square - best <= near and mean_square - 1 <= limit.TIE * max(best - 1, 0.25 * floor)


def simplest_first(fits: Sequence[ModelFit], base: ModelFit) -> list[ModelFit]:
    """Return fits in their order, but first one that does as well as the best: within its range where that is not, or its special case.

    A special case at the end of its range does not go before what is within its own: the stop of a van, which only bump met, was told as a
    spring of the largest stiffness that one may have.

    Parameters
    ----------
    fits
        Best first, each of one more effect than `base`.
    base
        What they were added to.
    """
    before = max(base.training - 1, 0.0)
    for fit in fits[1:]:
        likelier = goes_before(fit, fits[0], bool(numbers_at_ends(fit)), bool(numbers_at_ends(fits[0])))
        if likelier and np.isfinite(fit.validation) and does_as_well(fit.training, fits[0].training, before):
            return [fit, *(item for item in fits if item is not fit)]
    return list(fits)


def goes_before(fit: ModelFit, best: ModelFit, ends: bool, best_ends: bool) -> bool:
    """Return whether a fit that does as well as the best one is the likelier: its special case, or alone of the two within its range."""
    return best_ends if ends != best_ends else best.last.holds(fit.last)


def holding(fits: Sequence[ModelFit], fit: ModelFit, base: ModelFit) -> list[ModelFit]:
    """Return those of a round's fits that hold the last effect of `fit` as a special case and do as well; `base` is as above."""
    before = max(base.training - 1, 0.0)
    return [item for item in fits if item.last.holds(fit.last) and does_as_well(item.training, fit.training, before)]
