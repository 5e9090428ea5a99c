"""A vehicle over one hump, in all its coordinates: what an animation of it shows."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from vehgen.mechanics import EquationsOfMotion

Array = NDArray[np.float64]
DRIVE_HUMP_LENGTH, DRIVE_HUMP_HEIGHT = 0.5, 0.05
"""Of a half-sine hump [m]."""
DRIVE_SPEED = 2.5
"""Of the drive [m/s]."""
_LEAD, _TAIL = 0.5, 2.0
"""Time before the first wheel meets the hump and after the last has left it [s]."""
_DRIVE_STEP, FRAMES_PER_SECOND = 2e-3, 25


@dataclass(frozen=True)
class HumpDrive:
    """Coordinates over time, `q shape (n_frames, n_dof)` [m, rad], `road shape (n_frames, n_axles)` the road under each wheel [m].

    `start` is where the hump begins ahead of the first wheel at the first frame [m].
    """

    q: Array
    road: Array
    start: float


def hump_drive(model: EquationsOfMotion, values: Mapping[str, float]) -> HumpDrive:
    """Return how a vehicle crosses a half-sine hump, its force laws left out.

    Parameters
    ----------
    values
        Parameters [SI] by name.

    Raises
    ------
    ValueError
        For a rig without axles.
    """
    if not model.vehicle.axles:
        raise ValueError("a rig without axles cannot drive")
    offsets = model.wheel_offsets(values)
    seconds = _LEAD + (offsets.max() + DRIVE_HUMP_LENGTH) / DRIVE_SPEED + _TAIL
    time = np.arange(0.0, seconds, _DRIVE_STEP)
    start = _LEAD * DRIVE_SPEED
    along = DRIVE_SPEED * time[:, None] - offsets - start
    on = (along > 0) & (along < DRIVE_HUMP_LENGTH)
    angle = np.pi * along / DRIVE_HUMP_LENGTH
    road = np.where(on, DRIVE_HUMP_HEIGHT * np.sin(angle), 0.0)
    rate = np.where(on, DRIVE_HUMP_HEIGHT * np.pi / DRIVE_HUMP_LENGTH * DRIVE_SPEED * np.cos(angle), 0.0)
    numeric = model.numeric(values)
    columns = [model.inputs.index(f"road.{name}") for name in model.vehicle.axles]
    forces = road @ numeric.P[:, columns].T + rate @ numeric.Q[:, columns].T
    from vehgen.simulate.exact import newmark_states

    q = newmark_states(numeric, forces, _DRIVE_STEP)[0]
    every = round(1.0 / (FRAMES_PER_SECOND * _DRIVE_STEP))
    return HumpDrive(q[::every], road[::every], start)
