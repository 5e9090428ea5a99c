"""Rigs' simulators against closed forms."""

import math
from dataclasses import replace

import numpy as np
import pytest
from benchmarks.measured_world.chain import RATE
from benchmarks.measured_world.rigs import half_car, signals
from benchmarks.measured_world.rigs.cases import Hidden, Quantity, Rig, Run
from benchmarks.measured_world.rigs.mechanism import Joint, Mechanism
from benchmarks.measured_world.rigs.recorder import draw_recorder
from benchmarks.measured_world.rigs.sets import draw_rig
from scipy.integrate import cumulative_simpson, cumulative_trapezoid


def still(t, q, v):
    return np.zeros_like(q)


def at(motion, t):
    return round(t * RATE), motion.q[0, round(t * RATE)]


def test_a_damped_mass_decays_as_in_the_textbook():
    m, k, c = 12.0, 4800.0, 60.0
    motion = Mechanism([m], [Joint((-1.0,), k, c)], still).run([0.05], [0.0], 3.0)
    decay = c / (2.0 * m)
    pace = math.sqrt(k / m - decay**2)
    expected = 0.05 * np.exp(-decay * motion.t) * (np.cos(pace * motion.t) + decay / pace * np.sin(pace * motion.t))
    assert motion.q[0] == pytest.approx(expected, abs=1e-7)
    assert motion.a[0] == pytest.approx(-(k * motion.q[0] + c * motion.v[0]) / m, abs=1e-9)


def test_coulomb_friction_takes_the_same_from_every_half_cycle_and_holds_in_the_end():
    m, k, force = 10.0, 4000.0, 21.0
    joint = Joint((-1.0,), k, law="dry_friction", values={"force": force})
    motion = Mechanism([m], [joint], still).run([0.1], [0.0], 5.0)
    half = math.pi / math.sqrt(k / m)
    for n in range(10):
        i = round(n * half * RATE)
        peak = np.max(np.abs(motion.q[0, max(i - 5, 0) : i + 6]))
        assert peak == pytest.approx(0.1 - 2.0 * n * force / k, abs=1e-6)
    assert motion.v[0, -1] == 0.0
    assert abs(k * motion.q[0, -1]) <= force
    assert motion.force[0, -1] == pytest.approx(0.0, abs=1e-9)


def test_friction_that_differs_by_direction_is_its_mean_beside_a_constant_force():
    bump, rebound = 14.0, 26.0
    pushed = signals.sampled(signals.random(4.0, 60.0, 0.4, 5.0, 0.5, np.random.default_rng(3)))
    apart = Mechanism(
        [20.0],
        [Joint((-1.0,), c=30.0, law="directional_friction", values={"bump": bump, "rebound": rebound})],
        lambda t, q, v: pushed.value(t) + np.zeros_like(q),
    )
    mean = Mechanism(
        [20.0],
        [Joint((-1.0,), c=30.0, law="dry_friction", values={"force": 0.5 * (bump + rebound)})],
        lambda t, q, v: pushed.value(t) + 0.5 * (bump - rebound) + np.zeros_like(q),
    )
    one, other = apart.run([0.0], [0.0], 4.0), mean.run([0.0], [0.0], 4.0)
    assert np.mean(np.abs(one.v[0]) < 1e-12) > 0.02
    assert one.q[0] == pytest.approx(other.q[0], abs=1e-7)


def test_two_frictions_stick_one_by_one():
    """A chain of two masses on a slope of force: the outer one slips first, then both."""
    joints = [
        Joint((1.0, 0.0), law="dry_friction", values={"force": 30.0}),
        Joint((-1.0, 1.0), law="dry_friction", values={"force": 10.0}),
    ]
    pulled = Mechanism([2.0, 1.0], joints, lambda t, q, v: np.stack([0.0 * q[0], 12.0 * t + 0.0 * q[1]]))
    motion = pulled.run([0.0, 0.0], [0.0, 0.0], 2.0)
    slips = 10.0 / 12.0
    later = motion.t > slips
    assert np.all(motion.q[1, ~later] == 0.0)
    assert motion.q[1, later] == pytest.approx(2.0 * (motion.t[later] - slips) ** 3, abs=1e-7)
    assert np.all(motion.q[0] == 0.0)
    assert motion.force[0] == pytest.approx(np.minimum(12.0 * motion.t, 10.0), abs=1e-6)


@pytest.mark.thorough
def test_a_reversal_within_a_step_is_not_taken_for_its_own_beginning():
    """In this drop a friction begins to slip and turns within one step of the integration."""
    rig = draw_rig(1, 7, 0)
    run = replace(rig.runs[1], duration=1.0)
    motion = half_car.respond(rig, run, {})[1]
    assert motion.t[-1] == pytest.approx(1.0)
    assert [hidden.law for hidden in rig.hidden] == ["dry_friction", "dry_friction"]


def loop(kind, values, **more):
    """Return a joint's travel and force as the base moves, its other end all but held."""
    base = signals.sampled(signals.sinusoid(2.0, 0.01, 1.0))
    motion = Mechanism([1.0], [Joint((-1.0,), law=kind, values=values, base=base, **more), Joint((-1.0,), 1e8, 2e4)], still).run(
        [0.0], [0.0], 2.0
    )
    return base, motion


@pytest.mark.thorough
def test_bouc_wen_begins_as_a_hyperbolic_tangent():
    base, motion = loop("hysteresis", {"force": 50.0, "travel": 0.002, "beta": 0.7})
    rising = motion.t < 0.2
    assert motion.force[0, rising] == pytest.approx(50.0 * np.tanh(base.value(motion.t[rising]) / 0.002), abs=0.02)


@pytest.mark.slow
def test_a_damper_on_a_soft_mount_answers_as_a_maxwell_element():
    k, c, frequency = 6e4, 2000.0, 3.0
    base = signals.sampled(signals.sinusoid(3.0, 0.01, frequency))
    joint = Joint((-1.0,), c=c, law="damper_mount", values={"k": k}, base=base)
    motion = Mechanism([1.0], [joint, Joint((-1.0,), 1e8, 2e4)], still).run([0.0], [0.0], 3.0)
    pace = 2.0 * math.pi * frequency
    stiffness = k * 1j * pace * c / (k + 1j * pace * c)
    late = motion.t > 2.0
    expected = np.imag(stiffness * 0.01 * np.exp(1j * pace * motion.t[late]))
    assert motion.force[0, late] == pytest.approx(expected, abs=2e-3 * abs(stiffness) * 0.01)


@pytest.mark.slow
def test_free_play_passes_no_force_until_it_is_used_up():
    base, motion = loop("free_play", {"gap": 0.002}, c=1500.0)
    i = int(np.argmax(base.value(motion.t) > 0.0019))
    assert np.all(np.abs(motion.force[0, :i]) < 1e-6)
    rates, falling = base.rate(motion.t), slice(i + 400, i + 500)
    assert motion.force[0, falling] == pytest.approx(1500.0 * rates[falling], rel=0.03, abs=2.0)


def dropped(height, hidden=(), kind="drop", pitch=0.0):
    """Return a half car with round numbers and its motion."""
    stated = {"mB": 500.0, "IB": 700.0, "m1": 40.0, "m2": 45.0, "k1": 18e3, "k2": 20e3, "c1": 1200.0, "c2": 1400.0, "kt1": 2e5, "kt2": 2e5}
    quantities = {name: Quantity(value, value, "", "") for name, value in stated.items()}
    run = Run("run", kind, 2.0, {"displacement": height, "pitch": pitch})
    recorder = draw_recorder((250.0,), np.random.default_rng(0))
    rig = Rig("rig", "half_car", quantities, {"front": 1.2, "rear": -1.4}, (), (), recorder, (run,), 0, hidden)
    return rig, *half_car.respond(rig, run, {})


@pytest.mark.parametrize("kind", ["drop", "hung"])
def test_the_centre_of_all_masses_falls_freely_until_a_tyre_meets_the_floor(kind):
    rig, motions, motion = dropped(0.08, kind=kind)
    touching = np.array([motions[f"tyre_load {end}"] for end in half_car.ENDS]).max(axis=0) > 0.0
    falls = np.cumsum(touching) == 0
    momentum = np.array([500.0, 0.0, 40.0, 45.0]) @ motion.v
    assert np.sum(falls) > 100
    assert momentum[falls] == pytest.approx(-585.0 * half_car.GRAVITY * motion.t[falls], abs=1e-3)
    loads = half_car.static_loads(rig)
    assert sum(loads) == pytest.approx(585.0 * half_car.GRAVITY)
    assert motions["tyre_load rear"][-1] == pytest.approx(loads[1], rel=0.05)
    if kind == "hung":
        assert motion.travel[:, 0] == pytest.approx([-loads[0] / 18e3, -loads[1] / 20e3])
        assert motion.a[2:, 0] == pytest.approx(0.0, abs=1e-8)
    else:
        assert motion.travel[:, 0] == pytest.approx(0.0, abs=1e-12)


def test_what_joints_take_up_is_what_the_car_loses():
    hidden = (
        Hidden("dry_friction", "front", {"force": 150.0}),
        Hidden("bump_stop", "rear", {"k": 1e5, "clearance": 0.02, "rebound": 0.03}),
    )
    rig, motions, motion = dropped(0.05, hidden, pitch=0.8)
    mass = np.array([500.0, 700.0, 40.0, 45.0])
    kinetic = 0.5 * np.sum(mass[:, None] * motion.v**2, axis=0)
    rows = np.array([[-1.0, 1.2, 1.0, 0.0], [-1.0, -1.4, 0.0, 1.0]])
    taken = cumulative_trapezoid(np.sum(motion.force * (rows @ motion.v), axis=0), motion.t, initial=0.0)
    floor = 0.0
    for i, (end, load) in enumerate(zip(("front", "rear"), half_car.static_loads(rig), strict=True)):
        pushed = motions[f"tyre_load {end}"] - load
        floor = floor + cumulative_simpson(pushed * motion.v[2 + i], x=motion.t, initial=0.0)
    assert kinetic == pytest.approx(kinetic[0] + floor - taken, abs=2e-3 * np.max(kinetic))
    assert taken[-1] > 10.0


def test_a_lifted_car_begins_with_its_axles_in_equilibrium():
    _, _, motion = dropped(0.04, (Hidden("cubic_stiffness", "front", {"k3": 5e6}),), kind="lift")
    assert motion.a[2:, 0] == pytest.approx(0.0, abs=1e-8)
    assert motion.a[0, 0] < -1.0


@pytest.mark.parametrize("signal", ["sinusoid", "sweep", "random"])
def test_signals_begin_at_rest_and_know_their_derivatives(signal):
    values = {
        "sinusoid": signals.sinusoid(3.0, 0.02, 2.0),
        "sweep": signals.sweep(3.0, 0.3, 0.5, 10.0, 0.02),
        "random": signals.random(3.0, 0.005, 0.4, 8.0, 1.5, np.random.default_rng(1)),
    }[signal]
    found, t = signals.sampled(values), signals.moments(2.9)
    assert [found.value(0.0), found.rate(0.0), found.acceleration(0.0)] == pytest.approx([0.0, 0.0, 0.0], abs=1e-3)
    assert found.value(t) == pytest.approx(values[: len(t)], abs=1e-12)
    assert found.rate(1.2345) == pytest.approx((found.value(1.2346) - found.value(1.2344)) / 2e-4, rel=1e-4)
    assert found.acceleration(t)[5:-5] == pytest.approx(np.gradient(found.rate(t), t)[5:-5], abs=2e-3 * np.max(found.acceleration(t)))
