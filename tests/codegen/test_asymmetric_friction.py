"""Friction that is stronger one way: a block on a rail and on a spring, against solutions in closed form."""

import numpy as np
import pytest

from vehgen.codegen import Excitation, Kernel
from vehgen.mechanics import ElementOutput, Place, PointOutput, derive, static_loads
from vehgen.vehicle import parse_vehicle

MASS, SPRING = 4.0, 5e3
FORCE, RATIO = 30.0, 1.5
COMPRESSED, EXTENDED = 36.0, 24.0
"""What holds the block back as it goes down, and up [N]."""
BLOCK = """name: block
gravity: false
bodies: {{block: {{mass: 4 kg, motions: [heave]}}}}
links: {{rail: {{ground: {{}}, block: {{}}, {spring}laws: [{law}]}}}}
"""
LOPSIDED = "{asymmetric_friction: {force: 30 N, ratio: 1.5}}"
PLACE = Place("P", "block")
CHANNELS = (PointOutput("q", PLACE, "displacement"), PointOutput("v", PLACE, "velocity"), ElementOutput("f", "rail", "link_force"))


def moved(push, dt, start=(0.0, 0.0), spring="", law=LOPSIDED):
    """Return times, and displacement, velocity and the rail's force at each, of a block that a force pushes upwards."""
    model = derive(parse_vehicle(BLOCK.format(spring=spring, law=law)), CHANNELS, [Place("push", "block")])
    still = np.zeros((len(push), len(model.inputs)))
    drive = Excitation(dt, still, still, np.asarray(push)[:, None])
    parameters = np.array([list(model.values().values())])
    return dt * np.arange(len(push)), *Kernel(model).run(parameters, drive, 1, np.array([start])).responses[0].T


@pytest.mark.parametrize(("speed", "force"), [(2.0, EXTENDED), (-2.0, COMPRESSED)])
def test_a_sliding_block_is_braked_by_the_force_of_its_direction_and_stays_where_it_stops(speed, force):
    t, q, v, f = moved(np.zeros(1000), 1e-3, (0.0, speed))
    until = np.minimum(t, abs(speed) * MASS / force)
    assert q == pytest.approx(np.sign(speed) * (abs(speed) * until - force / MASS * until**2 / 2), abs=2e-6)
    assert np.abs(v[-1]) < 1e-9
    assert f[t < until[-1] - 2e-3] == pytest.approx(-np.sign(speed) * force)
    assert f[-1] == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize(("limit", "way"), [(EXTENDED, 1), (COMPRESSED, -1)])
def test_it_sticks_up_to_the_force_of_the_way_that_it_is_pushed(limit, way):
    _, q, _, f = moved(np.full(2000, way * 0.99 * limit), 1e-3)
    assert np.abs(q).max() < 1e-6
    assert f[10:] == pytest.approx(-way * 0.99 * limit, rel=1e-6)
    t, q, _, _ = moved(np.full(2000, way * 1.05 * limit), 1e-3)
    assert q[-1] == pytest.approx(way * 0.05 * limit / MASS * t[-1] ** 2 / 2, rel=2e-3)


def test_at_rest_it_carries_nothing():
    _, q, v, f = moved(np.zeros(100), 1e-3)
    assert not q.any()
    assert not v.any()
    assert not f.any()
    model = derive(parse_vehicle(f"extends: quarter_car\naxles: {{axle1: {{suspension: {{laws: [{LOPSIDED}]}}}}}}\n"))
    assert static_loads(model).elements == static_loads(parse_vehicle("extends: quarter_car")).elements


def turns(q, v):
    """Return the displacements at which the velocity changes its sign, to second order."""
    at = np.flatnonzero((v[1:-1] * v[2:] < 0) & (np.abs(v[1:-1]) > 1e-6)) + 1
    return [q[i] + v[i] ** 2 / (v[i] - v[i + 1]) * 0.5e-4 for i in at]


def test_every_half_swing_on_a_spring_loses_twice_the_force_of_its_direction_over_the_stiffness():
    t, q, v, _ = moved(np.zeros(12000), 1e-4, (0.05, 0.0), "k: 5 kN/m, ")
    expected, here = [], 0.05
    while not -EXTENDED / SPRING <= here <= COMPRESSED / SPRING:  # the spring pulls back less than what it would slip at
        force = COMPRESSED if here > 0 else EXTENDED
        here = -(here - np.sign(here) * 2 * force / SPRING)
        expected.append(here)
    stop = len(expected) * np.pi * np.sqrt(MASS / SPRING)
    assert len(expected) >= 3
    assert turns(q, v)[: len(expected) - 1] == pytest.approx(expected[:-1], abs=2e-6)
    assert q[t > stop + 0.01] == pytest.approx(expected[-1], abs=5e-6)
    path = np.diff([0.05, *expected])
    lost = EXTENDED * path[path > 0].sum() - COMPRESSED * path[path < 0].sum()
    assert SPRING * (0.05**2 - q[-1] ** 2) / 2 == pytest.approx(lost, rel=1e-4)


def test_it_is_dry_friction_beside_a_constant_force_sliding_or_not():
    """Why no recording tells the two apart where such a force is not known."""
    t = np.arange(6000) * 1e-3
    push = 45 * np.sin(2 * np.pi * 0.9 * t) + 30 * np.sin(2 * np.pi * 2.3 * t)
    own = moved(push, 1e-3, spring="k: 0.2 kN/m, ")
    beside = (COMPRESSED - EXTENDED) / 2
    other = moved(push + beside, 1e-3, spring="k: 0.2 kN/m, ", law="{dry_friction: {force: 30 N}}")
    away = moved(push, 1e-3, spring="k: 0.2 kN/m, ", law="{dry_friction: {force: 30 N}}")
    still = np.mean(np.abs(own[2]) < 1e-9)
    assert 0.02 < still < 0.9
    assert own[1] == pytest.approx(other[1], abs=1e-9)
    assert np.abs(own[1] - away[1]).max() > 0.01


def test_a_ratio_of_one_is_dry_friction():
    push = 60 * np.sin(2 * np.pi * 1.3 * np.arange(2000) * 1e-3)
    own = moved(push, 1e-3, law="{asymmetric_friction: {force: 30 N, ratio: 1}}")
    assert np.array_equal(own, moved(push, 1e-3, law="{dry_friction: {force: 30 N}}"))
