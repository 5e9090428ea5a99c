"""Which parameters each place feels: the paper's Fig. 5, for its set of Sect. 2.3."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from benchmarks.paper_study.truth import TRACTOR_MASS
from vehgen.calibrate.sensitivity import sensitivity
from vehgen.simulate import load_run

Array = np.ndarray
PLACES = {"L1": "{body: tractor, behind: axle1", "L2": "{body: semitrailer, behind: fifth_wheel, distance: 8.45 m"}
PLACES["L2near"] = "{body: semitrailer, behind: fifth_wheel, distance: 2.5 m"
TITLES = {"L1": "L1, at axle 1", "L2": "L2, 8.45 m behind the hinge", "L2near": "L2', 2.5 m behind the hinge"}
KINDS = {"m": "mass", "k": "suspension stiffness", "kt": "tyre stiffness", "c": "damping"}
HIGHEST = 25.0
"""Frequencies drawn [Hz]."""


@dataclass(frozen=True)
class Sensitivities:
    """`index[place][name]` is the PSD of d(acceleration)/d(parameter over mT) at `frequency`."""

    frequency: Array
    index: dict[str, dict[str, Array]]

    def share(self, place: str, kind: str, axle: int) -> float:
        """Return an axle's root mean square sensitivity to one kind of parameter over the largest axle's at the same place."""
        areas = [float(np.sqrt(self.index[place][f"{kind}{i}"].sum())) for i in range(1, 6)]
        return areas[axle - 1] / max(areas)

    def ratio(self, place: str, other: str, kind: str, axle: int) -> float:
        """Return one place's root mean square sensitivity to an axle's parameter over another place's."""
        areas = [float(np.sqrt(self.index[item][f"{kind}{axle}"].sum())) for item in (place, other)]
        return areas[0] / areas[1]


def sensitivities(folder: Path) -> Sensitivities:
    """Compute the indices of Fig. 5 over the study's hump at 2 m/s."""
    lines = ["vehicle: tractor5", "set: sensitivity", "speed: 2 m/s"]
    lines += ["road: [{hump: {shape: half_sine, length: 0.5 m, height: 0.03 m, at: 3 m}}]", "sensors:"]
    lines += [f"  {name}: {place}, channels: {{acceleration: {name}}}}}" for name, place in PLACES.items()]
    path = folder / "sensitivity.yaml"
    path.write_text("\n".join([*lines, ""]), encoding="utf-8")
    names = [f"{kind}{i}" for kind in KINDS for i in range(1, 6)]
    found = sensitivity(load_run(path), names)
    inside = found.frequency <= HIGHEST
    scaled = found.index[:, :, inside] * TRACTOR_MASS**2
    index = {place: {name: scaled[i, j] for i, name in enumerate(names)} for j, place in enumerate(found.channels)}
    return Sensitivities(found.frequency[inside], index)
