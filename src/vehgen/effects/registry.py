"""The library of effects: those of vehgen, and those that other packages or files add."""

from __future__ import annotations

from importlib.metadata import entry_points

from vehgen.effects.base import Effect
from vehgen.effects.library.asymmetric_damping import ASYMMETRIC_DAMPING
from vehgen.effects.library.bump_stop import BUMP_STOP
from vehgen.effects.library.cargo_module import CARGO_MODULE
from vehgen.effects.library.cubic_stiffness import CUBIC_STIFFNESS
from vehgen.effects.library.dry_friction import DRY_FRICTION
from vehgen.effects.library.engine_harmonic import ENGINE_HARMONIC
from vehgen.effects.library.frame_bending import FRAME_BENDING
from vehgen.effects.library.hinge_friction import HINGE_FRICTION
from vehgen.effects.library.hinge_stiffness import HINGE_STIFFNESS
from vehgen.effects.library.hysteresis import HYSTERESIS
from vehgen.effects.library.progressive_stiffness import PROGRESSIVE_STIFFNESS
from vehgen.effects.library.quadratic_damping import QUADRATIC_DAMPING
from vehgen.effects.library.relaxation import RELAXATION
from vehgen.effects.library.sensor_delay import SENSOR_DELAY
from vehgen.effects.library.sensor_gain import SENSOR_GAIN
from vehgen.effects.library.sensor_position import SENSOR_POSITION
from vehgen.effects.library.sensor_tilt import SENSOR_TILT
from vehgen.effects.library.speed_error import SPEED_ERROR
from vehgen.effects.library.suspended_cab import SUSPENDED_CAB
from vehgen.effects.library.tyre_damping import TYRE_DAMPING
from vehgen.effects.library.tyre_footprint import TYRE_FOOTPRINT
from vehgen.effects.library.tyre_liftoff import TYRE_LIFTOFF
from vehgen.effects.library.walking_beam import WALKING_BEAM
from vehgen.errors import InputError, shown
from vehgen.files.names import is_identifier

GROUP = "vehgen.effects"
"""Entry points of this group name Effect objects of other packages."""

EFFECTS: dict[str, Effect] = {
    effect.name: effect
    for effect in (
        DRY_FRICTION,
        CUBIC_STIFFNESS,
        PROGRESSIVE_STIFFNESS,
        BUMP_STOP,
        ASYMMETRIC_DAMPING,
        QUADRATIC_DAMPING,
        HYSTERESIS,
        RELAXATION,
        TYRE_LIFTOFF,
        TYRE_DAMPING,
        TYRE_FOOTPRINT,
        HINGE_FRICTION,
        HINGE_STIFFNESS,
        SUSPENDED_CAB,
        FRAME_BENDING,
        WALKING_BEAM,
        CARGO_MODULE,
        ENGINE_HARMONIC,
        SENSOR_GAIN,
        SENSOR_POSITION,
        SENSOR_TILT,
        SENSOR_DELAY,
        SPEED_ERROR,
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
