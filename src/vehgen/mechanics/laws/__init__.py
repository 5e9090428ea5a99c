"""Which forces are not linear? The library of force laws, kin in one file, and laws that a file writes itself."""

from vehgen.mechanics.laws.asymmetric_damping import ASYMMETRIC_DAMPING
from vehgen.mechanics.laws.base import Kind, Law, LawParameter, LawState, LawStep, custom_law
from vehgen.mechanics.laws.free_play import DAMPER_FREE_PLAY
from vehgen.mechanics.laws.friction import ASYMMETRIC_FRICTION, DRY_FRICTION, ELASTO_PLASTIC
from vehgen.mechanics.laws.memory import HYSTERESIS, RELAXATION
from vehgen.mechanics.laws.powers import CUBIC_STIFFNESS, QUADRATIC_DAMPING, QUADRATIC_STIFFNESS
from vehgen.mechanics.laws.stops import BUMP_STOP, PROGRESSIVE_STIFFNESS, TYRE_LIFTOFF

LAWS: dict[str, Law] = {
    law.name: law
    for law in (
        DRY_FRICTION,
        ASYMMETRIC_FRICTION,
        ELASTO_PLASTIC,
        CUBIC_STIFFNESS,
        QUADRATIC_STIFFNESS,
        PROGRESSIVE_STIFFNESS,
        BUMP_STOP,
        ASYMMETRIC_DAMPING,
        QUADRATIC_DAMPING,
        DAMPER_FREE_PLAY,
        RELAXATION,
        HYSTERESIS,
        TYRE_LIFTOFF,
    )
}

__all__ = ["LAWS", "Kind", "Law", "LawParameter", "LawState", "LawStep", "custom_law"]
