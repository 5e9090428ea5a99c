"""A damper whose force grows with the square of its rate."""

from __future__ import annotations

from vehgen.effects.base import EffectParameter
from vehgen.effects.library.law_effect import suspension_law
from vehgen.effects.locator import EffectSite


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
