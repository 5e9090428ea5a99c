"""A spring where the vehicle's file has a damper alone, or nothing but friction."""

from __future__ import annotations

from operator import attrgetter

from vehgen.effects.base import Change, EffectParameter, Symbols
from vehgen.effects.kinds import VehicleEffect
from vehgen.effects.library.law_effect import on_spring
from vehgen.effects.locator import EffectSite
from vehgen.effects.places import springless


def _edit(site: EffectSite, symbols: Symbols) -> Change:
    return on_spring(site, {"k": symbols["k"]})


ADDED_STIFFNESS_EFFECT = VehicleEffect(
    name="added_stiffness",
    title="A spring that the file does not have",
    equation="f = k*d",
    meaning="gas under pressure in a damper, a bushing, a hose or a cable that pulls back, where the file declares no stiffness",
    signature="slow motions meet a force that follows the travel; what the file lets drift comes back, or rings",
    source="J. C. Dixon, The Shock Absorber Handbook, 2nd ed., Wiley 2007 (gas-pressurised dampers), doi:10.1002/9780470516430",
    attaches="suspension",
    places=springless,
    parameters=(
        EffectParameter(
            "k",
            "N/m",
            "stiffness beside what is there",
            low=0.003,
            high=10.0,
            starts=(0.03, 0.3),
            scale=attrgetter("k"),
            of="the largest force that occurs over the largest travel",
        ),
    ),
    frees=("c",),
    edit=_edit,
)
