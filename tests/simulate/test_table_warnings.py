"""Warnings of tables of speeds, forces and displacements: that do not cover the run, have a hole, or seem to be in ms."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from vehgen.simulate import load_run, simulate

VEHICLE = "bodies: {body: {mass: 1 t, motions: [heave]}}\nlinks: {post: {ground: {}, body: {x: 0 m}, k: 90 kN/m, c: 3 kN s/m}}\n"
SPEED = (
    "vehicle: sedan2\nspeed: {file: t.csv, time: t, speed: v}\nroad: [{hump: {shape: half_sine, length: 1 m, height: 10 mm, at: 2 m}}]\n"
)
FORCE = "vehicle: sedan2\nspeed: 5 m/s\nforces: {ram: {body: body, file: t.csv, time: t, force: v}}\n"
DISPLACEMENT = "vehicle: rig.yaml\ndisplacements: {post: {file: t.csv, time: t, displacement: v}}\n"
ENDING = "duration: 4 s\n"
KINDS = {"the speed": SPEED, "the force ram": FORCE, "the displacement post": DISPLACEMENT}


def warned(folder: Path, run: str, times: np.ndarray, heading: str = "t,v") -> list[str]:
    """Return what a run of 4 s says of a table t.csv of these times."""
    np.savetxt(folder / "t.csv", np.column_stack([times, 5 + 0.01 * np.sin(times)]), delimiter=",", header=heading, comments="")
    (folder / "rig.yaml").write_text(VEHICLE)
    (folder / "run.yaml").write_text(run + ENDING)
    return [item for item in simulate(load_run(folder / "run.yaml")).warnings if "table" in item]


@pytest.mark.parametrize("kind", KINDS)
def test_a_table_that_does_not_cover_the_run_is_told_with_what_is_done(tmp_path: Path, kind: str):
    what = f"the table of {kind} (t.csv) covers"
    assert warned(tmp_path, KINDS[kind], np.linspace(0.5, 6, 200)) == [
        f"{what} 0.5 to 6 s, the run lasts from 0 to 4 s: its first value is held before 0.5 s"
    ]
    assert warned(tmp_path, KINDS[kind], np.linspace(-1, 3, 200)) == [
        f"{what} -1 to 3 s, the run lasts from 0 to 4 s: its last value is held after 3 s"
    ]
    assert warned(tmp_path, KINDS[kind], np.linspace(2, 3, 200)) == [
        f"{what} 2 to 3 s, the run lasts from 0 to 4 s: its first value is held before 2 s and its last value is held after 3 s"
    ]
    assert warned(tmp_path, KINDS[kind], np.linspace(0, 4, 200)) == []
    assert warned(tmp_path, KINDS[kind], np.linspace(0.01, 3.99, 200)) == []


@pytest.mark.parametrize("kind", KINDS)
def test_a_hole_is_told_with_its_place(tmp_path: Path, kind: str):
    times = np.arange(0, 4.01, 0.01)
    hole = np.delete(times, slice(101, 300))
    assert warned(tmp_path, KINDS[kind], hole) == [
        f"the table of {kind} (t.csv) has a hole from 1 to 3 s, its rows being 0.01 s apart: a straight line bridges it"
    ]
    (said,) = warned(tmp_path, KINDS[kind], np.delete(hole, slice(20, 40)))
    assert "a hole from 1 to 3 s, its rows being 0.01 s apart (2 such holes in all)" in said
    assert warned(tmp_path, KINDS[kind], np.delete(times, slice(20, 28))) == []


def test_holes_outside_of_the_run_and_drawn_tables_are_not_told(tmp_path: Path):
    assert warned(tmp_path, FORCE, np.r_[np.arange(-3, -2, 0.01), np.arange(-0.5, 4.01, 0.01), np.arange(6, 7, 0.01)]) == []
    assert warned(tmp_path, FORCE, np.array([0, 1, 1.01, 1.02, 9])) == []
    assert warned(tmp_path, FORCE, np.r_[np.arange(0, 1.4, 0.1), 3.99]) == []


@pytest.mark.parametrize("kind", KINDS)
def test_a_table_in_ms_is_asked_for_its_unit(tmp_path: Path, kind: str):
    times = np.arange(0, 4001.0, 10)
    (said,) = warned(tmp_path, KINDS[kind], times)
    assert said == (
        f"the table of {kind} (t.csv) lasts 4000 s, 1e+03 times as long as the run: is its time in ms? "
        "State `time_unit: ms`, or `time_unit: s` if it is not"
    )
    stated = KINDS[kind].replace("time: t", "time: t, time_unit: UNIT")
    assert warned(tmp_path, stated.replace("UNIT", "ms"), times) == []
    assert warned(tmp_path, stated.replace("UNIT", "s"), times) == []
    assert warned(tmp_path, KINDS[kind], times, "t [s],v") == []
    assert warned(tmp_path, KINDS[kind], np.arange(0, 150, 0.5)) == []


def test_rows_far_apart_spare_no_more_than_a_hundredth_of_the_run(tmp_path: Path):
    (said,) = warned(tmp_path, FORCE, np.array([1.0, 3.0]))
    assert "covers 1 to 3 s" in said
    assert warned(tmp_path, FORCE, np.array([0.03, 3.97])) == []


def test_one_row_states_a_constant(tmp_path: Path):
    (tmp_path / "t.csv").write_text("t,v\n0,500\n")
    (tmp_path / "run.yaml").write_text(FORCE + ENDING)
    assert simulate(load_run(tmp_path / "run.yaml")).warnings == ()


def test_a_pulse_that_begins_and_ends_at_rest_covers_the_run(tmp_path: Path):
    times = np.linspace(1.0, 1.2, 50)
    (tmp_path / "run.yaml").write_text(FORCE + ENDING)

    def said(values: np.ndarray) -> list[str]:
        np.savetxt(tmp_path / "t.csv", np.column_stack([times, values]), delimiter=",", header="t,v", comments="")
        return [item for item in simulate(load_run(tmp_path / "run.yaml")).warnings if "table" in item]

    pulse = 1e3 * np.sin(np.pi * (times - 1.0) / 0.2)
    assert said(pulse) == []
    (text,) = said(np.where(times > 1.1, 1e3, pulse))
    assert text.endswith("its last value is held after 1.2 s")


def test_a_track_that_lacks_less_than_one_of_its_rows_covers_the_run(tmp_path: Path):
    run = SPEED + "duration: 30 s\n"
    for times, told in ((np.arange(0.6, 31), False), (np.arange(0.0, 29.5), False), (np.arange(2.0, 31), True)):
        np.savetxt(tmp_path / "t.csv", np.column_stack([times, np.full(len(times), 5.0)]), delimiter=",", header="t,v", comments="")
        (tmp_path / "run.yaml").write_text(run)
        assert bool([item for item in simulate(load_run(tmp_path / "run.yaml")).warnings if "covers" in item]) == told


def test_a_long_track_of_which_a_run_is_a_part_is_not_in_ms(tmp_path: Path):
    assert warned(tmp_path, SPEED, np.arange(0.0, 1500.0)) == []
