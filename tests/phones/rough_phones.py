"""Phone exports of a drive over a rough road: a motion of tests/measure/rough_half_car.py as phones with clocks of their own record it."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import CubicSpline

from .exports import phyphox, write_zip

ACCELERATION_NOISE, ROTATION_NOISE = 0.012, 0.0007
"""Standard deviation of a sample [m/s^2], [rad/s]."""


def write_phone(path, time, upward, pitch_rate, speed=None, seed=0, shift=0.0, drift=0.0, start=None, rate=100.0, hole=None):
    """Write a phyphox export of a phone that lay flat, its top edge forward.

    Its clock reads `shift` [s] at the motion's begin and runs `drift` faster; it began to record at 0 of its clock, `start` [s] of the
    world's. From `hole[0]` to `hole[1]` [s] it recorded nothing.
    """
    random = np.random.default_rng(seed)
    clock = np.arange(int((shift + (1 + drift) * time[-1]) * rate)) / rate
    clock = clock + np.clip(random.normal(0, 0.0008, len(clock)), -0.003, 0.003)
    true = (clock - shift) / (1 + drift)
    kept = (true >= 0) & (true <= time[-1])
    if hole is not None:
        kept &= (clock < hole[0]) | (clock > hole[1])
    clock, true = clock[kept], true[kept]
    rise, rotation = CubicSpline(time, upward)(true) + 9.81, CubicSpline(time, pitch_rate)(true)
    force = np.column_stack([0 * rise, 0 * rise, rise]) + random.normal(0, ACCELERATION_NOISE, (len(rise), 3))
    turning = np.column_stack([-rotation, 0 * rotation, 0 * rotation]) + random.normal(0, ROTATION_NOISE, (len(rise), 3))
    return write_zip(path, phyphox(clock, force, turning, start=start, speed=speed))
