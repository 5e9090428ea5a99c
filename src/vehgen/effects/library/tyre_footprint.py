"""Tyre footprint."""

from __future__ import annotations

from vehgen.effects.base import Effect, EffectParameter
from vehgen.effects.places import all_tyres

TYRE_FOOTPRINT = Effect(
    "tyre_footprint",
    "Tyre footprint",
    "w(s) = mean of the road over s - length/2 to s + length/2",
    "a tyre averages the road over its contact length; a point contact sees every edge",
    "too much high frequency in the simulation at every axle, with nulls at speed/length",
    "D. Cebon, Handbook of Vehicle-Road Interaction, 1999, ISBN 9789026515545",
    "tyre",
    (EffectParameter("length", "m", "contact length", 0.01, 0.5, (0.1, 0.25)),),
    all_tyres,
    adjusts="footprint",
)
