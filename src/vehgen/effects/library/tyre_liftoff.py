"""Tyres that leave the road."""

from __future__ import annotations

from vehgen.effects.base import Change, Effect
from vehgen.effects.library.law_effect import Given, law_edit
from vehgen.effects.locator import EffectSite
from vehgen.effects.places import tyres
from vehgen.mechanics.laws import LAWS

_ADD = law_edit("tyre", "tyre_liftoff")


def _edit(site: EffectSite, symbols: Given) -> Change:
    return _ADD(site, {"share": "1"})


TYRE_LIFTOFF = Effect(
    "tyre_liftoff",
    LAWS["tyre_liftoff"].title,
    LAWS["tyre_liftoff"].equation,
    LAWS["tyre_liftoff"].meaning,
    "after a high or fast hump the wheel flies and lands: misfits right behind the hump that vanish on lower humps",
    LAWS["tyre_liftoff"].source,
    "tyre",
    (),
    tyres,
    _edit,
)
