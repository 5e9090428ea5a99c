"""Sensor tilt."""

from __future__ import annotations

from vehgen.effects.base import Effect, EffectParameter
from vehgen.effects.places import sensors_

SENSOR_TILT = Effect(
    "sensor_tilt",
    "Sensor tilt",
    "a_z = a_true - g*sin(tilt)*pitch",
    "a phone that is not level reads a share of gravity as the body pitches",
    "one acceleration is off at low frequencies, in proportion to the pitch angle",
    "D. H. Titterton, J. L. Weston, Strapdown Inertial Navigation Technology, 2004, doi:10.1049/PBRA017E",
    "sensor",
    (EffectParameter("tilt", "rad", "nose-down angle of the sensor on its body", -0.8, 0.8, (-0.4, -0.15, 0.15, 0.4)),),
    sensors_,
    adjusts="tilt",
)
