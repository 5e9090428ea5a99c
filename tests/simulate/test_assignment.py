"""The assignment problem against scipy's."""

import numpy as np
import pytest
import scipy.optimize

from vehgen.simulate.assignment import assign


@pytest.mark.parametrize(("n", "m"), [(1, 1), (4, 4), (7, 9), (31, 31), (40, 60)])
def test_the_total_cost_is_the_least(n, m):
    for seed in range(20):
        random = np.random.default_rng([n, m, seed])
        cost = random.normal(size=(n, m)) if seed % 2 else random.integers(0, 4, (n, m)).astype(float)
        columns = assign(cost)
        assert len(set(columns.tolist())) == n
        least = cost[scipy.optimize.linear_sum_assignment(cost)].sum()
        assert cost[np.arange(n), columns].sum() == pytest.approx(least, abs=1e-12)
        if seed % 2:
            np.testing.assert_array_equal(columns, scipy.optimize.linear_sum_assignment(cost)[1])


def test_no_row_needs_no_column():
    assert assign(np.zeros((0, 0))).shape == (0,)
