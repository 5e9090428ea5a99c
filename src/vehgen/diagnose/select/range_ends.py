"""Effects whose own numbers end at the ends of their ranges: they may stand in for something that they are not."""

from __future__ import annotations

from vehgen.diagnose.fits.model_fit import ModelFit


def numbers_at_ends(fit: ModelFit) -> list[str]:
    """Return the parameters of the last effect of a fit that are at an end of their range."""
    found, last, named = fit.least_squares, fit.last, fit.last.effect.parameters
    held = {(type(item), item.place) for item in found.adjusted_to_bounds}
    searched = [item.name for item, symbol in zip(named, last.parameters, strict=False) if symbol in found.on_bound]
    return searched + [item.name for item, own in zip(named, last.shared, strict=False) if (type(own), own.place) in held]
