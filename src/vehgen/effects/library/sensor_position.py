"""Sensor position."""

from __future__ import annotations

from vehgen.effects.base import Effect, EffectParameter
from vehgen.effects.places import sensors_

SENSOR_POSITION = Effect(
    "sensor_position",
    "Sensor position",
    "x = x_nominal + shift",
    "a sensor that is not where its run file says",
    "acceleration of one sensor is off by a share of the pitch acceleration; its pitch rate fits",
    "Wu & Li 2023, Eqs. 15 to 18, doi:10.3390/s23249691",
    "sensor",
    (EffectParameter("shift", "m", "ahead of where the run file says", -2.0, 2.0, (-0.4, 0.4)),),
    sensors_,
    adjusts="position",
)
