"""Equations that are kept: the same numbers bit for bit, and nothing that another version or user wrote."""

import os
from dataclasses import fields
from importlib import import_module

import numpy as np
import pytest

from tests.commands.calls import python
from vehgen.codegen import kernel_store
from vehgen.mechanics import derivation, derive
from vehgen.mechanics.plain_equations import PlainEquations
from vehgen.simulate import natural_modes
from vehgen.simulate import remembered_equations as remembered
from vehgen.vehicle import bundled_models, load_vehicle


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.setenv("VEHGEN_CACHE", str(tmp_path / "cache"))
    monkeypatch.setattr(kernel_store, "_private", {})
    monkeypatch.setattr(kernel_store, "_writable", {})
    return tmp_path / "cache"


@pytest.fixture
def derived(folder, monkeypatch):
    """Return the names of vehicles as they are derived."""
    names = []
    import_module("vehgen.mechanics.derivation")  # keeps the function itself
    monkeypatch.setattr(derivation, "derive", lambda vehicle: names.append(vehicle.name) or derive(vehicle))
    return names


@pytest.mark.parametrize("name", sorted(bundled_models()))
def test_the_matrices_are_the_same_bit_for_bit(name):
    vehicle = load_vehicle(name)
    model = derive(vehicle)
    plain = PlainEquations.from_text(PlainEquations.of(model).to_text())
    assert plain == PlainEquations.from_text(plain.to_text())
    assert [item.name for item in plain.coordinates] == [item.name for item in model.coordinates]
    random = np.random.default_rng(3)
    for values in (model.values(), {key: value * random.uniform(0.8, 1.2) for key, value in model.values().items()}):
        found, expected = plain.numeric(values), model.numeric(values)
        for field in fields(expected):
            if field.name != "outputs":
                np.testing.assert_array_equal(getattr(found, field.name), getattr(expected, field.name))
        assert {key: item.shape for key, item in found.outputs.items()} == {key: item.shape for key, item in expected.outputs.items()}


def test_a_vehicle_is_derived_once_and_again_when_it_changes(derived):
    sedan = load_vehicle("sedan2")
    first = natural_modes(sedan)
    assert natural_modes(sedan) == first == natural_modes(derive(sedan))
    assert natural_modes(sedan, {"kf": 2e5}) == natural_modes(derive(sedan), {"kf": 2e5})
    assert derived == ["sedan2"]
    natural_modes(sedan.with_changes({"links": {"strut": {"ground": {}, "body": {"x": "1 m"}, "k": "1 kN/m", "c": "0 N s/m"}}}))
    assert derived == ["sedan2", "sedan2"]


def test_other_code_and_other_versions_derive_anew(derived, monkeypatch):
    sedan = load_vehicle("sedan2")
    natural_modes(sedan)
    monkeypatch.setattr(remembered, "_code", lambda: "other code")
    natural_modes(sedan)
    monkeypatch.setattr(remembered.metadata, "version", lambda name: "0.0")
    natural_modes(sedan)
    monkeypatch.setattr(remembered.sys, "version", "another Python")
    natural_modes(sedan)
    assert derived == 4 * ["sedan2"]


def test_code_is_known_by_what_it_says_not_by_its_size_or_time(tmp_path):
    file = tmp_path / "mechanics" / "laws" / "spring.py"
    file.parent.mkdir(parents=True)
    file.write_text("SIGN = +1\n")
    times = (file.stat().st_atime_ns, file.stat().st_mtime_ns)
    first = remembered.code_hash(tmp_path)
    file.write_text("SIGN = -1\n")
    os.utime(file, ns=times)
    second = remembered.code_hash(tmp_path)
    assert second != first
    os.utime(file, ns=(0, 0))
    assert remembered.code_hash(tmp_path) == second
    file.rename(file.with_name("damper.py"))
    assert remembered.code_hash(tmp_path) != second


@pytest.mark.skipif(os.name == "nt", reason="permissions are those of POSIX")
@pytest.mark.parametrize("open_to_others", ["folder", "file"])
def test_what_others_can_write_is_not_read(folder, derived, open_to_others):
    sedan = load_vehicle("sedan2")
    natural_modes(sedan)
    (file,) = folder.glob("model_*")
    (folder if open_to_others == "folder" else file).chmod(0o777)
    natural_modes(sedan)
    assert derived == 2 * ["sedan2"]


def test_a_damaged_file_is_derived_anew_and_replaced(folder, derived):
    sedan = load_vehicle("sedan2")
    natural_modes(sedan)
    (file,) = folder.glob("model_*")
    data = file.read_bytes()
    file.write_bytes(data[:-40] + b"x" * 40)
    natural_modes(sedan)
    assert derived == 2 * ["sedan2"]
    assert file.read_bytes() == data


def test_a_cache_that_cannot_be_made_costs_no_result_and_no_word(tmp_path, monkeypatch):
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("VEHGEN_CACHE", str(tmp_path / "file" / "cache"))
    assert natural_modes(load_vehicle("sedan2")) == natural_modes(derive(load_vehicle("sedan2")))


def test_other_functions_are_left_to_sympy(folder):
    vehicle = load_vehicle("quarter_car")
    (axle,) = vehicle.axles
    vehicle = vehicle.with_changes({"axles": {axle: {"suspension": {"k": f"max({vehicle.axles[axle].suspension.k}, 1 N/m)"}}}})
    assert PlainEquations.of(derive(vehicle)) is None
    assert natural_modes(vehicle) == natural_modes(derive(vehicle))


def test_modes_load_neither_sympy_nor_numba_nor_scipy(folder):
    code = (
        "import sys; from vehgen.commands import main; main(['modes', 'tractor5', '--json'])\n"
        "print(sorted({'sympy', 'numba', 'scipy', 'matplotlib'} & set(sys.modules)), file=sys.stderr)"
    )
    first, second = python("-c", code, VEHGEN_CACHE=str(folder)), python("-c", code, VEHGEN_CACHE=str(folder))
    assert first.stdout == second.stdout
    assert second.stderr == "[]\n"


@pytest.mark.thorough
def test_a_build_without_plots_loads_neither_numba_nor_matplotlib(folder, tmp_path):
    code = (
        "import sys; from vehgen.commands import main; main(['build', 'quarter_car', '--no-plots', '--out', 'out', '--json'])\n"
        "print(sorted({'numba', 'scipy', 'matplotlib'} & set(sys.modules)), file=sys.stderr)"
    )
    first, second = (python("-c", code, folder=tmp_path, VEHGEN_CACHE=str(folder)) for _ in range(2))
    assert first.stdout == second.stdout
    assert second.stderr == "[]\n"


@pytest.mark.thorough
def test_a_simulation_over_a_hump_loads_of_scipy_only_what_numba_does(folder, tmp_path):
    (tmp_path / "run.yaml").write_text("vehicle: quarter_car\nspeed: 2 m/s\nduration: 1 s\n")
    unused = {"matplotlib", "scipy.fft", "scipy.interpolate", "scipy.optimize", "scipy.signal", "scipy.stats"}
    code = (
        "import sys; from vehgen.commands import main; main(['simulate', 'run.yaml', '--json', '--force'])\n"
        f"print(sorted({unused} & set(sys.modules)), file=sys.stderr)"
    )
    assert python("-c", code, folder=tmp_path, VEHGEN_CACHE=str(folder)).stderr == "[]\n"
