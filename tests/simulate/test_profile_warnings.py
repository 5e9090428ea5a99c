"""Warnings of measured profiles: that end before the run, lack long waves, or have too few points for axle hop."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import scipy.signal

from vehgen.road import MeasuredProfile
from vehgen.simulate import load_run, simulate
from vehgen.simulate.profile_warnings import long_wave_share

RUN = "vehicle: sedan2\nspeed: SPEED m/s\nduration: SECONDS s\nroad: [{profile: {file: road.csv, distance: s, height: h}}]\n"


def road(length: float, step: float = 0.05, seed: int = 3) -> tuple[np.ndarray, np.ndarray]:
    """A road of white slope, the exponent 2 of ISO 8608: a random walk."""
    s = np.arange(0.0, length + step / 2, step)
    return s, np.cumsum(np.random.default_rng(seed).normal(0, 1e-3 * np.sqrt(step), len(s)))


def warnings_of(folder: Path, s: np.ndarray, h: np.ndarray, speed: float, seconds: float) -> str:
    np.savetxt(folder / "road.csv", np.column_stack([s, h]), delimiter=",", header="s,h", comments="")
    (folder / "run.yaml").write_text(RUN.replace("SPEED", str(speed)).replace("SECONDS", str(seconds)))
    return "\n".join(simulate(load_run(folder / "run.yaml")).warnings)


def test_a_profile_shorter_than_the_run_is_told_with_its_time(tmp_path: Path):
    s, h = road(60.0)
    assert "the measured profile ends at 60 m, the run at 80 m: from 6 s on" in warnings_of(tmp_path, s, h, 10, 8)
    assert "profile" not in warnings_of(tmp_path, s, h, 10, 5.9)


def test_an_obstacle_on_a_level_road_is_no_profile_that_ends_too_early(tmp_path: Path):
    s = np.linspace(0, 2, 200)
    assert "profile" not in warnings_of(tmp_path, s, 0.03 * np.sin(np.pi * s / 2) ** 2, 5, 4)


def test_a_profile_too_short_for_long_waves_is_told(tmp_path: Path):
    s, h = road(9.0)
    assert "is 9 m long and can hold no wave of 10 m" in warnings_of(tmp_path, s, h, 3, 2)


def test_a_profile_of_a_three_metre_straightedge_is_told(tmp_path: Path):
    s, h = road(200.0)
    sections = scipy.signal.butter(4, 1 / 3.0, "high", fs=20.0, output="sos")
    assert "of the waves of 10 m and longer that its short ones let expect" in warnings_of(
        tmp_path, s, scipy.signal.sosfiltfilt(sections, h) + s * 1e-4, 10, 10
    )


@pytest.mark.parametrize("seed", range(30))
@pytest.mark.parametrize("length", [80.0, 300.0])
def test_roads_of_white_slope_have_their_long_waves(seed: int, length: float):
    assert 0.1 < long_wave_share(MeasuredProfile(*road(length, seed=seed))) < 5.0


def test_points_too_far_apart_for_axle_hop_are_told(tmp_path: Path):
    s, h = road(60.0, 0.5)
    said = warnings_of(tmp_path, s, h, 5, 10)
    assert "has a point every 0.5 m, no wave shorter than 1 m: at 5 m/s it excites nothing above 5 Hz" in said
    assert "a point every" not in warnings_of(tmp_path, *road(60.0, 0.1), 5, 10)


def test_points_that_nearly_coincide_ask_for_no_memory():
    distance = np.r_[1e-9 * np.arange(51), 100.0]
    assert np.isfinite(long_wave_share(MeasuredProfile(distance, 1e-3 * np.sin(distance))))
