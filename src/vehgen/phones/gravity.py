"""What the gravity that a phone reads at rest tells of its accelerometer: a gain or an offset, or readings in another unit."""

from __future__ import annotations

from vehgen.files.units import STANDARD_GRAVITY

LARGEST_FACTOR = 2.0
"""Gravity is read as such from so many times less to so many times more than 9.8 m/s^2: no unit in use is as near to m/s^2."""
DOUBTFUL = 0.05
"""A reading off by more than this share deserves a warning: an offset as large as no data sheet allows (0.5 m/s^2), or a gain."""
OTHER_UNITS = {
    "g": 1.0,
    "ft/s^2": STANDARD_GRAVITY / 0.3048,
    "mg": 1000.0,
    "cm/s^2": 100 * STANDARD_GRAVITY,
    "mm/s^2": 1000 * STANDARD_GRAVITY,
}
"""What gravity reads in other units that apps and loggers write."""
UNIT_WITHIN = 0.1
"""A reading within this share of gravity in another unit seems to be in that unit."""


def is_gravity(magnitude: float) -> bool:
    """Return whether a reading at rest [m/s^2] is gravity, however wrong the accelerometer's gain may be."""
    return STANDARD_GRAVITY / LARGEST_FACTOR <= magnitude <= STANDARD_GRAVITY * LARGEST_FACTOR


def seems_in_g(magnitude: float) -> bool:
    """Return whether a reading at rest, taken for m/s^2, seems to be gravity in g."""
    return abs(magnitude / OTHER_UNITS["g"] - 1) <= UNIT_WITHIN


def no_gravity(magnitude: float, otherwise: str) -> str:
    """Return in which unit a reading at rest that is not gravity [m/s^2] seems to be, and what to do; `otherwise` where it fits none."""
    off = {unit: abs(magnitude / worth - 1) for unit, worth in OTHER_UNITS.items()}
    units = sorted((unit for unit in off if off[unit] <= UNIT_WITHIN), key=off.__getitem__)
    if not units:
        return otherwise
    return (
        f"it seems to be in {' or '.join(units)}; these files are read in m/s^2, so export it again in that unit (Sensor Logger: with "
        f"'Standardise Units & Frames'), or multiply its accelerations by {STANDARD_GRAVITY / OTHER_UNITS[units[0]]:.5g}; a plain CSV may "
        f"state acceleration_unit={units[0]} in `columns`"
    )


def gain_warnings(magnitude: float) -> tuple[str, ...]:
    """Return what to say of an accelerometer that reads gravity as `magnitude` [m/s^2]."""
    factor = magnitude / STANDARD_GRAVITY
    if abs(factor - 1) <= DOUBTFUL:
        return ()
    offset = magnitude - STANDARD_GRAVITY
    return (
        f"at rest gravity reads {magnitude:.3f} m/s^2, {factor:.3f} times what it is: a gain of {factor:.3f}, or an offset of "
        f"{offset:+.2f} m/s^2, of the accelerometer, or no steady speed. An offset is taken off; a gain is kept: `diagnose` looks for it "
        "as `sensor_gain`, `calibrate` takes channels for right within 1 %. If it reads as much face down, it is a gain: divide its "
        f"accelerations by {factor:.3f} and import again",
    )
