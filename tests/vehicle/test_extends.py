"""Files that extend others: what merges, what replaces, what is removed, and where errors point."""

from __future__ import annotations

from pathlib import Path

import pytest

from vehgen.errors import InputError
from vehgen.files.document import read_text
from vehgen.vehicle import bundled_models, find_vehicle_file, load_vehicle, parse_vehicle
from vehgen.vehicle.changes import merge

BASE = """\
name: base
title: the base
parameters:
  mB: {value: 900 kg, range: [500 kg, 2 t], meaning: body mass}
  b1: {value: 1.2 m, meaning: axle ahead of the COG}
  b2: {equals: 3 m - b1, meaning: axle behind the COG}
bodies:
  body: {mass: mB, pitch_inertia: 800 kg m^2, motions: [heave, pitch]}
axles:
  front: {body: body, x: b1, tyre: {k: 200 kN/m, c: 1 kN s/m}}
  rear: {body: body, x: -b2, tyre: {k: 150 kN/m}}
sets:
  laden: {mB: 1.4 t}
"""


def child(folder: Path, text: str, name: str = "child.yaml") -> Path:
    (folder / "base.yaml").write_text(BASE)
    (folder / name).write_text(text)
    return folder / name


def test_an_empty_child_is_its_base_by_another_name(tmp_path: Path):
    vehicle = load_vehicle(child(tmp_path, "extends: base.yaml\n"))
    assert vehicle.model_dump() == load_vehicle(tmp_path / "base.yaml").model_dump() | {"name": "child"}
    assert vehicle.files == (tmp_path / "child.yaml", tmp_path / "base.yaml")


def test_mappings_merge_and_scalars_and_lists_replace(tmp_path: Path):
    vehicle = load_vehicle(
        child(
            tmp_path,
            "extends: base.yaml\ntitle: the child\nparameters:\n  mB: {range: [800 kg, 1 t]}\n  kR: {value: 90 kN/m}\n"
            "bodies:\n  body: {motions: [heave]}\naxles:\n  rear: {tyre: {k: kR}}\n  third: {body: body, x: 0 m, tyre: {k: kR}}\n"
            "sets:\n  empty: {mB: 850 kg}\n",
        )
    )
    assert (vehicle.name, vehicle.title) == ("child", "the child")
    assert list(vehicle.parameters) == ["mB", "b1", "b2", "kR"]
    assert vehicle.ranges() == {"mB": (800.0, 1000.0)}
    assert vehicle.parameters["mB"].meaning == "body mass"
    assert vehicle.bodies["body"].motions == ("heave",)
    assert str(vehicle.axles["rear"].tyre.k) == "kR"
    assert str(vehicle.axles["front"].tyre.c) == "1 kN s/m"
    assert list(vehicle.axles) == ["front", "rear", "third"]
    assert vehicle.values("laden")["mB"] == 1400.0
    assert vehicle.values("empty")["mB"] == 850.0


def test_null_removes(tmp_path: Path):
    vehicle = load_vehicle(
        child(tmp_path, "extends: base.yaml\ntitle: null\nparameters:\n  mB: {range: ~}\naxles:\n  rear:\nsets: {laden: null}\n")
    )
    assert vehicle.title == ""
    assert vehicle.ranges() == {}
    assert list(vehicle.axles) == ["front"]
    assert vehicle.sets == {}


@pytest.mark.parametrize(
    ("text", "place", "message"),
    [
        (
            "extends: base.yaml\naxles:\n  raer: null\n",
            "3:3",
            "null removes 'raer', but the file it extends has none; did you mean 'rear'?",
        ),
        ("extends: base.yaml\nlinks: null\n", "2:1", "null removes 'links', but the file it extends has none"),
        ("extends: base.yaml\nparameters: {mB: {equals: ~}}\n", "2:19", "null removes 'equals'"),
    ],
)
def test_null_must_remove_something(text: str, place: str, message: str, tmp_path: Path):
    path = child(tmp_path, text)
    with pytest.raises(InputError) as caught:
        load_vehicle(path)
    assert str(caught.value).startswith(f"{path}:{place}: {message}")


def test_equals_replaces_value_and_range_and_the_other_way_round(tmp_path: Path):
    vehicle = load_vehicle(
        child(
            tmp_path,
            "extends: base.yaml\nparameters:\n  mB: {equals: 100 kg/m * b1}\n  b2: {value: 1.5 m, range: [1 m, 2 m]}\nsets: null\n",
        )
    )
    assert vehicle.free_parameters == ("b1", "b2")
    assert vehicle.all_values(vehicle.values()) == {"mB": 120.0, "b1": 1.2, "b2": 1.5}
    assert vehicle.ranges() == {"b2": (1.0, 2.0)}
    assert vehicle.parameters["b2"].meaning == "axle behind the COG"


def test_names_that_are_also_keys_of_a_parameter_are_left_alone():
    base = read_text("p: {equals: {a: 1}, range: {b: 2}, c: {equals: x, meaning: y}}\n", "base")
    merged = merge(base, read_text("p: {value: {d: 3}, c: {value: z}}\n", "child"))
    assert merged.plain() == {"p": {"equals": {"a": 1}, "range": {"b": 2}, "value": {"d": 3}, "c": {"meaning": "y", "value": "z"}}}


def test_what_is_written_twice_over_changes_nothing_of_the_base(tmp_path: Path):
    child(tmp_path, "extends: base.yaml\nparameters: {mB: {value: 1 t}}\n")
    before = (tmp_path / "base.yaml").read_text()
    assert load_vehicle(tmp_path / "child.yaml").values()["mB"] == 1000.0
    assert load_vehicle(tmp_path / "base.yaml").values()["mB"] == 900.0
    assert (tmp_path / "base.yaml").read_text() == before


def test_grandchildren(tmp_path: Path):
    child(tmp_path, "extends: base.yaml\nname: child\nparameters: {mB: {value: 1 t}}\n")
    (tmp_path / "sub").mkdir()
    path = tmp_path / "sub" / "grandchild.yaml"
    path.write_text("extends: ../child.yaml\nname: grandchild\nparameters: {b1: {value: 1 m}}\n")
    vehicle = load_vehicle(path)
    assert vehicle.values() == {"mB": 1000.0, "b1": 1.0}
    assert [item.name for item in vehicle.files] == ["grandchild.yaml", "child.yaml", "base.yaml"]
    assert str(vehicle.position("parameters", "mB", "value")).endswith("child.yaml:3:26")
    assert str(vehicle.position("parameters", "b2", "equals")).endswith("base.yaml:6:16")


def test_a_bundled_model_by_name_and_a_file_that_hides_it(tmp_path: Path):
    for name in ("quarter_car", "quarter_car.yaml"):
        path = tmp_path / "mine.yaml"
        path.write_text(f"extends: {name}\nname: mine\nparameters: {{mB: {{value: 1.5 t}}}}\n")
        vehicle = load_vehicle(path)
        assert vehicle.values()["mB"] == 1500.0
        assert vehicle.values()["mG"] == 1000.0
        assert vehicle.files[1] == bundled_models()["quarter_car"]
    (tmp_path / "quarter_car.yaml").write_text(BASE)
    assert load_vehicle(path).files[1] == tmp_path / "quarter_car.yaml"
    assert find_vehicle_file("quarter_car") == bundled_models()["quarter_car"]
    assert find_vehicle_file("quarter_car.yaml", tmp_path) == tmp_path / "quarter_car.yaml"


def test_a_text_may_extend_bundled_models_only(tmp_path: Path):
    assert parse_vehicle("extends: quarter_car\nname: mine\n").values()["mG"] == 1000.0
    child(tmp_path, "")
    for name in (tmp_path / "base.yaml", "/etc/hostname", "../base.yaml"):
        with pytest.raises(InputError, match=r"^a\.yaml:1:10: no bundled model"):
            parse_vehicle(f"extends: {name}\n", "a.yaml")


@pytest.mark.parametrize(
    ("text", "place", "message"),
    [
        ("extends: absent.yaml\n", "1:10", "no file {folder}/absent.yaml, and no bundled model 'absent'; known: "),
        ("name: a\nextends:   tractr5\n", "2:12", "no file {folder}/tractr5, and no bundled model 'tractr5'; did you mean 'tractor5'"),
        ("extends: Bases.yaml\n", "1:10", "no file {folder}/Bases.yaml; did you mean 'base.yaml'?"),
        ("extends: [base.yaml]\n", "1:10", "`extends` names a file"),
        ("extends: 5\n", "1:10", "`extends` names a file"),
        ("extends:\n", "1:1", "`extends` names a file"),
        ("extends: .\n", "1:10", "{folder} is a folder; a YAML file was expected"),
        ("extends: " + "a" * 300 + "\n", "1:10", "cannot read {folder}/aaa"),
        ("extends: child.yaml\n", "1:10", "circular `extends`: child.yaml -> child.yaml"),
        ("extends: ./../{name}/child.yaml\n", "1:10", "circular `extends`: child.yaml -> child.yaml"),
        ("extend: base.yaml\n", "1:1", "unknown key 'extend'; did you mean 'extends'?"),
        ("- extends: base.yaml\n", "1:1", "a file of `key: value` lines was expected"),
        ("extends: base.yaml\nbodies: [body]\n", "2:9", "expected `key: value` entries"),
        ("extends: base.yaml\naxles: {rear: {tyre: 5}}\n", "2:22", "expected `key: value` entries"),
    ],
)
def test_what_cannot_be_extended(text: str, place: str, message: str, tmp_path: Path):
    path = child(tmp_path, text.replace("{name}", tmp_path.name))
    with pytest.raises(InputError) as caught:
        load_vehicle(path)
    assert str(caught.value).startswith(f"{path}:{place}: {message.replace('{folder}', str(tmp_path))}")


def test_a_circle_of_three_files_is_named_where_it_closes(tmp_path: Path):
    for own, other in (("a", "b"), ("b", "c"), ("c", "a")):
        (tmp_path / f"{own}.yaml").write_text(f"name: {own}\nextends: {other}.yaml\n")
    with pytest.raises(InputError, match=r"c\.yaml:2:10: circular `extends`: a\.yaml -> b\.yaml -> c\.yaml -> a\.yaml$"):
        load_vehicle(tmp_path / "a.yaml")
    (tmp_path / "d.yaml").write_text("extends: b.yaml\n")
    with pytest.raises(InputError, match=r"a\.yaml:2:10: circular `extends`: b\.yaml -> c\.yaml -> a\.yaml -> b\.yaml$"):
        load_vehicle(tmp_path / "d.yaml")


def test_a_very_long_chain_of_files_is_refused(tmp_path: Path):
    (tmp_path / "f0.yaml").write_text(BASE)
    for i in range(1, 25):
        (tmp_path / f"f{i}.yaml").write_text(f"extends: f{i - 1}.yaml\n")
    assert load_vehicle(tmp_path / "f19.yaml").title == "the base"
    with pytest.raises(InputError, match=r"f1\.yaml:1:10: more than 20 files extend one another"):
        load_vehicle(tmp_path / "f20.yaml")


@pytest.mark.parametrize(
    ("text", "file", "place"),
    [
        ("extends: base.yaml\nparameters: {b1: {value: 9 kg}}\n", "base.yaml", "6:16"),  # where metres and kilograms meet
        ("extends: base.yaml\nparameters: {mB: {value: 3 t}}\n", "base.yaml", "4:30"),  # the base's range excludes the child's value
        ("extends: base.yaml\nparameters: {mB: {range: [1 t, 2 t]}}\n", "child.yaml", "2:26"),
        ("extends: base.yaml\nbodies: {body: {mass: mC}}\n", "child.yaml", "2:23"),
        ("extends: base.yaml\nparameters: {b1: null}\n", "base.yaml", "6:22"),
    ],
)
def test_errors_name_the_file_that_holds_the_text(text: str, file: str, place: str, tmp_path: Path):
    path = child(tmp_path, text)
    with pytest.raises(InputError) as caught:
        load_vehicle(path)
    assert str(caught.value).startswith(f"{tmp_path / file}:{place}: ")
