"""What may be wrong with the measuring: a sensor's gain, position, tilt or clock, the speed of all runs."""

from __future__ import annotations

from vehgen.effects.base import EffectParameter
from vehgen.effects.kinds import RunEffect
from vehgen.effects.places import channels, runs, sensors, sensors_on_bodies
from vehgen.fit.adjustments import Gain, SensorDelay, SpeedScale, Tilt

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


SPEED_ERROR_EFFECT = RunEffect(
    name="speed_error",
    title="Speed error",
    equation="v = scale*v_nominal",
    meaning="a speed that was not what the run file says, by the same share in all runs",
    signature="axles arrive too early or late one after the other; the delay grows with the axle distance",
    source="Wu & Li 2023, Sect. 3, doi:10.3390/s23249691",
    attaches="run",
    places=runs,
    parameters=(
        EffectParameter(
            "scale",
            "",
            "true speed over that of the run file",
            low=0.85,
            high=1.15,
            starts=tuple(round(0.9 + 0.01 * i, 2) for i in range(21) if i != 10),
        ),
    ),
    is_global=True,
    adjustment=SpeedScale,
    scale=0.01,
    neutral=1.0,
)
