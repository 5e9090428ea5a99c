"""How alike two histories are, against sums over all shifts."""

import numpy as np
import pytest

from vehgen.measure.likeness import LEAST_SHARED, agreement


def by_sums(first, second):
    """Return the largest correlation of what overlaps, and its shift, where each has its share of energy there."""
    n = len(first)
    one, other = first - first.mean(), second - second.mean()
    best = (-np.inf, 0)
    for late in range(1 - n, n):
        a, b = (one[late:], other[: n - late]) if late >= 0 else (one[:late], other[-late:])
        if min(a @ a / (one @ one), b @ b / (other @ other)) >= LEAST_SHARED:
            best = max(best, (a @ b / np.sqrt((a @ a) * (b @ b)), late))
    return best


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("n", [7, 31, 32])
def test_all_shifts_are_compared_where_histories_overlap(seed, n):
    first, second = np.random.default_rng(seed).normal(1.0, 1.0, (2, n))
    found = agreement(first, second, 0.01)
    best, late = by_sums(first, second)
    assert found.at_best == pytest.approx(best, abs=1e-12)
    assert found.late == pytest.approx(0.01 * late)
    assert found.at_once == pytest.approx(np.corrcoef(first, second)[0, 1])


@pytest.mark.parametrize("late", [-1100, 600, 1100])
def test_a_road_heard_seconds_later_is_one_motion(late):
    motion = np.random.default_rng(0).standard_normal(6000)
    found = agreement(motion[2000:4500], motion[2000 + late : 4500 + late], 0.01)
    assert found.late == pytest.approx(0.01 * late)
    assert found.at_best > 0.999
    assert abs(found.at_once) < 0.1


def test_nothing_is_like_what_does_not_move():
    assert agreement(np.ones(20), np.arange(20.0), 0.01).at_best == 0
