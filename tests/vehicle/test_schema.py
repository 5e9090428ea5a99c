"""What editors are told: the JSON Schemas know every key of the docs, describe it, and refuse misspelt ones at every level."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import jsonschema
import pytest

from vehgen.files.document import read_document, read_text
from vehgen.simulate.run_file.schema import run_schema
from vehgen.vehicle import bundled_models, load_vehicle
from vehgen.vehicle.schema import vehicle_schema

DOCS = Path(__file__).parents[2] / "docs"
VEHICLE = jsonschema.Draft202012Validator(vehicle_schema())
RUN = jsonschema.Draft202012Validator(run_schema())


def examples(name: str) -> list[str]:
    """Return the YAML examples of a page."""
    return re.findall(r"```yaml\n(.*?)```", (DOCS / name).read_text(encoding="utf-8"), re.DOTALL)


def test_the_docs_examples_pass():
    (vehicle,) = examples("vehicle-file.md")
    (run,) = examples("run-file.md")
    assert VEHICLE.is_valid(read_text(vehicle, "docs").plain())
    assert RUN.is_valid(read_text(run, "docs").plain())


@pytest.mark.parametrize("name", sorted(bundled_models()))
def test_bundled_models_pass(name: str):
    assert VEHICLE.is_valid(read_document(bundled_models()[name]).plain())


@pytest.mark.parametrize("schema", [vehicle_schema(), run_schema()], ids=["vehicle", "run"])
def test_the_schemas_are_valid_themselves(schema: dict[str, Any]):
    dialect = jsonschema.Draft202012Validator(jsonschema.Draft202012Validator.META_SCHEMA)
    assert list(dialect.iter_errors(schema)) == []


def test_the_dialect_is_named():
    assert vehicle_schema()["$schema"] == "https://json-schema.org/draft/2020-12/schema"
    assert vehicle_schema() == vehicle_schema()
    assert vehicle_schema() is not vehicle_schema()


def objects(data: Any, path: tuple[str | int, ...] = ()) -> Iterator[tuple[tuple[str | int, ...], dict[str, Any]]]:
    if isinstance(data, dict):
        yield path, data
        for key, item in data.items():
            yield from objects(item, (*path, key))
    elif isinstance(data, list):
        for index, item in enumerate(data):
            yield from objects(item, (*path, index))


COLLECTIONS = ("parameters", "bodies", "hinges", "axles", "links", "sets", "forces", "displacements", "sensors", "outputs", "channels")


def takes_any_name(path: tuple[str | int, ...]) -> bool:
    """Whether a mapping's keys are names that the file chooses."""
    return bool(path) and (path[-1] in COLLECTIONS or path[:1] == ("sets",))


@pytest.mark.parametrize("name", ["tractor5_module", "tractor5_cab", "tractor5_cargo", "b_double"])
def test_an_unknown_key_is_refused_wherever_it_stands(name: str):
    data = read_document(bundled_models()[name]).plain()
    count = 0
    for path, item in list(objects(data)):
        if not takes_any_name(path):
            item["massss"] = "1 kg"
            assert not VEHICLE.is_valid(data), path
            del item["massss"]
            count += 1
    assert count > 8
    assert VEHICLE.is_valid(data)


def test_an_unknown_key_of_a_run_is_refused_wherever_it_stands():
    data = read_text(examples("run-file.md")[0], "docs").plain()
    count = 0
    for path, item in list(objects(data)):
        if not takes_any_name(path):
            item["massss"] = "1 kg"
            assert not RUN.is_valid(data), path
            del item["massss"]
            count += 1
    assert count > 12
    assert RUN.is_valid(data)


@pytest.mark.parametrize(
    ("path", "value"),
    [
        (("bodies", "tractor", "motions"), ["hop"]),
        (("bodies", "tractor", "motions"), "heave"),
        (("bodies", "tractor", "mass"), [1]),
        (("bodies", "tractor", "mass"), True),
        (("bodies", "tractor"), None),
        (("bodies",), ["tractor"]),
        (("parameters", "mT", "range"), ["1 kg"]),
        (("parameters", "mT", "range"), ["1 kg", "2 kg", "3 kg"]),
        (("parameters", "mT", "value"), {"kg": 8000}),
        (("axles", "axle1", "tyre"), "1 MN/m"),
        (("hinges", "fifth_wheel", "tractor"), 3),
        (("sets", "light"), {"mT": []}),
        (("name",), 5),
        (("extends",), ["tractor5"]),
        (("wheels",), {}),
    ],
)
def test_wrong_kinds_are_refused(path: tuple[str, ...], value: Any):
    data = read_document(bundled_models()["tractor5"]).plain()
    assert VEHICLE.is_valid(data)
    holder = data
    for key in path[:-1]:
        holder = holder[key]
    holder[path[-1]] = value
    assert not VEHICLE.is_valid(data)


def test_a_file_that_extends_another_may_leave_anything_out():
    assert VEHICLE.is_valid({"extends": "tractor5"})
    assert VEHICLE.is_valid({"extends": "tractor5", "bodies": {"cab": {"title": "cab"}}, "axles": {"axle1": {"x": "b1 - 1 m"}}})
    assert VEHICLE.is_valid({"extends": "tractor5", "hinges": {"fifth_wheel": {"tractor": {"x": "1 m"}}}})


def test_every_key_of_the_docs_tables_is_in_the_schema():
    page = (DOCS / "vehicle-file.md").read_text(encoding="utf-8")
    schema = vehicle_schema()
    for heading, definition in (("Parameters", "Parameter"), ("Bodies", "Body"), ("Axles", "Axle")):
        section = page.partition(f"## {heading}\n")[2].partition("\n## ")[0]
        keys = set(re.findall(r"^\| `(\w+)` \|", section, re.MULTILINE))
        assert keys == set(schema["$defs"][definition]["properties"]), heading
    assert {"extends", "name", "title", "source", "parameters", "bodies", "hinges", "axles", "links", "sets"} <= set(schema["properties"])


def test_what_a_file_says_of_itself_is_not_inherited(tmp_path):
    (tmp_path / "a.yaml").write_text("extends: quarter_car\nsource: mine\n")
    (tmp_path / "b.yaml").write_text("extends: a.yaml\ndescription: own\n")
    assert load_vehicle("quarter_car").description
    assert load_vehicle(tmp_path / "a.yaml").source == "mine"
    assert load_vehicle(tmp_path / "a.yaml").description == ""
    assert load_vehicle(tmp_path / "b.yaml").source == ""
    assert load_vehicle(tmp_path / "b.yaml").description == "own"
