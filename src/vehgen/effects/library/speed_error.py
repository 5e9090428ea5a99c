"""Speed error."""

from __future__ import annotations

from vehgen.effects.base import Effect, EffectParameter
from vehgen.effects.places import runs

SPEED_ERROR = Effect(
    "speed_error",
    "Speed error",
    "v = scale*v_nominal",
    "a speed that was not what the run file says, by the same share in all runs",
    "axles arrive too early or late one after the other; the delay grows with the axle distance",
    "Wu & Li 2023, Sect. 3, doi:10.3390/s23249691",
    "run",
    (
        EffectParameter(
            "scale", "", "true speed over that of the run file", 0.85, 1.15, tuple(round(0.9 + 0.01 * i, 2) for i in range(21) if i != 10)
        ),
    ),
    runs,
    adjusts="speed",
)
