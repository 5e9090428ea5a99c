"""The comparison of two records finds what changed, and only that; the recorder writes runs that the commands take."""

import copy
import json
import re
from pathlib import Path

import pytest
from benchmarks.unchanged import compare as module
from benchmarks.unchanged.commands import COMMANDS, command
from benchmarks.unchanged.compare import compare, report
from benchmarks.unchanged.inputs import write_runs
from benchmarks.unchanged.record import SECTIONS, condensed, failures, numbers

from vehgen import bundled_models, load_run, load_vehicle

RESULTS = Path(module.__file__).with_name("results") / "0.1.0.json"
RECORD = {
    "machine": {"numpy": "2.0"},
    "modes": {"car": {"modes": [{"name": "hop", "undamped_hz": 12.345678901234567}]}},
    "hidden": {
        "diagnosis": {
            "verdict": "named",
            "reason": "friction closes 100 %",
            "effects": [{"name": "dry_friction", "parameters": {"force": {"value": 445.6049383420799, "interval": [427.2, 464.0]}}}],
            "warnings": ["one", "two"],
            "files": ["a/b.json"],
            "p_value": None,
        }
    },
}


def changed(path, value):
    new = copy.deepcopy(RECORD)
    *places, last = path
    item = new
    for place in places:
        item = item[place]
    item[last] = value
    return new


def test_equal_records_are_equal():
    lines, same = report(RECORD, copy.deepcopy(RECORD), 0.0, False)
    assert same
    assert lines[-1] == "nothing that was computed changed"


@pytest.mark.parametrize(
    ("path", "value"),
    [
        (("modes", "car", "modes", 0, "undamped_hz"), 12.345678901234569),
        (("hidden", "diagnosis", "effects", 0, "parameters", "force", "value"), 445.60493834208),
        (("hidden", "diagnosis", "effects", 0, "parameters", "force", "interval"), [427.2, 464.0, 1.0]),
        (("hidden", "diagnosis", "effects", 0, "name"), "hysteresis"),
        (("hidden", "diagnosis", "effects"), []),
        (("hidden", "diagnosis", "verdict"), "ambiguous"),
        (("hidden", "diagnosis", "p_value"), 0.5),
        (("hidden", "diagnosis", "warnings"), ["one"]),
        (("hidden", "diagnosis"), {"failed": "error: no such file"}),
    ],
)
def test_one_changed_digit_word_or_entry_is_found(path, value):
    lines, same = report(RECORD, changed(path, value), 0.0, False)
    assert not same
    assert any(line.startswith(f"  {path[0]} / ") for line in lines)


def test_a_missing_entry_or_section_is_found():
    new = copy.deepcopy(RECORD)
    del new["hidden"]["diagnosis"]["verdict"]
    assert [item.place for item in compare(RECORD, new)] == ["hidden / diagnosis / verdict"]
    del new["hidden"]
    assert not report(RECORD, new, 0.0, False)[1]


@pytest.mark.parametrize(
    ("path", "value"),
    [
        (("machine", "numpy"), "2.1"),
        (("hidden", "diagnosis", "reason"), "Dry friction explains all"),
        (("hidden", "diagnosis", "warnings"), ["eins", "zwei"]),
        (("hidden", "diagnosis", "files"), ["elsewhere"]),
        (("hidden", "diagnosis", "a new key"), 1.0),
    ],
)
def test_versions_paths_wording_and_new_keys_are_no_change(path, value):
    assert report(RECORD, changed(path, value), 0.0, True)[1]


def test_the_tolerance_holds_for_fits_and_not_for_arithmetic():
    fit = ("hidden", "diagnosis", "effects", 0, "parameters", "force", "value")
    new = changed(fit, 445.6049383420799 * (1 + 1e-9))
    (difference,) = compare(RECORD, new)
    assert difference.relative == pytest.approx(1e-9, rel=1e-3)
    assert report(RECORD, new, 1e-8, False)[1]
    assert not report(RECORD, new, 1e-10, False)[1]
    assert not report(RECORD, changed(("modes", "car", "modes", 0, "undamped_hz"), 12.345678901234569), 1e-3, False)[1]


def test_renamed_keys_and_words_are_followed(monkeypatch):
    monkeypatch.setattr(module, "RENAMED", {"verdict": "decision", "named": "found"})
    new = copy.deepcopy(RECORD)
    del new["hidden"]["diagnosis"]["verdict"]
    new["hidden"]["diagnosis"]["decision"] = "found"
    assert report(RECORD, new, 0.0, False)[1]
    new["hidden"]["diagnosis"]["decision"] = "ambiguous"
    assert not report(RECORD, new, 0.0, False)[1]


def test_a_renamed_parameter_set_is_followed_in_keys_and_values():
    old = {"modes": {"sedan2, DHCM-F&R": {"set": "DHCM-F&R", "modes": [1.5]}}}
    assert report(old, {"modes": {"sedan2, DHCM-F-R": {"set": "DHCM-F-R", "modes": [1.5]}}}, 0.0, False)[1]
    assert not report(old, {"modes": {"sedan2, DHCM-F-R": {"set": "DHCM-F-R", "modes": [1.6]}}}, 0.0, False)[1]
    assert not report(old, {"modes": {"sedan2, DHCM": {"set": "DHCM-F-R", "modes": [1.5]}}}, 0.0, False)[1]


def test_failed_commands_are_named():
    assert failures({"a": {"b": {"failed": "error: no"}}, "c": {"d": 1.0}}) == ["a / b: error: no"]


def test_numbers_of_a_text():
    assert numbers("linear m1 0.53, k1 1.02e+05\n   RMSE [mV]: multisine 6.963") == [0.53, 1.02e5, 6.963]


def test_a_condensed_list_shows_a_changed_digit():
    values = [0.1 * i for i in range(30)]
    old, new = (condensed({"rms": {"k1": [item, [1.0]]}}) for item in (values, [*values[:-1], values[-1] + 1e-12]))
    assert old["rms"]["k1"][1] == [1.0]
    assert [item.place for item in compare(old, new)] == ["rms / k1[0] / sha256", "rms / k1[0] / sum"]


def test_every_place_of_a_command_line_can_be_filled():
    for name, text in COMMANDS.items():
        places = dict.fromkeys(re.findall(r"{(\w+)}", text), "x y")
        assert not any("{" in part for part in command(name, **places))


RIGS = ("damper_dyno", "drop_test", "shaker")
"""Bundled later than the baseline was recorded."""


@pytest.mark.thorough
def test_the_recorder_writes_runs_of_every_bundled_vehicle(tmp_path):
    axles = {name: list(load_vehicle(name).axles) for name in bundled_models()}
    runs = write_runs(tmp_path, axles)
    assert {f"run {name}" for name in axles if name not in RIGS} < {run.stem for run in runs}
    for run in runs:
        assert load_run(run).outputs()


def test_the_recorded_baseline_is_whole():
    record = json.loads(RESULTS.read_text(encoding="utf-8"))
    assert set(record) == {*SECTIONS, "machine"}
    assert failures(record) == []
