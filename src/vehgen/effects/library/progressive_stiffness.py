"""A helper spring that joins in beyond some travel."""

from __future__ import annotations

from vehgen.effects.base import EffectParameter
from vehgen.effects.library.law_effect import suspension_law

PROGRESSIVE_STIFFNESS = suspension_law(
    name="progressive_stiffness",
    law="progressive_stiffness",
    signature="stiffer in bump than in rebound: even harmonics and a shifted mean over rough roads",
    parameters=(
        EffectParameter("k", "N/m", "stiffness added beyond `start`", 0.05, 5.0, (0.5, 2.0), lambda site: site.k),
        EffectParameter("start", "m", "travel in bump at which it joins in", 0.02, 3.0, (0.3, 1.0), lambda site: site.travel),
    ),
)
