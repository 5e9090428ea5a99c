"""Dry friction in a hinge."""

from __future__ import annotations

from operator import attrgetter

from vehgen.effects.base import EffectParameter
from vehgen.effects.library.law_effect import hinge_law

HINGE_FRICTION_EFFECT = hinge_law(
    name="hinge_friction",
    law="dry_friction",
    title="Hinge friction (Coulomb)",
    meaning="a greased plate that sticks: both bodies pitch as one until the moment slips",
    signature="small pitch motions of the two bodies are locked together, large ones are not",
    parameters=(
        EffectParameter(
            "force",
            "N m",
            "moment at which it slips",
            low=0.002,
            high=0.4,
            starts=(0.02, 0.1),
            scale=attrgetter("load"),
            of="the hinge's static load times 1 m",
        ),
    ),
)
