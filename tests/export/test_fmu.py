"""Co-simulation units: described as the standard asks, and over a hump the kernel, to rounding."""

import ctypes
import platform
import shutil
import sys
import zipfile
from dataclasses import replace

import numpy as np
import pytest

from tests.bundled import few
from tests.export.c_code import STRICT, assert_alike, compile_c, hump, kernel_run, needs_compiler
from tests.export.fmi import SIZE, VOID, Unit
from tests.export.vehicles import TEXT, hostile, sedan_with, truck
from vehgen.codegen import Excitation
from vehgen.errors import ModelWarning
from vehgen.export import export
from vehgen.mechanics import ElementOutput, Place, PointOutput, derive
from vehgen.simulate import exact_response
from vehgen.simulate.state_space import model_with_channels
from vehgen.vehicle import bundled_models, load_vehicle, parse_vehicle

SEAT = Place("seat", "body", behind="front", distance=0.8)
OUTPUTS = (PointOutput("az", SEAT, "acceleration"), PointOutput("z", SEAT, "displacement"), PointOutput("q", SEAT, "pitch_rate"))
FORMATS = {"fmu": 2, "fmu3": 3}
pytestmark = [
    needs_compiler,
    pytest.mark.skipif(not sys.platform.startswith("linux"), reason="binaries are built on Linux"),
    pytest.mark.parametrize("name", FORMATS),
]


def unit(model, name, folder, **settings):
    (path,) = export(model, name, folder / "unit.fmu", **settings)
    return Unit(path, folder / "unpacked")


def with_slopes(drive):
    """Return an excitation whose rates have the slope of every step as their mean."""
    slopes = np.diff(drive.inputs, axis=0) / drive.dt
    rates = np.zeros_like(drive.inputs)
    for n, slope in enumerate(slopes):
        rates[n + 1] = 2 * slope - rates[n]
    return replace(drive, rates=rates)


def test_a_unit_with_every_kind_of_law_and_input_goes_over_a_hump_as_the_kernel_does(name, tmp_path):
    laws = ", laws: [{dry_friction: {force: 900 N}}, {bump_stop: {k: 900 kN/m, clearance: 8 mm, rebound: 9 mm}}]"
    vehicle = truck().with_changes(parse_laws(laws))
    model = derive(vehicle, OUTPUTS, [Place("engine", "body")])
    drive = with_slopes(hump(model, duration=2.0, height=0.06))
    found = unit(model, name, tmp_path)
    assert found.version == FORMATS[name]
    assert found.initialise() == 0
    assert_alike(found.drive(drive, model)[:, 1:], kernel_run(model, drive)[:, 1:], 1e-9)


def parse_laws(laws):
    """Return a change that gives the truck's front suspension laws and its rear tyre a lift-off."""
    text = f"front: {{suspension: {{k: 300 kN/m{laws}}}}}, rear: {{tyre: {{laws: [{{tyre_liftoff: {{}}}}]}}}}"
    from ruamel.yaml import YAML

    return {"axles": YAML(typ="safe").load(f"{{{text}}}")}


@pytest.mark.thorough
@pytest.mark.parametrize("vehicle", few(name for name in bundled_models() if load_vehicle(name).axles))
def test_every_bundled_vehicle(name, vehicle, tmp_path):
    model = model_with_channels(vehicle)
    drive = with_slopes(hump(model, duration=1.0))
    found = unit(model, name, tmp_path)
    assert found.initialise() == 0
    assert_alike(found.drive(drive, model), kernel_run(model, drive), 1e-9)


def test_communication_steps_of_many_time_steps(name, tmp_path):
    """Held forces, and heights that are linear over ten steps: what the kernel says of such a road."""
    model = derive("sedan2", OUTPUTS)
    drive = hump(model, duration=1.0)
    heights = drive.inputs[::10]
    time = np.arange(len(drive.inputs)) * drive.dt
    linear = np.column_stack([np.interp(time, time[::10], column) for column in heights.T])
    found = unit(model, name, tmp_path)
    assert found.initialise() == 0
    expected = kernel_run(model, replace(drive, inputs=linear))[::10]
    assert_alike(found.drive(drive, model, every=10), expected, 1e-9)
    assert found.step(1.0, 0.00025) == 0  # shorter than the time step
    assert found.step(1.00025, -1.0) == 3


def test_a_jump_reaches_a_damped_tyre_without_a_rate(name, tmp_path):
    """Held heights lose nothing: the impulse Q dw of a jump sets the axle in motion."""
    model = derive(truck(), [PointOutput("v", SEAT, "velocity"), PointOutput("z", SEAT, "displacement")])
    numeric, dt, n_steps = model.numeric(), 1e-4, 3000
    start = np.concatenate([np.zeros(model.n_dof), np.linalg.solve(numeric.M, numeric.Q[:, 0])]) * 0.01
    inputs = np.zeros((n_steps + 1, 3))
    inputs[:, 0] = 0.01
    still = Excitation(dt, inputs, 0 * inputs, np.zeros((n_steps + 1, 0)))
    expected, without = exact_response(model, still, initial=start), exact_response(model, still)
    found = unit(model, name, tmp_path, step=dt)
    assert found.initialise() == 0
    assert found.set(["road.front"], [0.01]) == 0
    assert found.step(0.0, n_steps * dt) == 0
    final = found.get(["v", "z"])
    assert final == pytest.approx(expected[-1], rel=2e-3)
    assert abs(without[-1] - expected[-1]).max() > 5 * abs(final - expected[-1]).max()


def test_parameters_are_set_before_and_not_after_the_start(name, tmp_path):
    model = derive(truck(), OUTPUTS, [Place("engine", "body")])
    drive = with_slopes(hump(model, duration=0.5))
    found = unit(model, name, tmp_path)
    assert found.initialise(mB=7e3) == 0
    own = model.values(overrides={"mB": 7e3})
    assert_alike(found.drive(drive, model)[:, 1:], kernel_run(model, drive, own)[:, 1:], 1e-9)
    assert found.set(["mB"], [8e3]) == 3
    assert found.set(["az"], [1.0]) == 3
    assert found.call("Reset") == 0
    assert found.get(["mB", "road.front", "az"]).tolist() == [6e3, 0.0, 0.0]
    assert found.initialise(mB=np.nan) == 3
    assert b"a parameter is not finite, or the masses are none" in found.messages


def test_a_static_equilibrium_that_was_solved_fixes_its_parameters(name, tmp_path):
    text = "extends: sedan2\naxles: {rear: {suspension: {laws: [{cubic_stiffness: {k3: 2.0e6 N/m^3, from: unloaded}}]}}}\n"
    model = derive(parse_vehicle(text), (*OUTPUTS, ElementOutput("load", "rear", "tyre_load")))
    found = unit(model, name, tmp_path)
    assert set(found.names("local")) == set(model.vehicle.free_parameters)
    assert found.names("parameter") == ["seat.shift"]
    assert found.initialise(**{"seat.shift": 0.1}) == 0
    assert found.get(["load"])[0] > 1000.0  # at rest it carries its static load
    assert found.initialise(kf=1e5) == 3


def test_states_can_be_kept_and_put_back(name, tmp_path):
    model = derive("sedan2", OUTPUTS)
    found = unit(model, name, tmp_path)
    assert found.initialise() == 0
    assert found.set(["road.front"], [0.02]) == 0
    kept, state = VOID(), "FMUstate" if found.version == 2 else "FMUState"
    assert found.step(0.0, 0.1) == 0
    assert found.call(f"Get{state}", ctypes.byref(kept)) == 0
    assert found.step(0.1, 0.1) == 0
    first = found.get(["az", "z"])
    assert found.call(f"Set{state}", kept) == 0
    assert found.step(0.1, 0.1) == 0
    assert (found.get(["az", "z"]) == first).all()
    assert found.call(f"Free{state}", ctypes.byref(kept)) == 0
    assert not found.instantiate(token="{00000000-0000-0000-0000-000000000000}")


@pytest.mark.thorough
def test_units_starts_and_sources_are_described(name, tmp_path):
    model = derive(truck(), OUTPUTS, [Place("engine", "body")])
    found = unit(model, name, tmp_path, parameter_set="heavy")
    assert found.names("input") == [
        "road.front", "road.rear", "ground.rope", "road.front.rate", "road.rear.rate", "ground.rope.rate", "force.engine",
    ]  # fmt: skip
    assert found.names("output") == ["az", "z", "q"]
    mass = found.variables["mB"]
    numbers = mass.find("Real") if found.version == 2 else mass
    assert (numbers.get("start"), numbers.get("unit"), mass.get("description")) == ("9000.0", "kg", "sprung mass")
    units = {item.get("name"): item.find("BaseUnit").attrib for item in found.root.find("UnitDefinitions")}
    assert units["m/s^2"] == {"m": "1", "s": "-2"}
    assert units["rad/s"] == {"rad": "1", "s": "-1"}
    sources = sorted(path.name for path in (found.folder / "sources").glob("*.c"))
    assert sources == [*{2: ["fmi2.c"], 3: ["fmi3.c", "fmi3_refused.c"]}[found.version], "instance.c", "model.c"]
    compile_c(sorted((found.folder / "sources").glob("*.c")), tmp_path / "own.so", "-shared", "-fPIC", "-fsanitize=address,undefined")
    assert "-Werror" in STRICT
    assert found.initialise() == 0
    if found.version == 3:
        assert found.references["time"] == max(found.references.values())
        assert found.step(0.0, 0.25) == 0
        assert found.get(["az", "time", "z"])[1] == 0.25
    assert found.call("GetBoolean", VOID(), SIZE(0), VOID(), SIZE(0)) == 0


def test_hostile_names_stay_texts(name, tmp_path):
    found = unit(hostile(), name, tmp_path)
    assert found.initialise() == 0
    assert [text.startswith("*/ int x;") and "</fmiModelDescription>" in text for text in found.names("output")] == [True]
    assert "\n" not in found.names("output")[0]
    assert TEXT.split("\n")[0] in found.root.get("modelName")
    assert not (tmp_path / "PWNED").exists()


def test_the_same_vehicle_gives_the_same_bytes(name, tmp_path):
    first, second = (export("sedan2", name, tmp_path / folder / "a.fmu")[0].read_bytes() for folder in "ab")
    assert first == second


def test_without_a_compiler_there_are_sources_alone(name, tmp_path, monkeypatch):
    monkeypatch.setattr(shutil, "which", lambda _: None)
    with pytest.warns(ModelWarning, match="the unit holds its sources, but no binary: no C compiler is installed"):
        (path,) = export("sedan2", name, tmp_path / "a.fmu")
    assert not [item for item in zipfile.ZipFile(path).namelist() if item.startswith("binaries")]
    broken = tmp_path / "broken"
    broken.write_text("#!/bin/sh\necho no licence >&2\nexit 1\n")
    broken.chmod(0o755)
    monkeypatch.setattr(shutil, "which", lambda _: str(broken))
    with pytest.warns(ModelWarning, match=r"no binary: .*broken could not build it \(no licence\)"):
        export("sedan2", name, tmp_path / "b.fmu")
    monkeypatch.setattr(platform, "system", lambda: "Darwin")
    with pytest.warns(ModelWarning, match="binaries are built on Linux alone"):
        export("sedan2", name, tmp_path / "c.fmu")


@pytest.mark.thorough
def test_fmpy_accepts_and_simulates_it(name, tmp_path):
    fmpy = pytest.importorskip("fmpy")
    from fmpy.validation import validate_fmu

    model = derive(sedan_with("dry_friction", "tyre_liftoff"), OUTPUTS)
    drive = hump(model, duration=1.0, height=0.06)
    (path,) = export(model, name, tmp_path / "sedan.fmu")
    assert validate_fmu(str(path)) == []
    slopes = np.vstack([np.diff(drive.inputs, axis=0) / drive.dt, np.zeros((1, 2))])
    columns = ["time", *model.inputs, *(f"{item}.rate" for item in model.inputs)]
    signals = np.rec.fromarrays([drive.time, *drive.inputs.T, *slopes.T], names=columns)
    found = fmpy.simulate_fmu(str(path), stop_time=1.0, step_size=1e-3, output_interval=1e-3, input=signals, output=["az", "z", "q"])
    expected = kernel_run(model, drive)
    assert len(found) == len(expected)
    assert_alike(np.column_stack([found[key] for key in ("az", "z", "q")]), expected, 1e-9)
