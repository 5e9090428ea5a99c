"""Sensor position."""

from __future__ import annotations

from vehgen.effects.base import EffectParameter
from vehgen.effects.kinds import RunEffect
from vehgen.effects.places import sensors_on_bodies

SENSOR_POSITION_EFFECT = RunEffect(
    name="sensor_position",
    title="Sensor position",
    equation="x = x_nominal + shift",
    meaning="a sensor that is not where its run file says",
    signature="acceleration of one sensor is off by a share of the pitch acceleration; its pitch rate fits",
    source="Wu & Li 2023, Eqs. 15 to 18, doi:10.3390/s23249691",
    attaches="sensor",
    places=sensors_on_bodies,
    parameters=(EffectParameter("shift", "m", "ahead of where the run file says", low=-2.0, high=2.0, starts=(-0.4, 0.4)),),
    adjustment=None,
)
