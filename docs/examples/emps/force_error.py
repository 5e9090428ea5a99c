"""How well does a vehicle with friction explain the motor's force? Run `python force_error.py VEHICLE.yaml DATA_EMPS.mat`.

The benchmark's own measure: the force that the measured motion asks of the model, and what is left of the recorded one, over its size.
The motion is smoothed up to 20 Hz, forwards and backwards; a constant force is fitted.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import scipy.signal
from numpy.typing import NDArray

from vehgen.vehicle import load_vehicle

sys.path.insert(0, str(Path(__file__).parent))
from prepare import read_emps

Array = NDArray[np.float64]
SMOOTHED_TO, AT_ENDS = 20.0, 200
"""Highest frequency of the motion [Hz], and how many samples are left out at both ends."""


def read_motion(path: Path) -> tuple[Array, Array, Array]:
    """Return velocity [m/s], acceleration [m/s^2] and force [N] of a recording, smoothed, without its ends."""
    time, place, force = read_emps(path)
    step = time[1] - time[0]
    sections = scipy.signal.butter(4, SMOOTHED_TO, fs=1 / step, output="sos")
    velocity = np.gradient(place, step)
    columns = [scipy.signal.sosfiltfilt(sections, item)[AT_ENDS:-AT_ENDS] for item in (velocity, np.gradient(velocity, step), force)]
    return columns[0], columns[1], columns[2]


def force_error(vehicle: Path, path: Path) -> tuple[float, float]:
    """Return what is left of the recorded force over its size, both without their means, and the constant force beside it [N]."""
    values = load_vehicle(vehicle).values()
    law = {name.rpartition("_")[2]: value for name, value in values.items() if name.startswith(("dry_friction", "asymmetric_friction"))}
    friction, ratio = law.get("force", 0.0), law.get("ratio", 1.0)
    velocity, acceleration, force = read_motion(path)
    slipping = np.sign(velocity) + (1 - ratio) / (1 + ratio) * np.abs(np.sign(velocity))  # the rail is compressed as the carriage falls
    left = force - values["M"] * acceleration - values["c"] * velocity - friction * slipping
    return float(np.std(left) / np.std(force)), -float(np.mean(left))


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit("usage: python force_error.py VEHICLE.yaml DATA_EMPS.mat")
    share, constant = force_error(Path(sys.argv[1]), Path(sys.argv[2]))
    print(f"{100 * share:.2f} % of the force is left; beside it acts {constant:.2f} N")
