"""C against the kernel that it is printed beside: the same numbers, for every law; no warning, no undefined behaviour, no foreign text."""

import ctypes
import os
import re
import subprocess
from pathlib import Path

import numpy as np
import pytest

import vehgen
from tests.bundled import few
from tests.commands.calls import python
from tests.export.c_code import COMPILERS, Library, assert_alike, compile_c, hump, kernel_run, needs_compiler
from tests.export.vehicles import LAWS, TEXT, hostile, sedan_with, truck
from vehgen.export import export
from vehgen.mechanics import ElementOutput, Place, PointOutput, derive, static_loads
from vehgen.mechanics.laws import LAWS as LIBRARY
from vehgen.simulate.state_space import model_with_channels
from vehgen.vehicle import bundled_models, parse_vehicle

SEAT = Place("seat", "body", behind="front", distance=0.8)
OUTPUTS = (
    PointOutput("az", SEAT, "acceleration"),
    PointOutput("z", SEAT, "displacement"),
    ElementOutput("front_force", "front", "suspension_force"),
    ElementOutput("rear_tyre", "rear", "tyre_force"),
)
pytestmark = needs_compiler


def exported(model, folder, *options, **settings):
    header, *_ = export(model, "c", folder, **settings)
    return Library(header, None, *options)


@pytest.mark.parametrize("name", few(bundled_models()))
def test_every_bundled_vehicle_gives_the_kernels_numbers(name, tmp_path):
    model = model_with_channels(name)
    drive = hump(model, duration=1.0 + (model.wheel_offsets().max(initial=0.0) + 0.6) / 3.0)  # until the last axle is over it
    tolerance = 3e-12 if name == "road_train" else 1e-12  # twelve seconds of rounding: contracted products in one, none in the other
    assert_alike(exported(model, tmp_path).run(drive), kernel_run(model, drive), tolerance)


@pytest.mark.thorough
def test_it_is_the_kernels_arithmetic_bit_by_bit(tmp_path):
    """Compiled kernels may contract a product and a sum; told not to compile, they do as C of the strict standard does."""
    model = derive(sedan_with("dry_friction", "hysteresis", "tyre_liftoff"), OUTPUTS)
    drive = hump(model, duration=0.3, height=0.08)
    found = exported(model, tmp_path, "-ffp-contract=off").run(drive)
    code = (
        "import numpy as np\nfrom tests.export.c_code import hump, kernel_run\n"
        "from tests.export.test_c import OUTPUTS, derive, sedan_with\n"
        "model = derive(sedan_with('dry_friction', 'hysteresis', 'tyre_liftoff'), OUTPUTS)\n"
        "np.save('plain.npy', kernel_run(model, hump(model, duration=0.3, height=0.08)))"
    )
    paths = os.pathsep.join([str(Path(vehgen.__file__).parents[1]), str(Path(__file__).parents[2])])
    done = python("-c", code, folder=tmp_path, NUMBA_DISABLE_JIT="1", PYTHONPATH=paths, VEHGEN_CACHE=str(tmp_path / "cache"))
    assert done.returncode == 0, done.stderr
    assert (np.load(tmp_path / "plain.npy") == found).all()


def test_every_law_is_tried():
    assert LAWS.keys() == {*LIBRARY, "law"}


@pytest.mark.parametrize("law", LAWS)
def test_every_force_law_gives_the_kernels_numbers(law, tmp_path):
    model = derive(sedan_with(law), OUTPUTS, [Place("engine", "body")])
    drive = hump(model, height=0.06)
    found = exported(model, tmp_path).run(drive)
    assert_alike(found, kernel_run(model, drive))
    linear = kernel_run(derive("sedan2", OUTPUTS, [Place("engine", "body")]), drive)
    assert np.abs(found - linear).max() > 1e-3 * np.abs(linear).max()  # the law did something


def test_friction_sticks_stops_are_met_and_wheels_lift(tmp_path):
    """Together, with both origins of travel and a damped tyre, for long enough to come to rest."""
    text = (
        "extends: sedan2\naxles:\n"
        "  front: {suspension: {laws: [{dry_friction: {force: 900 N}}, {bump_stop: {k: 900 kN/m, clearance: 8 mm, rebound: 9 mm}}]},\n"
        "    tyre: {c: 400 N s/m, laws: [{tyre_liftoff: {}}]}}\n"
        "  rear: {suspension: {laws: [{cubic_stiffness: {k3: 2.0e6 N/m^3, from: unloaded}}]}, tyre: {laws: [{tyre_liftoff: {}}]}}\n"
    )
    model = derive(parse_vehicle(text), (*OUTPUTS, ElementOutput("load", "front", "tyre_load")))
    drive = hump(model, duration=4.0, height=0.07)
    library = exported(model, tmp_path)
    found, expected = library.run(drive), kernel_run(model, drive)
    static = static_loads(model).axles["front"]
    assert_alike(found[:, :4], expected[:, :4])
    assert found[:, 4] == pytest.approx(expected[:, 4] + static, rel=1e-12, abs=1e-12 * static)
    assert found[:, 4].min() == pytest.approx(0.0, abs=1e-6 * static)  # in the air
    assert np.ptp(found[-200:, 2] - found[-1, 2]) < 900.0
    assert library.call("check") == 0
    changed = np.array(list(model.values().values()))
    changed[0] *= 1.01
    assert library.setup(changed, 1e-3) == 3  # static equilibrium belongs to the exported parameters


def test_the_whole_load_of_a_hinge_has_its_static_part(tmp_path):
    model = derive("tractor5", [ElementOutput("load", "fifth_wheel", "hinge_load"), ElementOutput("force", "fifth_wheel", "hinge_force")])
    drive = hump(model, duration=1.0)
    found, expected = exported(model, tmp_path).run(drive), kernel_run(model, drive)
    static = static_loads(model).hinges["fifth_wheel"]
    assert static > 1e4
    assert found[:, 1] == pytest.approx(expected[:, 1], rel=1e-12, abs=1e-12 * static)
    assert found[:, 0] == pytest.approx(found[:, 1] + static, rel=1e-12)


def test_parameters_and_step_are_those_asked_for(tmp_path):
    model = derive(truck(), [PointOutput("az", Place("driver", "body"), "acceleration")], [Place("engine", "body")])
    library = exported(model, tmp_path, parameter_set="heavy")
    drive = hump(model, dt=5e-4)
    assert_alike(library.run(drive), kernel_run(model, drive, model.values("heavy")))
    own = model.values(overrides={"mB": 7e3})
    assert_alike(library.run(drive, list(own.values())), kernel_run(model, drive, own))
    nothing = np.array(list(model.values().values()))
    assert [library.setup(nothing, dt) for dt in (0.0, -1.0, np.nan, np.inf)] == [1, 1, 1, 1]
    assert library.setup(np.where(nothing == nothing[0], np.nan, nothing), 1e-3) == 2
    assert library.setup(np.zeros_like(nothing), 1e-3) == 2  # no mass


@pytest.mark.thorough
@pytest.mark.parametrize("compiler", COMPILERS)
@pytest.mark.parametrize("options", [(), ("-fsanitize=address,undefined", "-fno-sanitize-recover=all", "-g")])
def test_the_example_drives_over_the_hump(compiler, options, tmp_path):
    model = derive(sedan_with("dry_friction", "bump_stop", "tyre_liftoff"), OUTPUTS)
    _, source, main = export(model, "c", tmp_path)
    program = compile_c([source, main], tmp_path / "run", *options, compiler=compiler)
    done = subprocess.run([program, "4", "0.4", "0.05", "1.2"], capture_output=True, text=True, check=True)
    assert done.stderr == ""
    heading, *rows = done.stdout.splitlines()
    assert heading == "t,az,z,front_force,rear_tyre"
    found = np.array([[float(item) for item in row.split(",")] for row in rows])
    time = np.arange(1201) * 1e-3
    s = 4.0 * time[:, None] - 0.3 - model.wheel_offsets()
    inside = (s > 0) & (s < 0.4)
    drive = hump(model, duration=1.2)
    drive.inputs[:] = np.where(inside, 0.05 * np.sin(np.pi * s / 0.4), 0.0)
    drive.rates[:] = np.where(inside, 4.0 * 0.05 * np.pi / 0.4 * np.cos(np.pi * s / 0.4), 0.0)
    assert_alike(found[:, 1:], kernel_run(model, drive), 1e-11)
    assert found[:, 0] == pytest.approx(time)


def test_the_example_refuses_what_is_no_speed(tmp_path):
    _, source, main = export("quarter_car", "c", tmp_path)
    program = compile_c([source, main], tmp_path / "run")
    for wrong, said in (
        (["abc"], "expected the speed [m/s] as a finite number, found 'abc'"),
        (["36 km/h"], "found '36 km/h'"),
        ([""], "found ''"),
        (["nan"], "found 'nan'"),
        (["inf"], "found 'inf'"),
        (["1e999"], "found '1e999'"),
        (["0"], "expected a speed above 0 m/s, found 0"),
        (["-2"], "expected a speed above 0 m/s, found -2"),
        (["2", "long"], "expected the length [m] as a finite number, found 'long'"),
        (["2", "0.5", "0.03", "3s"], "expected the duration [s] as a finite number, found '3s'"),
        (["2", "0.5", "0.03", "1e300"], "cannot be used"),
        (["2", "0.5", "0.03", "3", "4"], "at most 4 numbers were expected"),
    ):
        done = subprocess.run([program, *wrong], capture_output=True, text=True, check=False)
        assert (done.returncode, done.stdout) == (2, ""), wrong
        assert said in done.stderr
    done = subprocess.run([program, "2", "0.5", "0.03", "0.01"], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr, len(done.stdout.splitlines())) == (0, "", 12)


def test_a_law_that_does_not_converge_is_told(tmp_path):
    model = derive(sedan_with("bump_stop").with_changes({"axles": {"front": {"suspension": {"laws": [
        {"cubic_stiffness": {"k3": "9e13 N/m^3"}}]}}}}), OUTPUTS)  # fmt: skip
    library = exported(model, tmp_path)
    library.run(hump(model, dt=0.02, height=0.3))
    assert library.call("residual") > 0
    assert library.call("check") in (4, 5)


def test_hostile_names_are_no_code(tmp_path):
    folder = tmp_path / "out"
    header, source, main = export(hostile(), "c", folder)
    assert all(re.fullmatch(r"[A-Za-z0-9_]+\.[ch]", path.name) for path in (header, source, main))
    for path in (header, source, main):
        text = path.read_text(encoding="ascii")
        plain = re.sub(r'"(?:[^"\\\n]|\\[0-7]{3})*"', '""', text)
        assert "system" not in re.sub(r"\w*system\w+|\w+system\w*", "", plain)
        assert "??" not in text
    library = Library(header)
    names = (library.library, f"{header.stem}_output_names")
    assert (ctypes.c_char_p * 1).in_dll(*names)[0].decode() == TEXT
    compile_c([source, main], tmp_path / "run")


def test_names_alike_stay_apart(tmp_path):
    outputs = [PointOutput(name, Place("place", "body"), "velocity") for name in ("a-b", "a.b", "names")]
    header, source, main = export(derive(truck().with_changes(name="math"), outputs), "c", tmp_path)
    assert [source.name, main.name] == ["v_math.c", "v_math_main.c"]
    names = ["a_b", "a_b_2", "names"]
    assert re.findall(r"V_MATH_OUTPUT_(\w+) = (\d)", header.read_text()) == [(name, str(i)) for i, name in enumerate(names)]
    compile_c([source, main], tmp_path / "run", "-I", str(tmp_path))


def test_powers_of_powers_are_not_reordered(tmp_path):
    """(a**1.5)**1.7 is not a**(1.5**1.7), in the kernel or in C."""
    text = (
        "parameters: {a: {value: 2}}\nbodies: {body: {mass: 1 t, motions: [heave]}}\n"
        "axles: {a1: {body: body, x: 0 m, tyre: {k: 90 kN/m, c: 2 kN s/m, laws: [{law: {force: FORCE}}]}}}\n"
    )
    nested, plain = (
        derive(parse_vehicle(text.replace("FORCE", force)), [PointOutput("z", Place("p", "body"), "displacement")])
        for force in ("100 N*((a + 0.5)**1.5)**1.7", f"{100 * 2.5 ** (1.5 * 1.7)} N")
    )
    drive = hump(nested)
    expected = kernel_run(plain, drive)
    assert_alike(kernel_run(nested, drive), expected, 1e-10)
    assert_alike(exported(nested, tmp_path).run(drive), expected, 1e-10)
