"""The five-axle vehicle of Wu & Li 2023 (doi:10.3390/s23249691), entry by entry, and its laden forms."""

import numpy as np
import pytest
import scipy.linalg
import sympy as sp

from vehgen.mechanics import derive, static_loads
from vehgen.simulate import natural_modes
from vehgen.vehicle import load_vehicle, parse_vehicle

NAMES = "mT mS IT IS a1 a2 b1 b2 b3 b4 b5 b6 b7 m1 m2 m3 m4 m5 k1 k2 k3 k4 k5 c1 c2 c3 c4 c5 kt1 kt2 kt3 kt4 kt5"
ORDER = ["heave.tractor", "pitch.tractor", "pitch.semitrailer", *(f"hop.axle{i}" for i in range(1, 6))]


def printed_matrices():
    """The paper's M, C, K and P with the signs it must mean (ISO 8855, pitch nose-down)."""
    mT, mS, IT, IS, a1, a2, b1, b2, b3, b4, b5, b6, b7, *rest = sp.symbols(NAMES, real=True)
    m, k, c, kt = rest[0:5], rest[5:10], rest[10:15], rest[15:20]
    mu = mT * mS / (mT + mS)
    M = sp.zeros(8)
    M[:3, :3] = sp.Matrix(
        [
            [mT + mS, b7 * mS, b6 * mS],
            [b7 * mS, IT + b7**2 * mS + mu * a1**2, b6 * b7 * mS - mu * a1 * a2],
            [b6 * mS, b6 * b7 * mS - mu * a1 * a2, IS + b6**2 * mS + mu * a2**2],
        ]
    )
    for i in range(5):
        M[3 + i, 3 + i] = m[i]

    def stiffness(k):
        B4, B5 = b4 + b6, b5 + b6
        K = sp.zeros(8)
        K[0, 0] = sum(k)
        K[0, 1] = -b1 * k[0] + b2 * k[1] + b3 * k[2] + b7 * (k[3] + k[4])
        K[0, 2] = B4 * k[3] + B5 * k[4]
        K[1, 1] = b1**2 * k[0] + b2**2 * k[1] + b3**2 * k[2] + b7**2 * (k[3] + k[4])
        K[1, 2] = b7 * (B4 * k[3] + B5 * k[4])
        K[2, 2] = B4**2 * k[3] + B5**2 * k[4]
        K[1, 3:] = sp.Matrix([[b1 * k[0], -b2 * k[1], -b3 * k[2], -b7 * k[3], -b7 * k[4]]])
        K[0, 3:] = -sp.Matrix([k])
        K[2, 6], K[2, 7] = -B4 * k[3], -B5 * k[4]
        for i in range(5):
            K[3 + i, 3 + i] = k[i]
        return sp.Matrix(8, 8, lambda i, j: K[min(i, j), max(i, j)])

    K = stiffness(k)
    P = sp.zeros(8, 5)
    for i in range(5):
        K[3 + i, 3 + i] += kt[i]
        P[3 + i, i] = kt[i]
    return M, stiffness(c), K, P


def test_derived_matrices_equal_the_papers_symbolically():
    model = derive(load_vehicle("tractor5"))
    assert [item.name for item in model.coordinates] == ORDER
    for derived, printed in zip((model.M, model.C, model.K, model.P), printed_matrices(), strict=True):
        assert sp.simplify(sp.Matrix(derived) - printed) == sp.zeros(*printed.shape)


def test_energies_written_out_and_differentiated_give_the_same_matrices():
    model = derive(load_vehicle("tractor5_module"))
    velocities = sp.symbols(f"s0:{model.n_dof}", real=True)
    kinetic = sum(term.inertia * sum(a * velocities[i] for i, a in term.row.items()) ** 2 for term in model.energies.inertias) / 2
    forward = sp.Symbol("X", real=True)
    for group in model.energies.fore_aft.values():
        kinetic += sum(term.inertia * (forward + sum(a * velocities[i] for i, a in term.row.items())) ** 2 for term in group) / 2
    ignorable = sp.solve(sp.diff(kinetic, forward), forward)[0]
    reduced = kinetic.subs(forward, ignorable)
    assert sp.simplify(sp.Matrix(sp.hessian(reduced, velocities)) - sp.Matrix(model.M)) == sp.zeros(model.n_dof)


@pytest.mark.parametrize(
    ("name", "parameter_set", "frequencies"),
    [
        ("tractor5", None, [1.243784729, 2.710665116, 3.238006833, 11.99706999, 13.04757213, 16.65226161, 17.0339614, 19.55492624]),
        ("tractor5", "DHCM-1-2", [1.243784729, 2.710665116, 3.238006833, 11.99706999, 13.04757213, 16.65226161, 17.0339614, 19.55492624]),
        (
            "tractor5",
            "sensitivity",
            [1.389324917, 1.693076712, 2.171124386, 8.850063006, 9.471814606, 9.510802528, 10.19188981, 10.22513606],
        ),
        ("sedan2", None, [1.311728997, 1.642946819, 10.76733726, 14.39470766]),
        ("quarter_car", None, [1.1112478077533552, 7.208241791310187]),
        (
            "vbi2d_2A3",
            None,
            [1.4105487359, 1.5890769411, 5.2350767470, 8.8508275359, 10.5353064694, 11.9807488703, 11.9817410523, 12.1270944255],
        ),
        (
            "tractor5_module",
            None,
            [1.243297106, 2.627365595, 3.055570469, 6.787363978, 11.99764722, 13.05938722, 16.65229406, 17.03396126, 19.5549086],
        ),
        (
            "tractor5_module_paper",
            None,
            [1.243687316, 2.65621121, 3.041044072, 6.776455726, 11.99726986, 13.04656853, 16.65348226, 17.03397753, 19.55502271],
        ),
    ],
)
def test_undamped_frequencies(name, parameter_set, frequencies):
    model = derive(load_vehicle(name))
    modes = natural_modes(model, model.values(parameter_set))
    np.testing.assert_allclose([mode.undamped_hz for mode in modes], frequencies, rtol=2e-9)


def test_damped_frequencies_and_ratios():
    modes = natural_modes(derive(load_vehicle("tractor5")))
    expected = [
        (1.289779923, 0.1989466948),
        (2.775582868, 0.3744152497),
        (3.527365915, 0.2549615757),
        (11.72853589, 0.5401819908),
        (12.23755536, 0.4547455575),
        (16.39266357, 0.4014041328),
        (16.63513589, 0.07119782946),
        (19.17847799, 0.4759854518),
    ]
    found = sorted((mode.pole_hz, mode.damping_ratio) for mode in modes)
    np.testing.assert_allclose(found, expected, rtol=1e-8)


def test_damped_poles_of_the_quarter_car():
    slow, fast = natural_modes(derive(load_vehicle("quarter_car")))
    for mode, pole in ((slow, complex(-0.24375390137480146, 6.97791976956781)), (fast, complex(-10.25624609862521, 44.11415459565645))):
        assert mode.pole_hz == pytest.approx(abs(pole) / (2 * np.pi), rel=1e-10)
        assert mode.damped_hz == pytest.approx(pole.imag / (2 * np.pi), rel=1e-10)
        assert mode.damping_ratio == pytest.approx(-pole.real / abs(pole), rel=1e-10)


def test_a_motion_that_creeps_back_has_no_damped_frequency():
    """m s^2 + c s + k with m = 100 kg, k = 10 kN/m and c = 5 kN s/m has the poles -2.0871 and -47.9129 1/s."""
    text = "name: one\nbodies: {b: {mass: 100 kg, motions: [heave]}}\nlinks: {l: {ground: {}, b: {}, k: 10 kN/m, c: 5 kN s/m}}\n"
    (mode,) = natural_modes(derive(parse_vehicle(text)))
    assert (mode.pole_hz, mode.damping_ratio) == pytest.approx((10 / (2 * np.pi), 2.5))
    assert mode.damped_hz == 0.0


def test_static_loads_of_vbi2d_and_of_the_paper():
    loads = static_loads(derive(load_vehicle("vbi2d_2A3"))).axles
    np.testing.assert_allclose(
        list(loads.values()), [55162.20664017522, 105278.27884704091, 78252.47741669805, 77319.83817092795, 76387.19892515783], rtol=1e-10
    )
    loads = static_loads(derive(load_vehicle("tractor5"))).axles
    expected = np.array([1.303246339, 0.7598816945, 2.526704251, 1.682139728, 1.398027987]) * 8000 * 9.81
    np.testing.assert_allclose(list(loads.values()), expected, rtol=1e-8)


def test_hinge_force_balances_the_semitrailer():
    model = derive(load_vehicle("tractor5"))
    loads = static_loads(model)
    values = model.values()
    weight = 9.81 * (values["mS"] + values["m4"] + values["m5"])
    assert loads.hinges["fifth_wheel"] == pytest.approx(weight - loads.axles["axle4"] - loads.axles["axle5"], rel=1e-12)


def test_stiff_module_becomes_the_rigid_load():
    module = derive(load_vehicle("tractor5_module"))
    rigid = parse_vehicle("extends: tractor5_module\nbodies:\n  module: {motions: []}\nlinks: null\n")
    reference = np.array([mode.undamped_hz for mode in natural_modes(derive(rigid))])
    errors = []
    for k0 in (1e9, 1e11, 1e13):
        numeric = module.numeric(module.values(overrides={"k0": k0}))
        found = np.sqrt(scipy.linalg.eigh(numeric.K, numeric.M, eigvals_only=True))[:8] / (2 * np.pi)
        errors.append(np.abs(found / reference - 1).max())
    assert errors[0] > errors[1] > errors[2]
    assert errors[2] < 1e-6
    np.testing.assert_allclose(
        reference, [1.243302552, 2.643225621, 3.086351937, 11.99538268, 12.99491471, 16.65099536, 17.03394407, 19.5548014], rtol=1e-8
    )


def test_rigid_load_obeys_the_parallel_axis_theorem():
    model = derive(load_vehicle("tractor5_cargo"))
    values = model.vehicle.all_values({name: value for name, value in model.values().items() if name in model.vehicle.parameters})
    m, mS, h, length = (values[name] for name in ("m01", "mS", "h01", "l01"))
    total = mS + m
    carried = model.vehicle.bodies["cargo"].carried_by
    dx, dz = (item.evaluate(values) for item in (carried.x, carried.z))
    IS = values["IS"] + m * (length**2 + h**2) / 12 + mS * m / total * (dx**2 + dz**2)
    b6 = values["b6"] - m * dx / total
    a2 = values["a2"] - m * dz / total
    mu = values["mT"] * total / (values["mT"] + total)
    M = model.numeric().M
    assert M[2, 2] == pytest.approx(IS + b6**2 * total + mu * a2**2, rel=1e-12)
    assert M[0, 2] == pytest.approx(b6 * total, rel=1e-12)
    assert M[1, 2] == pytest.approx(b6 * values["b7"] * total - mu * values["a1"] * a2, rel=1e-12)
