"""What the paper's printed tables give by themselves: natural frequencies, and spectra on a class B road (Figs. 14, 16 and 17)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.signal

from benchmarks.paper_study.recordings import Rig
from benchmarks.paper_study.roads import LEVELS
from vehgen import Place, PointOutput, derive, load_vehicle
from vehgen.simulate.frequency import transfer_functions

Array = np.ndarray
FREQUENCY = np.arange(0.3, 30.001, 0.05)
"""Where spectra are drawn [Hz]."""
RESOLUTION = 0.25
"""Half width [Hz] of the triangle that a spectrum is averaged over, about that of Welch's method with segments of 4 s."""
SETS = {
    "truck": {"SHCM-1": "SHCM-1", "SHCM-2": "SHCM-2", "DHCM-1&2": "DHCM-1-2"},
    "sedan": {"SHCM-M": "SHCM-M", "SHCM-F": "SHCM-F", "SHCM-R": "SHCM-R", "DHCM-F&R": "DHCM-F-R"},
}
"""The paper's rows, and the parameter sets of the bundled models that hold them."""
TEST_PLACE = {
    "truck": Place(name="test place", body="semitrailer", behind="fifth_wheel", distance=5.76),
    "sedan": Place(name="test place", body="body", behind="front", distance=1.70),
}
"""Where the paper recorded what it compares with."""


@dataclass(frozen=True)
class Printed:
    """One row of the paper's tables: its frequencies [Hz] by mode, and the acceleration's PSD on a class B road [(m/s^2)^2/Hz]."""

    name: str
    frequencies: dict[str, float]
    density: Array

    @property
    def peaks(self) -> list[float]:
        """Frequencies of the PSD's maxima [Hz] that rise by at least half above what surrounds them."""
        found, _ = scipy.signal.find_peaks(np.log(self.density), prominence=np.log(1.5))
        return [float(FREQUENCY[i]) for i in found if self.density[i] > 0.02 * self.density.max()]


def printed_vehicles(rig: Rig) -> list[Printed]:
    """Return all rows of the paper's table for a kind of vehicle."""
    steps = round(RESOLUTION / 0.01)
    fine = np.arange(round(FREQUENCY[0] / 0.01) - steps, round(FREQUENCY[-1] / 0.01) + steps + 1) * 0.01
    window = np.bartlett(2 * steps + 1)
    vehicle = load_vehicle(rig.model)
    model = derive(vehicle, [PointOutput("a", TEST_PLACE[rig.kind], "acceleration")])
    found = []
    for name, parameter_set in SETS[rig.kind].items():
        values = model.values(overrides=vehicle.values(parameter_set))
        late = model.wheel_offsets(values) / rig.cruise
        gains = transfer_functions(model.numeric(values), fine)[0][:, 0, : len(late)]
        total = (gains * np.exp(-2j * np.pi * fine[:, None] * late)).sum(axis=1)
        road = LEVELS["B"] * 0.1**2 * rig.cruise / fine**2
        smooth = np.convolve(np.abs(total) ** 2 * road, window / window.sum(), mode="valid")
        found.append(Printed(name, rig.system(values).frequencies(), smooth[::5]))
    return found
