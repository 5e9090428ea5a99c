"""Every effect: absent at its neutral values, present otherwise, right in its limits."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np
import pytest
from benchmarks.hidden_effects.generator import (
    EFFECTS,
    REFERENCE_RUN,
    SHARP_RUN,
    SILENT,
    Case,
    Effect,
    Hump,
    RunSpec,
    list_effects,
    nominal,
    simulate_case,
)
from benchmarks.hidden_effects.generator.integrate import OutputRow, assemble, integrate
from benchmarks.hidden_effects.generator.library import visibility
from benchmarks.hidden_effects.generator.setup import Reading, Setup
from benchmarks.hidden_effects.generator.simulate import build_road, prepare, wheel_inputs
from benchmarks.hidden_effects.generator.system import GRAVITY
from scipy.integrate import solve_ivp

from tests.hidden_effects import paper_matrices
from tests.hidden_effects.test_generator_exact import sedan_rates, sedan_road

SHORT = {"sedan2": RunSpec((Hump(0.5, 0.03, 1.0),), 3.0, 3.0), "tractor5": RunSpec((Hump(1.0, 0.03, 0.5),), 5.0, 3.8)}


def clean(vehicle, *effects, run=None, **more):
    case = Case(vehicle, nominal(vehicle), effects, (run or SHORT[vehicle],), noise=SILENT, **more)
    return simulate_case(case)[0].clean


@lru_cache
def bare(vehicle, run):
    return clean(vehicle, run=run, step=2e-4)


def distance(one, other):
    return max(np.linalg.norm(one[name] - other[name]) / np.linalg.norm(other[name]) for name in one)


def one_place_each():
    for vehicle in ("sedan2", "tractor5"):
        seen = set()
        for option in list_effects(vehicle):
            if option.name not in seen:
                seen.add(option.name)
                yield pytest.param(vehicle, option, id=f"{vehicle}-{option.name}")


@pytest.mark.thorough
@pytest.mark.parametrize(("vehicle", "option"), list(one_place_each()))
def test_neutral_is_absent_and_visible_is_seen(vehicle, option):
    run = option.run if option.name == "tyre_liftoff" else SHORT[vehicle]
    effect = option.middle()
    if option.name == "tyre_liftoff":
        effect = replace(effect, place="all")
    base = bare(vehicle, run)
    absent = Effect(effect.name, effect.place, {**effect.values, **option.neutral})
    assert distance(clean(vehicle, absent, run=run, step=2e-4), base) < 1e-12
    assert distance(clean(vehicle, effect, run=run, step=2e-4), base) > 0.01


def test_menu_is_complete():
    listed = {
        "dry_friction", "cubic_stiffness", "progressive_stiffness", "bump_stop", "asymmetric_damping", "quadratic_damping", "hysteresis",
        "relaxation", "damper_mount", "damper_free_play",
        "tyre_liftoff", "tyre_damping", "tyre_footprint", "wheel_runout", "hinge_friction", "hinge_stiffness",
        "suspended_cab", "frame_bending", "walking_beam",
        "cargo_module", "engine_harmonic", "sensor_gain", "sensor_position", "sensor_tilt", "sensor_delay", "speed_error",
    }  # fmt: skip
    assert {name for name, kind in EFFECTS.items() if kind.listed} == listed
    assert sum(not kind.listed for kind in EFFECTS.values()) >= 6
    assert {option.name for option in list_effects("tractor5")} == set(EFFECTS)
    assert all(option.neutral for option in list_effects("tractor5"))


def test_draws_stay_in_their_ranges_and_weak_is_weaker():
    rng = np.random.default_rng(1)
    for option in list_effects("sedan2"):
        for level in ("weak", "visible"):
            for name, value in option.draw(rng, level).values.items():
                low, high = getattr(option, level)[name]
                assert low <= value <= high or value == pytest.approx(low)
    option = next(o for o in list_effects("sedan2") if o.name == "cubic_stiffness")
    weak, strong = (visibility(Case("sedan2", runs=(SHORT["sedan2"],), effects=(option.middle(level),))) for level in ("weak", "visible"))
    assert 1.0 < weak < strong


def test_effects_refuse_what_does_not_fit():
    with pytest.raises(ValueError, match="hinge_friction cannot sit at 'rear' of sedan2"):
        clean("sedan2", Effect("hinge_friction", "rear", {"moment": 1.0}))
    with pytest.raises(ValueError, match="cubic_stiffness takes the values k3"):
        clean("sedan2", Effect("cubic_stiffness", "rear", {"k2": 1.0}))


def test_infinitely_stiff_cab_and_frame_are_rigid():
    base = clean("tractor5")
    cab = {"mass_share": 0.15, "damping": 0.1, "half_base": 0.8, "gyration": 0.8, "behind": 0.3, "height": 0.9}
    frame = {"damping": 0.02, "modal_mass_share": 0.8, "participation": 1.0}
    for name, place, values in (("suspended_cab", "tractor", cab), ("frame_bending", "semitrailer", frame)):
        far, further = (distance(clean("tractor5", Effect(name, place, {**values, "frequency": f})), base) for f in (30.0, 120.0))
        assert further < far / 8
        assert further < 2e-3


def test_stiff_cargo_is_a_heavier_body():
    p = nominal("tractor5")
    share, x, z = 0.1, -2.0, 0.7
    mass = share * p["mS"]
    total = mass + p["mS"]
    p2 = dict(p)
    p2["mS"] = total
    p2["b6"] = p["b6"] - mass * x / total
    p2["a2"] = p["a2"] - mass * z / total
    p2["IS"] = p["IS"] + mass * p["mS"] / total * (x * x + z * z)
    heavier = simulate_case(Case("tractor5", p2, (), (SHORT["tractor5"],), noise=SILENT))[0].clean
    cargo = Effect("cargo_module", "semitrailer", {"mass_share": share, "frequency": 200.0, "damping": 0.05, "x": x, "height": z})
    assert distance(clean("tractor5", cargo, step=0.5e-4), heavier) < 1e-3


def test_stiff_hinge_compliance_is_a_pin():
    base = clean("tractor5")
    far, further = (
        distance(clean("tractor5", Effect("hinge_compliance", "fifth_wheel", {"compliance": c, "time": 0.003})), base)
        for c in (1e-9, 1e-10)
    )
    assert further < 0.2 * far
    assert further < 0.01


def test_walking_beam_shares_the_load():
    p = nominal("tractor5")
    case = Case("tractor5", p, (Effect("walking_beam", "axle4+axle5", {"share": 1.0, "split": 0.4}),))
    static = prepare(case).system.static_forces()
    carried = {i: static[f"tyre:axle{i}"] - GRAVITY * p[f"m{i}"] for i in (4, 5)}
    assert carried[4] / (carried[4] + carried[5]) == pytest.approx(0.4, rel=1e-9)


def test_lifted_tyres_never_pull():
    case = Case("tractor5", nominal("tractor5"), (Effect("tyre_liftoff", "all", {"share": 1.0}),), (SHARP_RUN["tractor5"],), noise=SILENT)
    setup = prepare(case)
    run, h = case.runs[0], 1e-4
    road, _ = build_road(setup, run, np.random.default_rng(0), 0.0)
    t = 0.5 * h * np.arange(2 * round(run.duration / h) + 1)
    u = wheel_inputs(setup, road, run.speed, t, 0.5 * h)
    n = len(setup.system.coordinates)
    zero = np.zeros(n)
    at = [setup.system.coordinates.index(f"axle{i}") for i in range(1, 6)]
    motion = integrate(assemble(setup.system, []), u, h, [OutputRow(np.eye(n)[i], zero, zero) for i in at])
    accelerations = integrate(assemble(setup.system, []), u, h, [OutputRow(zero, zero, np.eye(n)[i]) for i in at])
    static = setup.system.static_forces()
    lifted = 0
    for j in range(5):
        pressed = static[f"tyre:axle{j + 1}"] + setup.layout.axles[f"axle{j + 1}"].kt * (u[::2, j] - motion[:, j])
        lifted += np.sum(pressed < 0)
    assert lifted > 50
    assert np.max(np.abs(accelerations)) < 200


@pytest.mark.thorough
def test_free_play_against_events_of_scipy():
    p = nominal("sedan2")
    c, play = p["cf"], 0.006
    found = clean("sedan2", Effect("damper_free_play", "front", {"play": play}), run=RunSpec((Hump(0.5, 0.03, 0.6),), 3.0, 3.0), step=2e-5)
    g = np.array([-1.0, p["Lf"], 1.0, 0.0])
    t, x, mode, e = 0.0, np.zeros(8), 0, 0.0
    kept, out = 0.01 * np.arange(301), [np.zeros(8)]
    while t < 3.0 - 1e-12:
        rates = sedan_rates(p, lambda d, v, s, mode=mode: (0.0 if mode else -c * v, []))
        start = g @ x[:4]

        def switch(t, y, mode=mode, e=e, start=start):
            return mode * (g @ y[4:]) if mode else play / 2 - abs(e + g @ y[:4] - start)

        switch.terminal, switch.direction = True, -1
        part = solve_ivp(rates, (t, 3.0), x, "DOP853", rtol=1e-10, atol=1e-13, max_step=1e-3, events=switch, dense_output=True)
        out += [part.sol(when) for when in kept[(kept > t + 1e-12) & (kept <= part.t[-1])]]
        t, x = part.t[-1], part.y[:, -1]
        if part.status == 1:
            e = mode * play / 2 if mode else float(np.clip(e + g @ x[:4] - start, -play / 2, play / 2))
            mode = 0 if mode else int(np.sign(e))
            e *= 1 - 1e-9
    expected = np.array(out)[:, 5]
    assert np.linalg.norm(found["F_q"] - expected) < 2e-3 * np.linalg.norm(expected)


@pytest.mark.thorough
def test_air_spring_against_scipy_and_its_limits():
    p, kappa, p0, height = nominal("sedan2"), 1.4, 6e5, 0.12
    k, ratio, flow_time, heat_time = 5e4, 2.0, 0.3, 0.8
    A = k * height / (kappa * p0)
    V, tank = A * height, ratio * A * height
    values = {"stiffness": k, "height": height, "volume_ratio": ratio, "flow_time": flow_time, "heat_time": heat_time}
    run = RunSpec((Hump(0.5, 0.03, 0.6),), 3.0, 3.0)
    found = clean("sedan2", Effect("two_chamber_air_spring", "front", values), run=run)

    def force(d, v, s):
        P1, P2, moved = 1 + s[0], 1 + s[1], s[2]
        V1 = V - A * d
        jump = P1 - P2
        flow = (np.sign(jump) * np.sqrt(abs(jump)) if abs(jump) > 1e-4 else 100 * jump) / flow_time
        return A * p0 * s[0], [
            kappa * (P1 * A * v - V * flow) / V1 - (P1 - (1 - moved) * V / V1) / heat_time,
            kappa * V * flow / tank - (P2 - 1 - moved * V / tank) / heat_time,
            flow,
        ]

    answer = solve_ivp(sedan_rates(p, force), (0, 3), np.zeros(11), "DOP853", 0.01 * np.arange(301), rtol=1e-8, atol=1e-11, max_step=2e-3)
    assert np.linalg.norm(found["F_q"] - answer.y[5]) < 1e-5 * np.linalg.norm(answer.y[5])
    closed = {"stiffness": 1e3, "height": 50.0, "volume_ratio": 1.0, "flow_time": 1e6, "heat_time": 1e6}
    stiffer = simulate_case(Case("sedan2", {**p, "kf": p["kf"] + 1e3}, (), (run,), noise=SILENT))[0].clean
    assert distance(clean("sedan2", Effect("two_chamber_air_spring", "front", closed), run=run), stiffer) < 1e-5


def test_fluid_mount_and_hanger_against_scipy():
    p = nominal("sedan2")
    run = RunSpec((Hump(0.5, 0.03, 0.6),), 3.0, 3.0)
    mass, w, zeta = 120.0, 2 * np.pi * 6.0, 0.2

    def fluid(d, v, s):
        return mass * w * w * (d - s[0]), [s[1], w * w * (d - s[0]) - 2 * zeta * w * s[1]]

    answer = solve_ivp(sedan_rates(p, fluid), (0, 3), np.zeros(10), "DOP853", 0.01 * np.arange(301), rtol=1e-9, atol=1e-12, max_step=5e-3)
    found = clean("sedan2", Effect("fluid_mount", "front", {"inertance": mass, "frequency": 6.0, "damping": zeta}), run=run)
    assert np.linalg.norm(found["F_q"] - answer.y[5]) < 2e-6 * np.linalg.norm(answer.y[5])

    M, C, K, P = paper_matrices.sedan(p)
    hung = 0.3 * p["mf"]
    link = np.array([0, 0, 1.0, 0, -1.0])
    wide = [np.pad(X, (0, 1)) for X in (M, C, K)]
    wide[0][4, 4] = hung
    wide[1] += 2 * zeta * hung * w * np.outer(link, link)
    wide[2] += hung * w * w * np.outer(link, link)
    dt = 5e-5
    heights = np.array([sedan_road(p)(t) for t in dt * np.arange(60001)])
    _, v, _ = paper_matrices.first_order_hold(*wide, np.vstack([P, np.zeros((1, 2))]), heights, dt)
    found = clean("sedan2", Effect("axle_hanger", "front", {"mass_share": 0.3, "frequency": 6.0, "damping": zeta}), run=run)
    assert np.linalg.norm(found["F_q"] - v[::200, 1]) < 1e-5 * np.linalg.norm(v[::200, 1])


def test_measurement_effects_do_what_they_say():
    base = clean("tractor5")
    gain = clean("tractor5", Effect("sensor_gain", "L1_az", {"error": 0.2}))
    np.testing.assert_allclose(gain["L1_az"], 1.2 * base["L1_az"])
    np.testing.assert_array_equal(gain["L1_q"], base["L1_q"])
    late = clean("tractor5", Effect("sensor_delay", "L2", {"time": 0.02}))
    np.testing.assert_allclose(late["L2_q"][2:], base["L2_q"][:-2], atol=1e-12)
    np.testing.assert_array_equal(late["L1_q"], base["L1_q"])
    shifted = clean("tractor5", Effect("sensor_position", "L1", {"shift": 0.5}))
    between = clean("tractor5", Effect("sensor_position", "L1", {"shift": 0.25}))
    np.testing.assert_allclose(between["L1_az"], 0.5 * (base["L1_az"] + shifted["L1_az"]), atol=1e-12)
    fast = clean("tractor5", Effect("speed_error", "all", {"error": 0.1}))
    truly = clean("tractor5", run=RunSpec(SHORT["tractor5"].road, 5.5, 3.8))
    assert distance(fast, truly) < 1e-12


def test_tilt_sees_pitch_through_gravity():
    slow = RunSpec((Hump(60.0, 0.5, 1.0),), 1.0, 70.0)
    angle = 0.3
    base = clean("sedan2", run=slow, step=5e-4)
    tilted = clean("sedan2", Effect("sensor_tilt", "F", {"angle": angle}), run=slow, step=5e-4)
    theta = np.concatenate([[0.0], np.cumsum(0.5 * (base["F_q"][1:] + base["F_q"][:-1]) * 0.01)])
    leak = tilted["F_az"] - np.cos(angle) * base["F_az"]
    assert np.linalg.norm(leak + GRAVITY * np.sin(angle) * theta) < 1e-3 * np.linalg.norm(leak)


def test_engine_runs_before_the_recording_starts():
    found = clean("sedan2", Effect("engine_harmonic", "body", {"amplitude": 300.0, "frequency": 20.0, "drift": 0.0, "x": 0.3}))
    lead = found["F_az"][:30]
    assert np.std(lead) > 0.05
    assert abs(np.mean(lead[:25])) < 0.2 * np.std(lead)


def test_setup_starts_without_effects():
    setup = prepare(Case("sedan2", runs=(REFERENCE_RUN["sedan2"],)))
    assert isinstance(setup, Setup)
    assert all(reading == Reading() for reading in setup.readings.values())
