"""A spring that hardens with its travel."""

from __future__ import annotations

from vehgen.effects.base import EffectParameter
from vehgen.effects.library.law_effect import suspension_law
from vehgen.effects.locator import EffectSite


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
