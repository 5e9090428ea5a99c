"""Sensor delay."""

from __future__ import annotations

from vehgen.effects.base import Effect, EffectParameter
from vehgen.effects.places import sensors_

SENSOR_DELAY = Effect(
    "sensor_delay",
    "Sensor delay",
    "y(t) = y_true(t - delay)",
    "a sensor whose clock is late against the others",
    "one sensor lags by a phase that grows with frequency",
    "J. S. Bendat, A. G. Piersol, Random Data, 4th ed., 2010, doi:10.1002/9781118032428",
    "sensor",
    (EffectParameter("delay", "s", "late against the first sensor", -0.3, 0.3, (-0.05, -0.015, 0.015, 0.05)),),
    sensors_,
    adjusts="sensor_delay",
)
