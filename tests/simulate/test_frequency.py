import numpy as np
import pytest
import sympy as sp

from vehgen.mechanics import Place, derive
from vehgen.mechanics.outputs import ElementOutput, PointOutput
from vehgen.simulate.frequency import force_response, maxwell_branches, response_derivatives, transfer_functions
from vehgen.vehicle import load_vehicle, parse_vehicle


def test_a_quarter_cars_response_is_the_textbooks():
    vehicle = load_vehicle("quarter_car.yaml")
    model = derive(vehicle, [PointOutput("z", Place("z", next(iter(vehicle.bodies))), "acceleration")])
    numeric = model.numeric()
    frequency = np.linspace(0.2, 20, 50)
    s = 2j * np.pi * frequency
    M, C, K, P, Q = numeric.M, numeric.C, numeric.K, numeric.P, numeric.Q
    a, b, c, d = (s**2 * M[i, j] + s * C[i, j] + K[i, j] for i, j in ((0, 0), (0, 1), (1, 0), (1, 1)))
    load = P[:, 0][:, None] + Q[:, 0][:, None] * s
    body = (d * load[0] - b * load[1]) / (a * d - b * c)
    assert transfer_functions(numeric, frequency)[0][:, 0, 0] == pytest.approx(s**2 * body, rel=1e-10)


def test_maxwell_branches_stand_beside_springs_and_dashpots():
    """Closed form of two masses on complex stiffnesses: a damper on a soft mount in the suspension, a tyre that relaxes."""
    kS, kT, mB, mG = 1e6, 1.5e6, 1e4, 1e3
    text = f"""
name: mounted
gravity: false
bodies: {{body: {{mass: {mB} kg, motions: [heave]}}}}
axles:
  axle:
    body: body
    mass: {mG} kg
    suspension: {{k: {kS} N/m, laws: [{{relaxation: {{k: 2 MN/m, time: 20 ms}}}}]}}
    tyre: {{k: {kT} N/m, c: 3 kN s/m, laws: [{{relaxation: {{k: 300 kN/m, time: 5 ms}}}}]}}
"""
    outputs = [PointOutput("z", Place("z", "body"), "displacement"), ElementOutput("hub", "axle", "displacement")]
    model = derive(parse_vehicle(text), [*outputs, ElementOutput("F", "axle", "suspension_force")])
    values, frequency = model.values(), np.linspace(0.2, 30, 60)
    s = 2j * np.pi * frequency
    suspension, tyre = kS + 2e6 * 0.02 * s / (1 + 0.02 * s), kT + 3e3 * s + 3e5 * 0.005 * s / (1 + 0.005 * s)
    upper, lower = mB * s**2 + suspension, mG * s**2 + suspension + tyre
    both = upper * lower - suspension**2
    found = transfer_functions(model.numeric(values), frequency, maxwell_branches(model, values))[0][:, :, 0]
    body, hub = suspension * tyre / both, upper * tyre / both
    assert found[:, 0] == pytest.approx(body, rel=1e-10)
    assert found[:, 1] == pytest.approx(hub, rel=1e-10)
    assert found[:, 2] == pytest.approx(suspension * (hub - body), rel=1e-10)
    pushed = force_response(model, values, [{0: sp.Integer(1)}], frequency)[:, :, 0]
    assert pushed[:, 0] == pytest.approx(lower / both, rel=1e-10)
    assert pushed[:, 2] == pytest.approx(suspension * (suspension - lower) / both, rel=1e-10)


def test_derivatives_agree_with_differences():
    vehicle = load_vehicle("tractor5.yaml")
    outputs = [PointOutput("L2", Place("L2", "semitrailer", behind="fifth_wheel", distance=9.1), "acceleration")]
    model = derive(vehicle, outputs)
    values, names = model.values(), ("mS", "k3", "a1", "b1", "b6", "kt5")
    frequency = np.array([1.0, 3.3, 12.0, 17.5])
    exact = response_derivatives(model, values, names, frequency)
    for i, name in enumerate(names):
        step = 1e-5 * values[name]
        sides = [transfer_functions(model.numeric({**values, name: values[name] + s}), frequency)[0] for s in (step, -step)]
        difference = (sides[0] - sides[1]) / (2 * step)
        assert np.abs(exact[i] - difference).max() < 1e-6 * np.abs(difference).max()


def test_a_constant_force_on_a_free_mass_has_no_answer():
    vehicle = parse_vehicle("name: sled\ngravity: false\nbodies: {sled: {mass: 20 kg, motions: [heave]}}\n")
    model = derive(vehicle, [PointOutput("z", Place("z", "sled"), "displacement")])
    found = force_response(model, model.values(), [{0: sp.Integer(1)}], np.array([0.0, 1.0]))
    assert found[:, 0, 0] == pytest.approx([0.0, -1 / (20 * (2 * np.pi) ** 2)])
