"""Sensor delay."""

from __future__ import annotations

from vehgen.effects.base import EffectParameter
from vehgen.effects.kinds import RunEffect
from vehgen.effects.places import sensors
from vehgen.fit.adjustments import SensorDelay

SENSOR_DELAY_EFFECT = RunEffect(
    name="sensor_delay",
    title="Sensor delay",
    equation="y(t) = y_true(t - delay)",
    meaning="a sensor whose clock is late against the others",
    signature="one sensor lags by a phase that grows with frequency",
    source="J. S. Bendat, A. G. Piersol, Random Data, 4th ed., 2010, doi:10.1002/9781118032428",
    attaches="sensor",
    places=sensors,
    parameters=(
        EffectParameter(
            "delay", "s", "late against the first sensor", low=-0.3, high=0.3, starts=(-0.25, -0.15, -0.05, -0.015, 0.015, 0.05, 0.15, 0.25)
        ),
    ),
    adjustment=SensorDelay,
    scale=0.01,
    tie_advice=(
        "no run tells which of the sensors is late and which early: only the difference of their clocks shows; record both by one clock, "
        "or let both feel a knock at a known time"
    ),
)
