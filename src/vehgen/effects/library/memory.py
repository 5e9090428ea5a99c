"""Laws that remember: dry friction, a smooth hysteresis loop (Bouc-Wen), a spring in series with a dashpot (Maxwell branch)."""

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
HYSTERESIS_EFFECT = suspension_law(
    name="hysteresis",
    law="hysteresis",
    special_case="added_stiffness",  # whose loop never develops
    signature="a loop of force over travel that does not depend on the rate; rounded corners tell it from dry friction",
    parameters=(
        EffectParameter(
            "force",
            "N",
            "force of the fully developed loop",
            low=0.002,
            high=0.4,
            starts=(0.03, 0.12),
            scale=attrgetter("load"),
            of="the static load",
        ),
        EffectParameter(
            "travel",
            "m",
            "travel over which the loop develops",
            low=0.05,
            high=3.0,
            starts=(0.3, 1.0),
            scale=attrgetter("travel"),
            of="a typical travel",
        ),
        EffectParameter("beta", "", "share of the loss that follows |v|", low=0.3, high=1.0, starts=(0.55,)),
    ),
)
RELAXATION_EFFECT = suspension_law(
    name="relaxation",
    law="relaxation",
    frees=("k", "c"),
    special_case="damper_mount",  # where no dashpot is left beside it
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
