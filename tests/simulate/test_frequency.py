import numpy as np
import pytest
import sympy as sp

from vehgen.mechanics import Place, derive
from vehgen.mechanics.outputs import PointOutput
from vehgen.simulate.frequency import force_response, response_derivatives, transfer_functions
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
