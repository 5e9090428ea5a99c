"""Speed error."""

from __future__ import annotations

from vehgen.effects.base import EffectParameter
from vehgen.effects.kinds import RunEffect
from vehgen.effects.places import runs
from vehgen.fit.adjustments import SpeedScale

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
