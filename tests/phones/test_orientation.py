"""How a phone lay: readings made by rotating a known motion, and what must be asked for."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from vehgen.errors import InputError
from vehgen.phones.gravity import no_gravity
from vehgen.phones.orientation import AXES, find_orientation

FORWARD, LEFT, UP = np.eye(3)


def lying(forward, up):
    """Rotation from the vehicle's axes (forward, left, up) to those of a phone whose axes point so."""
    f, u = np.array(AXES[forward]), np.array(AXES[up])
    return np.column_stack([f, np.cross(u, f), u])


@pytest.mark.parametrize(("forward", "up"), [("y", "z"), ("x", "z"), ("-x", "z"), ("-y", "z"), ("y", "-z"), ("z", "y"), ("-z", "x")])
@pytest.mark.parametrize("sign", [1, -1])
def test_every_way_to_lie(forward, up, sign):
    tilt = Rotation.from_euler("xy", [4.0, -6.0], degrees=True).as_matrix()
    turned = tilt @ lying(forward, up)
    motion = np.array([0.3, -0.2, 1.7])
    orientation = find_orientation(sign * turned @ (9.81 * UP), "phone", up, forward)
    assert orientation.sign == sign
    assert orientation.upward(sign * (turned @ (motion + 9.81 * UP))[None]) == pytest.approx([1.7])
    nose_down = 0.4
    assert orientation.pitch_rate((turned @ (nose_down * LEFT))[None])[0] == pytest.approx(nose_down, rel=0.01)
    axis = np.array(AXES[up])
    expected = np.degrees(np.arccos(axis @ tilt @ axis))
    assert orientation.tilt == pytest.approx(expected, abs=1e-6)


def test_pitch_is_nose_down_positive():
    """The top edge forward, face up: nose-down turns y towards -z, a negative rotation about x."""
    orientation = find_orientation(np.array([0, 0, 9.81]), "phone", None, "y")
    turn = Rotation.from_rotvec([-0.1, 0.0, 0.0]).as_matrix()
    assert (turn @ [0, 1, 0])[2] < 0
    assert orientation.pitch_rate(np.array([[-0.1, 0.0, 0.0]])) == pytest.approx([0.1])


def test_face_up_needs_no_word():
    assert find_orientation(np.array([0.3, 0.2, 9.78]), "phone").sign == 1


@pytest.mark.parametrize(
    ("gravity", "options", "message"),
    [
        ([0, 0, -9.81], {}, "face down (say up=-z), or its app reverses accelerations"),
        ([0, 9.81, 0], {}, "did not lie flat; say which of its axes pointed up"),
        ([0, 0, 9.81], {"up": "y"}, "is not along y, said to point up"),
        ([0, 0, 9.81], {"up": "z", "sign": -1}, "so the sign of accelerations is +1, not -1"),
        ([0, 0, 4.0], {}, "at rest gravity reads 4 m/s^2 (x +0.00, y +0.00, z +4.00 m/s^2), not 9.8: was the vehicle at a steady speed"),
        ([0, 0, 25.0], {}, "was the vehicle at a steady speed, and is the recording in m/s^2?"),
        ([0.02, 0, 0.99], {}, "it seems to be in g;"),
        ([0, 0, 32.2], {}, "it seems to be in ft/s^2;"),
        ([0, 30, 1004.0], {}, "it seems to be in mg or cm/s^2;"),
        ([0, 0, 9790.0], {}, "it seems to be in mm/s^2;"),
        ([0, 0, 9.81], {"forward": "z"}, "said to point forward, points up"),
        ([0, 0, 9.81], {"forward": "w"}, "forward is an axis of the phone, found 'w'"),
        (None, {}, "without gravity, which would show how it lay; say which of its axes pointed up"),
        (None, {"up": "z"}, "the sign of its acceleration is unknown: say acceleration_sign=1"),
    ],
)
def test_what_cannot_be_known_is_asked_for(gravity, options, message):
    with pytest.raises(InputError) as caught:
        find_orientation(None if gravity is None else np.array(gravity, dtype=float), "phone", **options)
    assert message in str(caught.value)


@pytest.mark.parametrize(("tilt", "flat"), [(0, True), (35, True), (45, False), (90, False)])
def test_a_phone_lies_flat_up_to_forty_degrees(tilt, flat):
    gravity = 9.81 * np.array([np.sin(np.radians(tilt)), 0.0, np.cos(np.radians(tilt))])
    if flat:
        assert find_orientation(gravity, "phone").tilt == pytest.approx(tilt, abs=1e-6)
        assert find_orientation(gravity, "phone", "z").sign == 1
        return
    for up, said in ((None, "did not lie flat"), ("z", "is not along z, said to point up")):
        with pytest.raises(InputError, match=said):
            find_orientation(gravity, "phone", up)


@pytest.mark.parametrize(("reading", "factor"), [(0.99, 9.80665), (32.2, 0.3048), (1002.0, 0.00980665), (979.0, 0.01), (9790.0, 0.001)])
def test_another_unit_is_told_with_what_makes_it_m_per_s2(reading, factor):
    told = no_gravity(reading, "").partition("multiply its accelerations by ")[2].partition(";")[0]
    assert float(told) == pytest.approx(factor, rel=1e-4)


def test_face_down_and_reversed_are_told_apart_by_up():
    down = find_orientation(np.array([0, 0, -9.81]), "phone", up="-z")
    reversed_ = find_orientation(np.array([0, 0, -9.81]), "phone", up="z")
    assert (down.sign, reversed_.sign) == (1, -1)
    assert down.upward(np.array([[0, 0, -10.81]])) == pytest.approx([1.0])
    assert reversed_.upward(np.array([[0, 0, -10.81]])) == pytest.approx([1.0])


def test_without_gravity_nothing_is_subtracted():
    orientation = find_orientation(None, "phone", "z", "y", -1)
    assert orientation.upward(np.array([[0.0, 0.0, -1.5]])) == pytest.approx([1.5])


@pytest.mark.parametrize("factor", [0.52, 0.9, 1.233, 1.9])
def test_a_gain_is_told_and_left_in_the_readings(factor):
    """The accelerometer reads `factor` times what it should, motion and gravity alike: the motion comes out as often too large."""
    tilt = Rotation.from_euler("xy", [4.0, -6.0], degrees=True).as_matrix()
    motion = np.array([0.3, -0.2, 1.7])
    orientation = find_orientation(factor * tilt @ (9.80665 * UP), "phone")
    assert orientation.upward(factor * (tilt @ (motion + 9.80665 * UP))[None]) == pytest.approx([factor * 1.7])
    (warning,) = orientation.warnings
    assert f"a gain of {factor:.3f}, or an offset of {9.80665 * (factor - 1):+.2f} m/s^2" in warning
    assert "`sensor_gain`" in warning


def test_an_offset_that_chips_have_is_no_warning():
    orientation = find_orientation(np.array([0.0, 0.0, 10.1]), "phone")
    assert orientation.warnings == ()
    assert "offset or gain is +3.0% off" in orientation.notes[-1]
