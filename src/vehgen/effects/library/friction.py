"""Dry friction in a suspension or link, alike both ways or stronger one way than the other."""

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


ASYMMETRIC_FRICTION_EFFECT = suspension_law(
    name="asymmetric_friction",
    law="asymmetric_friction",
    frees=("c",),
    special_case="dry_friction",
    signature=("as dry friction, but the mean force leaves zero as soon as it slips; beside an unknown constant force it is dry friction"),
    parameters=(
        EffectParameter(
            "force",
            "N",
            "mean of the forces at which it slips either way",
            low=0.002,
            high=0.4,
            starts=(0.03, 0.12),
            scale=attrgetter("load"),
            of="the static load",
        ),
        EffectParameter("ratio", "", "force in compression over that in extension", low=0.1, high=10.0, starts=(0.6, 1.6)),
    ),
)
