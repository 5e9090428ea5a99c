"""Tyres that touch the road along a length, or leave it."""

from __future__ import annotations

from vehgen.effects.base import Change, EffectParameter, Symbols
from vehgen.effects.kinds import RunEffect, VehicleEffect
from vehgen.effects.library.law_effect import LawEdit
from vehgen.effects.locator import EffectSite
from vehgen.effects.places import all_tyres, tyres
from vehgen.files.expressions import Expression
from vehgen.fit.adjustments import Footprint
from vehgen.mechanics.laws import LAWS

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


_LIFTOFF = LawEdit("tyre", "tyre_liftoff")


def _lift_off(site: EffectSite, symbols: Symbols) -> Change:
    return _LIFTOFF(site, {"share": Expression.quantity(1)})


TYRE_LIFTOFF_EFFECT = VehicleEffect(
    name="tyre_liftoff",
    title=LAWS["tyre_liftoff"].title,
    equation=LAWS["tyre_liftoff"].equation,
    meaning=LAWS["tyre_liftoff"].meaning,
    signature="after a high or fast hump the wheel flies and lands: misfits right behind the hump that vanish on lower humps",
    source=LAWS["tyre_liftoff"].source,
    attaches="tyre",
    places=tyres,
    is_global=True,
    frees=("kt",),
    edit=_lift_off,
)
