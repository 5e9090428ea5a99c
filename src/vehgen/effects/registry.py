"""The library of effects: those of vehgen, and those that other packages or files add."""

from __future__ import annotations

from importlib.metadata import entry_points

from vehgen.effects.base import Effect
from vehgen.effects.library.bodies import ENGINE_HARMONIC_EFFECT, FRAME_BENDING_EFFECT
from vehgen.effects.library.damper_springs import ADDED_STIFFNESS_EFFECT, DAMPER_MOUNT_EFFECT
from vehgen.effects.library.hinges import HINGE_FRICTION_EFFECT, HINGE_STIFFNESS_EFFECT
from vehgen.effects.library.measuring import (
    SENSOR_DELAY_EFFECT,
    SENSOR_GAIN_EFFECT,
    SENSOR_POSITION_EFFECT,
    SENSOR_TILT_EFFECT,
    SPEED_ERROR_EFFECT,
)
from vehgen.effects.library.memory import ASYMMETRIC_FRICTION_EFFECT, DRY_FRICTION_EFFECT, HYSTERESIS_EFFECT, RELAXATION_EFFECT
from vehgen.effects.library.mounted_masses import CARGO_MODULE_EFFECT, SUSPENDED_CAB_EFFECT
from vehgen.effects.library.nonlinear_dampers import ASYMMETRIC_DAMPING_EFFECT, DAMPER_FREE_PLAY_EFFECT, QUADRATIC_DAMPING_EFFECT
from vehgen.effects.library.stiffening_springs import BUMP_STOP_EFFECT, CUBIC_STIFFNESS_EFFECT, PROGRESSIVE_STIFFNESS_EFFECT
from vehgen.effects.library.tyres import TYRE_DAMPING_EFFECT, TYRE_FOOTPRINT_EFFECT, TYRE_LIFTOFF_EFFECT
from vehgen.effects.library.walking_beam import WALKING_BEAM_EFFECT
from vehgen.effects.library.wheels import WHEEL_RUNOUT_EFFECT
from vehgen.errors import InputError, shown
from vehgen.files.names import is_identifier

GROUP = "vehgen.effects"
"""Entry points of this group name Effect objects of other packages."""

EFFECTS: dict[str, Effect] = {
    effect.name: effect
    for effect in (
        DRY_FRICTION_EFFECT,
        ASYMMETRIC_FRICTION_EFFECT,
        ADDED_STIFFNESS_EFFECT,
        CUBIC_STIFFNESS_EFFECT,
        PROGRESSIVE_STIFFNESS_EFFECT,
        BUMP_STOP_EFFECT,
        ASYMMETRIC_DAMPING_EFFECT,
        QUADRATIC_DAMPING_EFFECT,
        HYSTERESIS_EFFECT,
        RELAXATION_EFFECT,
        DAMPER_MOUNT_EFFECT,
        DAMPER_FREE_PLAY_EFFECT,
        TYRE_LIFTOFF_EFFECT,
        TYRE_DAMPING_EFFECT,
        TYRE_FOOTPRINT_EFFECT,
        HINGE_FRICTION_EFFECT,
        HINGE_STIFFNESS_EFFECT,
        SUSPENDED_CAB_EFFECT,
        FRAME_BENDING_EFFECT,
        WALKING_BEAM_EFFECT,
        CARGO_MODULE_EFFECT,
        ENGINE_HARMONIC_EFFECT,
        WHEEL_RUNOUT_EFFECT,
        SENSOR_GAIN_EFFECT,
        SENSOR_POSITION_EFFECT,
        SENSOR_TILT_EFFECT,
        SENSOR_DELAY_EFFECT,
        SPEED_ERROR_EFFECT,
    )
}
"""The effects of vehgen, by name."""


def library() -> dict[str, Effect]:
    """Return all effects: those of vehgen, then those that installed packages add.

    Raises
    ------
    InputError
        For an entry point that is no effect, whose effect has no proper name, or that of another.
    """
    found = dict(EFFECTS)
    for point in entry_points(group=GROUP):
        effect = point.load()
        if not isinstance(effect, Effect):
            raise InputError(f"the entry point {shown(point.name)} of {GROUP} is not an Effect")
        if not is_identifier(effect.name):
            raise InputError(f"the entry point {shown(point.name)} of {GROUP} names its effect {shown(effect.name)}, which is no name")
        if effect.name in found:
            raise InputError(f"two effects are named {shown(effect.name)}; the entry point {shown(point.name)} must choose another name")
        found[effect.name] = effect
    return found
