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
from vehgen.mechanics import ElementOutput, Place, PointOutput, derive
from vehgen.mechanics.hinge_forces import far_side
from vehgen.simulate import load_run, simulate
from vehgen.simulate.frequency import maxwell_branches, transfer_functions
from vehgen.simulate.frequency_response import frequency_response
from vehgen.simulate.resonance_lines import oscillating_poles
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

M, MU, K, KT, SPEED = 2000.0, 300.0, 120e3, 900e3, 20.0
"""Body and axle [kg], suspension and tyre [N/m], and the speed [m/s] of :func:`two_masses`."""


def outputs(found):
    return {item.name: item for item in found.outputs}


def two_masses(ratio, relaxation=None):
    """Return the file of a body on an axle whose suspension has a damping ratio, that of the body on it alone, and may relax [N/m, s]."""
    laws = f", laws: [{{relaxation: {{k: {relaxation[0]} N/m, time: {relaxation[1]} s}}}}]" if relaxation else ""
    spring = f"{{k: {K} N/m, c: {2 * ratio * np.sqrt(K * M):.12g} N s/m{laws}}}"
    return (
        f"name: two_masses\nbodies: {{body: {{mass: {M} kg, motions: [heave]}}}}\n"
        f"axles: {{axle: {{body: body, x: 0 m, mass: {MU} kg, suspension: {spring}, tyre: {{k: {KT} N/m}}}}}}"
    )


def two_masses_by_hand(ratio, relaxation=(0.0, 0.0)):
    """Return by output the numerator n of H = s^2 n/d per metre of road, and d: polynomials of s in descending powers.

    A suspension of stiffness S/T, T = 1 + s time, has S = (k + c s) T + k1 s time: Newton's laws of body and axle, multiplied by T.
    """
    k1, time = relaxation
    T = np.poly1d([time, 1.0])
    S = np.poly1d([2 * ratio * np.sqrt(K * M), K]) * T + np.poly1d([k1 * time, 0.0])
    d = np.poly1d([M * MU, 0.0, M * KT, 0.0, 0.0]) * T + S * np.poly1d([M + MU, 0.0, KT])
    return {"body": KT * S, "axle tyre": KT * (np.poly1d([M * MU, 0.0, 0.0]) * T + (M + MU) * S), "axle travel": -KT * M * T}, d


def exact_rms(n, d):
    """Return the RMS on a road of class C at the speed, of H = s^2 n/d: an integral of partial fractions, exact.

    G(f) is C/f^2, so that |H|^2 G is C (2 pi)^2 w^2 |n|^2/|d|^2, a sum of r/(w - p) over the poles p and their conjugates.
    """
    roots = -1j * d.roots
    poles = np.concatenate([roots, roots.conj()])
    total = 0j
    low, high = 2 * np.pi * 0.011 * SPEED, 2 * np.pi * 2.83 * SPEED
    for i, pole in enumerate(poles):
        others = np.prod(pole - np.delete(poles, i)) * abs(d.coeffs[0]) ** 2
        residue = pole**2 * n(1j * pole) * n(-1j * pole) / others
        total += residue * (np.log(high - pole) - np.log(low - pole))
    return np.sqrt(total.real / (2 * np.pi) * (2 * np.pi) ** 2 * 256e-6 * (SPEED * 0.1) ** 2 / SPEED)


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


LIGHTLY = [(0.3, None), (2e-3, None), (5e-5, None), (1e-6, None), (5e-5, (2000.0, 2.0))]


@pytest.mark.parametrize(("ratio", "relaxation"), LIGHTLY)
def test_rms_and_peaks_are_exact_however_light_the_damping(ratio, relaxation):
    found = road_response(parse_vehicle(two_masses(ratio, relaxation)), speed=SPEED, roughness="C")
    numerators, d = two_masses_by_hand(ratio, *([relaxation] if relaxation else []))
    table = {row[0]: row[4:] for row in found.table()[1]}
    near = [p.imag + abs(p.real) * np.linspace(-9.0, 9.0, 9001) for p in d.roots if p.imag > 0]
    s = 1j * np.concatenate([2 * np.pi * np.geomspace(0.011 * SPEED, 2.83 * SPEED, 20001), *near])
    for name, n in numerators.items():
        amplitude = abs(s**2 * n(s) / d(s))
        assert outputs(found)[name].rms == pytest.approx(exact_rms(n, d), rel=1e-3)
        largest, at, loudest = table[name]
        assert largest == pytest.approx(amplitude.max(), rel=1e-3)
        first, second = 2j * np.pi * at, 2j * np.pi * loudest
        assert abs(first**2 * n(first) / d(first)) == pytest.approx(amplitude.max(), rel=2e-3)
        assert abs(second * n(second) / d(second)) == pytest.approx((amplitude / abs(s)).max(), rel=2e-3)


def test_the_poles_of_a_relaxing_suspension_are_those_of_its_polynomial():
    """One that relaxes half of its stiffness in a twentieth of a second moves both poles far."""
    model = derive(parse_vehicle(two_masses(0.1, (K / 2, 0.05))))
    values = model.values()
    roots = two_masses_by_hand(0.1, (K / 2, 0.05))[1].roots
    found = oscillating_poles(model.numeric(values), maxwell_branches(model, values))
    np.testing.assert_allclose(found, sorted(roots[roots.imag > 0], key=lambda root: root.imag), rtol=1e-9)


@pytest.mark.parametrize(("ratio", "relaxation"), LIGHTLY)
def test_the_curves_that_are_kept_have_the_rms_that_is_told(ratio, relaxation):
    found = road_response(parse_vehicle(two_masses(ratio, relaxation)), speed=SPEED, roughness="C")
    columns, rows = found.curves()
    written = [",".join(columns), *(",".join(f"{cell:.9g}" for cell in row) for row in rows)]
    assert len(rows) < 2500
    table = np.loadtxt(written[1:], delimiter=",")
    for i, item in enumerate(found.outputs):
        assert np.sqrt(np.trapezoid(table[:, 4 + 3 * i], table[:, 0])) == pytest.approx(item.rms, rel=0.01)


@pytest.mark.thorough
def test_a_mode_without_damping_is_warned_of(tmp_path, capsys):
    found = road_response(parse_vehicle(two_masses(1e-9)), speed=SPEED, roughness="C")
    assert [note.partition(" has hardly any damping (ratio ")[0] for note in found.notes] == [
        "body heave at 1.157 Hz",
        "axle hop at 9.29 Hz",
    ]
    assert all("body, axle hop, axle travel, axle tyre mean nothing" in note for note in found.notes)
    assert RoadResponse.from_dict(json.loads(json.dumps(found.to_dict(), allow_nan=False))).notes == found.notes
    assert road_response(parse_vehicle(two_masses(1e-5)), speed=SPEED).notes == ()
    path = tmp_path / "undamped.yaml"
    path.write_text(two_masses(0.0))
    assert main(["response", str(path), "--out", str(tmp_path / "out")]) == 0
    assert "warning: axle hop at 9.29 Hz has hardly any damping (ratio 0" in capsys.readouterr().err


def test_what_the_road_does_not_shake_needs_no_damper():
    """Two equal boxes move together: what they would do against each other is damped by nothing and excited by nothing."""

    def loaded(boxes, mass, stiffness):
        box = f"{{mass: {mass} kg, motions: [heave], carried_by: {{body: body, x: 0 m, z: 1 m}}}}"
        links = ", ".join(f"on_{name}: {{body: {{x: 0 m}}, {name}: {{x: 0 m}}, k: {stiffness} kN/m}}" for name in boxes)
        bodies = "".join(f", {name}: {box}" for name in boxes)
        text = two_masses(0.3).replace("[heave]}}", f"[heave]}}{bodies}}}\nlinks: {{{links}}}")
        return road_response(parse_vehicle(text), speed=SPEED)

    found = loaded(["one", "two"], 50, 300)
    assert found.notes == ()
    together = outputs(loaded(["one"], 100, 600))
    for name, same in (("body", "body"), ("one", "one"), ("two", "one"), ("axle tyre", "axle tyre")):
        assert outputs(found)[name].rms == pytest.approx(together[same].rms, rel=3e-4)


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


def test_a_link_is_told_by_its_travel_and_by_what_spring_and_damper_make_of_it():
    """The seat lies under its driver: its travel is that of the two places it joins."""
    found = road_response("tractor5_cab", speed=20.0, places=[Place("below", "cab", "xD")])
    rows = dict(zip(outputs(found), found.amplitude, strict=True))
    omega = 2 * np.pi * found.frequency
    np.testing.assert_allclose(rows["link seat"], np.abs(8e3 + 500j * omega) * rows["link seat travel"], rtol=1e-4)
    phases = {name: np.radians(phase) for name, phase in zip(outputs(found), found.phase, strict=True)}
    apart = rows["driver"] * np.exp(1j * phases["driver"]) - rows["below"] * np.exp(1j * phases["below"])
    near = found.frequency < 5.0  # beyond, two large numbers of six digits differ by little
    np.testing.assert_allclose(rows["link seat travel"][near], (np.abs(apart) / omega**2)[near], rtol=1e-3)
