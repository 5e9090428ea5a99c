"""Rainflow counts against the worked example of ASTM E1049 and properties that any count has."""

import numpy as np
import pytest

from vehgen.measure.rainflow import equivalent_range, exceedances, rainflow_cycles, turning_points

HISTORY = np.array([-2.0, 1.0, -3.0, 5.0, -1.0, 3.0, -4.0, 4.0, -2.0])


def totals(values):
    found = {}
    for size, count in zip(*rainflow_cycles(values), strict=True):
        found[float(size)] = found.get(float(size), 0.0) + float(count)
    return found


def test_the_worked_example_of_the_standard():
    assert totals(HISTORY) == {3.0: 0.5, 4.0: 1.5, 6.0: 0.5, 8.0: 1.0, 9.0: 0.5}


def test_samples_between_turning_points_and_waiting_change_nothing():
    fine = np.interp(np.linspace(0.0, 8.0, 801), np.arange(9), HISTORY)
    assert totals(np.repeat(fine, 2)) == pytest.approx(totals(HISTORY))
    np.testing.assert_allclose(turning_points(fine), HISTORY)


def test_a_steady_sine_has_its_cycles_and_its_own_range_as_equivalent():
    t = np.arange(0.0, 50.0, 1e-3)
    ranges, counts = rainflow_cycles(2.0 * np.sin(2 * np.pi * t))
    assert counts.sum() == pytest.approx(50.0, abs=1.0)
    assert equivalent_range(ranges, counts, 50.0, 5.0) == pytest.approx(4.0, rel=0.01)
    faster = rainflow_cycles(2.0 * np.sin(2 * np.pi * 32.0 * t))
    assert equivalent_range(*faster, 50.0, 5.0) == pytest.approx(4.0 * 2.0, rel=0.01)


def test_exceedances_count_from_the_largest():
    ranges, counts = rainflow_cycles(HISTORY)
    np.testing.assert_allclose(exceedances(ranges, counts, np.array([0.0, 4.0, 8.5, 9.0, 9.1])), [4.0, 3.5, 0.5, 0.5, 0.0])


@pytest.mark.parametrize("values", [[], [1.0], [1.0, 1.0, 1.0]])
def test_what_never_turns_has_no_cycle(values):
    ranges, counts = rainflow_cycles(np.array(values))
    assert len(ranges) == len(counts) == 0
    assert equivalent_range(ranges, counts, 10.0, 5.0) == 0.0
    assert exceedances(ranges, counts, np.array([0.0])) == [0.0]
