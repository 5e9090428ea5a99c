"""How a run begins, and how well it knows itself."""

from __future__ import annotations

from pydantic import Field

from vehgen.files.entry import FileModel
from vehgen.files.quantities import (
    Angle,
    AngleDeviation,
    Displacement,
    ForceSpread,
    LengthDeviation,
    LengthSpread,
    PitchRate,
    PositiveAngle,
    PositiveDisplacement,
    PositivePitchRate,
    PositiveVelocity,
    ShareSpread,
    SpeedSpread,
    TimeDeviation,
    Velocity,
)


class UncertaintyEntry(FileModel):
    """How well a run knows itself and its sensors: standard deviations, those of a fit's errors (docs/measurement.md).

    Of the recording's begin (`delay`), the speed and how it changes along the run, the height of the road, the form of the hump and
    the wear of its edges, the way over a measured profile (`odometer`), how far each axle runs behind the first, the sensors' clocks
    against the first one's, their gyroscopes' lags, gains, tilts and places, gain and offset of measured forces, gain of measured
    displacements.
    """

    delay: TimeDeviation | None = None
    speed: SpeedSpread | None = None
    wander: SpeedSpread | None = None
    height: LengthSpread | None = None
    length: LengthSpread | None = None
    form: ShareSpread | None = None
    skew: ShareSpread | None = None
    wear: LengthDeviation | None = None
    odometer: ShareSpread | None = None
    clock: TimeDeviation | None = None
    lag: TimeDeviation | None = None
    gain: ShareSpread | None = None
    tilt: AngleDeviation | None = None
    position: LengthDeviation | None = None
    axle_position: LengthDeviation | None = None
    force_gain: ShareSpread | None = None
    force_offset: ForceSpread | None = None
    displacement_gain: ShareSpread | None = None


class Uncertain(FileModel):
    """A value with its standard deviation."""

    value: float
    tolerance: float


class UncertainDisplacement(Uncertain):
    """A displacement with its standard deviation."""

    value: Displacement
    tolerance: PositiveDisplacement


class UncertainVelocity(Uncertain):
    """A velocity with its standard deviation."""

    value: Velocity
    tolerance: PositiveVelocity


class UncertainAngle(Uncertain):
    """An angle with its standard deviation."""

    value: Angle
    tolerance: PositiveAngle


class UncertainPitchRate(Uncertain):
    """A pitch rate with its standard deviation."""

    value: PitchRate
    tolerance: PositivePitchRate


class InitialEntry(FileModel):
    """How a body's centre of gravity, or an axle, is displaced and moves as the run begins, from static equilibrium; upwards, nose down.

    Each is a quantity, or one with its standard deviation, {value, tolerance}: a fit then finds it, held by that.
    """

    displacement: Displacement | UncertainDisplacement | None = Field(None, union_mode="left_to_right")
    velocity: Velocity | UncertainVelocity | None = Field(None, union_mode="left_to_right")
    pitch: Angle | UncertainAngle | None = Field(None, union_mode="left_to_right")
    pitch_rate: PitchRate | UncertainPitchRate | None = Field(None, union_mode="left_to_right")

    def stated(self) -> dict[str, tuple[float, float]]:
        """Return what is stated: value and standard deviation [SI] by key; an exact value deviates by 0."""
        entries = {key: getattr(self, key) for key in type(self).model_fields}
        exact = {key: (item, 0.0) for key, item in entries.items() if isinstance(item, float)}
        return exact | {key: (item.value, item.tolerance) for key, item in entries.items() if isinstance(item, Uncertain)}
