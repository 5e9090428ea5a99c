"""A damper that is softer in bump than in rebound."""

from __future__ import annotations

from vehgen.effects.base import EffectParameter
from vehgen.effects.law_effect import suspension_law

ASYMMETRIC_DAMPING = suspension_law(
    "asymmetric_damping",
    "asymmetric_damping",
    "the body rises faster than it falls: even harmonics that follow the rate, a mean that sinks over rough roads",
    (
        EffectParameter("c", "N s/m", "damping in rebound, beside the linear damper", 0.05, 3.0, (0.4, 1.2), lambda site: site.c),
        EffectParameter("ratio", "", "damping in bump over that in rebound", 0.02, 1.0, (0.3,)),
    ),
)
