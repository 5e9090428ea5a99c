import json
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vehgen.calibrate.genetic import GeneticSearch, SearchState
from vehgen.calibrate.genetic.operators import migrate, mutate, rank_fitness, recombine, sample_parents
from vehgen.errors import InputError


def test_rank_fitness_is_the_papers_formula():
    objective = np.random.default_rng(0).random(100)
    fitness = rank_fitness(objective)
    position = 1 + np.array([(objective < value).sum() for value in objective])
    assert fitness == pytest.approx(2 * (position - 1) / 99)


def test_universal_sampling_keeps_every_count_within_one_of_its_expectation():
    random = np.random.default_rng(1)
    fitness = rank_fitness(random.random(20))
    for _ in range(50):
        counts = np.bincount(sample_parents(fitness, 20, random), minlength=20)
        expected = 20 * (2 - fitness) / (2 - fitness).sum()
        assert (np.abs(counts - expected) < 1).all()


@given(st.integers(0, 2**32 - 1), st.floats(0, 1))
def test_operators_stay_in_the_unit_cube(seed, rate):
    random = np.random.default_rng(seed)
    genes = random.random((10, 7))
    for changed in (recombine(genes, rate, random), mutate(genes, rate, random)):
        assert changed.shape == genes.shape
        assert ((changed >= 0) & (changed <= 1)).all()


def test_rates_of_zero_change_nothing_and_mutation_meets_its_rate():
    random = np.random.default_rng(2)
    genes = random.random((1000, 20))
    assert np.array_equal(recombine(genes, 0.0, random), genes)
    assert np.array_equal(mutate(genes, 0.0, random), genes)
    assert (mutate(genes, 0.03, random) != genes).mean() == pytest.approx(0.03, abs=0.005)


def test_the_best_travel_around_the_ring_to_the_worst_of_the_next():
    genes = np.arange(12.0).reshape(3, 4, 1)
    objective = np.array([[1.0, 2, 3, 4], [8, 7, 6, 5], [9, 10, 11, 12]])
    moved, values = migrate(genes, objective)
    assert moved[1, 0, 0] == 0.0
    assert values[1, 0] == 1.0
    assert moved[2, 3, 0] == 7.0
    assert moved[0, 3, 0] == 8.0
    assert values[0, 3] == 9.0


def sphere(centre):
    return lambda unit: ((unit - centre) ** 2).sum(axis=1)


@pytest.mark.parametrize("populations", [1, 3])
def test_the_search_finds_the_minimum_of_a_sphere(populations):
    search, objective = GeneticSearch(populations, 60, 150), sphere(np.linspace(0.1, 0.9, 8))
    state = search.start(objective, 8, seed=3)
    for _ in range(search.generations):
        state = search.advance(state, objective)
    assert state.elite_objective < 1e-4
    assert list(state.history) == sorted(state.history, reverse=True)
    assert len(state.history) == 151


@pytest.mark.parametrize(
    ("history", "settled"),
    [
        (np.geomspace(1.0, 0.79, 51), False),
        (np.geomspace(1.0, 0.81, 51), True),
        (np.ones(50), False),
        (np.r_[9.0, np.ones(51)], True),
        (np.r_[np.ones(51), 0.7], False),
    ],
)
def test_a_search_is_settled_once_fifty_generations_take_less_than_a_fifth_off(history, settled):
    search = GeneticSearch(1, 4, 0)
    state = search.start(sphere(np.full(2, 0.5)), 2, seed=1)
    assert replace(state, history=tuple(history.tolist())).is_settled is settled


def test_a_saved_search_goes_on_bit_for_bit():
    search, objective = GeneticSearch(2, 20, 30), sphere(np.full(5, 0.4))
    whole = search.start(objective, 5, seed=7)
    for _ in range(30):
        whole = search.advance(whole, objective)
    part = search.start(objective, 5, seed=7)
    for _ in range(11):
        part = search.advance(part, objective)
    part = SearchState.from_data(json.loads(json.dumps(part.to_data())))
    for _ in range(19):
        part = search.advance(part, objective)
    assert np.array_equal(part.genes, whole.genes)
    assert part.history == whole.history


@pytest.mark.parametrize("populations", [1, 3])
def test_less_exact_values_rank_and_what_is_carried_on_is_exact(populations):
    """The quick objective is wrong by up to 10 %, in a way of its own for every point."""
    asked = []

    def exact(unit):
        asked.append(len(unit))
        return sphere(np.linspace(0.1, 0.9, 6))(unit)

    def quick(unit):
        return sphere(np.linspace(0.1, 0.9, 6))(unit) * (1 + 0.1 * np.sin(1e4 * unit.sum(axis=1)))

    search = GeneticSearch(populations, 40, 60)
    state = search.start(exact, 6, seed=3, quick=quick)
    for _ in range(60):
        best = state.objective.argmin(axis=1)
        genes = np.array([own[i] for own, i in zip(state.genes, best, strict=True)])
        np.testing.assert_array_equal(state.objective.min(axis=1), sphere(np.linspace(0.1, 0.9, 6))(genes))
        assert state.elite_objective == sphere(np.linspace(0.1, 0.9, 6))(state.elite[None])[0]
        state = search.advance(state, exact, quick)
    assert list(state.history) == sorted(state.history, reverse=True)
    assert state.elite_objective < 1e-2
    assert sum(asked) < 0.2 * search.evaluations


def test_individuals_that_fail_are_left_behind():
    def objective(unit):
        return np.where(unit[:, 0] > 0.5, np.nan, unit.sum(axis=1))

    search = GeneticSearch(1, 20, 20)
    state = search.start(objective, 3, seed=1)
    for _ in range(20):
        state = search.advance(state, objective)
    assert np.isfinite(state.elite_objective)
    assert state.elite[0] <= 0.5


@pytest.mark.parametrize("text", ["{}", "[1]", '{"genes": 1}', "null", '{"generation": "x"}'])
def test_a_damaged_state_is_refused(text):
    with pytest.raises(InputError, match="not the state of a search"):
        SearchState.from_data(json.loads(text))


@pytest.mark.parametrize(
    "change",
    [
        {"elite": [0.5, 0.5]},
        {"elite": [7.0, 0.5, 0.5]},
        {"elite": [float("nan"), 0.5, 0.5]},
        {"generation": -1},
        {"objective": [[1.0]]},
        {"rates": [0.5, 0.5]},
    ],
    ids=lambda item: f"{item}",
)
def test_a_state_that_was_edited_is_refused(change):
    state = GeneticSearch(1, 4, 2).start(lambda unit: unit.sum(axis=1), 3, seed=1).to_data()
    assert SearchState.from_data(json.loads(json.dumps(state))).generation == 0
    with pytest.raises(InputError, match="not the state of a search"):
        SearchState.from_data(json.loads(json.dumps({**state, **change})))


def test_a_search_without_individuals_is_refused():
    with pytest.raises(InputError, match="at least 4 individuals"):
        GeneticSearch(1, 3, 10)
