"""What ranks fits of effects, and holds them against what base parameters do alone."""

from __future__ import annotations

import numpy as np

from vehgen.diagnose.fits.model_fit import ModelFit


def merit(fit: ModelFit) -> float:
    """Return what ranks fits: -2 ln of the likelihood on the training runs and of the errors it supposes, with the price of its numbers.

    That price is BIC's for the last effect's numbers. Errors count because of two effects that do as well, the one that needs a phone's
    clock to be 30 ms off in every run is the less likely one.
    """
    return fit.squares + own_numbers(fit) * float(np.log(fit.n_residuals))


def own_numbers(fit: ModelFit) -> int:
    """Return how many numbers the last effect of a fit added."""
    return fit.last.effect.n_numbers(len(fit.least_squares.misfit.problem.trials))


def numbers_at_ends(fit: ModelFit) -> list[str]:
    """Return the parameters of the last effect of a fit that are at an end of their range: it may stand in for what it is not."""
    found, last, named = fit.least_squares, fit.last, fit.last.effect.parameters
    held = {(type(item), item.place) for item in found.adjusted_to_bounds}
    searched = [item.name for item, symbol in zip(named, last.parameters, strict=False) if symbol in found.on_bound]
    return searched + [item.name for item, own in zip(named, last.shared, strict=False) if (type(own), own.place) in held]
