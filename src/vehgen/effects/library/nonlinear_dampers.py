"""Dampers that are softer in bump than in rebound, grow with the square of their rate, or sit loose in worn eyes."""

from __future__ import annotations

from operator import attrgetter

from vehgen.effects.base import Change, EffectParameter, Symbols
from vehgen.effects.kinds import VehicleEffect
from vehgen.effects.library.law_effect import in_place_of_dashpot, on_spring, suspension_law
from vehgen.effects.locator import EffectSite
from vehgen.effects.places import dampers, suspensions
from vehgen.mechanics.laws import LAWS


def _edit(site: EffectSite, symbols: Symbols) -> Change:
    ratio, c = symbols["ratio"], site.spring.c
    bump, more = 2 * c * ratio / (1 + ratio), 2 * c * (1 - ratio) / (1 + ratio)
    law = {"asymmetric_damping": {"c": more, "ratio": 0}}
    return on_spring(site, {"c": bump, "laws": [*site.laws(site.kind, site.place), law]})


ASYMMETRIC_DAMPING_EFFECT = VehicleEffect(
    name="asymmetric_damping",
    title=LAWS["asymmetric_damping"].title,
    equation="f = 2 c ratio/(1 + ratio)*v in bump, 2 c/(1 + ratio)*v in rebound",
    meaning=LAWS["asymmetric_damping"].meaning,
    signature="the body rises faster than it falls: even harmonics that follow the rate, a mean that sinks over rough roads",
    source=LAWS["asymmetric_damping"].source,
    attaches="suspension",
    places=suspensions,
    parameters=(
        EffectParameter("ratio", "", "damping in bump over that in rebound, their mean kept", low=0.05, high=1.0, starts=(0.3, 0.6)),
    ),
    frees=("c",),
    edit=_edit,
)


def _size(site: EffectSite) -> float:
    return site.c / 0.2


QUADRATIC_DAMPING_EFFECT = suspension_law(
    name="quadratic_damping",
    law="quadratic_damping",
    frees=("c",),
    signature="damping grows with amplitude and speed; odd harmonics",
    parameters=(
        EffectParameter(
            "c2",
            "N s^2/m^2",
            "quadratic damping",
            low=0.02,
            high=30.0,
            starts=(0.5, 4.0),
            scale=_size,
            of="the damping there over 0.2 m/s",
        ),
    ),
)

WORN_ENDS = 0.02
"""No worn eye ends its play quite sharply, and recorders smooth its knocks: of nine plays that were known eight strayed by 0.6 to 3.5 %
and one by 8 %."""


def _loosen(site: EffectSite, symbols: Symbols) -> Change:
    """Return the dashpot moved into one of the same c with play."""
    return in_place_of_dashpot(site, {"damper_free_play": {"c": site.spring.c, "play": symbols["play"]}})


DAMPER_FREE_PLAY_EFFECT = VehicleEffect(
    name="damper_free_play",
    title=LAWS["damper_free_play"].title,
    equation="f = c*dy/dt in place of c*v, y carried along by d where |d - y| would be more than play/2",
    meaning=LAWS["damper_free_play"].meaning,
    signature="small motions are hardly damped, large ones as before; a knock each time the motion turns",
    source=LAWS["damper_free_play"].source,
    attaches="suspension",
    places=dampers,
    parameters=(
        EffectParameter(
            "play",
            "m",
            "from one end of the play to the other",
            low=0.01,
            high=3.0,
            starts=(0.15, 0.5),
            scale=attrgetter("travel"),
            of="a typical travel",
            form=WORN_ENDS,
        ),
    ),
    frees=("c",),
    edit=_loosen,
)
