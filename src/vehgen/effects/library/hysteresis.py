"""A smooth hysteresis loop (Bouc-Wen)."""

from __future__ import annotations

from vehgen.effects.base import EffectParameter
from vehgen.effects.library.law_effect import suspension_law

HYSTERESIS = suspension_law(
    name="hysteresis",
    law="hysteresis",
    signature="a loop of force over travel that does not depend on the rate; rounded corners tell it from dry friction",
    parameters=(
        EffectParameter("force", "N", "force of the fully developed loop", 0.002, 0.4, (0.03, 0.12), lambda site: site.load),
        EffectParameter("travel", "m", "travel over which the loop develops", 0.05, 3.0, (0.3, 1.0), lambda site: site.travel),
        EffectParameter("beta", "", "share of the loss that follows |v|", 0.3, 1.0, (0.55,)),
    ),
)
