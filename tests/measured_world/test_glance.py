"""Counts of scored sets of effects: what was right, a wrong cause, or not told, and which intervals hold."""

import json
from pathlib import Path

import pytest
from benchmarks.measured_world.telling.glance import glance, intervals, kinds, misses

FRICTION = {"name": "dry_friction", "place": "rear", "values": {"force": 500.0}}
PLAY = {"name": "damper_free_play", "listed": False, "place": "rear", "values": {"play": 0.002}}
"""Outside the library when it was scored; what has always been outside says nothing of it."""
HANGER = {"name": "axle_hanger", "place": "rear", "values": {"frequency": 9.0}}


def record(judged, effect=FRICTION, interval=None):
    told = [{"name": effect["name"], "place": "rear", "parameters": {"force": {"value": 450.0, "interval": interval, "unit": "N"}}}]
    found = {"case": "effects_000", "kind": "effects", "recorder": "phones", "effects": [effect]}
    return {**found, "judged": judged, "answer": {"effects": told}}


@pytest.fixture
def scored(tmp_path):
    """Two sets: six cases of the library, three outside it, one healthy vehicle."""
    first = [
        record("named right", interval=[400.0, 510.0]),
        record("named right", interval=[400.0, 480.0]),
        record("named right"),
        record("ambiguous, truth among them", interval=[400.0, 480.0]),
        record("too_weak"),
        record("not_in_library", PLAY),
        {"case": "healthy_000", "kind": "healthy", "effects": [], "fault": None, "judged": "no_missing_effect", "answer": {}},
    ]
    second = [record("several_effects"), record("measurement_fault", PLAY), record("import_refused", HANGER)]
    paths = [tmp_path / "one.jsonl", tmp_path / "two.jsonl"]
    for path, records in zip(paths, (first, second), strict=True):
        path.write_text("".join(json.dumps(item) + "\n" for item in records), encoding="utf-8")
    return paths


def test_each_set_has_a_row_and_all_together_one(scored):
    assert glance(scored).splitlines()[2:] == [
        "| one | 5 | 3 | 1 | 0 | 1 | 0 | 1 | 1 | 0 | 0 | 0 | 1 of 2 |",
        "| two | 1 | 0 | 0 | 0 | 0 | 1 | 2 | 0 | 1 | 0 | 1 | 0 of 0 |",
        "| all | 6 | 3 | 1 | 0 | 1 | 1 | 3 | 1 | 1 | 0 | 1 | 1 of 2 |",
    ]


def test_each_thing_hidden_has_a_row(scored, tmp_path):
    faults = [
        {"case": "faults_000", "kind": "faults", "effects": [], "fault": {"kind": "low_passed"}, "judged": judged, "answer": {}}
        for judged in ("fault named right, place too", "refused, fault told", "named as a false effect", "not_in_library")
    ]
    path = tmp_path / "faults.jsonl"
    path.write_text("".join(json.dumps(item) + "\n" for item in faults), encoding="utf-8")
    assert kinds([*scored, path]).splitlines()[2:] == [
        "| axle_hanger | 1 | 0 | 0 | 0 | 0 | 1 |",
        "| damper_free_play | 2 | 0 | 0 | 1 | 0 | 1 |",
        "| dry_friction | 6 | 3 | 1 | 0 | 1 | 1 |",
        "| low_passed | 4 | 2 | 0 | 1 | 0 | 1 |",
        "| nothing | 1 | 1 | 0 | 0 | 0 | 0 |",
    ]


def test_intervals_that_miss_are_listed(scored):
    assert misses(scored).splitlines()[2:] == ["| effects_000 | dry_friction_force | 400 | 480 | 500 |"]


def test_numbers_that_the_generator_does_not_state_count_for_nothing():
    other = record("named right", {**FRICTION, "values": {"level": 500.0}}, [400.0, 480.0])
    assert intervals(other) == []


def test_an_engine_is_not_held_against_what_it_did_over_all_of_a_phones_export():
    engine = {"name": "engine_harmonic", "place": "body", "values": {"frequency": 21.0, "amplitude": 300.0}}
    item = record("named right", engine)
    told = {name: {"value": value, "interval": [value - 1, value + 1], "unit": ""} for name, value in engine["values"].items()}
    item["answer"]["effects"][0]["parameters"] = told
    assert [name for name, *_ in intervals(item)] == ["engine_harmonic_amplitude"]
    assert len(intervals({**item, "recorder": "logger"})) == 2


def test_the_page_shows_all_sets_as_their_records_have_them():
    root = Path(__file__).parents[2]
    files = (root / "benchmarks" / "measured_world" / "results").glob("sealed_effects*.jsonl")
    listed = sorted(files, key=lambda path: int(path.stem.rpartition("_")[2].replace("effects", "1")))
    page = (root / "docs" / "hidden-effects.md").read_text(encoding="utf-8")
    assert glance(listed) in page
    assert kinds(listed[-6:]) in page
    of_library, right, tied, wrong, none, other, outside, so, *_, held = glance(listed[-6:]).splitlines()[-1].strip("| ").split(" | ")[1:]
    assert f"| {of_library} (the last six sets) | {right} named right" in page
    assert f"{tied} as one of several" in page
    assert f"{none} not seen" in page
    assert f"{wrong} as another cause" in page
    assert f", {other} otherwise |" in page
    assert f"{held} intervals hold the truth" in page
    assert f"| {outside} (the same sets) | {so} told as such" in page
