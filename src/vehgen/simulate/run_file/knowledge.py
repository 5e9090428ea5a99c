"""How a run begins, and how well it knows itself."""

from __future__ import annotations

from vehgen.files.entry import FileModel
from vehgen.files.quantities import (
    Angle,
    AngleDeviation,
    Displacement,
    ForceSpread,
    LengthDeviation,
    LengthSpread,
    PitchRate,
    ShareSpread,
    SpeedSpread,
    TimeDeviation,
    Velocity,
)


class UncertaintyEntry(FileModel):
    """How well a run knows itself and its sensors: standard deviations, those of a fit's errors (docs/measurement.md).

    Of the recording's begin (`delay`), the speed and how it changes along the run, the height of the road, the form of the hump and
    the wear of its edges, the sensors' clocks against the first one's, their gyroscopes' lags, gains, tilts and places, gain and offset of
    measured forces.
    """

    delay: TimeDeviation | None = None
    speed: SpeedSpread | None = None
    wander: SpeedSpread | None = None
    height: LengthSpread | None = None
    length: LengthSpread | None = None
    form: ShareSpread | None = None
    skew: ShareSpread | None = None
    wear: LengthDeviation | None = None
    clock: TimeDeviation | None = None
    lag: TimeDeviation | None = None
    gain: ShareSpread | None = None
    tilt: AngleDeviation | None = None
    position: LengthDeviation | None = None
    force_gain: ShareSpread | None = None
    force_offset: ForceSpread | None = None


class InitialEntry(FileModel):
    """How a body's centre of gravity, or an axle, is displaced and moves as the run begins, from static equilibrium; upwards, nose down."""

    displacement: Displacement | None = None
    velocity: Velocity | None = None
    pitch: Angle | None = None
    pitch_rate: PitchRate | None = None
