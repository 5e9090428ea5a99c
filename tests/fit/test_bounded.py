"""Bounded least squares against scipy's."""

import numpy as np
import pytest
import scipy.optimize

from vehgen.fit.bounded import LinearisedPoint, _slowly_within, _within, minimise


def problem(seed, n=6):
    random = np.random.default_rng(seed)
    matrix, wanted = random.normal(size=(40, n)), random.normal(size=40)

    def residuals(x):
        return matrix @ (x + 0.3 * np.sin(x)) - wanted

    def jacobian(x):
        return matrix * (1 + 0.3 * np.cos(x))

    return residuals, jacobian


def ours(residuals, jacobian, x, bounds, max_steps=100):
    def linearise(at):
        slopes, left = jacobian(at), residuals(at)
        return LinearisedPoint(slopes.T @ slopes, slopes.T @ left)

    return minimise(lambda at: float(residuals(at) @ residuals(at)), linearise, x, bounds, 1e-14, max_steps)


@pytest.mark.parametrize("seed", range(8))
def test_it_ends_where_scipy_ends_whether_bounds_hold_or_not(seed):
    residuals, jacobian = problem(seed)
    tight = 0.15 if seed % 2 else 10.0
    bounds = np.full(6, -tight), np.full(6, tight)
    found = ours(residuals, jacobian, np.zeros(6), bounds)
    wanted = scipy.optimize.least_squares(residuals, np.zeros(6), jacobian, bounds, xtol=1e-14, ftol=1e-14, gtol=1e-14).x
    assert found == pytest.approx(wanted, abs=1e-5)
    assert np.all(np.abs(found) <= tight)


def test_a_direction_that_nothing_tells_is_left_where_it_was():
    residuals, jacobian = (lambda x: np.array([x[0] + x[1] - 1.0])), (lambda x: np.array([[1.0, 1.0]]))
    found = ours(residuals, jacobian, np.array([0.2, 0.2]), (np.full(2, -5.0), np.full(2, 5.0)))
    assert found == pytest.approx([0.5, 0.5], abs=1e-4)


def test_unknowns_of_any_size_count_alike():
    """An unknown that hardly tells makes normal equations whose condition number is 1e28: warnings are errors here."""
    sizes = np.array([1e8, 1.0, 1e-6])
    mixed = np.array([[1.0, 0.5, 0.2], [0.3, 1.0, 0.1], [0.2, 0.4, 1.0], [0.1, 0.2, 0.3]]) * sizes
    wanted = np.array([2e-8, -0.4, 0.3e6])
    bounds = np.full(3, -1e9), np.full(3, 1e9)
    found = ours(lambda x: mixed @ (x - wanted), lambda x: mixed, np.zeros(3), bounds)
    assert found == pytest.approx(wanted, rel=1e-4)


def test_few_steps_never_end_higher_than_they_began():
    residuals, jacobian = problem(3)
    start = np.full(6, 2.0)
    ends = [ours(residuals, jacobian, start, (np.full(6, -5.0), np.full(6, 5.0)), steps) for steps in (1, 2, 3, 5)]
    losses = [float(residuals(x) @ residuals(x)) for x in (start, *ends)]
    assert losses == sorted(losses, reverse=True)


def test_where_nothing_can_be_computed_it_stays():
    nothing = LinearisedPoint(np.full((2, 2), np.nan), np.full(2, np.nan))
    found = minimise(lambda x: float("nan"), lambda x: nothing, np.array([0.3, 0.4]), (np.zeros(2), np.ones(2)), 1e-8, 20)
    assert found.tolist() == [0.3, 0.4]


@pytest.mark.parametrize("seed", range(16))
def test_bounds_that_hold_unknowns_alike_do_not_end_a_fit_early(seed):
    """Unknowns that nearly undo one another: a step cut at the bounds of some, however the others follow, may lead uphill."""
    random = np.random.default_rng(seed)
    matrix = 10 * random.normal(size=(60, 2)) @ random.normal(size=(2, 12)) + random.normal(size=(60, 12))
    wanted = matrix @ (4 * random.normal(size=12)) + random.normal(size=60)
    bounds = np.full(12, -1.0), np.full(12, 1.0)
    found = ours(lambda x: matrix @ x - wanted, lambda x: matrix, random.uniform(-0.9, 0.9, 12), bounds, 400)
    best = scipy.optimize.lsq_linear(matrix, wanted, bounds, method="bvls", tol=1e-14)
    assert ((matrix @ found - wanted) ** 2).sum() == pytest.approx(2 * best.cost, rel=1e-6)


def test_a_flat_valley_is_followed_to_its_end():
    """The sum of two unknowns is told a million times as well as their difference: damping by the one holds the other."""
    matrix = np.array([[1e3, 1e3], [1.0, -1.0]])
    wanted = matrix @ np.array([30.0, -30.0])
    bounds = np.full(2, -100.0), np.full(2, 100.0)

    def square(x):
        return float(((matrix @ x - wanted) ** 2).sum()) + 1e6

    found = minimise(square, lambda x: LinearisedPoint(matrix.T @ matrix, matrix.T @ (matrix @ x - wanted)), np.zeros(2), bounds, 1e-4, 60)
    assert found == pytest.approx([30.0, -30.0], abs=0.5)


def test_a_fit_with_derivatives_from_elsewhere_ends_only_where_those_of_the_point_lead_no_further():
    """The derivatives from elsewhere have the second unknown's turned round, so that no step by them leads downhill along it."""
    matrix, wanted = np.array([[1.0, 0.0], [0.0, 1.0]]), np.array([3.0, 4.0])
    stale = np.array([[1.0, 0.0], [0.0, -1.0]])
    bounds = np.full(2, -10.0), np.full(2, 10.0)

    def square(x):
        return float(((matrix @ x - wanted) ** 2).sum()) + 1.0

    def point(x, by):
        return LinearisedPoint(by.T @ by, by.T @ (matrix @ x - wanted))

    alone = minimise(square, lambda x: point(x, stale), np.zeros(2), bounds, 1e-9, 60)
    assert abs(alone[1] - 4.0) > 1
    found = minimise(square, lambda x: point(x, stale), np.zeros(2), bounds, 1e-9, 60, lambda x: point(x, matrix))
    assert found == pytest.approx([3.0, 4.0], abs=1e-4)


@pytest.mark.parametrize("seed", range(30))
def test_the_quick_way_within_bounds_ends_where_the_sure_one_does(seed):
    """Nearly singular matrices of unknowns that undo one another included; both are the least within the bounds."""
    random = np.random.default_rng(seed)
    n = int(random.integers(2, 40))
    rows = random.normal(size=(n, n)) * 10.0 ** random.uniform(-2, 2, n)
    matrix = rows.T @ rows
    size = 1 / np.sqrt(np.diagonal(matrix))
    matrix = matrix * size[:, None] * size + 10.0 ** random.uniform(-8, -1) * np.eye(n)
    right, low, high = 3 * random.normal(size=n), -random.uniform(0, 1, n), random.uniform(0, 1, n)
    low[0] = high[0] = 0.25

    def least(y):
        return y @ matrix @ y / 2 - right @ y

    quick, sure = _within(matrix, right, low, high), _slowly_within(matrix, right, low, high)
    assert quick is not None
    assert (low - 1e-9 <= quick).all()
    assert (quick <= high + 1e-9).all()
    assert least(quick) <= least(sure) + 1e-9 * abs(least(sure))
    pull = right - matrix @ quick
    assert np.abs(pull[(low + 1e-9 < quick) & (quick < high - 1e-9)]).max(initial=0.0) < 1e-6
