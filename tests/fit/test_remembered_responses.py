"""A fit asks for the same few individuals again and again: they are simulated once, and nobody may write to what is kept."""

import numpy as np
import pytest

from tests.fit.test_harmonic import RUN, SIGMA, record, trial_of
from vehgen.fit.least_squares import first_noises
from vehgen.fit.misfit import Misfit
from vehgen.fit.problem import REMEMBERED_UP_TO, make_problem
from vehgen.simulate.simulator import Simulator


@pytest.fixture
def problem(tmp_path):
    noise = np.random.default_rng(0).standard_normal((601, 4)) * SIGMA
    return make_problem(trial_of(tmp_path, record(tmp_path, RUN) + noise))


@pytest.fixture
def runs(monkeypatch):
    counted, run = [], Simulator.run
    monkeypatch.setattr(Simulator, "run", lambda self, parameters, *more: counted.append(len(parameters)) or run(self, parameters, *more))
    return counted


def test_the_same_individual_over_the_same_run_is_simulated_once(problem, runs):
    values = problem.space.start[None] * 1.01
    first, _ = problem.respond(values, problem.trials[0])
    again, _ = problem.respond(values.copy(), problem.trials[0])
    assert runs == [1]
    np.testing.assert_array_equal(first, again)
    with pytest.raises(ValueError, match="read-only"):
        first[0] = 0.0


def test_other_parameters_and_other_errors_are_simulated(problem, runs):
    misfit = Misfit(problem, first_noises(problem), problem.space.start)
    x = np.concatenate([problem.space.unit(problem.space.start), np.zeros(misfit.n_errors)])
    found = [misfit.residuals(x)]
    for i in range(len(x)):
        moved = x.copy()
        moved[i] += 0.1
        found.append(misfit.residuals(moved))
    assert all(np.abs(one - found[0]).max() > 1e-9 for one in found[1:])
    assert 1 < len(runs) <= len(found)


def test_populations_of_a_search_are_not_remembered(problem, runs):
    values = np.repeat(problem.space.start[None], REMEMBERED_UP_TO + 1, axis=0)
    for _ in range(2):
        problem.respond(values, problem.trials[0])
    assert runs == [REMEMBERED_UP_TO + 1] * 2
