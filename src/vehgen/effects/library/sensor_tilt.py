"""Sensor tilt."""

from __future__ import annotations

from vehgen.effects.base import EffectParameter
from vehgen.effects.kinds import RunEffect
from vehgen.effects.places import sensors
from vehgen.fit.adjustments import Tilt

SENSOR_TILT_EFFECT = RunEffect(
    name="sensor_tilt",
    title="Sensor tilt",
    equation="a = a_z*cos(tilt) + (a_x - g*pitch)*sin(tilt), a_x that of its body at the sensor plus height*pitch''",
    meaning="a phone that is not level reads a share of gravity as the body pitches, and of its fore-aft motion",
    signature="one acceleration is off in proportion to the pitch angle at low frequencies, to the pitch acceleration at high ones",
    source="D. H. Titterton, J. L. Weston, Strapdown Inertial Navigation Technology, 2004, doi:10.1049/PBRA017E",
    attaches="sensor",
    places=sensors,
    parameters=(
        EffectParameter("tilt", "rad", "nose-down angle of the sensor on its body", low=-0.8, high=0.8, starts=(-0.4, -0.15, 0.15, 0.4)),
        EffectParameter("height", "m", "of the sensor above where the run file has it", low=-3.0, high=3.0, starts=(0.0,)),
    ),
    adjustment=Tilt,
    scale=0.1,
)
