"""Springs that stiffen with travel: by its cube, beyond a travel in bump, at stops either way."""

from __future__ import annotations

from operator import attrgetter

from vehgen.effects.base import EffectParameter
from vehgen.effects.library.law_effect import suspension_law
from vehgen.effects.locator import EffectSite

BUMP_STOP_EFFECT = suspension_law(
    name="bump_stop",
    law="bump_stop",
    special_case="progressive_stiffness",  # where the stop in rebound is never met
    signature="sharp peaks of acceleration when travel passes a threshold; nothing below it",
    parameters=(
        EffectParameter(
            "k",
            "N/m",
            "stiffness of the stops",
            low=0.5,
            high=30.0,
            starts=(6.0,),
            scale=attrgetter("k"),
            of="the stiffness there",
        ),
        EffectParameter(
            "clearance",
            "m",
            "travel in bump before the stop is met",
            low=0.05,
            high=4.0,
            starts=(0.5, 1.2, 2.0),
            scale=attrgetter("travel"),
            of="a typical travel",
        ),
        EffectParameter(
            "rebound",
            "m",
            "travel in rebound before the stop is met",
            low=0.05,
            high=6.0,
            starts=(1.5,),
            scale=attrgetter("travel"),
            of="a typical travel",
        ),
    ),
)


def _size(site: EffectSite) -> float:
    return site.k / site.travel**2


CUBIC_STIFFNESS_EFFECT = suspension_law(
    name="cubic_stiffness",
    law="cubic_stiffness",
    frees=("k",),
    signature="frequencies rise with amplitude; odd harmonics; bump and rebound alike",
    parameters=(
        EffectParameter(
            "k3",
            "N/m^3",
            "cubic stiffness",
            low=0.01,
            high=30.0,
            starts=(0.3, 3.0),
            scale=_size,
            of="the stiffness there over the square of a typical travel",
        ),
    ),
)

PROGRESSIVE_STIFFNESS_EFFECT = suspension_law(
    name="progressive_stiffness",
    law="progressive_stiffness",
    frees=("k",),
    signature="stiffer in bump than in rebound: even harmonics and a shifted mean over rough roads",
    parameters=(
        EffectParameter(
            "k",
            "N/m",
            "stiffness added beyond `start`",
            low=0.05,
            high=5.0,
            starts=(0.5, 2.0),
            scale=attrgetter("k"),
            of="the stiffness there",
        ),
        EffectParameter(
            "start",
            "m",
            "travel in bump at which it joins in",
            low=0.02,
            high=3.0,
            starts=(0.3, 1.0),
            scale=attrgetter("travel"),
            of="a typical travel",
        ),
    ),
)
