"""A spring in series with a dashpot (Maxwell branch)."""

from __future__ import annotations

from operator import attrgetter

from vehgen.effects.base import EffectParameter
from vehgen.effects.library.law_effect import suspension_law

RELAXATION_EFFECT = suspension_law(
    name="relaxation",
    law="relaxation",
    frees=("k", "c"),
    signature="stiffness and damping change with frequency, not with amplitude: low and high frequencies want different k and c",
    parameters=(
        EffectParameter(
            "k",
            "N/m",
            "stiffness of the series spring",
            low=0.05,
            high=10.0,
            starts=(0.5, 2.0),
            scale=attrgetter("k"),
            of="the stiffness there",
        ),
        EffectParameter("time", "s", "relaxation time, dashpot over spring", low=0.002, high=1.0, starts=(0.02, 0.1)),
    ),
)
