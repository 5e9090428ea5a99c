"""The run file: what it says in SI units, and its defaults."""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import Any

import pytest

from tests.simulate.run_files import GOOD, SHORT, load
from vehgen.errors import InputError
from vehgen.mechanics import ElementOutput, Place, PointOutput
from vehgen.simulate.run_file import load_run
from vehgen.vehicle import bundled_models


def test_quantities_are_held_in_si_units(tmp_path: Path):
    file = load(tmp_path, GOOD).file
    assert file.speed == pytest.approx(2.0, rel=1e-15)
    assert (file.duration, file.step, file.sample, file.footprint) == (10.0, 0.002, 0.01, 0.24)
    first, second, third, fourth = (entry.hump for entry in file.road[:4])
    assert first is not None
    assert (first.shape, first.length, first.height, first.at) == ("half_sine", 0.5, 0.03, 6.0)
    assert second is not None
    assert (second.height, second.ramp) == (-0.02, 0.3)
    assert third is not None
    assert third.radius == 0.01
    assert fourth is not None
    assert (fourth.file, fourth.distance, fourth.height_column) == ("hump.csv", "distance", "h")
    assert file.road[4].iso8608 is not None
    assert (file.road[4].iso8608.class_, file.road[4].iso8608.seed) == ("B", 1)
    shaker = file.forces["shaker"].harmonic
    assert shaker is not None
    assert (shaker.amplitude, shaker.frequency) == (2000.0, 5.0)
    assert shaker.phase == pytest.approx(math.pi / 2, rel=1e-15)
    post = file.displacements["post"].harmonic
    assert post is not None
    assert (post.amplitude, post.frequency, post.phase) == (0.005, 3.0, 0.0)
    assert file.recording == "measured.csv"


def test_values_are_the_files_then_the_sets_then_the_runs(tmp_path: Path):
    assert load(tmp_path, GOOD).values() == {"mB": 800.0, "kF": 1.2e6, "b1": 1.4}
    assert load(tmp_path, GOOD.replace("set: soft\n", "")).values() == {"mB": 900.0, "kF": 1.2e6, "b1": 1.4}
    assert load(tmp_path, GOOD.replace("parameters: {kF: 1.2 MN/m}\n", "")).values()["kF"] == 40000.0
    assert load(tmp_path, SHORT).values() == {"mB": 900.0, "kF": 60000.0, "b1": 1.4}


def test_a_run_at_another_speed_or_of_another_set_is_as_if_its_file_said_so(tmp_path: Path):
    run = load(tmp_path, GOOD.replace("set: soft\n", ""))
    said = load(tmp_path, GOOD.replace("7.2 km/h", "18 km/h"))
    assert run.changed(speed=5.0, parameter_set="soft").file == said.file
    assert run.changed().file == run.file


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"speed": 0.0}, "`speed`: a number above 0 in m/s was expected, found 0.0"),
        ({"speed": float("nan")}, "`speed`: a number above 0 in m/s was expected, found nan"),
        ({"speed": "18 km/h"}, "`speed`: a number above 0 in m/s was expected, found '18 km/h'"),
        ({"speed": 400}, "`speed`: a speed is 0.01 to 150 m/s in magnitude, found 400 m/s"),
        ({"parameter_set": "sofft"}, "`parameter_set`: rig has no parameter set 'sofft'; did you mean 'soft'?"),
    ],
)
def test_changes_of_a_run_that_cannot_be(tmp_path: Path, change: dict[str, Any], message: str):
    with pytest.raises(InputError, match=re.escape(message)):
        load(tmp_path, GOOD).changed(**change)


def test_outputs_and_places(tmp_path: Path):
    run = load(tmp_path, GOOD)
    outputs = run.outputs()
    assert [output.name for output in outputs] == [
        "L1_az",
        "L1_q",
        "v2",
        "L3_acceleration",
        "L3_pitch_rate",
        "travel1",
        "load1",
        "post_force",
    ]
    assert [output.quantity for output in outputs] == [
        "acceleration",
        "pitch_rate",
        "velocity",
        "acceleration",
        "pitch_rate",
        "suspension_travel",
        "tyre_load",
        "link_force",
    ]
    first, last = outputs[0], outputs[-1]
    assert isinstance(first, PointOutput)
    assert first.place == Place("L1", "frame", None, "front", -0.29)
    assert isinstance(last, ElementOutput)
    assert last.owner == "post"
    shaker, ram = run.forces()
    assert (shaker.body, str(shaker.x), shaker.behind) == ("frame", "0.5 m", None)
    assert ram == Place("ram", "frame", None, "front", 1.0)


def test_defaults(tmp_path: Path):
    run = load(tmp_path, SHORT)
    assert run.file.duration is None
    assert run.file.step == 0.001
    assert run.decimation == 10
    assert run.file.road == []
    assert run.folder == tmp_path
    assert run.outputs() == (PointOutput("frame_acceleration", Place("frame", "frame"), "acceleration"),)
    assert run.forces() == ()


@pytest.mark.parametrize(("step", "sample", "keep"), [("1 ms", "1 ms", 1), ("0.1 ms", "10 ms", 100), ("3 ms", "0.3 s", 100)])
def test_how_often_a_sample_is_kept(step: str, sample: str, keep: int, tmp_path: Path):
    assert load(tmp_path, SHORT + f"step: {step}\nsample: {sample}\n").decimation == keep


def test_a_speed_history(tmp_path: Path):
    speed = load(tmp_path, SHORT.replace("2 m/s", "{file: speed.csv, time: seconds}")).file.speed
    assert not isinstance(speed, float)
    assert (speed.file, speed.time, speed.speed) == ("speed.csv", "seconds", "speed")


def test_a_bundled_vehicle_and_one_in_another_folder(tmp_path: Path):
    run = load(tmp_path, SHORT.replace("rig.yaml", "quarter_car"))
    assert run.vehicle.files == (bundled_models()["quarter_car"],)
    (tmp_path / "runs").mkdir()
    path = tmp_path / "runs" / "run.yaml"
    path.write_text(SHORT.replace("rig.yaml", "../rig.yaml"))
    assert load_run(str(path)).vehicle.name == "rig"


# (what, old text, new text with the mark @, how the message begins)
