"""The quantities that can be recorded or computed, with SI units, by what they belong to."""

POINT_QUANTITIES = {
    "acceleration": "m/s^2",
    "velocity": "m/s",
    "displacement": "m",
    "pitch": "rad",
    "pitch_rate": "rad/s",
    "pitch_acceleration": "rad/s^2",
    "fore_aft_acceleration": "m/s^2",
}
AXLE_QUANTITIES = {"suspension_travel": "m", "suspension_force": "N", "tyre_force": "N", "tyre_load": "N"}
AXLE_MOTIONS = {name: POINT_QUANTITIES[name] for name in ("acceleration", "velocity", "displacement")}
"""Vertical motions of an axle; where its wheel sits on its body, of that body there."""
LINK_QUANTITIES = {"link_travel": "m", "link_force": "N"}
HINGE_QUANTITIES = {"hinge_force": "N", "hinge_load": "N", "hinge_angle": "rad", "hinge_moment": "N m"}
"""Of a pin: the vertical force that the first-named body presses upwards on the second, and the second's pitch against the first."""
ELEMENT_QUANTITIES = {**AXLE_QUANTITIES, **LINK_QUANTITIES, **HINGE_QUANTITIES}
WITH_STATIC = ("tyre_load", "hinge_load")
"""Forces that count the weight; all others are zero in static equilibrium."""
QUANTITIES = {**POINT_QUANTITIES, **ELEMENT_QUANTITIES}
"""All that can be recorded, with SI units."""
