"""Warnings of measured profiles: that end before the run, lack long waves, have a hole or too few points for axle hop, or are in mm."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import scipy.signal

from vehgen.errors import InputError
from vehgen.road import MeasuredProfile
from vehgen.simulate import load_run, simulate
from vehgen.simulate.holes import holes
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


def test_a_few_points_too_far_apart_are_told_where_they_were_measured(tmp_path: Path):
    s = np.arange(0.0, 60.0, 4.0)
    h = 0.01 * np.sin(2 * np.pi * s / 3)
    said = warnings_of(tmp_path, s, h, 5, 6)
    assert "has a point every 4 m, no wave shorter than 8 m: at 5 m/s it excites nothing above 0.625 Hz" in said
    drawn = s + np.where(np.arange(len(s)) % 2, 1.0, 0.0)
    assert "a point every" not in warnings_of(tmp_path, drawn, h, 5, 6)
    assert "a point every" not in warnings_of(tmp_path, s[:7], h[:7], 5, 4)
    steps = np.where(s < 20, 0.0, np.where(s < 40, 0.02, 0.01))
    assert "a point every" not in warnings_of(tmp_path, s, steps, 5, 6)


def test_a_hole_that_wheels_cross_is_told(tmp_path: Path):
    s, h = road(60.0, 0.1)
    kept = np.r_[0:100, 300:601]
    said = warnings_of(tmp_path, s[kept], h[kept], 5, 6)
    assert "the measured profile has a hole from 9.9 to 30 m, its points being 0.1 m apart: wheels cross it on a straight line" in said
    assert "hole" not in warnings_of(tmp_path, s[kept], h[kept], 5, 1.9)
    assert "hole" not in warnings_of(tmp_path, np.delete(s, slice(100, 108)), np.delete(h, slice(100, 108)), 5, 6)
    two = np.delete(kept, slice(20, 40))
    assert "a hole from 9.9 to 30 m, its points being 0.1 m apart (2 such holes in all)" in warnings_of(tmp_path, s[two], h[two], 5, 6)


def test_a_hole_behind_the_first_wheel_is_crossed_by_nobody(tmp_path: Path):
    """What lies behind it counts as level."""
    s, h = road(60.0, 0.05)
    kept = np.r_[0:20, 40:1201]
    assert "has a hole from 0.95 to 2 m" in warnings_of(tmp_path, s[kept], h[kept], 5, 6)
    assert "hole" not in warnings_of(tmp_path, s[kept] - 2.5, h[kept], 5, 6)


def test_a_road_that_was_levelled_ends_before_its_run_and_an_obstacle_does_not(tmp_path: Path):
    s, h = road(60.0, 0.05)
    levelled = h - np.interp(s, s[[0, -1]], h[[0, -1]])
    assert "ends at 60 m, the run at 100 m" in warnings_of(tmp_path, s, levelled, 5, 20)
    crossing = np.where((s > 5) & (s < 55), levelled - np.interp(s, [5, 55], np.interp([5, 55], s, levelled)), 0.0)
    assert "ends at" not in warnings_of(tmp_path, s, crossing, 5, 20)


def test_a_long_obstacle_that_was_drawn_has_its_ends_on_the_level(tmp_path: Path):
    assert "ends at" not in warnings_of(tmp_path, np.array([0.0, 0.5, 11.5, 12.0]), np.array([0.0, 0.1, 0.1, 0.0]), 5, 20)


def test_a_profile_behind_the_first_wheel_is_refused(tmp_path: Path):
    with pytest.raises(InputError, match=r"run.yaml:\d+:\d+: the profile ends at -1 m, behind the first wheel, which begins at 0 m"):
        warnings_of(tmp_path, np.array([-50.0, -20.0, -1.0]), np.array([0.0, 0.01, 0.02]), 5, 5)


def test_level_roads_between_obstacles_and_points_in_groups_are_no_holes(tmp_path: Path):
    s = np.linspace(0, 2, 200)
    bumps = 0.03 * np.sin(np.pi * s / 2) ** 2
    assert "hole" not in warnings_of(tmp_path, np.r_[s, s + 20], np.r_[bumps, bumps], 5, 6)
    slabs = np.arange(0.0, 60.0, 4.0)
    faulted = np.c_[slabs, slabs + 0.01, slabs + 3.99].ravel()
    assert "hole" not in warnings_of(tmp_path, faulted, np.tile([0.0, 0.001, 0.005], len(slabs)), 5, 6)


@pytest.mark.parametrize(("wide", "told"), [(4, 4), (6, 0)])
def test_wide_gaps_that_are_a_tenth_of_all_are_how_a_table_was_drawn(wide: int, told: int):
    """Of 50 gaps, 8 and 12 in a hundred."""
    gaps = np.ones(50)
    gaps[5 : 5 + 7 * wide : 7] = 20.0 + np.arange(wide)
    places = np.r_[0.0, np.cumsum(gaps)]
    found = holes(places, 0.0, places[-1])
    assert found.tolist() == [5 + 7 * i for i in reversed(range(told))]


def test_heights_in_mm_that_are_read_as_m_are_asked_for_their_unit(tmp_path: Path):
    s = np.arange(0, 60, 0.1)
    h = 0.01 * np.sin(2 * np.pi * s / 3)
    said = warnings_of(tmp_path, s, 1e3 * h, 5, 6)
    assert "rises or falls by 9.95 m over 0.5 m, its heights range over 19.89 m: are the heights in mm? Then state `unit: mm`" in said
    assert "in mm" not in warnings_of(tmp_path, s, h, 5, 6)
    assert "in mm" not in warnings_of(tmp_path, s, 0.2 * s, 5, 6)
    assert "in mm" not in warnings_of(tmp_path, s, np.where(s < 20, 0.0, 0.8), 5, 6)
