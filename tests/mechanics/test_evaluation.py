"""One evaluator for numbers and for arrays: both give what sympy gives."""

import numpy as np
import pytest
import sympy as sp

from vehgen.files.expressions import parse
from vehgen.mechanics import GRAVITY, derive
from vehgen.mechanics.evaluation import ExpressionSteps, PopulationValues, evaluate_array
from vehgen.mechanics.symbols import to_sympy
from vehgen.vehicle import bundled_models, load_vehicle

a, b = sp.symbols("a b", real=True)
VALUES = {a: -1.75, b: 0.3}


def evaluate_number(expression):
    return ExpressionSteps([expression], list(VALUES))(list(VALUES.values()))[0]


@pytest.mark.parametrize(
    "expression",
    [
        a + 2 * b - 3,
        a**2 / (1 + b) ** 3 - sp.sqrt(b),
        sp.Abs(a) * sp.sign(a) + sp.Max(a, b, 0) - sp.Min(a, b),
        sp.Heaviside(b) + sp.Heaviside(a),
        sp.Integer(7),
        sp.Rational(1, 3) * a,
    ],
)
def test_numbers_and_arrays_agree_with_sympy(expression):
    expected = float(expression.subs(VALUES))
    assert evaluate_number(expression) == pytest.approx(expected, rel=1e-14)
    found = evaluate_array(expression, {symbol: np.full(3, value) for symbol, value in VALUES.items()})
    np.testing.assert_allclose(np.broadcast_to(found, 3), expected, rtol=1e-14)


def test_a_matrix_and_a_list_follow_dependent_parameters():
    model = derive(load_vehicle(bundled_models()["tractor5_cab"]))
    values = model.values()
    assert model.definitions
    exact = {sp.Symbol(name, real=True): value for name, value in values.items()}
    for symbol, expression in model.definitions:
        exact[symbol] = expression.subs(exact)
    found = model.evaluate_matrix(model.mass_entries, (model.n_dof, model.n_dof), values)
    np.testing.assert_allclose(found, np.array(model.M.subs(exact).tolist(), dtype=float), rtol=1e-12)
    symbols = [symbol for symbol, _ in model.definitions]
    np.testing.assert_allclose(model.evaluate_list(symbols, values), [float(exact[symbol]) for symbol in symbols], rtol=1e-14)
    population = np.array([list(values.values())] * 2)
    np.testing.assert_allclose(PopulationValues(model, population).value(symbols[-1]), float(exact[symbols[-1]]), rtol=1e-14)


def test_the_weight_is_that_of_all_bodies_and_axles():
    vehicle = load_vehicle(bundled_models()["tractor5_cab"])
    masses = [body.mass for body in vehicle.bodies.values()] + [axle.mass for axle in vehicle.axles.values() if axle.mass is not None]
    known = vehicle.all_values(vehicle.values())
    assert derive(vehicle).total_weight() == pytest.approx(GRAVITY * sum(mass.evaluate(known) for mass in masses), rel=1e-12)


@pytest.mark.parametrize("exponent", ["0.5", "-0.5", "1e-3", "0.1", "1/3", "-2.75", "9.99999999", "2.7182818284590452", "1.41421356237310"])
def test_an_exponent_is_the_number_that_was_written(exponent):
    found = evaluate_number(to_sympy(parse(f"b**({exponent})")))
    value = float(exponent) if "/" not in exponent else 1 / 3
    assert found == pytest.approx(0.3**value, rel=1e-15)
