"""Stops at both ends of the travel."""

from __future__ import annotations

from operator import attrgetter

from vehgen.effects.base import EffectParameter
from vehgen.effects.library.law_effect import suspension_law

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
