"""The generator against things that share no code with it: exact linear solutions, scipy's integrators with events, energy."""

from __future__ import annotations

import numpy as np
import pytest
from benchmarks.hidden_effects.generator import SILENT, Case, Effect, Hump, RunSpec, nominal, perturbed, simulate_case
from benchmarks.hidden_effects.generator.integrate import OutputRow, assemble, integrate
from benchmarks.hidden_effects.generator.laws import CUBIC
from benchmarks.hidden_effects.generator.system import Law, base_system
from benchmarks.hidden_effects.generator.vehicles import layout
from scipy.integrate import solve_ivp
from scipy.linalg import eigh

from tests.hidden_effects import paper_matrices

HUMP = RunSpec((Hump(0.5, 0.03, 0.6),), 3.0, 3.0)


def recorded(effects, p, run=HUMP, **more):
    return simulate_case(Case("sedan2", p, tuple(effects), (run,), noise=SILENT, **more))[0].clean


def sedan_road(p, run=HUMP):
    hump = run.road[0]

    def heights(t):
        s = run.speed * t - np.array([0.0, p["wheelbase"]]) - hump.at
        return np.where((s > 0) & (s < hump.length), hump.height * np.sin(np.pi * s / hump.length), 0.0)

    return heights


@pytest.mark.thorough
@pytest.mark.parametrize(
    ("vehicle", "matrices", "wheels"),
    [("sedan2", paper_matrices.sedan, [0.0, 2.8]), ("tractor5", paper_matrices.tractor, [0.0, 3.46, 4.8, 12.25, 13.48])],
)
def test_linear_vehicle_is_the_exact_solution(vehicle, matrices, wheels):
    p = perturbed(vehicle, 4)
    run = RunSpec((Hump(0.5, 0.03, 1.0),), 2.5, 8.0)
    dt = 2.5e-5
    t = dt * np.arange(round(run.duration / dt) + 1)
    s = run.speed * t[:, None] - np.array(wheels) - 1.0
    road = np.where((s > 0) & (s < 0.5), 0.03 * np.sin(np.pi * s / 0.5), 0.0)
    _, v, a = paper_matrices.first_order_hold(*matrices(p), road, dt)
    clean = simulate_case(Case(vehicle, p, runs=(run,), noise=SILENT))[0].clean
    rows = {"F": (1, p.get("Lf")), "R": (1, p.get("Lf", 0) - 2.8)} if vehicle == "sedan2" else {"L1": (1, p["b1"] + 0.29), "L2": (2, None)}
    for sensor, (pitch, x) in rows.items():
        expected = a[:, 0] + (p["L1h"] - p["b1"]) * a[:, 1] + 9.115 * a[:, 2] if x is None else a[:, 0] - x * a[:, 1]
        for name, values in ((f"{sensor}_az", expected), (f"{sensor}_q", v[:, pitch])):
            kept = values[:: round(0.01 / dt)]
            assert np.linalg.norm(clean[name] - kept) < 1e-6 * np.linalg.norm(kept)


def test_natural_frequencies():
    for vehicle, expected in (
        ("sedan2", [1.312, 1.643, 10.77, 14.39]),
        ("tractor5", [1.244, 2.711, 3.238, 12.00, 13.05, 16.65, 17.03, 19.55]),
    ):
        model = assemble(base_system(layout(vehicle, nominal(vehicle))), [])
        squares = np.sort(np.linalg.eigvals(-model.Aq).real)
        found = np.sqrt(squares[-len(expected) :]) / (2 * np.pi)
        np.testing.assert_allclose(found, expected, rtol=1e-3)
        assert np.all(np.abs(squares[: -len(expected)]) < 1e-6)


def test_pin_forces_hold_the_pin_together():
    system = base_system(layout("tractor5", perturbed("tractor5", 2)))
    mobility, pins = system.mobility()
    J, M = system.constraint_matrix(), system.mass_matrix()
    np.testing.assert_allclose(J @ mobility, 0.0, atol=1e-15)
    np.testing.assert_allclose(M @ mobility, np.eye(len(M)) + J.T @ pins, atol=1e-9)


def test_static_loads_carry_the_weight():
    for vehicle, masses in (("sedan2", ["mH", "mf", "mr"]), ("tractor5", ["mT", "mS", "m1", "m2", "m3", "m4", "m5"])):
        p = nominal(vehicle)
        static = base_system(layout(vehicle, p)).static_forces()
        tyres = sum(force for name, force in static.items() if name.startswith("tyre"))
        assert tyres == pytest.approx(9.81 * sum(p[name] for name in masses), rel=1e-9)
    assert base_system(layout("sedan2", nominal("sedan2"))).static_forces()["tyre:front"] == pytest.approx(
        9.81 * (1500 * 1.62 / 2.8 + 90), rel=1e-9
    )


def sedan_rates(p, force):
    """Return x' = f(t, x) of the sedan with a force [N] of (d, v, own states) on its front suspension."""
    M, C, K, P = paper_matrices.sedan(p)
    g = np.array([-1.0, p["Lf"], 1.0, 0.0])
    road = sedan_road(p)

    def rates(t, x):
        q, v, own = x[:4], x[4:8], x[8:]
        f, own_rates = force(g @ q, g @ v, own)
        return np.concatenate([v, np.linalg.solve(M, P @ road(t) - C @ v - K @ q - g * f), own_rates])

    return rates


LAWS = {
    "cubic_stiffness": ({"k3": 2e8}, lambda d, v, s: (2e8 * d**3, []), 0),
    "quadratic_damping": ({"c2": 5e3}, lambda d, v, s: (5e3 * v * abs(v), []), 0),
    "hysteresis": (
        {"force": 600.0, "travel": 0.004, "beta": 0.7},
        lambda d, v, s: (600.0 * s[0], [(v - 0.7 * abs(v * s[0]) * s[0] - 0.3 * v * s[0] ** 2) / 0.004]),
        1,
    ),
    "relaxation": ({"k": 8e4, "time": 0.05}, lambda d, v, s: (s[0], [8e4 * v - s[0] / 0.05]), 1),
    "asymmetric_damping": ({"ratio": 0.4}, lambda d, v, s: (2.18 * 1500 * (v / 0.7 * (0.4 if v > 0 else 1.0) - v), []), 0),
    "bump_stop": (
        {"k": 6e5, "clearance": 0.008, "rebound": 0.006},
        lambda d, v, s: (6e5 * (max(d - 0.008, 0.0) - max(-d - 0.006, 0.0)), []),
        0,
    ),
    "position_damping": ({"c": 6e3, "travel": 0.02}, lambda d, v, s: (6e3 * (d / 0.02) ** 2 * v, []), 0),
}


@pytest.mark.thorough
@pytest.mark.parametrize("name", LAWS)
def test_laws_against_scipy(name):
    p = nominal("sedan2")
    values, force, n_states = LAWS[name]
    clean = recorded([Effect(name, "front", values)], p)
    t = 0.01 * np.arange(301)
    answer = solve_ivp(sedan_rates(p, force), (0, 3), np.zeros(8 + n_states), "DOP853", t, rtol=1e-9, atol=1e-12, max_step=5e-3)
    assert np.linalg.norm(clean["F_q"] - answer.y[5]) < 2e-6 * np.linalg.norm(answer.y[5])


def friction_with_events(p, F):
    """Return t and velocities of the sedan with Coulomb friction in front: modes stick, slip up and down, switched at events of scipy."""
    M, C, K, P = paper_matrices.sedan(p)
    g = np.array([-1.0, p["Lf"], 1.0, 0.0])
    road = sedan_road(p)
    give = g @ np.linalg.solve(M, g)

    def pull(t, x):
        return P @ road(t) - C @ x[4:] - K @ x[:4]

    def holding(t, x):
        return g @ np.linalg.solve(M, pull(t, x)) / give

    kept = 0.01 * np.arange(301)
    t, x, mode, out = 0.0, np.zeros(8), 0, [np.zeros((8, 1))]
    while t < 3.0 - 1e-12:

        def rates(t, x, mode=mode):
            f = F * mode if mode else holding(t, x)
            return np.concatenate([x[4:], np.linalg.solve(M, pull(t, x) - g * f)])

        def stop(t, x, mode=mode):
            return mode * (g @ x[4:]) if mode else F - abs(holding(t, x))

        stop.terminal, stop.direction = True, -1
        grid = kept[(kept > t + 1e-12)]
        part = solve_ivp(rates, (t, 3.0), x, "DOP853", rtol=1e-10, atol=1e-13, max_step=1e-3, events=stop, dense_output=True)
        inside = grid[grid <= part.t[-1]]
        if len(inside):
            out.append(part.sol(inside))
        t, x = part.t[-1], part.y[:, -1].copy()
        if part.status == 1:
            if mode:
                x[4:] -= np.linalg.solve(M, g) * (g @ x[4:]) / give
            hold = holding(t, x)
            mode = int(np.sign(hold)) if mode == 0 or abs(hold) > F else 0
    return kept, np.hstack(out)


@pytest.mark.thorough
def test_friction_against_events_of_scipy():
    p = nominal("sedan2")
    force = 700.0
    clean = recorded([Effect("dry_friction", "front", {"force": force})], p)
    t, x = friction_with_events(p, force)
    assert len(t) == x.shape[1]
    slip = np.abs(np.array([-1.0, p["Lf"], 1.0, 0.0]) @ x[4:])
    assert 0.2 < np.mean(slip < 1e-9) < 0.9
    assert np.linalg.norm(clean["F_q"] - x[5]) < 2e-4 * np.linalg.norm(x[5])
    finer = recorded([Effect("dry_friction", "front", {"force": force})], p, step=1e-5)
    assert np.linalg.norm(finer["F_q"] - x[5]) < 2e-5 * np.linalg.norm(x[5])


def test_energy_is_conserved_without_damping_and_lost_to_friction():
    p = perturbed("tractor5", 6)
    for name in [name for name in p if name[0] == "c"]:
        p[name] = 0.0
    rng = np.random.default_rng(0)
    for friction in (0.0, 3e3):
        system = base_system(layout("tractor5", p))
        system.elements["suspension:axle3"].laws.append(Law(CUBIC, (2e10,)))
        for axle in ("axle1", "axle4"):
            system.elements[f"suspension:{axle}"].dry = friction
        n = len(system.coordinates)
        mobility, _ = system.mobility()
        v0 = mobility @ rng.standard_normal(n) * 2e3
        zero = np.zeros(n)
        outputs = [OutputRow(row, zero, zero) for row in np.eye(n)] + [OutputRow(zero, row, zero) for row in np.eye(n)]
        motion = integrate(assemble(system, []), np.zeros((2 * 20000 + 1, 10)), 1e-4, outputs, v0=v0)
        q, v = motion[:, :n], motion[:, n:]
        energy = 0.5 * np.einsum("ti,ij,tj->t", v, system.mass_matrix(), v)
        for name, element in system.elements.items():
            d = q @ system.row(element.terms)
            energy += 0.5 * element.k * d**2 + (2e10 / 4 * d**4 if name == "suspension:axle3" else 0.0)
        if friction == 0.0:
            assert np.max(np.abs(energy / energy[0] - 1)) < 1e-8
            assert np.max(np.abs(q @ system.row(system.elements["suspension:axle3"].terms))) > 0.003
        else:
            assert np.max(np.diff(energy)) < 1e-6 * energy[0]
            assert energy[-1] < 0.8 * energy[0]


def test_modes_by_two_routes():
    p = perturbed("tractor5", 9)
    M, _, K, _ = paper_matrices.tractor(p)
    expected = np.sqrt(eigh(K, M, eigvals_only=True))
    found = np.sqrt(np.sort(np.linalg.eigvals(-assemble(base_system(layout("tractor5", p)), []).Aq).real)[-8:])
    np.testing.assert_allclose(found, expected, rtol=1e-8)
