"""A hinge that sticks, or resists pitch."""

from __future__ import annotations

from operator import attrgetter

from vehgen.effects.base import Change, EffectParameter, Symbols
from vehgen.effects.kinds import VehicleEffect
from vehgen.effects.library.law_effect import hinge_law
from vehgen.effects.locator import EffectSite
from vehgen.effects.places import hinges

HINGE_FRICTION_EFFECT = hinge_law(
    name="hinge_friction",
    law="dry_friction",
    title="Hinge friction (Coulomb)",
    meaning="a greased plate that sticks: both bodies pitch as one until the moment slips",
    signature="small pitch motions of the two bodies are locked together, large ones are not",
    parameters=(
        EffectParameter(
            "force",
            "N m",
            "moment at which it slips",
            low=0.002,
            high=0.4,
            starts=(0.02, 0.1),
            scale=attrgetter("load"),
            of="the hinge's static load, or a tenth of the lighter body's weight, times 1 m",
        ),
    ),
)


def _edit(site: EffectSite, symbols: Symbols) -> Change:
    return {"hinges": {site.place: {"k": symbols["k"]}}}


HINGE_STIFFNESS_EFFECT = VehicleEffect(
    name="hinge_stiffness",
    title="Hinge stiffness",
    equation="M = k*(pitch of the second body - pitch of the first)",
    meaning="rubber mounts or a plate that resist pitch between the two bodies",
    signature="pitch frequencies of both bodies rise, at every amplitude",
    source="Wu & Li 2023, Fig. 3 (which leaves it out), doi:10.3390/s23249691",
    attaches="hinge",
    places=hinges,
    parameters=(
        EffectParameter(
            "k",
            "N m",
            "stiffness against pitch, per rad",
            low=0.02,
            high=100.0,
            starts=(1.0, 10.0),
            scale=attrgetter("load"),
            of="the hinge's static load, or a tenth of the lighter body's weight, times 1 m",
        ),
    ),
    edit=_edit,
)
