"""A tyre that leaves the road carries no force at all, whatever other laws it has; against scipy's integrator."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.integrate

from vehgen.simulate import simulate

BODY, AXLE, SPRING, DAMPER, TYRE, GRAVITY = 400.0, 40.0, 20e3, 1.2e3, 180e3, 9.80665
WEIGHT = (BODY + AXLE) * GRAVITY
OTHERS = {
    "hysteresis": "hysteresis: {force: 1 kN, travel: 5 mm}",
    "cubic": "cubic_stiffness: {k3: 2e7 N/m^3}",
    "relaxation": "relaxation: {k: 100 kN/m, time: 20 ms}",
    "progressive": "progressive_stiffness: {k: 200 kN/m, start: 10 mm, from: unloaded}",
    "own": "law: {force: k3*d**3, parameters: {k3: 2e7 N/m^3}}",
    "elasto-plastic": "elasto_plastic: {force: 500 N, k: 100 kN/m}",
    "lift-off again": "tyre_liftoff: {}",
}


def over_a_hump(tmp_path, laws: str) -> np.ndarray:
    """Return the body's displacement and the tyre's load every ms."""
    (tmp_path / "car.yaml").write_text(
        f"name: car\nbodies: {{b: {{mass: {BODY} kg, motions: [heave]}}}}\n"
        f"axles: {{a: {{body: b, x: 0 m, mass: {AXLE} kg, suspension: {{k: {SPRING} N/m, c: {DAMPER} N s/m}}, "
        f"tyre: {{k: {TYRE} N/m, laws: [{laws}]}}}}}}\n"
    )
    (tmp_path / "run.yaml").write_text(
        "vehicle: car.yaml\nspeed: 5 m/s\nduration: 0.8 s\nsample: 1 ms\n"
        "road: [{hump: {shape: versine, length: 0.5 m, height: 0.1 m, at: 0.5 m}}]\n"
        "sensors: {s: {body: b, channels: {displacement: z}}}\noutputs: {load: {axle: a, quantity: tyre_load}}\n"
    )
    return simulate(tmp_path / "run.yaml").values[0]


@pytest.mark.parametrize("other", OTHERS)
@pytest.mark.parametrize("first", [True, False])
def test_a_tyre_with_other_laws_does_not_pull(tmp_path, other, first):
    laws = ["{tyre_liftoff: {}}", f"{{{OTHERS[other]}}}"]
    load = over_a_hump(tmp_path, ", ".join(laws if first else laws[::-1]))[:, 1]
    assert load.min() > -1e-6
    assert (load < 1e-6).sum() > 20


def test_a_cubic_tyre_leaves_the_road_and_comes_back_as_an_exact_one_does(tmp_path):
    def road(t: float) -> float:
        s = 5.0 * t - 0.5
        return 0.05 * (1 - np.cos(2 * np.pi * s / 0.5)) if 0 < s < 0.5 else 0.0

    def load(t: float, axle: float) -> float:
        d = road(t) - axle
        return max(WEIGHT + TYRE * d + 2e7 * d**3, 0.0)

    def rates(t, state):
        body, axle, body_rate, axle_rate = state
        spring = SPRING * (axle - body) + DAMPER * (axle_rate - body_rate)
        return [body_rate, axle_rate, spring / BODY, (load(t, axle) - WEIGHT - spring) / AXLE]

    time = np.arange(801) * 1e-3
    exact = scipy.integrate.solve_ivp(rates, (0, 0.8), np.zeros(4), t_eval=time, rtol=1e-8, atol=1e-10, max_step=1e-3).y
    loads = np.array([load(t, axle) for t, axle in zip(time, exact[1], strict=True)])
    found = over_a_hump(tmp_path, "{tyre_liftoff: {}}, {cubic_stiffness: {k3: 2e7 N/m^3}}")
    assert np.abs(found[:, 0] - exact[0]).max() < 1e-3 * np.abs(exact[0]).max()
    assert np.sqrt(np.mean((found[:, 1] - loads) ** 2)) < 5e-3 * loads.std()
