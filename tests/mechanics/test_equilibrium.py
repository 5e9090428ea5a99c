"""Static equilibrium with laws that count from the unloaded position, against equations written out again."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq, root

from vehgen.codegen import Excitation, Kernel
from vehgen.errors import InputError, ModelWarning
from vehgen.mechanics import ElementOutput, Place, PointOutput, derive, static_loads
from vehgen.mechanics.equilibrium import _Balance, equilibria
from vehgen.mechanics.static_loads import axle_loads
from vehgen.simulate import Simulator, load_run, make_scenario
from vehgen.vehicle import load_vehicle, parse_vehicle

G = 9.81
BUMP = "{bump_stop: {k: 2 MN/m, clearance: 60 mm, from: unloaded}}"
CUBIC = "{cubic_stiffness: {k3: 4e8 N/m^3, from: unloaded}}"
LAWS = {BUMP: lambda d: 2e6 * max(d - 0.06, 0.0), CUBIC: lambda d: 4e8 * d**3}


def quarter(laws, extra=""):
    return parse_vehicle(f"extends: quarter_car\naxles: {{axle1: {{suspension: {{laws: [{laws}]}}}}}}\n{extra}")


def columns(model, **changes):
    return np.array([list(model.values(overrides=changes).values())])


@pytest.mark.parametrize("law", LAWS)
def test_a_quarter_car_stands_where_its_spring_and_law_carry_the_body(law):
    model = derive(quarter(law))
    travel = brentq(lambda d: 1e6 * d + LAWS[law](d) - 10000 * G, 0, 1, xtol=1e-15)
    loads = static_loads(model)
    found = equilibria(model, columns(model))
    assert found.travels[0] == pytest.approx([travel, 11000 * G / 1e6], rel=1e-12)
    assert loads.elements["suspension", "axle1"] == pytest.approx(10000 * G, rel=1e-12)
    assert loads.axles["axle1"] == pytest.approx(11000 * G, rel=1e-12)
    assert travel < 0.9 * 10000 * G / 1e6


def sedan_forces(q, p, front, rear):
    """Upward force and nose-down moment on the body, and upward forces on both axles, all from the unloaded position."""
    z, pitch, zf, zr = q
    df, dr = zf - (z - p["Lf"] * pitch), zr - (z + p["Lr"] * pitch)
    sf, sr = p["kf"] * df + front(df), p["kr"] * dr + rear(dr)
    return np.array(
        [
            sf + sr - p["mH"] * G,
            -p["Lf"] * sf + p["Lr"] * sr,
            -p["ktf"] * zf - sf - p["mf"] * G,
            -p["ktr"] * zr - sr - p["mr"] * G,
        ]
    )


def test_a_sedan_stands_where_scipy_finds_it():
    front, rear = "{cubic_stiffness: {k3: 5e6 N/m^3, from: unloaded}}", "{bump_stop: {k: 300 kN/m, clearance: 50 mm, from: unloaded}}"
    vehicle = parse_vehicle(
        f"extends: sedan2\naxles: {{front: {{suspension: {{laws: [{front}]}}}}, rear: {{suspension: {{laws: [{rear}]}}}}}}\n"
    )
    model = derive(vehicle)
    found = equilibria(model, columns(model))
    values = vehicle.all_values(vehicle.values())
    laws = (lambda d: 5e6 * d**3, lambda d: 3e5 * max(d - 0.05, 0.0))
    expected = root(sedan_forces, np.array([-0.1, 0, -0.01, -0.01]), (values, *laws), tol=1e-13).x
    np.testing.assert_allclose(found.displacement[0], expected, rtol=1e-9, atol=1e-12)
    assert found.travels[0, 2] > 0.05
    alone = _Balance(model, columns(model)).alone()
    np.testing.assert_allclose(alone[0], expected, rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize("law", LAWS)
def test_released_without_load_a_damped_vehicle_settles_there(law):
    def fall(_t, x):
        z, wheel, v, hop = x
        d, rate = wheel - z, hop - v
        suspension = 1e6 * d + LAWS[law](d) + 5e4 * rate
        return [v, hop, suspension / 10000 - G, (-1e6 * wheel - 5e4 * hop - suspension) / 1000 - G]

    settled = solve_ivp(fall, (0, 60), np.zeros(4), method="Radau", rtol=1e-10, atol=1e-12).y[:, -1]
    assert np.abs(settled[2:]).max() < 1e-9
    model = derive(quarter(law))
    np.testing.assert_allclose(equilibria(model, columns(model)).displacement[0], settled[:2], rtol=1e-8)


OUTPUTS = (
    PointOutput("a", Place("s", "body"), "acceleration"),
    PointOutput("z", Place("s", "body"), "displacement"),
    ElementOutput("f", "axle1", "suspension_force"),
)


@pytest.mark.parametrize("law", LAWS)
def test_the_kernel_moves_about_that_equilibrium(law):
    model = derive(quarter(law), OUTPUTS)
    kernel = Kernel(model)
    time = np.arange(3001) * 1e-3
    phase = np.clip((time - 0.2) / 0.25, 0, 1)
    w, dw = 0.05 * np.sin(np.pi * phase) ** 2, 0.05 * np.pi / 0.25 * np.sin(2 * np.pi * phase)
    still = kernel.run(columns(model), Excitation(1e-3, 0 * w[:, None], 0 * w[:, None], np.zeros((3001, 0))), 10)
    assert np.abs(still.responses).max() < 1e-9
    found = kernel.run(columns(model), Excitation(1e-3, w[:, None], dw[:, None], np.zeros((3001, 0))), 10).responses[0]
    rest = brentq(lambda d: 1e6 * d + LAWS[law](d) - 10000 * G, 0, 1, xtol=1e-15)
    sunk = 11000 * G / 1e6

    def ride(t, x):
        z, wheel, v, hop = x
        s = min(max((t - 0.2) / 0.25, 0.0), 1.0)
        suspension = 1e6 * (wheel - z) + LAWS[law](wheel - z) + 1e4 * (hop - v)
        tyre = 1e6 * (0.05 * np.sin(np.pi * s) ** 2 - wheel) + 1e4 * (0.05 * np.pi / 0.25 * np.sin(2 * np.pi * s) - hop)
        return [v, hop, suspension / 10000 - G, (tyre - suspension) / 1000 - G]

    start = np.array([-rest - sunk, -sunk, 0, 0])
    solution = solve_ivp(ride, (0, 3), start, t_eval=time[::10], method="Radau", rtol=1e-9, atol=1e-11, max_step=0.005)
    a = np.array([ride(t, x)[2] for t, x in zip(solution.t, solution.y.T, strict=True)])
    expected = np.column_stack([a, solution.y[0] - start[0], 10000 * a])
    error = np.linalg.norm(found - expected, axis=0) / np.linalg.norm(expected, axis=0)
    assert error.max() < 5e-3, error


SOFT = "parameters: {soft: {value: 1e6 N/m^2}}\n"


def test_who_has_no_equilibrium_fails_with_the_reason_and_harms_no_other(tmp_path):
    soft = quarter("{law: {force: -soft*d*abs(d), from: unloaded}}", SOFT)
    model = derive(soft, OUTPUTS)
    parameters = np.repeat(columns(model), 4, axis=0)
    parameters[1, model.parameters.index("soft")] = 4e6  # the spring's peak, k^2/(4 s), lies below the weight
    parameters[2, model.parameters.index("kS")] = np.nan
    excitation = Excitation(1e-3, np.linspace(0, 0.01, 501)[:, None], np.full((501, 1), 0.02), np.zeros((501, 0)))
    result = Kernel(model).run(parameters, excitation)
    assert set(result.failures) == {1, 2}
    assert "no stable static equilibrium" in result.failures[1]
    assert "kS" in result.failures[2]
    np.testing.assert_array_equal(result.responses[0], result.responses[3])
    travel = (1e6 - np.sqrt(1e12 - 4 * 1e6 * 10000 * G)) / 2e6
    assert equilibria(model, parameters).travels[0, 0] == pytest.approx(travel, rel=1e-11)
    with pytest.raises(InputError, match="no stable static equilibrium"):
        static_loads(model, model.values(overrides={"soft": 4e6}))
    (tmp_path / "run.yaml").write_text("vehicle: quarter_car\nspeed: 1 m/s\nduration: 0.1 s\n")
    simulator = Simulator(soft, [ElementOutput("load", "axle1", "tyre_load")])
    scenario = make_scenario(load_run(tmp_path / "run.yaml"), simulator.model, simulator.model.values())
    with pytest.warns(ModelWarning, match="individual 1: no stable static equilibrium"):
        loads = simulator.run(simulator.parameters([{}, {"soft": 4e6}]), scenario).responses
    np.testing.assert_allclose(loads[0], 11000 * G)


def test_a_spring_that_softens_too_far_is_unstable():
    model = derive(quarter("{law: {force: d*(-2e6 N/m) + (1e9 N/m^3)*d**3, from: unloaded}}"))
    assert "no stable" in equilibria(model, columns(model, mB=10.0)).failures[0]


def test_a_law_may_be_the_whole_spring():
    model = derive(
        quarter(
            "{law: {force: 1e6*d*a + 4e8*a*d**3*b, parameters: {a: 1 N/m, b: 1 m^-2}, from: unloaded}}",
            "parameters: {kS: {value: 0 N/m, range: null}}",
        )
    )
    assert equilibria(model, columns(model)).travels == pytest.approx(equilibria(derive(quarter(CUBIC)), columns(model, kS=1e6)).travels)


CONTACT = """\
bodies:
  floor: {mass: 1 t, motions: [heave]}
  box: {mass: 400 kg, motions: [heave], carried_by: {body: floor, x: 0 m}}
  top: {mass: 100 kg, motions: [heave], carried_by: {body: box, x: 0 m}}
axles: {w: {body: floor, x: 0 m, tyre: {k: 200 kN/m, c: 4 kN s/m}}}
links:
  bed: {floor: {x: 0 m}, box: {x: 0 m}, k: 0 N/m, laws: [{bump_stop: {k: 1.5 MN/m, clearance: GAP, from: unloaded}}]}
  lid: {box: {x: 0 m}, top: {x: 0 m}, k: 0 N/m, laws: [{law: {force: "kk*(d + abs(d))/2", parameters: {kk: 1 MN/m}, from: unloaded}}]}
"""


@pytest.mark.parametrize("gap", [0.0, 0.02])
def test_cargo_that_only_contact_carries_stands_where_contact_does(gap):
    model = derive(parse_vehicle(CONTACT.replace("GAP", f"{gap} m")))
    travels = dict(zip((item.name for item in model.elements), equilibria(model, columns(model)).travels[0], strict=True))
    assert travels == pytest.approx({"w": 1500 * G / 200e3, "bed": gap + 500 * G / 1.5e6, "lid": 100 * G / 1e6}, rel=1e-9)


def test_what_bears_only_so_much_has_no_equilibrium_under_more():
    bears = "{law: {force: 'min(d*(1 MN/m), most)', parameters: {most: 4 kN}, from: unloaded}}"  # 500 kg weigh 4.9 kN
    text = CONTACT.replace("{bump_stop: {k: 1.5 MN/m, clearance: GAP, from: unloaded}}", bears)
    model = derive(parse_vehicle(text))
    assert "no stable static equilibrium" in equilibria(model, columns(model)).failures[0]


def test_what_tips_off_its_contacts_has_no_equilibrium():
    """The COG of a box stands behind both of its contacts: a far stop of the law would catch it a kilometre lower."""
    law = "[{bump_stop: {k: 1.5 MN/m, clearance: 0.01 m, from: unloaded}}]"
    text = f"""\
bodies:
  floor: {{mass: 1 t, motions: [heave]}}
  box: {{mass: 400 kg, pitch_inertia: 50 kg m^2, carried_by: {{body: floor, x: 0 m}}}}
axles: {{w: {{body: floor, x: 0 m, tyre: {{k: 200 kN/m, c: 4 kN s/m}}}}}}
links:
  a: {{floor: {{x: 0.5 m}}, box: {{x: 0.5 m}}, k: 0 N/m, laws: {law}}}
  b: {{floor: {{x: REAR}}, box: {{x: REAR}}, k: 0 N/m, laws: {law}}}
"""
    held = derive(parse_vehicle(text.replace("REAR", "-0.5 m")))
    forces = dict(zip((item.name for item in held.elements), equilibria(held, columns(held)).forces[0], strict=True))
    assert forces == pytest.approx({"w": 1400 * G, "a": 200 * G, "b": 200 * G}, rel=1e-6)
    tipped = derive(parse_vehicle(text.replace("REAR", "0.2 m")))
    assert "no stable static equilibrium" in equilibria(tipped, columns(tipped)).failures[0]


def test_tyres_leave_the_road_at_the_load_that_the_laws_leave_them():
    law = "{cubic_stiffness: {k3: K N/m^3, from: unloaded}}"
    axle = f"{{suspension: {{laws: [{law}]}}, tyre: {{laws: [{{tyre_liftoff: {{}}}}]}}}}\n"
    axles = "".join(f"  axle{i}: {axle.replace('K N', f'{1e9 * i} N')}" for i in range(1, 6))
    outputs = [ElementOutput(f"load{i}", f"axle{i}", "tyre_load") for i in range(1, 6)]
    model = derive(parse_vehicle(f"extends: tractor5\naxles:\n{axles}"), outputs)
    linear = static_loads(derive(parse_vehicle("extends: tractor5\n"))).axles
    loads = static_loads(model).axles
    assert sum(loads.values()) == pytest.approx(sum(linear.values()), rel=1e-12)
    assert max(abs(loads[name] - linear[name]) / linear[name] for name in loads) > 0.02
    time = np.arange(2001) * 1e-3
    w = 0.05 * np.sin(np.pi * np.clip((time[:, None] - 0.2 - 0.2 * np.arange(5)) / 0.15, 0, 1))
    excitation = Excitation(1e-3, w, np.gradient(w, 1e-3, axis=0), np.zeros((2001, 0)))
    dynamic = Kernel(model).run(columns(model), excitation, 1).responses[0]
    least = (dynamic + list(loads.values())).min(axis=0)
    np.testing.assert_allclose(least, 0, atol=1e-6)


@pytest.mark.parametrize(
    ("laws", "message"),
    [
        ("{bump_stop: {k: 1 N/m, clearance: 1 m, from: nowhere}}", "`from` is static or unloaded, found nowhere"),
        ("{dry_friction: {force: 1 N, from: unloaded}}", "dry_friction has no force at rest"),
        ("{asymmetric_friction: {force: 1 N, ratio: 2, from: unloaded}}", "asymmetric_friction has no force at rest"),
        ("{relaxation: {k: 1 N/m, time: 1 s, from: unloaded}}", "relaxation has no force at rest"),
        ("{quadratic_damping: {c2: 1 N s^2/m^2, from: unloaded}}", "quadratic_damping has no force at rest"),
        ("{bump_stop: {k: 1 N/m, clearance: 1 m, frm: static}}", "did you mean 'from'"),
    ],
)
def test_bad_origins_have_their_place(laws, message):
    with pytest.raises(InputError, match=r":\d+:\d+: ") as caught:
        derive(quarter(laws))
    assert message in str(caught.value)


def test_static_is_the_default():
    texts = [Kernel(derive(quarter(f"{{bump_stop: {{k: 1 MN/m, clearance: 6 cm{text}}}}}"))).source.text for text in ("", ", from: static")]
    assert texts[0] == texts[1]


@pytest.mark.parametrize("name", ["sedan2", "tractor5", "road_train"])
def test_axle_loads_of_a_population_carry_its_weights(name):
    model = derive(load_vehicle(name))
    parameters = np.repeat([list(model.values().values())], 5, axis=0) * np.linspace(0.9, 1.1, 5)[:, None]
    loads = axle_loads(model, parameters)
    assert list(loads) == list(model.vehicle.axles)
    for i, row in enumerate(parameters):
        alone = static_loads(model, dict(zip(model.parameters, row, strict=True)))
        assert {key: load[i] for key, load in loads.items()} == pytest.approx(alone.axles, rel=1e-9)
        mass = model.total_mass(dict(zip(model.parameters, row, strict=True)))
        assert sum(load[i] for load in loads.values()) == pytest.approx(9.81 * mass, rel=1e-6)


def test_axles_without_gravity_press_on_nothing():
    model = derive(parse_vehicle("extends: sedan2\ngravity: false\n"))
    loads = axle_loads(model, np.array([list(model.values().values())] * 3))
    assert [load.tolist() for load in loads.values()] == [[0.0] * 3] * 2
