"""The driver's way, humps, roads and their profiles, and satellite fixes."""

import numpy as np
import pytest
from benchmarks.measured_world import gps
from benchmarks.measured_world.driver import wandering
from benchmarks.measured_world.hump import RAMP, SHAPES, Hump, as_it_lies
from benchmarks.measured_world.roads import ROUGHNESS, Profiler, draw_profiler, joined, random_road
from scipy import integrate, signal


def test_the_way_is_the_integral_of_the_speed_and_starts_at_the_mark():
    drive = wandering(3.0, 0.015, 2.0, -5.0, 10.0, np.random.default_rng(2))
    t = np.linspace(-4.0, 9.0, 20_001)
    summed = integrate.cumulative_simpson(drive.speed(t), x=t, initial=0.0)
    way = drive.distance(t)
    assert way - way[0] == pytest.approx(summed, abs=1e-8)
    assert drive.distance(np.zeros(1)) == pytest.approx(0.0)
    assert drive.distance(np.array([drive.passes(7.3)])) == pytest.approx(7.3)
    assert drive.acceleration(t[1:-1]) == pytest.approx(np.gradient(drive.speed(t), t)[1:-1], abs=1e-4)


def test_the_speed_wanders_as_far_as_told_and_for_as_long():
    shares = []
    for seed in range(60):
        drive = wandering(2.0, 0.01, 2.5, 0.0, 30.0, np.random.default_rng(seed))
        departure = drive.speed(np.arange(0.0, 30.0, 0.05)) / 2.0 - 1.0
        assert np.max(np.abs(departure)) == pytest.approx(0.01, rel=0.05)
        shares.append(np.mean(departure[:-50] * departure[50:]) / np.mean(departure**2))
    assert np.mean(shares) == pytest.approx(np.exp(-1.0), abs=0.12)


def test_humps_have_their_shapes_and_wear_keeps_their_area():
    areas = {"half_sine": 2 / np.pi, "versine": 0.5, "trapezoid": 1 - RAMP}
    for shape in SHAPES:
        for hump in (Hump(shape, 0.5, 0.03), Hump(shape, 0.5, 0.03, wear=0.01)):
            s, height = hump.points()
            assert np.trapezoid(height, s) == pytest.approx(areas[shape] * 0.5 * 0.03, rel=0.01)
            assert np.max(height) <= 0.03 + 1e-12
    assert Hump("half_sine", 0.5, 0.03).heights(np.array([-1.0, 0.125, 0.25, 2.0])) == pytest.approx(
        [0.0, 0.03 * np.sqrt(0.5), 0.03, 0.0], abs=1e-6
    )
    tilted = Hump("versine", 0.5, 0.03, tilt=0.05)
    assert tilted.heights(np.array([0.4])) > tilted.heights(np.array([0.1]))
    with pytest.raises(ValueError, match="spike"):
        Hump("spike", 0.5, 0.03).points()


def test_a_hump_lies_two_to_five_percent_off():
    stated = Hump("half_sine", 0.5, 0.03)
    for seed in range(20):
        hump = as_it_lies(stated, np.random.default_rng(seed))
        for share in (hump.length / 0.5, hump.height / 0.03):
            assert 0.0199 < abs(share - 1.0) < 0.0501


def test_a_random_road_has_the_density_of_its_class():
    road = random_road("B", 0.0, 4000.0, np.random.default_rng(1), scale=0.5)
    wavenumber, density = signal.welch(road.height, 100.0, nperseg=20_000)
    for low, high in ((0.05, 0.2), (0.5, 2.0)):
        inside = (wavenumber >= low) & (wavenumber < high)
        expected = 0.25 * ROUGHNESS["B"] * (wavenumber[inside] / 0.1) ** -2.0
        assert np.mean(density[inside] / expected) == pytest.approx(1.0, abs=0.12)
    assert np.max(density[wavenumber > 6.0]) < 1e-3 * density[np.argmin(np.abs(wavenumber - 3.0))]


def test_a_measured_road_follows_its_approach_and_an_exact_profiler_tells_it():
    rng = np.random.default_rng(3)
    approach, section = random_road("A", -20.0, 60.0, rng), random_road("C", -1.0, 60.0, rng)
    road = joined(approach, section)
    assert road.heights(np.zeros(1)) == pytest.approx(0.0)
    before = road.distance < 0
    assert road.height[before] - approach.height[before] == pytest.approx(np.full(before.sum(), road.height[0] - approach.height[0]))
    exact = Profiler(0.0, 0.0, 0.0, 0.0, 0.01).measure(road, 50.0, rng)
    assert exact.height == pytest.approx(road.heights(exact.distance))
    real = draw_profiler(rng).measure(road, 50.0, rng)
    error = real.height - road.heights(real.distance)
    assert 5e-5 < np.std(np.diff(error)) < 6e-4


def test_fixes_come_once_a_second_late_and_noisy():
    drive = wandering(10.0, 0.015, 3.0, -30.0, 100.0, np.random.default_rng(1))
    found = gps.fixes(drive, -20.0, 90.0, np.random.default_rng(2))
    assert np.diff(found[:, 0]) == pytest.approx(np.ones(len(found) - 1))
    assert np.std(found[:, 1] - drive.speed(found[:, 0] - 20.0)) == pytest.approx(0.1, abs=0.03)
