"""The recipe of docs/cargo.md for cargo that lifts off its floor, against its numbers."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import numpy as np
import pytest

from vehgen import load_vehicle, natural_modes, simulate, static_loads

DOCS = Path(__file__).parents[2] / "docs"
PAGE = (DOCS / "cargo.md").read_text(encoding="utf-8")
SECTION = PAGE.split("## Cargo that lifts off its floor")[1].split("\n## ")[0]
STRAPPED = re.findall(r"```yaml\n(.*?)```", SECTION, re.DOTALL)[0]
LOOSE = STRAPPED.split("  strap:")[0]
FIXED = LOOSE.split("    laws:")[0].replace("k: 0 N/m", "k: 1.5 MN/m")
WEIGHT = 9.81e3
RUN = """\
vehicle: vehicle.yaml
speed: 5 m/s
step: 0.2 ms
sample: 1 ms
road: [{hump: {shape: half_sine, length: 0.5 m, height: 80 mm, at: 2 m}}]
sensors:
  crate: {body: crate, channels: {acceleration: az}}
  floor: {link: floor, channels: {link_force: force, link_travel: travel}}
"""


def least(folder: Path, vehicle: str) -> np.ndarray:
    """Return the least acceleration, force of the floor and travel of it in a run."""
    shutil.copy(DOCS / "examples" / "my_truck.yaml", folder)
    (folder / "vehicle.yaml").write_text(vehicle, encoding="utf-8")
    (folder / "run.yaml").write_text(RUN, encoding="utf-8")
    return simulate(folder / "run.yaml").values[0].min(axis=0)


def test_a_floor_pushes_and_a_strap_holds(tmp_path: Path):
    fixed, loose, strapped = (least(tmp_path, text) for text in (FIXED, LOOSE, STRAPPED))
    assert fixed[1] + WEIGHT == pytest.approx(-29.6e3, rel=5e-3)
    assert loose[0] == pytest.approx(-10.7, abs=0.06)
    assert loose[1] + WEIGHT > -1e3  # the damper alone
    assert [1e3 * found[2] for found in (loose, strapped)] == pytest.approx([-56, -31], abs=0.5)


def test_the_strap_shares_in_the_rest_and_modes_leave_it_out(tmp_path: Path):
    least(tmp_path, STRAPPED)
    vehicle = load_vehicle(tmp_path / "vehicle.yaml")
    carried = static_loads(vehicle).elements
    assert carried["link", "strap"] == pytest.approx(-1.88e3, abs=5)
    assert carried["link", "floor"] - 1.88e3 == pytest.approx(WEIGHT, abs=5)
    assert 1e3 * carried["link", "floor"] / 1.5e6 == pytest.approx(7.8, abs=0.05)
    assert natural_modes(vehicle)[0].undamped_hz == pytest.approx(0.0, abs=1e-3)
