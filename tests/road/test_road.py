"""Roads against closed forms."""

import numpy as np
import pytest
import scipy.signal

from vehgen.errors import InputError
from vehgen.files.tables import read_columns
from vehgen.road import (
    CLASSES,
    ConstantSpeed,
    Hump,
    Iso8608Road,
    MeasuredProfile,
    SpeedHistory,
    Track,
    displacement_psd,
    pass_time,
    wheel_inputs,
)

S = np.linspace(0, 4, 4001)


@pytest.mark.parametrize(
    ("shape", "extra", "quarter", "area"),
    [
        ("half_sine", {}, np.sin(np.pi / 4), 2 / np.pi),
        ("versine", {}, 0.5, 0.5),
        ("trapezoid", {"ramp": 0.25}, 1.0, 0.75),
        ("trapezoid", {"ramp": 0.5}, 0.5, 0.5),
    ],
)
def test_shapes(shape, extra, quarter, area):
    hump = Hump.from_shape(shape, 1.0, 0.8, 0.05, **extra)
    assert hump.height(np.array([1.2]))[0] == pytest.approx(0.05 * quarter, rel=1e-12)
    assert hump.height(np.array([0.999, 1.801])) == pytest.approx([0, 0])
    s = np.linspace(1.0, 1.8, 20001)
    assert np.trapezoid(hump.height(s), s) == pytest.approx(0.05 * 0.8 * area, rel=1e-6)


def test_rounded_rectangle():
    hump = Hump.from_shape("rectangle", 1.0, 0.5, 0.03, radius=0.04)
    s = np.linspace(1.0, 1.5, 100001)
    z = hump.height(s)
    assert z.max() == pytest.approx(0.03, rel=1e-12)
    assert np.abs(np.diff(z)).max() < 2e-5
    run = np.sqrt(0.04**2 - 0.025**2)
    assert hump.height(np.array([1 + run]))[0] == pytest.approx(0.015, rel=1e-9)
    slope = np.gradient(z, s)
    curvature = np.abs(np.gradient(slope, s)) / (1 + slope**2) ** 1.5
    on_foot = (s > 1.001) & (s < 1 + 0.95 * run)
    np.testing.assert_allclose(1 / curvature[on_foot], 0.04, rtol=1e-3)
    hole = Hump.from_shape("rectangle", 1.0, 0.5, -0.03, radius=0.04)
    np.testing.assert_array_equal(hole.height(s), -z)


@pytest.mark.parametrize(("length", "height", "radius"), [(0.5, 0.1, 0.04), (0.1, 0.03, 0.04), (0.5, 0.03, -1)])
def test_impossible_rectangles_are_refused(length, height, radius):
    with pytest.raises(InputError, match=r"radius|rounded edges"):
        Hump.from_shape("rectangle", 0, length, height, radius=radius)


@pytest.mark.parametrize(
    ("shape", "nulls"),
    [("half_sine", [7.5, 12.5, 17.5]), ("versine", [10, 15, 20]), ("trapezoid", [20 / 3, 40 / 3, 20])],
)
def test_spectral_nulls(shape, nulls):
    np.testing.assert_allclose(Hump.from_shape(shape, 5, 0.4, 0.03).spectral_nulls(2.0, 20.5), nulls, atol=0.02)


def test_spectral_nulls_end_where_they_are_asked_to_and_are_no_mere_minima():
    hump = Hump.from_shape("half_sine", 5, 0.4, 0.03)
    assert hump.spectral_nulls(2.0, 12.49) == pytest.approx([7.5], abs=0.02)
    assert hump.deformed(skew=0.02).spectral_nulls(2.0, 20.5).tolist() == []  # its far end, 4 % higher, fills them by a hundredth


@pytest.mark.parametrize("roughness", ["A", "C", "H"])
def test_iso8608_has_its_psd(roughness):
    spectra = []
    for seed in range(6):
        s = 5 + np.arange(0, 2000, 0.02)
        n, psd = scipy.signal.welch(Iso8608Road(roughness, seed, 2100.0).height(s), 50.0, nperseg=8192)
        spectra.append(psd)
    mean = np.mean(spectra, axis=0)
    for low in (0.05, 0.1, 0.2, 0.4, 0.8, 1.2):
        band = (n >= low) & (n < 2 * low)
        ratio = np.trapezoid(mean[band], n[band]) / np.trapezoid(displacement_psd(roughness, n[band]), n[band])
        assert 0.85 < ratio < 1.15


def test_iso8608_has_all_its_waves_however_short_the_road():
    """The mean square of waves of k cycles a period falls as 1/k^2; a road of 20 m has those of 91 m, of which the first is too long."""
    long, short = Iso8608Road("C", 1, 5000.0, 0.05), Iso8608Road("C", 1, 20.0, 0.05)
    power = (long.height(5.0 + np.arange(0, 5000, 0.05)) ** 2).mean()
    assert power == pytest.approx(256e-6 * 0.1**2 * (1 / 0.011 - 1 / 2.83), rel=0.02)
    power = (short.height(5.0 + np.arange(0, 91, 0.05)) ** 2).mean()
    assert power == pytest.approx(256e-6 * 0.1**2 * 91 * (np.pi**2 / 6 - 1), rel=0.01)


def test_a_random_road_repeats_itself_without_a_step():
    road = Iso8608Road("C", 1, 100.0)
    period = 100.01
    s = np.array([period - 0.01, period - 0.005, period])
    before, middle, after = road.height(s)
    assert road.height(s + period) == pytest.approx([before, middle, after])
    assert middle == pytest.approx((before + after) / 2, abs=1e-12)
    assert abs(after - before) > 1e-6


def test_iso8608_classes_are_the_standards():
    assert CLASSES["A"][1:] == pytest.approx((16e-6, 32e-6))
    assert CLASSES["B"] == pytest.approx((32e-6, 64e-6, 128e-6))
    assert CLASSES["G"] == pytest.approx((32768e-6, 65536e-6, 131072e-6))
    assert displacement_psd("B", np.array([0.1, 0.2])) == pytest.approx([64e-6, 16e-6])


def test_a_seed_is_a_road_and_another_seed_another():
    first, again, other = (Iso8608Road("B", seed, 100.0).height(S) for seed in (1, 1, 2))
    np.testing.assert_array_equal(first, again)
    assert np.abs(first - other).max() > 1e-3
    assert first[0] == 0.0


def test_footprint_is_a_moving_average():
    hump = Hump.from_shape("half_sine", 1.0, 0.4, 0.03)
    track = Track((hump,), footprint=0.24)

    def area(s):
        local = np.clip(s - 1.0, 0, 0.4)
        return 0.03 * 0.4 / np.pi * (1 - np.cos(np.pi * local / 0.4))

    expected = (area(S + 0.12) - area(S - 0.12)) / 0.24
    np.testing.assert_allclose(track.height(S), expected, atol=2e-6)
    np.testing.assert_allclose(Track((hump,), footprint=0.24, scale=1.1).height(S), 1.1 * expected, atol=2e-6)
    assert track.end == pytest.approx(1.4 + 0.12)
    ahead, beyond = track.height(np.array([track.end - 0.01, track.end + 0.002]))
    assert ahead > 1e-5 > 1e-9 > beyond
    short = Track((Hump.from_shape("half_sine", 1.0, 0.02, 0.03),), footprint=0.3)
    assert np.trapezoid(short.height(S), S) == pytest.approx(0.03 * 0.02 * 2 / np.pi, rel=0.02)


def test_every_axle_follows_the_same_track():
    track = Track((Hump.from_shape("versine", 2.0, 0.5, 0.03), Iso8608Road("A", 3, 50.0)))
    time = np.arange(0, 4, 1e-3)
    wheels = wheel_inputs(track, ConstantSpeed(2.0), np.array([0.0, 1.5]), time)
    np.testing.assert_allclose(wheels.heights[750:, 1], wheels.heights[:-750, 0], atol=1e-12)
    np.testing.assert_allclose(wheels.rates[1:-1], (wheels.heights[2:] - wheels.heights[:-2]) / 2e-3, atol=0.02)
    assert pass_time(track, ConstantSpeed(2.0), np.array([0.0, 1.5])) == pytest.approx(2.0, abs=1e-5)


def test_varying_speed_is_integrated_exactly():
    speed = SpeedHistory(np.array([0.0, 2.0, 4.0]), np.array([1.0, 3.0, 3.0]))
    t = np.array([0.0, 1.0, 2.0, 3.0, 5.0])
    np.testing.assert_allclose(speed.distance(t), [0, 1.5, 4.0, 7.0, 13.0])
    np.testing.assert_allclose(speed.distance(np.array([-1.0])), [-1.0])


@pytest.mark.parametrize("speed", [0.0, -2.0, np.nan, np.inf])
def test_no_speed_is_refused(speed):
    with pytest.raises(InputError, match="above 0"):
        ConstantSpeed(speed)


def test_what_lies_behind_the_first_wheel_counts_as_level():
    """Chainage is often counted from a marker: rows before the run's begin were a step under all wheels."""
    profile = MeasuredProfile(np.array([-4.0, -1.0, 1.0, 3.0]), np.array([0.5, 0.3, 0.1, 0.4]))
    met = profile.met_from(0.0)
    np.testing.assert_allclose(met.height(np.array([-9.0, -2.0, 0.0, 0.5, 2.0, 9.0])), [0, 0, 0, -0.05, 0.05, 0.2], atol=1e-15)
    assert profile.met_from(-5.0) is profile


def test_measured_profile_and_points():
    profile = MeasuredProfile(np.array([0.0, 1.0, 3.0]), np.array([0.1, 0.2, 0.0]))
    np.testing.assert_allclose(profile.height(np.array([-1, 0.5, 2, 9])), [0, 0.05, 0.0, -0.1], atol=1e-15)
    hump = Hump.from_points(5.0, np.array([0.0, 0.1, 0.4]), np.array([0.0, 0.03, 0.0]))
    np.testing.assert_allclose(hump.height(np.array([5.05, 5.25, 5.5])), [0.015, 0.015, 0.0])
    with pytest.raises(InputError, match="ascending"):
        MeasuredProfile(np.array([0.0, 0.0]), np.zeros(2))


def test_csv_faults_have_their_place(tmp_path):
    path = tmp_path / "road.csv"
    path.write_text("s,height\n0,0\n1,oops\n")
    with pytest.raises(InputError, match=r"road.csv:3:2: 'oops' in column 'height'"):
        read_columns(path, ("s", "height"))
    with pytest.raises(InputError, match=r"no column 'heigth'; did you mean 'height'"):
        read_columns(path, ("s", "heigth"))
    path.write_text("s,height\n0,nan\n")
    with pytest.raises(InputError, match="not a finite number"):
        read_columns(path, ("s", "height"))
    with pytest.raises(InputError, match="no file"):
        read_columns(tmp_path / "absent.csv", ("s",))
