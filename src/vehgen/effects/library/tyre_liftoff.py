"""Tyres that leave the road."""

from __future__ import annotations

from vehgen.effects.base import Change, Symbols
from vehgen.effects.kinds import VehicleEffect
from vehgen.effects.library.law_effect import LawEdit
from vehgen.effects.locator import EffectSite
from vehgen.effects.places import tyres
from vehgen.files.expressions import Expression
from vehgen.mechanics.laws import LAWS

_ADD = LawEdit("tyre", "tyre_liftoff")


def _edit(site: EffectSite, symbols: Symbols) -> Change:
    return _ADD(site, {"share": Expression.quantity(1)})


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
    edit=_edit,
)
