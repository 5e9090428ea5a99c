"""Sensor gain."""

from __future__ import annotations

from vehgen.effects.base import EffectParameter
from vehgen.effects.kinds import RunEffect
from vehgen.effects.places import channels
from vehgen.fit.adjustments import Gain

SENSOR_GAIN_EFFECT = RunEffect(
    name="sensor_gain",
    title="Sensor gain",
    equation="y = gain*y_true",
    meaning="a sensor that reads too much or too little",
    signature="one sensor is off by the same factor at all frequencies and in all runs, the others fit",
    source="ISO 16063-1:1998, calibration of vibration transducers",
    attaches="sensor",
    places=channels,
    parameters=(EffectParameter("gain", "", "reading over truth", low=0.7, high=1.4, starts=(0.9, 1.1)),),
    adjustment=Gain,
    scale=0.05,
    neutral=1.0,
)
