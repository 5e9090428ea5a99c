"""Tyre footprint."""

from __future__ import annotations

from vehgen.effects.base import EffectParameter
from vehgen.effects.kinds import RunEffect
from vehgen.effects.places import all_tyres
from vehgen.fit.adjustments import Footprint

TYRE_FOOTPRINT_EFFECT = RunEffect(
    name="tyre_footprint",
    title="Tyre footprint",
    equation="w(s) = mean of the road over s - length/2 to s + length/2",
    meaning="a tyre averages the road over its contact length; a point contact sees every edge",
    signature="too much high frequency in the simulation at every axle, with nulls at speed/length",
    source="D. Cebon, Handbook of Vehicle-Road Interaction, 1999, ISBN 9789026515545",
    attaches="tyre",
    places=all_tyres,
    parameters=(EffectParameter("length", "m", "contact length", low=0.01, high=0.5, starts=(0.1, 0.25)),),
    is_global=True,
    adjustment=Footprint,
    scale=0.05,
)
