"""Matrices and names as data: read back by others, they are the model."""

import io
import json

import jsonschema
import numpy as np
import pytest
import scipy.linalg

from tests.bundled import few
from tests.export.vehicles import TEXT, hostile, sedan_with, truck
from vehgen.errors import ArgumentError, InputError
from vehgen.export import EXPORT_FORMATS, export, matrix_schema
from vehgen.mechanics import Place, PointOutput, derive, static_loads
from vehgen.simulate import natural_modes
from vehgen.vehicle import bundled_models, parse_vehicle


def read_json(path):
    return json.loads(path.read_text(encoding="utf-8"))


@pytest.mark.parametrize("name", few(bundled_models()))
def test_every_bundled_vehicle_keeps_its_frequencies_and_loads(name, tmp_path):
    (path,) = export(name, "json", tmp_path / "a.json")
    found = read_json(path)
    jsonschema.validate(found, matrix_schema())
    squares = scipy.linalg.eigh(found["K"], found["M"], eigvals_only=True)
    expected = [mode.undamped_hz for mode in natural_modes(name)]
    assert np.sqrt(squares) / (2 * np.pi) == pytest.approx(expected, rel=1e-9)
    assert found["static"]["axles"] == static_loads(name).axles
    (path,) = export(name, "npz", tmp_path / "a.npz", linear=True)
    with np.load(path) as arrays:  # allow_pickle is off
        assert (arrays["M"] == found["M"]).all()
        assert arrays["static_axle_loads"].tolist() == list(found["static"]["axles"].values())
        assert arrays["coordinate_names"].tolist() == [item["name"] for item in found["coordinates"]]


def test_all_input_matrices_names_units_and_parameters(tmp_path):
    model = derive(truck(), [PointOutput("az", Place("driver", "body"), "acceleration")], [Place("engine", "body")])
    (path,) = export(model, "json", tmp_path / "truck.json", parameter_set="heavy")
    found, numeric = read_json(path), model.numeric(model.values("heavy"))
    for name in ("M", "C", "K", "P", "Q", "F", "weight"):
        assert (np.array(found[name]) == getattr(numeric, name)).all(), name
    assert np.count_nonzero(found["Q"]) == 3  # one damped tyre, and the rope on heave and pitch
    assert [item["name"] for item in found["inputs"]] == ["road.front", "road.rear", "ground.rope"]
    assert [item["name"] for item in found["forces"]] == ["engine"]
    parameters = {item["name"]: item for item in found["parameters"]}
    assert parameters["mB"] == {"name": "mB", "value": 9000.0, "unit": "kg", "meaning": "sprung mass", "equals": None}
    assert (parameters["half"]["value"], parameters["half"]["equals"]) == (4500.0, "mB/2")
    assert found["axle_offsets"] == {"front": 0.0, "rear": pytest.approx(3.8)}
    assert found["output_matrices"]["acceleration"] == numeric.outputs["acceleration"].tolist()


def test_force_laws_are_described_in_json_and_refused_by_name_elsewhere(tmp_path):
    vehicle = sedan_with("dry_friction", "tyre_liftoff")
    (path,) = export(vehicle, "json", tmp_path / "a.json")
    found = read_json(path)
    jsonschema.validate(found, matrix_schema())
    assert [(law["law"], law["kind"], law["element"]) for law in found["force_laws"]] == [
        ("dry_friction", "suspension", "front"), ("tyre_liftoff", "tyre", "front"),
        ("dry_friction", "suspension", "rear"), ("tyre_liftoff", "tyre", "rear"),
    ]  # fmt: skip
    tyre = found["force_laws"][
        1
    ]  # where all is lifted by a metre with the road, it travels by nothing; where the road rises alone, by that
    lifted = [float(item["name"] != "pitch.body") for item in found["coordinates"]]
    assert np.dot(tyre["row"], lifted) + np.sum(tyre["input_row"]) == pytest.approx(0.0, abs=1e-12)
    assert np.abs(tyre["input_row"]).tolist() == [1.0, 0.0]
    friction = found["force_laws"][0]
    assert friction["parameters"] == {"force": 800.0}
    assert friction["static_force"] == pytest.approx(static_loads(vehicle).elements["suspension", "front"])
    with pytest.raises(InputError, match=r"sedan: the force law dry_friction of suspension front \(and 3 more\) cannot be carried by npz"):
        export(vehicle, "npz", tmp_path / "a.npz")
    assert not (tmp_path / "a.npz").exists()
    export(vehicle, "npz", tmp_path / "a.npz", linear=True)


@pytest.mark.parametrize(("text", "gravity"), [("", 9.81), ("gravity: false\n", 0.0)])
def test_gravity_is_that_of_the_vehicle(tmp_path, text, gravity):
    (path,) = export(parse_vehicle(f"extends: sedan2\nname: sedan\n{text}"), "json", tmp_path / "a.json")
    static = read_json(path)["static"]
    assert static["gravity"] == gravity
    assert bool(sum(static["axles"].values())) is bool(gravity)


def test_the_same_vehicle_gives_the_same_bytes(tmp_path):
    for name in ("json", "npz"):
        first, second = (export("sedan2", name, tmp_path / f"{i}.{name}")[0].read_bytes() for i in "ab")
        assert first == second


def test_hostile_names_stay_texts(tmp_path):
    (path,) = export(hostile(), "json", tmp_path / "a.json")
    assert read_json(path)["vehicle"]["name"] == TEXT
    (path,) = export(hostile(), "npz", tmp_path / "a.npz")
    assert np.load(io.BytesIO(path.read_bytes()))["output_names"].tolist() == [TEXT]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"to": "jsn"}, "`to`: unknown format 'jsn'; did you mean 'json'"),
        ({"to": 3}, "`to`: unknown format 3"),
        ({"to": ["c"]}, "`to`: unknown format"),
        ({"to": "json", "out": "a.txt"}, r"`out`: the name of a file of the format json ends in .json; found 'a.txt'"),
        ({"to": "json", "step": 0.0}, "`step`: a time step is 1e-06 s to 0.1 s, found 0.0"),
        ({"to": "json", "values": {"kx": 1.0}}, "no parameter 'kx'"),
        ({"to": "json", "values": {"kf": float("nan")}}, "`values`: kf must be a finite number, found nan"),
        ({"to": "json", "parameter_set": "x"}, "no parameter set 'x'"),
    ],
)
def test_arguments_that_cannot_be_used(arguments, message, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(InputError, match=message):
        export("sedan2", **arguments)
    assert list(tmp_path.iterdir()) == []


def test_a_file_that_cannot_be_written_leaves_nothing(tmp_path):
    (tmp_path / "file").write_text("mine")
    with pytest.raises(InputError, match="is not a folder"):
        export("sedan2", "json", tmp_path / "file" / "a.json")
    assert [path.name for path in tmp_path.iterdir()] == ["file"]


def test_every_format_says_what_it_is():
    assert all(item.meaning for item in EXPORT_FORMATS.values())
    assert issubclass(ArgumentError, InputError)
