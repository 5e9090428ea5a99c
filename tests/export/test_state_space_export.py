"""State space for other libraries: their step responses are those of the matrix exponential, damped tyres included."""

import json

import numpy as np
import pytest
import scipy.io
import scipy.signal

from tests.bundled import few
from tests.export.vehicles import sedan_with, truck
from vehgen.codegen import Excitation
from vehgen.errors import InputError
from vehgen.export import export
from vehgen.export.adapters import to_control, to_pyyeti, to_scipy
from vehgen.mechanics import ElementOutput, Place, PointOutput, derive
from vehgen.simulate import exact_response, state_space
from vehgen.vehicle import bundled_models, parse_vehicle

DRIVER = Place("driver", "body", behind="front", distance=0.5)
MOTION = (PointOutput("v", DRIVER, "velocity"), PointOutput("z", DRIVER, "displacement"))
ROPELESS = truck().with_changes(links={"rope": None})
DT = 1e-3


def exact_step(model, column, n_steps=1500):
    """Return what a jump of one input by 1 m does: w' is an impulse, which sets the velocities to M^-1 Q at once."""
    numeric = model.numeric()
    inputs = np.zeros((n_steps + 1, len(model.inputs)))
    inputs[:, column] = 1.0
    start = np.concatenate([np.zeros(model.n_dof), np.linalg.solve(numeric.M, numeric.Q[:, column])])
    return exact_response(model, Excitation(DT, inputs, np.zeros_like(inputs), np.zeros((n_steps + 1, 0))), initial=start)


def close(found, expected, tolerance=1e-12):
    assert (np.abs(found - expected).max(axis=0) <= tolerance * np.abs(expected).max(axis=0)).all()


@pytest.mark.parametrize(
    ("vehicle", "quantity", "column"), [(truck(), "velocity", 0), (truck(), "velocity", 2), (ROPELESS, "acceleration", 0)]
)
def test_scipys_step_response_is_exact_with_damped_tyres(vehicle, quantity, column):
    model = derive(vehicle, (PointOutput("first", DRIVER, quantity), MOTION[1]))
    expected = exact_step(model, column)
    system = to_scipy(state_space(model, input_rates="states"), inputs=[model.inputs[column]])
    time = np.arange(len(expected)) * DT
    close(scipy.signal.step(system, T=time)[1], expected)


def test_the_quarter_cars_step_response_is_exact():
    model = derive("tractor5", [PointOutput("az", Place("L1", "tractor"), "acceleration")])
    expected = exact_step(model, 2)
    system = to_scipy(state_space(model), inputs=["road.axle3"])
    close(scipy.signal.step(system, T=np.arange(len(expected)) * DT)[1][:, None], expected)


@pytest.mark.parametrize("column", [0, 2])
def test_pythons_control_system_has_the_same_step_response(column):
    control = pytest.importorskip("control")
    model = derive(truck(), MOTION)
    system = to_control(state_space(model, input_rates="states"), inputs=[model.inputs[column]])
    assert system.output_labels == ["v", "z"]
    assert system.state_labels[0] == "heave_body"
    expected = exact_step(model, column)
    found = control.forced_response(system, np.arange(len(expected)) * DT, np.ones((1, len(expected))))
    close(found.outputs.T, expected, 1e-11)


def test_pyyetis_solver_has_the_same_response():
    pytest.importorskip("pyyeti")
    model = derive("tractor5", [PointOutput("z", Place("L1", "tractor"), "displacement")])
    numeric, expected = model.numeric(), exact_step(model, 0)
    load = np.repeat(numeric.P[:, :1], len(expected), axis=1)
    found = to_pyyeti(model, DT).tsolve(load)
    close(found.d.T @ numeric.outputs["displacement"].T, expected)
    with pytest.raises(InputError, match="sedan has force laws, which pyyeti"):
        to_pyyeti(sedan_with("dry_friction"), DT)


@pytest.mark.parametrize("name", few(name for name in bundled_models() if name != "drop_test"))
def test_every_bundled_vehicle_has_its_states_named(name, tmp_path):
    (path,) = export(name, "state-space", tmp_path / "a.mat")
    found, system = scipy.io.loadmat(path), state_space(name)
    for key in "ABCD":
        assert (found[key] == getattr(system, key)).all()
    assert [cell[0] for cell in found["state_names"][:, 0]] == list(system.states)
    assert [cell[0] for cell in found["input_units"][:, 0]] == list(system.input_units)
    poles = np.sort(np.abs(np.linalg.eigvals(found["A"])))
    assert poles == pytest.approx(np.sort(np.abs(system.poles)), rel=1e-9)


def test_rates_stand_among_the_inputs_with_their_units(tmp_path):
    (path,) = export(derive(truck(), (ElementOutput("force", "front", "tyre_force"),)), "state-space", tmp_path / "a.mat")
    found = scipy.io.loadmat(path)
    names = [cell[0] for cell in found["input_names"][:, 0]]
    units = [cell[0] for cell in found["input_units"][:, 0]]
    assert dict(zip(names, units, strict=True)) == {
        "road.front": "m", "road.rear": "m", "ground.rope": "m", "road.front.rate": "m/s", "ground.rope.rate": "m/s",
    }  # fmt: skip
    assert found["D"].tolist() == [[1.6e6, 0.0, 0.0, 3000.0, 0.0]]
    assert [cell[0] for cell in found["state_units"][:, 0]] == ["m", "rad", "m", "m", "m/s", "rad/s", "m/s", "m/s"]


def test_the_static_part_of_a_tyres_load_is_told_beside_every_matrix(tmp_path):
    """By statics alone: the two axles of a beam share its weight as the levers tell, each with its own unsprung mass on top."""
    text = "name: two\nbodies: {b: {mass: 1 t, pitch_inertia: 2 t m^2}}\naxles:\n"
    text += "  one: {body: b, x: 1 m, mass: 100 kg, suspension: {k: 50 kN/m}, tyre: {k: 200 kN/m}}\n"
    text += "  two: {body: b, x: -3 m, mass: 100 kg, suspension: {k: 50 kN/m}, tyre: {k: 200 kN/m}}\n"
    model = derive(parse_vehicle(text), (ElementOutput("force", "two", "tyre_force"), ElementOutput("load", "two", "tyre_load")))
    expected = [0.0, pytest.approx((250.0 + 100.0) * 9.81)]
    (path,) = export(model, "state-space", tmp_path / "a.mat")
    assert scipy.io.loadmat(path)["static_outputs"][:, 0].tolist() == expected
    (path,) = export(model, "json", tmp_path / "a.json")
    assert json.loads(path.read_text(encoding="utf-8"))["static"]["outputs"] == expected


def test_force_laws_and_unknown_inputs_are_refused(tmp_path):
    with pytest.raises(InputError, match=r"tyre_liftoff of tyre front .* cannot be carried by state-space"):
        export(sedan_with("tyre_liftoff"), "state-space", tmp_path / "a.mat")
    export(sedan_with("tyre_liftoff"), "state-space", tmp_path / "a.mat", linear=True)
    with pytest.raises(InputError, match=r"`inputs`: no input 'road.fornt'; did you mean 'road.front'"):
        to_scipy(state_space(truck()), inputs=["road.fornt"])
