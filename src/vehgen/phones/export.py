"""What a phone recorded, as every reader hands it on: one stream a sensor, each on its own clock."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from vehgen.errors import InputError
from vehgen.phones.gravity import is_gravity, no_gravity, seems_in_g

Array = NDArray[np.float64]

ACCELERATION_STREAM = "acceleration"
"""Stream: x, y, z of the phone with gravity [m/s^2]."""
LINEAR_ACCELERATION_STREAM = "linear_acceleration"
"""Stream: x, y, z of the phone without gravity [m/s^2]."""
GRAVITY_STREAM = "gravity"
"""Stream: x, y, z of gravity alone, as the phone estimates it from its sensors [m/s^2]."""
ROTATION_STREAM = "rotation"
"""Stream: x, y, z of the phone's rate of rotation [rad/s]."""
SPEED_STREAM = "speed"
"""Stream: speed over ground [m/s]."""
VERTICAL_ACCELERATION_STREAM = "vertical_acceleration"
"""Stream: acceleration upwards [m/s^2], already in the vehicle's axes."""
PITCH_RATE_STREAM = "pitch_rate"
"""Stream: pitch rate, nose-down positive [rad/s], already in the vehicle's axes."""


@dataclass(frozen=True)
class Stream:
    """Samples of one sensor: `time shape (n,)` [s] on the sensor's own clock, `values shape (n, k)` in `unit`, one of `columns` each.

    Times may be uneven and samples may be NaN: `resampling.clean` sees to that.
    """

    time: Array
    values: Array
    columns: tuple[str, ...]
    unit: str

    def __post_init__(self) -> None:
        if self.values.shape != (needed := (len(self.time), len(self.columns))):
            raise ValueError(f"values have the shape {self.values.shape}; these times and columns need {needed}")

    def scaled(self, factor: float) -> Stream:
        """Return the stream with its values times `factor`."""
        return replace(self, values=self.values * factor)

    def between(self, start: float, end: float) -> Stream:
        """Return the samples from `start` to `end` [s]."""
        kept = (self.time >= start) & (self.time <= end)
        return replace(self, time=self.time[kept], values=self.values[kept])


@dataclass(frozen=True)
class EpochMap:
    """Which moment of the world's clock belongs to a moment of a recording.

    `recording shape (k,)` [s] are the moments at which recording began or went on, ascending; `epoch shape (k,)` [s since 1970, UTC].
    """

    recording: Array
    epoch: Array

    def at(self, time: float) -> float:
        """Return the epoch time [s] of a moment of the recording [s]."""
        index = max(int(np.searchsorted(self.recording, time, side="right")) - 1, 0)
        return float(self.epoch[index] + (time - self.recording[index]))


@dataclass(frozen=True)
class PhoneExport:
    """One phone's export.

    Parameters
    ----------
    app
        Which app or format it came from.
    streams
        The sensors by the names above.
    epoch
        Its clock against the world's, None where the export does not say.
    notes
        What the reader passed over or took for granted, in words.
    acceleration_sign
        +1 where a phone that lies still, face up, is known to read +9.8 m/s^2 on z, -1 where it is known to read -9.8 m/s^2, None where the
        export does not say.
    accelerometer
        What the system calls the accelerometer, None where the export does not say.
    """

    app: str
    streams: dict[str, Stream]
    epoch: EpochMap | None = None
    notes: tuple[str, ...] = field(default=())
    acceleration_sign: int | None = None
    accelerometer: str | None = None


def acceleration_kind(values: Array) -> str:
    """Say whether `values shape (n, 3)` [m/s^2] hold gravity, by their mean: a phone that stays on a vehicle reads about 9.8 or 0 m/s^2.

    With gravity it may read from half to twice as much, where its gain is wrong. A steady 1 is gravity in g, as no offset is so large.

    Raises
    ------
    InputError
        Where the mean is neither nearly gravity nor nearly nothing, or where there is no sample.
    """
    finite = values[np.isfinite(values).all(axis=1)]
    if not len(finite):
        raise InputError("an acceleration file holds no number")
    with np.errstate(over="ignore", invalid="ignore"):
        mean = float(np.linalg.norm(np.median(finite, axis=0)))
    if is_gravity(mean):
        return ACCELERATION_STREAM
    if mean < 2.0 and not seems_in_g(mean):
        return LINEAR_ACCELERATION_STREAM
    raise InputError(
        f"the acceleration has a mean of {mean:.4g} m/s^2; a phone on a vehicle shows about 9.8 with gravity, about 0 without: "
        + no_gravity(mean, "is its unit m/s^2?")
    )
