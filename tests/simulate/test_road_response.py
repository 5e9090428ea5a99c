"""Responses to rough roads against closed forms, long simulations and the balance of forces."""

import json
import warnings

import numpy as np
import pytest
from matplotlib.figure import Figure

from tests.commands.calls import run_json
from vehgen.commands import main
from vehgen.errors import InputError, ModelWarning
from vehgen.measure.ride_comfort import WEIGHTINGS, evaluate_vibration
from vehgen.mechanics import ElementOutput, Place, PointOutput
from vehgen.mechanics.hinge_forces import far_side
from vehgen.simulate import load_run, simulate
from vehgen.simulate.frequency import transfer_functions
from vehgen.simulate.frequency_response import frequency_response
from vehgen.simulate.road_response import RoadResponse, road_response
from vehgen.vehicle import load_vehicle, parse_vehicle

RUN = """\
vehicle: sedan2
speed: 15 m/s
duration: 400 s
sample: 10 ms
road: [{iso8608: {class: C, seed: 3}}]
sensors: {rear: {body: body, behind: rear, distance: 0.2 m, channels: {acceleration: az}}}
outputs: {load: {axle: rear, quantity: tyre_force}}
"""


def outputs(found):
    return {item.name: item for item in found.outputs}


def test_a_quarter_car_has_the_closed_form():
    vehicle = load_vehicle("quarter_car")
    values = vehicle.all_values(vehicle.values())
    body, (axle_name, axle) = next(iter(vehicle.bodies.values())), next(iter(vehicle.axles.items()))
    m, mu = body.mass.evaluate(values), axle.mass.evaluate(values)
    (k, c), (kt, ct) = ((spring.k.evaluate(values), spring.c.evaluate(values)) for spring in (axle.suspension, axle.tyre))
    found = road_response(vehicle, speed=10.0, roughness="A")
    s = 2j * np.pi * found.frequency
    spring = k + c * s
    body_over_axle = spring / (m * s**2 + spring)
    wheel = kt + ct * s
    axle_over_road = wheel / (mu * s**2 + wheel + m * s**2 * body_over_axle)
    expected = s**2 * body_over_axle * axle_over_road
    names = [item.name for item in found.outputs]
    row = names.index(next(iter(vehicle.bodies)))
    np.testing.assert_allclose(found.amplitude[row], abs(expected), rtol=1e-4)
    turned = np.exp(1j * np.radians(found.phase[row])) * expected.conj()
    np.testing.assert_allclose(np.angle(turned), 0.0, atol=1e-4)
    road = 16e-6 * (found.frequency / 10.0 / 0.1) ** -2 / 10.0
    np.testing.assert_allclose(found.psd[row], abs(expected) ** 2 * road, rtol=1e-4)
    tyre = names.index(f"{axle_name} tyre")
    np.testing.assert_allclose(found.amplitude[tyre], abs(wheel * (1 - axle_over_road)), rtol=1e-4)


def test_a_long_simulation_has_the_same_rms(tmp_path):
    path = tmp_path / "run.yaml"
    path.write_text(RUN)
    run = load_run(path)
    response = simulate(run)
    place = Place("rear place", "body", behind="rear", distance=0.2)
    found = outputs(road_response("sedan2", speed=15.0, roughness="C", places=[place]))
    assert response.values[0, 500:, 0].std() == pytest.approx(found["rear place"].rms, rel=0.03)
    assert response.values[0, 500:, 1].std() == pytest.approx(found["rear tyre"].rms, rel=0.03)
    weighted = evaluate_vibration(response.values[0, 500:, 0], 0.01, WEIGHTINGS["Wk"])
    assert weighted.rms == pytest.approx(found["rear place"].weighted_rms, rel=0.03)


@pytest.mark.parametrize("name", ["tractor5_cab", "truck_dolly_trailer"])
def test_a_hinges_force_balances_the_bodies_on_this_side_too(name):
    """What the bodies beyond ask of the hinge, those on the near side must lack."""
    vehicle = load_vehicle(name)
    values = vehicle.all_values(vehicle.values())
    hinge = next(iter(vehicle.hinges))
    near = [body for body in vehicle.bodies if body not in far_side(vehicle, hinge)]
    axles = [axle for axle, item in vehicle.axles.items() if item.body in near]
    wanted = [PointOutput(body, Place(body, body), "acceleration") for body in near]
    wanted += [ElementOutput(f"{axle} spring", axle, "suspension_force") for axle in axles]
    response = frequency_response(vehicle, [0.7, 2.0, 9.0], outputs=[*wanted, ElementOutput("pin", hinge, "hinge_force")], speed=20.0)
    *others, force = response.values[:, :, 0].T
    by_name = dict(zip((output.name for output in wanted), others, strict=True))
    carried = sum(by_name[f"{axle} spring"] for axle in axles)
    inertia = sum(vehicle.bodies[body].mass.evaluate(values) * by_name[body] for body in near)
    np.testing.assert_allclose(force, carried - inertia, rtol=1e-6)


def test_axles_meet_the_road_one_after_another():
    slow, fast = (road_response("sedan2", speed=speed, roughness="A") for speed in (5.0, 40.0))
    at = 3.0
    i, j = np.argmin(abs(slow.frequency - at)), np.argmin(abs(fast.frequency - at))
    assert slow.amplitude[0, i] != pytest.approx(fast.amplitude[0, j], rel=0.1)


def test_what_is_solved_in_parts_is_the_same(monkeypatch):
    frequency = np.linspace(0.5, 20.0, 41)
    from vehgen.mechanics import derive
    from vehgen.simulate import frequency as module

    model = derive("sedan2", [PointOutput("az", Place("p", "body"), "acceleration")])
    numeric = model.numeric(model.values())
    whole = transfer_functions(numeric, frequency)
    monkeypatch.setattr(module, "MATRIX_NUMBERS", 7 * len(numeric.M) ** 2)
    for one, other in zip(whole, transfer_functions(numeric, frequency), strict=True):
        np.testing.assert_array_equal(one, other)


def test_a_result_survives_json_and_shows_itself():
    found = road_response("tractor5")
    again = RoadResponse.from_dict(json.loads(json.dumps(found.to_dict(), allow_nan=False)))
    assert again == found
    assert isinstance(again.plot(), Figure)
    columns, rows = again.curves()
    assert len(rows) == len(found.frequency)
    assert {len(row) for row in rows} == {len(columns)} == {2 + 3 * len(found.outputs)}
    assert found.inputs["tractor5.yaml"]
    assert found.versions["vehgen"]


def test_laws_are_left_out_with_a_warning_and_bent_bodies_tell_the_hinge_force():
    law = parse_vehicle("extends: tractor5\naxles: {axle1: {suspension: {laws: [{dry_friction: {force: 2 kN}}]}}}")
    with pytest.warns(ModelWarning, match="linear"):
        road_response(law)
    bent = parse_vehicle("extends: tractor5\nbodies: {semitrailer: {bending: {frequency: 6 Hz, damping_ratio: 0.02, length: 12 m}}}")
    found = road_response(bent)
    assert outputs(found)["hinge fifth_wheel"].rms > 0


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ({"speed": 0.0}, "speed"),
        ({"speed": float("inf")}, "speed"),
        ({"speed": 1e6}, "`speed`: a speed is"),
        ({"roughness": "Q"}, "unknown road class"),
        ({"places": [Place("body", "body")]}, "two outputs are called 'body'"),
        ({"places": [Place("p", "bdy")]}, "no body 'bdy'"),
    ],
)
def test_what_cannot_be_is_refused(arguments, said):
    with warnings.catch_warnings(), pytest.raises(InputError, match=said):
        road_response("sedan2", **arguments)


def test_the_command_writes_and_tells(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    found = run_json(capsys, "response", "sedan2", "--speed", "54 km/h", "--road", "C", "--at", "seat:body=body,x=0.4", "--out", "out")
    assert [path.rpartition("/")[2] for path in found["files"]] == ["response.json", "response.csv", "response.png"]
    assert "seat" in [item["name"] for item in found["outputs"]]
    header, *rows = (tmp_path / "out" / "response.csv").read_text().splitlines()
    assert header.startswith("frequency [Hz],road PSD [m^2/Hz],body |H| [m/s^2/m]")
    assert len(rows) > 500
    assert main(["report", "out/response.json", "--out", "again"]) == 0
    assert (tmp_path / "again" / "response.png").read_bytes() == (tmp_path / "out" / "response.png").read_bytes()
    capsys.readouterr()
    assert main(["response", "sedan2", "--at", "seat:bdy=body"]) == 2
    assert capsys.readouterr().err.startswith("error: --at seat: unknown key")
