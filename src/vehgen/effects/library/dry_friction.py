"""Dry friction in a suspension."""

from __future__ import annotations

from operator import attrgetter

from vehgen.effects.base import EffectParameter
from vehgen.effects.library.law_effect import suspension_law

DRY_FRICTION_EFFECT = suspension_law(
    name="dry_friction",
    law="dry_friction",
    frees=("c",),
    signature=(
        "small motions pass the suspension as if it were locked, large ones are damped; hump and rough-road runs disagree on its stiffness"
    ),
    parameters=(
        EffectParameter(
            "force",
            "N",
            "force at which it slips",
            low=0.002,
            high=0.4,
            starts=(0.02, 0.06, 0.15),
            scale=attrgetter("load"),
            of="the static load",
        ),
    ),
)
