"""What must hold for force laws beyond their numbers: zero strength, parked vehicles, energy, failures."""

import numpy as np
import pytest
import scipy.linalg

from vehgen.codegen import Excitation, Kernel
from vehgen.errors import InputError
from vehgen.mechanics import Place, PointOutput, derive
from vehgen.mechanics.laws import LAWS
from vehgen.mechanics.static_loads import element_rows
from vehgen.vehicle import load_vehicle, parse_vehicle

OUTPUTS = (
    PointOutput("a", Place("L1", "body"), "acceleration"),
    PointOutput("z", Place("L1", "body"), "displacement"),
    PointOutput("v", Place("L1", "body"), "velocity"),
    PointOutput("q", Place("L1", "body"), "pitch_rate"),
)
VALUES = {
    "clearance": "5 mm",
    "play": "2 mm",
    "rebound": "5 mm",
    "start": "2 mm",
    "time": "20 ms",
    "travel": "2 mm",
    "ratio": "0.5",
    "beta": "0.6",
    "share": "0",
}
UNITS = {"force": "N", "k": "N/m", "k3": "N/m^3", "k2": "N/m^2", "c": "N s/m", "c2": "N s^2/m^2"}


def sedan(laws, part="suspension", extra=""):
    axles = "".join(f"  {axle}: {{{part}: {{laws: [{laws}]}}}}\n" for axle in ("front", "rear"))
    return parse_vehicle(f"extends: sedan2\naxles:\n{axles}{extra}")


def hump(model, duration=2.0, height=0.03):
    time = np.arange(round(duration / 1e-3) + 1) * 1e-3
    s = time[:, None] * 3.0 - model.wheel_offsets() - 0.3
    inside = (s > 0) & (s < 0.5)
    w = np.where(inside, height * np.sin(np.pi * s / 0.5), 0.0)
    dw = np.where(inside, 3 * height * np.pi / 0.5 * np.cos(np.pi * s / 0.5), 0.0)
    return Excitation(1e-3, w, dw, np.zeros((len(time), 0)))


def run(vehicle, excitation=None, outputs=OUTPUTS, initial=None, **changes):
    model = derive(vehicle, outputs)
    parameters = np.array([list(model.values(overrides=changes).values())])
    return model, Kernel(model).run(parameters, excitation or hump(model), 1, initial=initial)


@pytest.mark.parametrize("name", sorted(LAWS))
def test_a_law_of_no_strength_is_the_linear_vehicle(name):
    law = LAWS[name]
    given = {
        item.name: VALUES.get(item.name, f"1 {UNITS.get(item.name, '')}")
        for item in law.parameters
        if item.default is None or item.name in VALUES
    }
    given[law.strength] = f"0 {UNITS.get(law.strength, '')}".strip()
    text = ", ".join(f"{key}: {value}" for key, value in given.items())
    _, found = run(sedan(f"{{{name}: {{{text}}}}}", "tyre" if name == "tyre_liftoff" else "suspension"))
    _, linear = run(load_vehicle("sedan2"))
    for column in range(len(OUTPUTS)):
        expected = linear.responses[0, :, column]
        assert np.abs(found.responses[0, :, column] - expected).max() <= 1e-10 * np.abs(expected).max()


def test_a_force_of_parameters_alone_moves_the_vehicle():
    """A law that depends on no motion is a constant force: the answer from rest is that of the matrix exponential."""
    vehicle = sedan("{law: {force: push/2}}", extra="parameters: {push: {value: 900 N}}\n")
    model, found = run(vehicle, hump(derive(vehicle), height=0.0))
    numeric, n = model.numeric(), model.n_dof
    rows, _ = element_rows(model, model.values())
    push = -sum(450.0 * rows[i] for i, element in enumerate(model.elements) if element.laws)
    system = np.zeros((2 * n + 1, 2 * n + 1))
    system[:n, n : 2 * n] = np.eye(n)
    system[n : 2 * n, : 2 * n] = -np.linalg.solve(numeric.M, np.hstack([numeric.K, numeric.C]))
    system[n : 2 * n, -1] = np.linalg.solve(numeric.M, push)
    for sample in (100, 500, 2000):
        state = scipy.linalg.expm(1e-3 * sample * system)[: 2 * n, -1]
        expected = (numeric.outputs["displacement"] @ state[:n])[1]
        assert found.responses[0, sample, 1] == pytest.approx(expected, rel=1e-3)


def test_a_tyre_of_no_stiffness_carries_nothing():
    """Its contact force is always zero, so leaving the road changes nothing."""
    text = (
        "bodies:\n  body: {mass: 1 t, motions: [heave]}\n"
        "axles:\n  a: {body: body, x: 0 m, mass: 50 kg, suspension: {k: 20 kN/m, c: 1 kN s/m}, tyre: {k: 0 N/m, LAW}}\n"
        "  b: {body: body, x: 0 m, tyre: {k: 90 kN/m, c: 1 kN s/m}}\n"
    )
    moved = [
        run(vehicle, hump(derive(vehicle)), (PointOutput("z", Place("L1", "body"), "displacement"),))[1].responses
        for vehicle in (parse_vehicle(text.replace(", LAW", law)) for law in (", laws: [{tyre_liftoff: {}}]", ""))
    ]
    assert np.abs(moved[1]).max() > 1e-3
    np.testing.assert_allclose(moved[0], moved[1], rtol=0, atol=1e-12)


def test_friction_holds_a_parked_vehicle_still():
    """A push below the friction of both suspensions leaves the body standing on its tyres."""
    vehicle = sedan("{dry_friction: {force: 2 kN}}")
    model = derive(vehicle, OUTPUTS, [Place("push", "body")])
    time = np.arange(8001) * 1e-3
    force = np.where(time > 0.5, 1500.0, 0.0)[:, None] * np.minimum((time[:, None] - 0.5) / 3, 1).clip(0)
    quiet = np.zeros((len(time), 2))
    parameters = np.array([list(model.values().values())])
    z = Kernel(model).run(parameters, Excitation(1e-3, quiet, quiet, force), 1).responses[0, :, 1]
    values = model.values()
    on_tyres = 1500.0 / (values["ktf"] + values["ktr"])
    on_springs = 1500.0 / (1 / (1 / values["ktf"] + 1 / values["kf"]) + 1 / (1 / values["ktr"] + 1 / values["kr"]))
    assert z[-1] < 2 * on_tyres
    assert on_springs > 5 * on_tyres
    still = sedan("{dry_friction: {force: 2 kN}}", extra="")
    model = derive(still, OUTPUTS)
    nothing = Excitation(1e-3, quiet, quiet, np.zeros((len(time), 0)))
    assert not Kernel(model).run(parameters[:, : len(model.parameters)], nothing, 1).responses.any()


@pytest.mark.parametrize(
    "laws", ["{dry_friction: {force: 500 N}}", "{elasto_plastic: {force: 500 N, k: 3e5 N/m}}", "{quadratic_damping: {c2: 9e3 N s^2/m^2}}"]
)
def test_energy_never_grows(laws):
    """Released from a push, an undamped vehicle with a dissipative law only loses energy."""
    undamped = "parameters: {cf: {value: 0 N s/m}, cr: {value: 0 N s/m}}\n"
    vehicle = sedan(laws, extra=undamped.replace("0 N s/m}", "0 N s/m, range: null}"))
    model = derive(
        vehicle,
        [
            PointOutput(f"{kind}{i}", Place(f"p{i}", "body", x=None), kind)
            for i in range(1)
            for kind in ("displacement", "velocity", "pitch", "pitch_rate")
        ],
    )
    n = model.n_dof
    numeric = model.numeric()
    initial = np.zeros(2 * n)
    initial[:2] = 0.02, 0.01
    rest = np.zeros((3001, 2))
    kernel = Kernel(model)
    parameters = np.array([list(model.values().values())])
    states = []
    for steps in range(0, 1501, 25):
        excitation = Excitation(1e-3, rest[: steps + 1], rest[: steps + 1], np.zeros((steps + 1, 0)))
        states.append(kernel.run(parameters, excitation, max(steps, 1), initial=initial[None]).responses[0, -1])
    assert np.isfinite(states).all()
    body = np.array(states)
    kinetic = 0.5 * numeric.M[0, 0] * body[:, 1] ** 2 + 0.5 * numeric.M[1, 1] * body[:, 3] ** 2
    start = 0.5 * initial[:n] @ numeric.K @ initial[:n]
    assert kinetic.max() <= start
    assert kinetic[-10:].max() < 0.5 * kinetic.max()


def test_residuals_are_reported_and_divergence_is_a_failure():
    _, good = run(sedan("{hysteresis: {force: 400 N, travel: 3 mm}}"))
    assert 0 < good.residuals[0] < 10
    assert not good.failures
    _, bad = run(sedan("{law: {force: -a*d**3, parameters: {a: 1e12 N/m^3}}}"))
    assert 0 in bad.failures


def test_unknown_laws_and_wrong_units_have_their_place():
    for laws, message in (
        ("{dry_frction: {force: 1 N}}", "unknown force law 'dry_frction'; did you mean 'dry_friction'"),
        ("{dry_friction: {forc: 1 N}}", "dry_friction has no parameter 'forc'; did you mean 'force'"),
        ("{dry_friction: {}}", "lacks its parameter 'force'"),
        ("{dry_friction: {force: 2 * (mH - 2500 kg) * 1 m/s^2}}", "force of dry_friction must not be below 0, found -2000"),
        ("{dry_friction: {force: -500 N}}", "force of dry_friction must not be below 0, found -500"),
        ("{dry_friction: {force: kf * 1 mm - 30 N}}", "force of dry_friction must not be below 0, found -10 at the end of the range of kf"),
        ("{relaxation: {k: 30 kN/m, time: 0 s}}", "time of relaxation must be above 0, found 0"),
        ("{hysteresis: {force: 300 N, travel: 0 mm}}", "travel of hysteresis must be above 0, found 0"),
        ("{asymmetric_damping: {c: 1 kN s/m, ratio: 0.3, relief: 1.5}}", "relief of asymmetric_damping must be at most 1, found 1.5"),
        ("{relaxation: {k: -500 kN/m, time: 0.1 s}}", "k of relaxation must not be below 0, found -500000"),
        ("{cubic_stiffness: {k3: 1 N/m}}", "k3 must be in"),
        ("{tyre_liftoff: {}}", "belongs on a tyre, not on a suspension"),
        ("{law: {force: a*d, parameters: {a: 1 N}}}", "force must be in N"),
        ("{law: {force: F*sign(v), parameters: {F: 600 N}}}", "jumps, or is infinitely steep, where v passes 0: dry friction is the law"),
        ("{law: {force: F*sign(v)*d/l, parameters: {F: 600 N, l: 1 m}}}", "infinitely steep, where v passes 0"),
        ("{law: {force: F*sign(d), parameters: {F: 60 N}}}", "infinitely steep, where d passes 0"),
        ("{law: {force: 'F*sqrt(max(v, 0 m/s)/u)', parameters: {F: 60 N, u: 1 m/s}}}", "infinitely steep, where v passes 0"),
        ("{law: {force: k*d/abs(d)*1 m, parameters: {k: 60 N/m}}}", "the force has no value at d = 0, v = 0: "),
        ("{law: {force: k*(d/l)**1.5, parameters: {k: 60 N, l: 1 m}}}", "the force has no value at d = -0.0001, v = 0: "),
        ("{law: {force: a*dd, parameters: {a: 1 N}}}", "unknown symbol 'dd'"),
    ):
        with pytest.raises(InputError, match=r":\d+:\d+: ") as caught:
            derive(sedan(laws))
        assert message in str(caught.value)


def test_hinge_friction_locks_the_articulation():
    text = "extends: tractor5\nhinges:\n  fifth_wheel: {laws: [{dry_friction: {force: MOMENT}}]}\n"
    outputs = [PointOutput("t", Place("T", "tractor"), "pitch"), PointOutput("s", Place("S", "semitrailer"), "pitch")]
    apart = []
    for moment in ("0 N m", "5 MN m"):
        vehicle = parse_vehicle(text.replace("MOMENT", moment))
        model = derive(vehicle, outputs)
        time = np.arange(4001) * 1e-3
        w = np.where((time[:, None] * 2 - model.wheel_offsets() - 0.5) > 0, 0.02, 0.0)
        excitation = Excitation(1e-3, w, 0 * w, np.zeros((len(time), 0)))
        pitch = Kernel(model).run(np.array([list(model.values().values())]), excitation, 1).responses[0]
        apart.append(np.abs(pitch[:, 0] - pitch[:, 1]).max())
    assert apart[1] < 0.02 * apart[0]


@pytest.mark.parametrize(
    ("own", "same"),
    [
        ("c1*v*(1 + sign(v)/2)", "c1*(v + abs(v)/2)"),
        ("c1*abs(v)*sign(v)", "c1*v"),
        ("F*(1 - (l/(l - d))**1.4) - c1*v", "F*(1 - (1 - d/l)**-1.4) - c1*v"),
        ("sign(d - 1 m)*c1*v", "-c1*v"),
    ],
)
def test_sign_may_stand_in_a_force_that_does_not_jump(own, same):
    laws = [f"{{law: {{force: '{text}', parameters: {{c1: 600 N s/m, F: 500 N, l: 1 m}}}}}}" for text in (own, same)]
    first, second = (run(sedan(text))[1].responses[0] for text in laws)
    assert np.abs(first).max() > 0
    np.testing.assert_allclose(first, second, rtol=0, atol=1e-9 * np.abs(second).max())
