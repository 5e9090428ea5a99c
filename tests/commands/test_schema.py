"""What editors are told of every file: its keys, what may stand there, and nothing of the inside of the program."""

from __future__ import annotations

import json

import jsonschema
import pytest

from tests.docs.pages import ROOT
from vehgen.commands import main
from vehgen.commands.schema import SCHEMAS
from vehgen.files.document import read_document, read_text
from vehgen.mechanics.laws import LAWS
from vehgen.vehicle import bundled_models

EXAMPLES = ROOT / "docs" / "examples"
FILES = {
    "run": ["two_humps.yaml", "road_b.yaml", "hidden/low_2ms.yaml", "hidden/rough.yaml", "rigs/shaker_run.yaml", "rigs/drop_test_run.yaml"],
    "cargo": ["cargo/pallets.yaml", "cargo/building_module.yaml"],
    "frame": ["cargo/steel_module.yaml"],
    "facts": ["phones/facts.yaml"],
    "effects": ["silverbox/two_springs.yaml"],
}
LAW = "extends: tractor5\naxles: {axle1: {suspension: {laws: [%s]}}}"
OUTPUT = "{vehicle: tractor5, speed: 2 m/s, outputs: {load: {axle: axle1, quantity: %s}}}"
SENSOR = "{vehicle: tractor5, speed: 2 m/s, sensors: {L1: {body: tractor, channels: {%s}}}}"


def checker(kind):
    return jsonschema.Draft202012Validator(SCHEMAS[kind][1]())


def defaults(node):
    if isinstance(node, dict):
        if "type" in node or "anyOf" in node or "$ref" in node:
            yield from [node["default"]] if "default" in node else []
        node = list(node.values())
    if isinstance(node, list):
        for item in node:
            yield from defaults(item)


@pytest.mark.parametrize("kind", SCHEMAS)
def test_the_command_prints_it_and_it_is_valid_itself(kind, capsys):
    assert main(["schema", f"--{kind}"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found == json.loads(json.dumps(SCHEMAS[kind][1]()))
    jsonschema.Draft202012Validator.check_schema(found)


@pytest.mark.parametrize(("kind", "name"), [(kind, name) for kind, names in FILES.items() for name in names])
def test_the_examples_pass_and_a_key_more_does_not(kind, name):
    data = read_document(EXAMPLES / name).plain()
    assert list(checker(kind).iter_errors(data)) == []
    assert not checker(kind).is_valid(data | {"massss": "1 kg"})


@pytest.mark.parametrize("name", sorted(bundled_models()))
def test_the_laws_of_the_bundled_vehicles_pass(name):
    assert list(checker("vehicle").iter_errors(read_document(bundled_models()[name]).plain())) == []


@pytest.mark.parametrize("kind", sorted(SCHEMAS.keys() - {"export"}))
def test_defaults_are_what_a_file_would_say(kind):
    found = list(defaults(SCHEMAS[kind][1]()))
    assert None not in found
    assert "" not in found
    assert all(isinstance(item, str | int | float | list) or item in ({},) for item in found)


def test_vehicles_positions_are_zero_by_default():
    assert SCHEMAS["vehicle"][1]()["$defs"]["Axle"]["properties"]["x"]["default"] == "0"


@pytest.mark.parametrize(
    ("kind", "right", "wrong"),
    [
        ("vehicle", LAW % "{cubic_stiffness: {k3: 5 GN/m^3}}", LAW % "{cubic_stifness: {k3: 5 GN/m^3}}"),
        ("vehicle", LAW % "{cubic_stiffness: {k3: 5 GN/m^3, from: unloaded}}", LAW % "{cubic_stiffness: {k3: 5 GN/m^3, from: loaded}}"),
        ("vehicle", LAW % "{law: {force: 'a*d', parameters: {a: 1 N/m}}}", LAW % "{law: {parameters: {a: 1 N/m}}}"),
        ("run", OUTPUT % "tyre_load", OUTPUT % "tyre_lode"),
        ("run", SENSOR % "acceleration: az", SENSOR % "acelleration: az"),
        ("run", SENSOR % "acceleration: {column: az, acquisition: bosch_bmi160}", SENSOR % "acceleration: {column: az, acquisition: bmi}"),
        ("cargo", "{on: semitrailer, behind: fifth_wheel, rigid: {mass: 8 t, length: 12 m, height: 2 m, front: 1 m}}", "{on: semitrailer}"),
    ],
)
def test_what_is_enumerated(kind, right, wrong):
    assert list(checker(kind).iter_errors(read_text(right, "right").plain())) == []
    assert not checker(kind).is_valid(read_text(wrong, "wrong").plain())


def test_every_law_of_the_library_can_be_completed():
    laws = SCHEMAS["vehicle"][1]()["$defs"]["Law"]["properties"]
    assert laws.keys() == {*LAWS, "law"}
    for name, law in LAWS.items():
        assert laws[name]["properties"].keys() == {*(parameter.name for parameter in law.parameters), "from"}
