"""Any layout: the symbolic derivation against force balances, and what must hold for every vehicle."""

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tests.oracles.layouts import random_layout, rigid_translation, to_yaml
from tests.oracles.newton_euler import assemble
from vehgen.codegen import Excitation, Kernel
from vehgen.mechanics import Place, PointOutput, derive, static_loads
from vehgen.simulate import newmark_response
from vehgen.vehicle import parse_vehicle

LIGHT = settings(max_examples=25, deadline=None, derandomize=True, suppress_health_check=[HealthCheck.too_slow])


def build(seed: int):
    layout = random_layout(np.random.default_rng(seed))
    model = derive(parse_vehicle(to_yaml(layout)))
    return layout, model, model.numeric()


@LIGHT
@given(st.integers(0, 10**9))
def test_force_balances_give_the_same_equations(seed):
    layout, model, numeric = build(seed)
    other = assemble(layout)
    names = [item.name for item in model.coordinates]
    assert sorted(names) == sorted(other.coordinates)
    assert list(model.inputs) == other.inputs
    order = [other.coordinates.index(name) for name in names]
    for key in ("M", "C", "K"):
        mine, theirs = getattr(numeric, key), getattr(other, key)[np.ix_(order, order)]
        np.testing.assert_allclose(mine, theirs, rtol=1e-10, atol=1e-10 * np.abs(theirs).max(initial=1e-300))
    for key in ("P", "Q", "weight"):
        mine, theirs = getattr(numeric, key), getattr(other, key)[order]
        np.testing.assert_allclose(mine, theirs, rtol=1e-10, atol=1e-10 * np.abs(theirs).max(initial=1e-300))


@LIGHT
@given(st.integers(0, 10**9))
def test_matrices_are_definite_and_translation_needs_no_force(seed):
    layout, model, numeric = build(seed)
    for matrix in (numeric.M, numeric.C, numeric.K):
        np.testing.assert_allclose(matrix, matrix.T, rtol=1e-12, atol=1e-14 * np.abs(matrix).max())
    scale = np.sqrt(np.diag(numeric.M))
    assert np.linalg.eigvalsh(numeric.M / np.outer(scale, scale)).min() > 0
    for matrix in (numeric.C, numeric.K):
        assert np.linalg.eigvalsh(matrix).min() > -1e-9 * np.abs(matrix).max()
    rise = rigid_translation([item.name for item in model.coordinates])
    push = numeric.P.sum(axis=1)
    np.testing.assert_allclose(numeric.K @ rise, push, atol=1e-9 * np.abs(numeric.K).max())
    assert numeric.weight @ rise == pytest.approx(
        -9.81 * (sum(b["mass"] for b in layout["bodies"].values()) + sum(a["mass"] or 0 for a in layout["axles"].values()))
    )


@LIGHT
@given(st.integers(0, 10**9))
def test_axles_and_ground_links_carry_the_whole_weight(seed):
    layout, model, _ = build(seed)
    loads = static_loads(model)
    carried = sum(loads.axles.values()) + sum(
        force for (kind, name), force in loads.elements.items() if kind == "link" and "ground" in layout["links"][name]["points"]
    )
    total = 9.81 * (sum(b["mass"] for b in layout["bodies"].values()) + sum(a["mass"] or 0 for a in layout["axles"].values()))
    assert carried == pytest.approx(total, rel=1e-8)


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_kernel_follows_the_oracle_and_keeps_the_energy_of_free_motion(seed, tmp_path):
    layout = random_layout(np.random.default_rng(seed))
    for part in (*layout["links"].values(), *layout["hinges"].values(), *(a["tyre"] for a in layout["axles"].values())):
        part["c"] = 0.0
    for axle in layout["axles"].values():
        if axle["suspension"]:
            axle["suspension"]["c"] = 0.0
    vehicle = parse_vehicle(to_yaml(layout))
    outputs = [
        PointOutput(f"{quantity}{i}", Place(name, name), quantity)
        for i, name in enumerate(vehicle.bodies)
        for quantity in ("displacement", "acceleration")
    ]
    model = derive(vehicle, outputs)
    n, steps = model.n_dof, 400
    rng = np.random.default_rng(seed)
    initial = np.concatenate([rng.normal(0, 0.01, n), rng.normal(0, 0.1, n)])
    rest = np.zeros((steps + 1, len(model.inputs)))
    excitation = Excitation(1e-3, rest, rest, np.zeros((steps + 1, 0)))
    parameters = np.array([list(model.values().values())])
    response = Kernel(model, tmp_path).run(parameters, excitation, decimation=1, initial=initial[None, :]).responses[0]
    oracle = newmark_response(model, excitation, 1, initial=initial)
    assert (np.abs(response - oracle) <= 1e-10 * np.abs(oracle).max(axis=0)).all()
    numeric = model.numeric()
    q, v = _states(numeric, excitation, initial)
    energy = 0.5 * np.einsum("ti,ij,tj->t", v, numeric.M, v) + 0.5 * np.einsum("ti,ij,tj->t", q, numeric.K, q)
    assert np.ptp(energy) < 1e-9 * energy[0]


def _states(numeric, excitation, initial):
    """Displacements and velocities of the midpoint form, step by step in numpy."""
    n, h = len(numeric.M), excitation.dt
    q, v = [initial[:n]], [initial[n:]]
    A = 2 / h * numeric.M + numeric.C + h / 2 * numeric.K
    for _ in range(excitation.n_steps):
        middle = np.linalg.solve(A, 2 / h * numeric.M @ v[-1] - numeric.K @ q[-1])
        q.append(q[-1] + h * middle)
        v.append(2 * middle - v[-1])
    return np.array(q), np.array(v)
