"""What a verdict says of the effects it names: what they are, how large, where, and how much they explain."""

from __future__ import annotations

from collections.abc import Sequence

from vehgen.diagnose.fits.model_fit import ModelFit
from vehgen.diagnose.select.estimates import validation_gain
from vehgen.diagnose.verdict import NamedEffect, sentence
from vehgen.vehicle import Vehicle

ALL_EXPLAINED = 0.9995
"""A share that rounds to 100.0 % is told as all."""


def describe_effects(vehicle: Vehicle, fit: ModelFit, named: Sequence[NamedEffect]) -> str:
    """Return the effects of a fit of a vehicle in words, each with its size and place; `named` holds their numbers, in the same order."""
    told = [
        candidate.effect.describe(vehicle, candidate.place, {name: number.value for name, number in item.parameters.items()})
        for candidate, item in zip(fit.effects, named, strict=True)
    ]
    return sentence([told[0], *(text[0].lower() + text[1:] for text in told[1:])], "and")


def explained_share(base: ModelFit, fit: ModelFit) -> str:
    """Return in words how much of what the base model misses a fit explains, on runs that neither was fitted to where these show a gap."""
    closed = validation_gain(base, fit)
    if closed is None:
        return "what the model missed on the runs that it was fitted to"
    share = "all" if closed >= ALL_EXPLAINED else f"{100 * closed:.1f} %"
    return f"{share} of what the model missed on runs that it was not fitted to"
