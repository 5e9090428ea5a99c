"""Humps are looked up where they are alone: the same heights as from looking everywhere."""

import numpy as np
import pytest

from vehgen.road import AdjustedSpeed, ConstantSpeed, Hump, MeasuredProfile, Track, Wander, WheelInputs, nearby_inputs, wheel_inputs

TIME = np.arange(0, 12, 1e-3)
OFFSETS = np.array([0.0, 3.46, 4.8, 12.25])
SPEED = AdjustedSpeed(ConstantSpeed(2.0), 0.01, 1.02, 2.0, Wander((0.0, 4.0, 8.0, 12.0), (0.01, -0.02, 0.01, 0.0)))
ONE, OTHER = Hump.from_shape("half_sine", 4.0, 0.5, 0.03), Hump.from_shape("trapezoid", 9.0, 0.4, -0.02)
PROFILE = MeasuredProfile(np.linspace(0.0, 40.0, 801), 1e-3 * np.sin(np.arange(801.0)))
ROADS = {"a hump": (ONE,), "two humps": (OTHER, ONE), "humps that touch": (ONE, Hump.from_shape("versine", 4.5, 0.4, 0.01)), "no hump": ()}
ROADS |= {
    "a hump on a rough road": (ONE, PROFILE),
    "a train of humps": tuple(Hump.from_shape("versine", at, 0.9, 0.01) for at in range(30)),
}


def nearby(track, tracks, ways):
    found = [WheelInputs(*np.zeros((2, len(TIME), len(OFFSETS)))) for _ in (*tracks, *ways)]
    nearby_inputs(track, SPEED, tracks, ways, OFFSETS, TIME, found)
    return found


@pytest.mark.parametrize("footprint", [0.0, 0.24])
@pytest.mark.parametrize("deformation", [pytest.param((1.0, 1.0, 0.0, 0.0), marks=pytest.mark.thorough), (1.03, 0.9, 0.05, 2e-5)])
@pytest.mark.parametrize("parts", ROADS.values(), ids=ROADS)
def test_every_wheel_is_where_the_road_is(parts, deformation, footprint):
    track = Track(parts, footprint, 1.1, deformation)
    found = wheel_inputs(track, SPEED, OFFSETS, TIME)
    for axle, offset in enumerate(OFFSETS):
        assert found.heights[:, axle] == pytest.approx(track.height(SPEED.distance(TIME) - offset), abs=1e-12)
        around = [track.height(SPEED.distance(TIME + half) - offset) for half in (-5e-4, 5e-4)]
        assert found.rates[:, axle] == pytest.approx((around[1] - around[0]) / 1e-3, abs=1e-9)


@pytest.mark.parametrize("footprint", [0.0, 0.24])
@pytest.mark.parametrize("parts", ROADS.values(), ids=ROADS)
def test_drives_nearby_change_as_drives_a_step_apart_do(parts, footprint):
    """What a derivative by a way is: where the road has corners, what it is at one point says nothing of moves like a fit's."""
    track, half = Track(parts, footprint), 5e-4
    later, sooner = (AdjustedSpeed(SPEED.law, SPEED.delay + by, SPEED.scale, SPEED.anchor, SPEED.wander) for by in (half, -half))
    small = AdjustedSpeed(SPEED.law, SPEED.delay + 1e-8, SPEED.scale, SPEED.anchor, SPEED.wander)
    (found,) = nearby(track, [], [(small, OFFSETS)])
    here, there, back = (wheel_inputs(track, law, OFFSETS, TIME) for law in (SPEED, later, sooner))
    for name in ("heights", "rates"):
        by_delay = (getattr(found, name) - getattr(here, name))[1:-1] / 1e-8
        expected = (getattr(there, name) - getattr(back, name))[1:-1] / 1e-3
        assert np.linalg.norm(by_delay - expected) <= 2e-3 * np.linalg.norm(expected)


@pytest.mark.parametrize("at", [4.031, 4.0315, 4.032])
def test_a_drive_nearby_comes_upon_a_hump_as_it_does_wherever_the_way_is_looked_at(at):
    """One that begins within half a step of a moment that was looked at lies a step within its piece, too."""
    time, track, speed = np.arange(0, 12, 1e-3), Track((Hump.from_shape("half_sine", at, 0.5, 0.03),)), ConstantSpeed(2.0)
    found = WheelInputs(*np.zeros((2, len(time), len(OFFSETS))))
    nearby_inputs(track, speed, [], [(AdjustedSpeed(speed, 1e-8), OFFSETS)], OFFSETS, time, [found])
    here, there, back = (wheel_inputs(track, AdjustedSpeed(speed, by), OFFSETS, time) for by in (0.0, 5e-4, -5e-4))
    expected = (there.rates - back.rates) / 1e-3
    assert np.linalg.norm((found.rates - here.rates) / 1e-8 - expected) < 2e-3 * np.linalg.norm(expected)


@pytest.mark.thorough
@pytest.mark.parametrize("footprint", [0.0, 0.24])
@pytest.mark.parametrize("parts", ROADS.values(), ids=ROADS)
def test_drives_over_tracks_nearby_are_those_drives(parts, footprint):
    track, near = Track(parts, footprint), Track(parts, footprint, deformation=(1 + 1e-6, 1.0, 0.0, 0.0))
    (found,) = nearby(track, [near], [])
    expected = wheel_inputs(near, SPEED, OFFSETS, TIME)
    assert found.heights == pytest.approx(expected.heights, abs=1e-12)
    assert found.rates == pytest.approx(expected.rates, abs=1e-9)


@pytest.mark.thorough
@pytest.mark.parametrize("parts", ROADS.values(), ids=ROADS)
def test_drives_nearby_are_those_drives_to_the_first_order(parts):
    """Over a road without corners."""
    track = Track(parts, 0.24)
    faster = AdjustedSpeed(SPEED.law, SPEED.delay, SPEED.scale + 1e-7, SPEED.anchor, SPEED.wander)
    farther = OFFSETS + np.array([0.0, 1e-7, 0.0, -1e-7])
    at_faster, behind = nearby(track, [], [(faster, OFFSETS), (SPEED, farther)])
    assert at_faster.heights == pytest.approx(wheel_inputs(track, faster, OFFSETS, TIME).heights, abs=1e-8)
    assert behind.heights == pytest.approx(wheel_inputs(track, SPEED, farther, TIME).heights, abs=1e-9)


def test_a_track_says_where_its_humps_reach():
    assert np.array(Track((ONE, OTHER)).reaches) == pytest.approx(np.array([(4.0, 4.5), (9.0, 9.4)]))
    assert Track((ONE, PROFILE)).reaches is None
    (reach,) = Track((ONE,), footprint=0.2).reaches
    assert reach[0] <= 3.9
    assert reach[1] >= 4.6


@pytest.mark.parametrize("footprint", [0.0, 0.24])
def test_a_hump_that_no_wheel_reaches_moves_none(footprint):
    far = Track((Hump.from_shape("versine", 400.0, 0.9, 0.01),), footprint)
    assert not wheel_inputs(far, SPEED, OFFSETS, TIME).heights.any()
    for found in nearby(far, [far], [(SPEED, OFFSETS)]):
        assert not found.heights.any()
        assert not found.rates.any()


def test_a_way_that_turns_back_is_looked_at_as_a_whole():
    back = AdjustedSpeed(ConstantSpeed(2.0), scale=-0.4, anchor=4.0)
    found = wheel_inputs(Track((ONE,)), back, OFFSETS, TIME)
    assert found.heights[:, 0] == pytest.approx(Track((ONE,)).height(back.distance(TIME)), abs=1e-12)
    assert found.heights.max() > 0.02
