"""A simulated channel is in the unit, and of the sign, that the run file gives to its column: what a recording would hold."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from vehgen.errors import InputError
from vehgen.fit.recording import read_recording
from vehgen.simulate import load_run, simulate, write_csv

RUN = """\
vehicle: sedan2
speed: 5 m/s
duration: 3 s
road: [{hump: {shape: half_sine, length: 0.5 m, height: 0.03 m, at: 2 m}}]
sensors:
  L: {body: body, channels: {acceleration: CHANNEL, pitch_rate: q}}
  F: {axle: front, channels: {tyre_force: FORCE}}
outputs:
  travel: {axle: front, quantity: suspension_travel}
"""


def run_file(folder: Path, channel: str, force: str = "F", more: str = "") -> Path:
    path = folder / "run.yaml"
    path.write_text(RUN.replace("CHANNEL", channel).replace("FORCE", force) + more, encoding="utf-8")
    return path


def test_unit_and_sign_of_a_channel_are_those_of_its_column(tmp_path: Path):
    plain = simulate(load_run(run_file(tmp_path, "az")))
    read = simulate(load_run(run_file(tmp_path, "{column: az, unit: g, sign: -1}", "{column: F, unit: lbf}")))
    assert [item.unit for item in plain.channels] == ["m/s^2", "rad/s", "N", "m"]
    assert [item.unit for item in read.channels] == ["g", "rad/s", "lbf", "m"]
    worth = np.array([-9.80665, 1.0, 4.4482216152605, 1.0])
    assert abs(plain.values).max(axis=(0, 1)).min() > 1e-4
    np.testing.assert_allclose(read.values * worth, plain.values, rtol=1e-12, atol=1e-15)


def test_a_response_reads_back_as_the_recording_of_its_own_run(tmp_path: Path):
    channel = "{column: az, unit: g, sign: -1}"
    force = "{column: F, unit: kN, sign: -1}"
    plain = simulate(load_run(run_file(tmp_path, "az")))
    write_csv(tmp_path / "measured.csv", simulate(load_run(run_file(tmp_path, channel, force))))
    recorded = read_recording(load_run(run_file(tmp_path, channel, force, "recording: measured.csv\n")))
    np.testing.assert_allclose(recorded.values, plain.values[0, :, :3], rtol=1e-6, atol=1e-6)


@pytest.mark.parametrize(
    ("channel", "said"),
    [
        ("{column: az, unit: banana}", "run.yaml:6:63: unknown unit 'banana'; known: GN, GPa"),
        ("{column: az, unit: M/s^2}", "run.yaml:6:63: unknown unit 'M/s^2'; did you mean 'm'? (acceleration is measured in m/s^2, g, mg)"),
        ("{column: az, unit: kN}", "run.yaml:6:63: acceleration is measured in m/s^2, found 'kN', a unit of N"),
        ("{column: az, unit: m^70}", "run.yaml:6:63: the exponent of a unit"),
    ],
)
def test_a_unit_that_is_none_is_refused_before_anything_is_computed(tmp_path: Path, channel: str, said: str):
    with pytest.raises(InputError) as caught:
        load_run(run_file(tmp_path, channel))
    assert said in str(caught.value)
