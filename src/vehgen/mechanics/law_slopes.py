"""Own force laws about rest: a force that jumps there, or is infinitely steep, cannot be stepped through time."""

from __future__ import annotations

from collections.abc import Mapping

from vehgen.errors import InputError
from vehgen.files.expressions import Expression, ExpressionError
from vehgen.vehicle.model import Vehicle

NEAR, NEARER = 1e-4, 1e-8
"""How far from rest forces are compared [m, m/s; on hinges rad, rad/s]."""
STEEP = 5e-4
"""A force that changes over the shorter way by this share of its change over the longer is too steep; a straight one by 1e-4."""
LEAST_CHANGE = 1e-9
"""A change that is smaller than this share of the force there is none."""
ACROSS = {"d": ("v", 0.1), "v": ("d", 0.01)}
"""Each is looked at where the other is zero, and where it is so much."""
CURE = "dry friction is the law `dry_friction`; else a force with a finite slope was expected, such as F*max(min(v/v0, 1), -1)"


def check_slopes(vehicle: Vehicle, force: Expression, own: Mapping[str, Expression], path: tuple[str | int, ...]) -> None:
    """Refuse an own law without a value about rest, or that jumps or is infinitely steep where d or v passes 0.

    Parameters
    ----------
    vehicle
        Whose values count.
    force, own
        The force of d, v and the law's parameters, and these by name.
    path
        Where the law stands in the vehicle file.

    Raises
    ------
    InputError
        At the force.
    """
    known = vehicle.all_values(vehicle.values())
    known |= {name: expression.evaluate(known) for name, expression in own.items()}
    place = vehicle.position(*path, "force")

    def at(**motion: float) -> float:
        try:
            return force.evaluate(known | motion)
        except ExpressionError as error:
            where = ", ".join(f"{name} = {value:g}" for name, value in sorted(motion.items()))
            raise InputError(f"the force has no value at {where}: {error}", place) from error

    for name, (other, size) in ACROSS.items():
        for beside in (0.0, size):
            rest = at(**{name: 0.0, other: beside})
            for way in (1.0, -1.0):
                long, short = (abs(at(**{name: way * reach, other: beside}) - rest) for reach in (NEAR, NEARER))
                if short > STEEP * long and short > LEAST_CHANGE * abs(rest):
                    raise InputError(f"the force jumps, or is infinitely steep, where {name} passes 0: {CURE}", place)
