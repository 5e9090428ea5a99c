"""A hinge that resists pitch."""

from __future__ import annotations

from vehgen.effects.base import Change, Effect, EffectParameter
from vehgen.effects.library.law_effect import Given
from vehgen.effects.locator import EffectSite
from vehgen.effects.places import hinges


def _edit(site: EffectSite, symbols: Given) -> Change:
    return {"hinges": {site.place: {"k": symbols["k"]}}}


HINGE_STIFFNESS = Effect(
    "hinge_stiffness",
    "Hinge stiffness",
    "M = k*(pitch of the second body - pitch of the first)",
    "rubber mounts or a plate that resist pitch between the two bodies",
    "pitch frequencies of both bodies rise, at every amplitude",
    "Wu & Li 2023, Fig. 3 (which leaves it out), doi:10.3390/s23249691",
    "hinge",
    (EffectParameter("k", "N m", "stiffness against pitch, per rad", 0.02, 100.0, (1.0, 10.0), lambda site: site.load),),
    hinges,
    _edit,
)
