"""Sensor gain."""

from __future__ import annotations

from vehgen.effects.base import Effect, EffectParameter
from vehgen.effects.places import sensors_

SENSOR_GAIN = Effect(
    "sensor_gain",
    "Sensor gain",
    "y = gain*y_true",
    "a sensor that reads too much or too little",
    "one sensor is off by the same factor at all frequencies and in all runs, the others fit",
    "ISO 16063-1:1998, calibration of vibration transducers",
    "sensor",
    (EffectParameter("gain", "", "reading over truth", 0.7, 1.4, (0.9, 1.1)),),
    sensors_,
    adjusts="gain",
)
