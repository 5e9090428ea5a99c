"""From a file to a vehicle: files that are none are refused, and the bundled models are whole."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.vehicle.rig import GOOD, check_refused
from vehgen.errors import InputError
from vehgen.vehicle import bundled_models, load_vehicle, parse_vehicle

BOMB = "a0: &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]\n" + "".join(f"a{i}: &a{i} [{', '.join([f'*a{i - 1}'] * 10)}]\n" for i in range(1, 10))


def test_a_file_and_its_text_give_the_same_vehicle(tmp_path: Path):
    path = tmp_path / "good.yaml"
    path.write_text(GOOD)
    assert load_vehicle(path).model_dump() == parse_vehicle(GOOD).model_dump()
    assert load_vehicle(path).files == (path,)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("name: rig", "name: 'rig", "22:22: not valid YAML: found unexpected end of stream"),
        ("name: rig", "name: @!!python/name:os.system rig", "the tag tag:yaml.org,2002:python/name:os.system is not allowed"),
        ("name: rig", "name: @&a [*a]", "nested more than"),
    ],
)
def test_what_yaml_may_not_say(old: str, new: str, message: str):
    check_refused(old, new, message)


@pytest.mark.parametrize("text", ["[" * 1200, "a: " + "{b: " * 60 + "1" + "}" * 60])
def test_deep_nesting_is_refused(text: str):
    with pytest.raises(InputError, match=r"^bad\.yaml:1:\d+: (nested|not valid YAML)"):
        parse_vehicle(text, "bad.yaml")


def test_aliases_that_multiply_are_refused():
    with pytest.raises(InputError, match="do aliases multiply"):
        parse_vehicle(BOMB)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"#" * 10_000_000, "10000000 bytes; a YAML file of at most 1000000 bytes was expected"),
        (b"name: \xff\xfe", "large.yaml:1:7: not UTF-8 text"),
        (b"", "large.yaml:1:1: the file is empty"),
    ],
    ids=["too large", "no text", "empty"],
)
def test_files_that_hold_no_vehicle(content: bytes, message: str, tmp_path: Path):
    path = tmp_path / "large.yaml"
    path.write_bytes(content)
    with pytest.raises(InputError, match=message):
        load_vehicle(path)


def test_paths_that_are_no_file(tmp_path: Path):
    with pytest.raises(InputError, match="is a folder; a YAML file was expected"):
        load_vehicle(tmp_path)
    with pytest.raises(InputError, match=r"^no file trcktor5, and no bundled model 'trcktor5'; did you mean 'tractor5'"):
        load_vehicle("trcktor5")
    with pytest.raises(InputError, match=r"did you mean 'tractor5'"):
        load_vehicle("tracktor5.yaml")


def test_a_bundled_model_in_a_folder_is_told_by_its_bare_name():
    with pytest.raises(InputError, match=r"^no file .*tractor5\.yaml, and a bundled model is named without a folder: tractor5$"):
        load_vehicle("no_folder/tractor5.yaml")


@pytest.mark.parametrize("name", sorted(bundled_models()))
def test_bundled_models_are_whole(name: str):
    vehicle = load_vehicle(name)
    assert vehicle.title
    assert vehicle.source
    assert all(parameter.meaning for parameter in vehicle.parameters.values())
