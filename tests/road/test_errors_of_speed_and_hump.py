"""A driver who strays about a speed, a speed that is not what it should be, and humps that are not as drawn."""

import numpy as np
import pytest
import scipy.integrate
import scipy.ndimage

from vehgen.road import AdjustedSpeed, ConstantSpeed, Hump, SpeedHistory, Track, Wander

T = np.linspace(-1.0, 9.0, 501)
KNOTS = (1.0, 3.0, 5.0, 7.0)


def test_the_distance_is_the_integral_of_the_speed_seen_from_the_anchor():
    wander = Wander(KNOTS, (0.02, -0.03, 0.01, 0.04))
    law = AdjustedSpeed(ConstantSpeed(3.0), 0.0, 1.05, 2.0, wander)

    def speed(t):
        return 3.0 * (1.05 + wander.at(np.array([t]))[0])

    for t in (-0.5, 1.3, 2.0, 4.4, 8.5):
        wanted = 6.0 + scipy.integrate.quad(speed, 2.0, t, limit=200, points=KNOTS)[0]
        assert law.distance(np.array([t]))[0] == pytest.approx(wanted, abs=2e-6)


def test_a_wander_of_one_size_is_another_speed():
    plain = AdjustedSpeed(ConstantSpeed(3.0), 0.2, 1.03, 1.0)
    strayed = AdjustedSpeed(ConstantSpeed(3.0), 0.2, 1.0, 1.0, Wander((0.0, 4.0), (0.03, 0.03)))
    assert strayed.distance(T) == pytest.approx(plain.distance(T), abs=1e-9)


def test_a_wander_is_a_natural_spline_that_stays_as_it_is_outside():
    """Of 0, 1, 0 a unit apart it rises as (3 x - x^3)/2, without curvature at its ends."""
    found = Wander((1.0, 2.0, 3.0), (0.0, 1.0, 0.0)).at(np.array([0.0, 1.5, 2.0, 2.5, 9.0]))
    assert found == pytest.approx([0.0, 0.6875, 1.0, 0.6875, 0.0])
    assert Wander((1.0, 2.0, 3.0), (0.02, 0.05, -0.01)).at(np.array([-4.0, 8.0])) == pytest.approx([0.02, -0.01])


def test_a_delay_is_how_much_later_the_vehicle_is_where_it_is():
    assert AdjustedSpeed(ConstantSpeed(3.0), 0.2).distance(np.array([0.2, 1.2])) == pytest.approx([0.0, 3.0])


def test_a_measured_speed_keeps_its_shape_when_it_is_scaled():
    measured = SpeedHistory(np.array([0.0, 4.0, 8.0]), np.array([2.0, 4.0, 3.0]))
    law = AdjustedSpeed(measured, 0.0, 1.1, 3.0)
    speed = np.gradient(law.distance(T), T)[1:-1]
    assert speed == pytest.approx(1.1 * np.gradient(measured.distance(T), T)[1:-1], rel=1e-9)
    assert law.distance(np.array([3.0])) == pytest.approx(measured.distance(np.array([3.0])))


def test_a_half_sine_of_form_two_is_a_versine():
    drawn = Hump.from_shape("half_sine", 2.0, 0.8, 0.05)
    s = np.linspace(1.9, 2.9, 1001)
    assert drawn.deformed(form=2.0).height(s) == pytest.approx(Hump.from_shape("versine", 2.0, 0.8, 0.05).height(s), abs=1e-12)
    hole = Hump.from_shape("half_sine", 2.0, 0.8, -0.05).deformed(form=2.0)
    assert hole.height(s) == pytest.approx(Hump.from_shape("versine", 2.0, 0.8, -0.05).height(s), abs=1e-12)


def test_a_hump_of_no_height_has_none_in_any_form():
    flat = Hump.from_shape("half_sine", 2.0, 0.8, 0.0)
    assert (flat.deformed(form=2.0).height(np.linspace(1.9, 2.9, 101)) == 0).all()


def test_a_longer_hump_starts_where_it_starts():
    drawn = Hump.from_shape("half_sine", 2.0, 0.8, 0.05)
    s = np.linspace(1.9, 2.9, 1001)
    assert drawn.deformed(length=1.1).height(s) == pytest.approx(Hump.from_shape("half_sine", 2.0, 0.88, 0.05).height(s), abs=1e-12)
    assert drawn.deformed(length=1.1).end == pytest.approx(2.88)


@pytest.mark.parametrize("shape", ["half_sine", "trapezoid"])
def test_a_skewed_hump_lies_tilted_its_far_side_higher(shape):
    drawn = Hump.from_shape(shape, 2.0, 0.8, 0.05)
    assert drawn.deformed(skew=0.2).height(np.array([2.2, 2.4, 2.6])) == pytest.approx(
        drawn.height(np.array([2.2, 2.4, 2.6])) * [0.9, 1.0, 1.1], rel=1e-12
    )


@pytest.mark.parametrize("wear", [0.004, 0.012])
def test_worn_edges_are_a_gaussian_mean_of_the_drawing(wear):
    """Compared where an axle's hop is excited: 12 Hz at 1.5 m/s are 8 cycles a metre."""
    s = np.linspace(1.5, 3.3, 18001)
    step = s[1] - s[0]
    drawn = Hump.from_shape("half_sine", 2.0, 0.5, 0.05)
    worn = scipy.ndimage.gaussian_filter1d(drawn.height(s), wear / step)
    found = drawn.deformed(rounding=wear**2).height(s)
    frequency = np.fft.rfftfreq(len(s), step)
    inside = frequency < 8.0
    left, whole = (np.abs(np.fft.rfft(item)[inside]).max() for item in (found - worn, drawn.height(s) - worn))
    assert left < 0.05 * whole
    assert drawn.deformed(rounding=wear**2).height(np.array([1.99]))[0] > 0.0


def test_only_the_humps_of_a_track_are_deformed():
    hump = Hump.from_shape("half_sine", 2.0, 0.8, 0.05)
    track = Track((hump,), deformation=(1.05, 1.0, 0.0, 0.0))
    s = np.linspace(1.9, 2.9, 101)
    assert track.height(s) == pytest.approx(hump.deformed(1.05).height(s))
