"""Loads of tyres against algebra and normal distributions."""

import numpy as np
import pytest

from vehgen.measure.tyre_loads import load_statistics, road_stress_factor


def test_a_sine_has_the_statistics_of_algebra():
    load = 1e4 * np.sin(2 * np.pi * np.arange(10_000) / 10_000)
    found = load_statistics(load, 4e4)
    assert found.coefficient == pytest.approx(0.25 / np.sqrt(2))
    assert found.least == pytest.approx(0.75)
    assert found.high == pytest.approx(1 + 0.25 * np.sin(np.pi * (0.95 - 0.5)), abs=1e-3)
    assert found.fourth_power == pytest.approx(1 + 6 * 0.25**2 / 2 + 0.25**4 * 3 / 8)
    assert found.road_stress == pytest.approx(1 + 6 * 0.03125 + 3 * 0.03125**2)


def test_a_normal_load_does_the_damage_that_eisenmann_says():
    load = 8e3 * np.random.default_rng(1).normal(size=400_000)
    found = load_statistics(load, 4e4)
    assert found.fourth_power == pytest.approx(found.road_stress, rel=5e-3)
    assert found.high == pytest.approx(1 + 1.6449 * 0.2, rel=5e-3)
    assert road_stress_factor(0.0) == 1.0


def test_a_wheel_off_the_road_does_no_damage():
    assert load_statistics(np.array([-3e4, -3e4]), 1e4).fourth_power == 0.0
