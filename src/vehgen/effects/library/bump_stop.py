"""Stops at both ends of the travel."""

from __future__ import annotations

from vehgen.effects.base import EffectParameter
from vehgen.effects.library.law_effect import suspension_law

BUMP_STOP = suspension_law(
    name="bump_stop",
    law="bump_stop",
    signature="sharp peaks of acceleration when travel passes a threshold; nothing below it",
    parameters=(
        EffectParameter("k", "N/m", "stiffness of the stops", 0.5, 30.0, (6.0,), lambda site: site.k),
        EffectParameter("clearance", "m", "travel in bump before the stop is met", 0.05, 4.0, (0.5, 1.2, 2.0), lambda site: site.travel),
        EffectParameter("rebound", "m", "travel in rebound before the stop is met", 0.05, 6.0, (1.5,), lambda site: site.travel),
    ),
)
