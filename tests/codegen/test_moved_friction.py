"""Dry friction between a body and what the road or a shaker moves, against Moreau's time stepping in far shorter steps."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from vehgen.simulate import simulate

SHORT = 2e-6
"""Step of the reference [s]."""
BODY, AXLE, SPRING, DAMPER, TYRE, SPEED = 400.0, 40.0, 20e3, 1.2e3, 180e3, 5.0
"""A quarter car: masses [kg], suspension and tyre [N/m, N s/m], its speed [m/s]."""
SETTLING = 3
"""So many samples after a shaker starts at full rate its rate as a step begins is not known."""
MOVED, HELD = (0.02, 2.0), (50.0, 50e3, 200.0)
"""The shaker's amplitude [m] and frequency [Hz]; mass [kg], spring and damper of what hangs on it by friction alone [N/m, N s/m]."""


def friction(law: str) -> tuple[str, float, float]:
    """Return a law's text and its bounds [N] against extension and compression of the element."""
    if law == "dry_friction":
        return "{dry_friction: {force: 300 N}}", 300.0, 300.0
    return "{asymmetric_friction: {force: 300 N, ratio: 3}}", 150.0, 450.0


def stuck_or_slipping(free: float, ground: float, mass: float, down: float, up: float) -> float:
    """Return the friction on a mass over a short step that alone would reach the velocity `free`: at most `up`, at least -`down`."""
    return min(max((ground - free) * mass / SHORT, -down), up)


def shaken_mass(law: str) -> np.ndarray:
    """Return displacement, velocity and friction of the mass every ms."""
    _, extending, compressing = friction(law)
    mass, k, c = HELD
    omega, z, v, rows = 2 * np.pi * MOVED[1], 0.0, 0.0, []
    for i in range(round(1.0 / SHORT) + 1):
        free = v - SHORT * (k * z + c * v) / mass
        ground = -MOVED[0] * omega * np.sin(omega * (i + 1) * SHORT)
        force = stuck_or_slipping(free, ground, mass, extending, compressing)
        if i % round(1e-3 / SHORT) == 0:
            rows.append((z, v, force))
        v = free + SHORT * force / mass
        z += SHORT * v
    return np.array(rows)


@pytest.mark.parametrize("law", ["dry_friction", "asymmetric_friction"])
def test_a_shaker_drags_a_mass_along_by_friction(tmp_path, law):
    """Where the mass sticks to the shaker the friction is what the shaker's motion asks for."""
    (tmp_path / "rig.yaml").write_text(
        "name: rig\ngravity: false\nbodies: {m: {mass: 50 kg, motions: [heave]}}\n"
        f"links:\n  A: {{ground: {{}}, m: {{}}, k: 0 N/m, c: 0 N s/m, laws: [{friction(law)[0]}]}}\n"
        "  B: {m: {}, ground: {}, k: 50 kN/m, c: 200 N s/m}\n"
    )
    (tmp_path / "run.yaml").write_text(
        "vehicle: rig.yaml\nspeed: 1 m/s\nduration: 1 s\nsample: 1 ms\n"
        "displacements: {A: {harmonic: {amplitude: 20 mm, frequency: 2 Hz, phase: 90 deg}}}\n"
        "sensors: {s: {body: m, channels: {displacement: z, velocity: v}}}\noutputs: {f: {link: A, quantity: link_force}}\n"
    )
    found, exact = simulate(tmp_path / "run.yaml").values[0], shaken_mass(law)
    size = np.abs(exact).max(axis=0)
    assert (np.abs(found - exact).max(axis=0) < [2e-3 * size[0], 5e-3 * size[1], np.inf]).all()
    assert np.abs(found - exact)[SETTLING:, 2].max() < 3.0


def car_with_rubbing_tyre(bump: Callable[[float], tuple[float, float]], law: str) -> np.ndarray:
    """Return the body's displacement, tyre force and suspension travel every ms, over a bump's heights and rates at times."""
    _, extending, compressing = friction(law)
    body, axle, body_rate, axle_rate, rows = 0.0, 0.0, 0.0, 0.0, []
    for i in range(round(0.6 / SHORT) + 1):
        w, rate = bump((i + 0.5) * SHORT)
        spring = SPRING * (axle - body) + DAMPER * (axle_rate - body_rate)
        tyre = TYRE * (w - axle)
        free = axle_rate + SHORT * (tyre - spring) / AXLE
        force = stuck_or_slipping(free, rate, AXLE, extending, compressing)
        if i % round(1e-3 / SHORT) == 0:
            rows.append((body, tyre + force, axle - body))
        axle_rate, body_rate = free + SHORT * force / AXLE, body_rate + SHORT * spring / BODY
        axle, body = axle + SHORT * axle_rate, body + SHORT * body_rate
    return np.array(rows)


@pytest.mark.parametrize("law", ["dry_friction", "asymmetric_friction"])
def test_a_tyre_rubs_as_the_road_rises_and_falls(tmp_path, law):
    """Over a versine, whose rate does not jump."""

    def bump(t: float) -> tuple[float, float]:
        phase = 2 * np.pi * (SPEED * t - 0.2513) / 0.5
        inside = 0 < phase < 2 * np.pi
        return (0.025 * (1 - np.cos(phase)), 0.025 * 2 * np.pi * SPEED / 0.5 * np.sin(phase)) if inside else (0.0, 0.0)

    (tmp_path / "car.yaml").write_text(
        f"name: car\nbodies: {{b: {{mass: {BODY} kg, motions: [heave]}}}}\n"
        f"axles: {{a: {{body: b, x: 0 m, mass: {AXLE} kg, suspension: {{k: {SPRING} N/m, c: {DAMPER} N s/m}}, "
        f"tyre: {{k: {TYRE} N/m, laws: [{friction(law)[0]}]}}}}}}\n"
    )
    (tmp_path / "run.yaml").write_text(
        f"vehicle: car.yaml\nspeed: {SPEED} m/s\nduration: 0.6 s\nsample: 1 ms\n"
        "road: [{hump: {shape: versine, length: 0.5 m, height: 50 mm, at: 0.2513 m}}]\n"
        "sensors: {s: {body: b, channels: {displacement: z}}}\n"
        "outputs: {f: {axle: a, quantity: tyre_force}, d: {axle: a, quantity: suspension_travel}}\n"
    )
    found, exact = simulate(tmp_path / "run.yaml").values[0], car_with_rubbing_tyre(bump, law)
    rms = np.sqrt(np.mean((found - exact) ** 2, axis=0) / np.mean(exact**2, axis=0))
    assert (rms < [2e-3, 6e-3, 2e-3]).all()
