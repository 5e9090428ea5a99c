"""The public names: imported when first used, given objects or paths, with arguments named where they cannot be used."""

import importlib
import pickle

import pytest
from matplotlib.figure import Figure

import vehgen
from tests.fit.recordings import sedan_truth, write_run
from vehgen.errors import ArgumentError


@pytest.fixture(scope="module")
def hump(tmp_path_factory):
    return write_run(tmp_path_factory.mktemp("run"), "hump", sedan_truth())


@pytest.mark.parametrize("name", vehgen.__all__)
def test_each_name_can_be_imported_and_has_help(name):
    space = {}
    exec(f"from vehgen import {name}", space)
    item = space[name]
    assert item.__doc__
    assert item is getattr(vehgen, name)
    assert item.__module__.startswith("vehgen.")
    if not isinstance(item, type):
        assert pickle.loads(pickle.dumps(item)) is item


def test_rooms_keep_their_names_as_modules():
    for name in ("simulate", "calibrate", "diagnose", "effects", "report"):
        room = importlib.import_module(f"vehgen.{name}")
        assert getattr(room, name) is getattr(vehgen, name)


@pytest.mark.parametrize("form", [str, lambda text: vehgen.load_vehicle(text), lambda text: vehgen.bundled_models()[text]])
def test_a_vehicle_is_an_object_a_path_or_a_name(form, hump):
    sedan = form("sedan2")
    model = vehgen.derive(sedan)
    assert model.n_dof == 4
    assert vehgen.natural_modes(sedan) == vehgen.natural_modes(model)
    assert vehgen.static_loads(sedan) == vehgen.static_loads(model)
    assert vehgen.state_space(sedan) == vehgen.state_space(model)
    assert vehgen.frequency_response(sedan, [1.0]) == vehgen.frequency_response(model, [1.0])
    assert isinstance(vehgen.draw_vehicle(sedan), Figure)
    assert vehgen.validate(sedan, [hump]).vehicle == "sedan2"


def test_a_run_is_an_object_or_a_path(hump):
    run = vehgen.load_run(hump)
    for name in ("simulate", "sensitivity"):
        function = getattr(vehgen, name)
        assert function(run) == function(hump) == function(str(hump), vehicle="sedan2")
    assert vehgen.advise_sensors(run, 1, parameters=["kf"]) == vehgen.advise_sensors(hump, 1, parameters=["kf"])
    assert vehgen.validate("sedan2", run) == vehgen.validate("sedan2", [str(hump)])


def test_values_and_sets_by_name():
    stiff = vehgen.natural_modes("sedan2", {"kf": 2e5})
    assert stiff != vehgen.natural_modes("sedan2")
    model = vehgen.derive("tractor5")
    by_set = vehgen.static_loads(model, parameter_set="SHCM-1")
    assert by_set == vehgen.static_loads(model, model.values("SHCM-1"))
    assert by_set != vehgen.static_loads(model)


FRICTION = {"axles": {"front": {"suspension": {"laws": [{"dry_friction": {"force": "1 kN"}}]}}}}
CALLS = {
    "vehicle": lambda hump: vehgen.derive(3),
    "run": lambda hump: vehgen.simulate(3),
    "runs": lambda hump: vehgen.calibrate("sedan2", []),
    "size": lambda hump: vehgen.calibrate("sedan2", hump, size=1),
    "seed": lambda hump: vehgen.calibrate("sedan2", hump, seed=-1),
    "search": lambda hump: vehgen.calibrate("sedan2", hump, search="mga"),
    "method": lambda hump: vehgen.calibrate("sedan2", hump, method="jiont", size=4, generations=0),
    "sensors": lambda hump: vehgen.calibrate("sedan2", hump, sensors="F"),
    "band": lambda hump: vehgen.calibrate("sedan2", hump, band=(40.0, 0.3)),
    "speed_error": lambda hump: vehgen.calibrate("sedan2", hump, speed_error=-1.0),
    "bands": lambda hump: vehgen.validate("sedan2", hump, bands=[(8.0, 5.0)]),
    "reference": lambda hump: vehgen.validate("sedan2", hump, reference="level 9"),
    "parameters": lambda hump: vehgen.sensitivity(hump, ["kx"]),
    "count": lambda hump: vehgen.advise_sensors(hump, 0),
    "effects": lambda hump: vehgen.diagnose("sedan2", hump, effects=["dry_frictoin"]),
    "frequency": lambda hump: vehgen.frequency_response("sedan2", ["a"]),
    "hump": lambda hump: vehgen.import_phones([hump], vehicle="sedan2", sensors=[], hump={"shape": "half_sin"}),
    "out": lambda hump: vehgen.import_phones(
        [hump], vehicle="sedan2", sensors=[], hump={"shape": "half_sine", "length": 0.5, "height": 0.03}, out="x.txt"
    ),
    "speed": lambda hump: vehgen.import_phones([hump], vehicle="sedan2", sensors=[], hump={}, speed=-1.0),
    "to": lambda hump: vehgen.export("sedan2", "jsn"),
    "step": lambda hump: vehgen.export("sedan2", "c", step=0.0),
    "linear": lambda hump: vehgen.export(vehgen.load_vehicle("sedan2").with_changes(FRICTION), "npz"),
    "result": lambda hump: vehgen.report(vehgen.natural_modes("sedan2"), "pages"),
}


@pytest.mark.parametrize("argument", CALLS)
def test_an_argument_that_cannot_be_used_is_named(argument, hump):
    with pytest.raises(vehgen.InputError) as caught:
        CALLS[argument](hump)
    assert isinstance(caught.value, ArgumentError)
    assert argument in caught.value.names
    assert "--" not in str(caught.value)
