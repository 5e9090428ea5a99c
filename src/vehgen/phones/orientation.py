"""How a phone lay on the vehicle: which way is up, by gravity, and which way is left, by the axis that is said to point forward.

Right-handed axes x forward, y left, z up: pitch, nose-down positive, is a rotation about the left axis. A phone's axes: x to the right and
y to the top edge of its screen, z out of the screen. At rest an accelerometer reads gravity upwards, +9.8 m/s^2 on z face up; some
apps reverse the sign, and from a face-down phone that looks the same. What the readings leave open is asked for, never guessed. How much
gravity is read shows a gain or an offset: it is told, and changes nothing that was recorded.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from vehgen.errors import InputError, did_you_mean, shown
from vehgen.files.units import STANDARD_GRAVITY
from vehgen.phones.gravity import gain_warnings, is_gravity, no_gravity

Array = NDArray[np.float64]
AXES = {
    "x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0),
    "-x": (-1.0, 0.0, 0.0), "-y": (0.0, -1.0, 0.0), "-z": (0.0, 0.0, -1.0),
}  # fmt: skip
"""A phone's axes as options name them."""
UPRIGHT = np.cos(np.radians(40.0))
"""An axis within 40 degrees of the vertical counts as the one that points up."""


@dataclass(frozen=True)
class Orientation:
    """Unit vectors `up` and `left shape (3,)` in the phone's axes (`left` None where forward is unknown).

    `sign` is -1 where the app reversed accelerations; `tilt` the angle [deg] from the nearest axis of the phone; `gravity` the magnitude
    that was read [m/s^2], 0 where none was; `notes` what was found, in words, `warnings` what is doubtful.
    """

    up: Array
    left: Array | None
    sign: int
    tilt: float
    gravity: float
    notes: tuple[str, ...]
    warnings: tuple[str, ...] = ()

    def upward(self, acceleration: Array) -> Array:
        """Return the upward acceleration `shape (n,)` of readings `shape (n, 3)`, less the gravity that was read at rest [m/s^2]."""
        return np.asarray(self.sign * acceleration @ self.up - self.gravity)

    def pitch_rate(self, rotation: Array) -> Array:
        """Return the pitch rate, nose-down positive `shape (n,)`, of rates of rotation `shape (n, 3)` [rad/s]."""
        assert self.left is not None
        return np.asarray(rotation @ self.left)


def find_orientation(
    gravity: Array | None, name: str, up: str | None = None, forward: str | None = None, sign: int | None = None
) -> Orientation:
    """Find how a phone lay.

    Parameters
    ----------
    gravity
        Mean reading of acceleration at rest `shape (3,)` [m/s^2], None where the recording is without gravity.
    name
        What errors call the phone.
    up
        The phone's axis that points up, more or less; only needed where readings leave it open.
    forward
        The phone's axis that points forward; only needed for the pitch rate.
    sign
        +1 or -1 where it is known whether the app keeps or reverses the sign of accelerations.

    Raises
    ------
    InputError
        Where the readings leave the sign open or contradict what was said; it names the option that settles it.
    """
    for option, axis in (("up", up), ("forward", forward)):
        if axis is not None and axis not in AXES:
            raise InputError(f"{name}: {option} is an axis of the phone, found {shown(axis)}; {did_you_mean(axis, AXES)}")
    if gravity is None:
        if up is None:
            raise InputError(
                f"{name} was recorded without gravity, which would show how it lay; say which of its axes pointed up, e.g. up=z"
            )
        if sign is None:
            raise InputError(
                f"{name} was recorded without gravity, so the sign of its acceleration is unknown: say acceleration_sign=1 "
                "(Android, or iOS with standardised units and frames) or acceleration_sign=-1 (iOS without)"
            )
        direction, magnitude, tilt = np.array(AXES[up]), 0.0, 0.0
        notes = [f"no gravity recorded: {up} taken as up, tilt not corrected, acceleration sign {sign:+d}"]
    else:
        direction, magnitude, sign, notes = _by_gravity(gravity, name, up, sign)
        tilt = float(np.degrees(np.arccos(np.clip(np.abs(direction).max(), 0.0, 1.0))))
    left = _left(direction, forward, name) if forward is not None else None
    return Orientation(direction, left, sign, tilt, magnitude, tuple(notes), gain_warnings(magnitude) if magnitude else ())


def _by_gravity(gravity: Array, name: str, up: str | None, sign: int | None) -> tuple[Array, float, int, list[str]]:
    magnitude = float(np.linalg.norm(gravity))
    reading = "x {:+.2f}, y {:+.2f}, z {:+.2f} m/s^2".format(*gravity)
    if not is_gravity(magnitude):
        why = no_gravity(magnitude, "was the vehicle at a steady speed, and is the recording in m/s^2?")
        raise InputError(f"{name}: at rest gravity reads {magnitude:.4g} m/s^2 ({reading}), not 9.8: {why}")
    direction = gravity / magnitude
    if up is not None:
        along = float(direction @ np.array(AXES[up]))
        if abs(along) < UPRIGHT:
            raise InputError(f"{name}: gravity reads {reading}, which is not along {up}, said to point up")
        shown = 1 if along > 0 else -1
        if sign is not None and sign != shown:
            raise InputError(
                f"{name}: gravity reads {reading} with {up} up, so the sign of accelerations is {shown:+d}, not {sign:+d} as its app or "
                "acceleration_sign says"
            )
        sign = shown
    elif sign is None:
        if direction[2] > UPRIGHT:
            sign = 1
        elif direction[2] < -UPRIGHT:
            raise InputError(
                f"{name}: at rest z reads {gravity[2]:+.2f} m/s^2: it lay face down (say up=-z), or its app reverses accelerations, as "
                "iOS does without standardised units and frames (say up=z)"
            )
        else:
            raise InputError(f"{name}: gravity reads {reading}, so it did not lie flat; say which of its axes pointed up, e.g. up=y")
    assert sign is not None
    notes = [f"gravity at rest: {reading} ({magnitude:.3f} m/s^2)" + (", sign reversed by the app and put right" if sign < 0 else "")]
    if abs(magnitude - STANDARD_GRAVITY) > 0.02 * STANDARD_GRAVITY:
        notes.append(
            f"gravity reads {magnitude:.3f} m/s^2: the accelerometer's offset or gain is {magnitude / STANDARD_GRAVITY - 1:+.1%} off"
        )
    return sign * direction, magnitude, sign, notes


def _left(up: Array, forward: str, name: str) -> Array:
    axis = np.array(AXES[forward])
    level = axis - (axis @ up) * up
    length = float(np.linalg.norm(level))
    if length < np.sqrt(1 - UPRIGHT**2):
        raise InputError(f"{name}: {forward}, said to point forward, points {'up' if axis @ up > 0 else 'down'}; say forward= another axis")
    return np.asarray(np.cross(up, level / length))
