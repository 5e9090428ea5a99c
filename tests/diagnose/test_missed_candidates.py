"""Candidates whose fits went astray are not taken for refuted where the best fit may stand in for them."""

from types import SimpleNamespace

import numpy as np
import pytest

from vehgen.diagnose.select.search import _missed_special_cases, _screened_out, _stuck

CHOSEN = ("friction", "relaxation", "cubic")


def fit(name, training, place="front", on_bound=(), slow=True, freed=(), refined=True):
    effect = SimpleNamespace(shows_in_slow_motions=slow, n_numbers=lambda runs: 1)
    last = SimpleNamespace(place=place, effect=effect, name=name, freed=freed)
    inner = SimpleNamespace(on_bound=on_bound, misfit=SimpleNamespace(problem=SimpleNamespace(trials=(1, 2))))
    validation = training if refined else np.nan
    return SimpleNamespace(
        last=last, training=training, validation=validation, squares=1e3 * training, n_residuals=1000, least_squares=inner
    )


@pytest.mark.parametrize(("on_bound", "expected"), [(("c",), ["mount"]), ((), [])])
def test_what_left_more_than_the_base_is_fitted_again_beside_a_best_fit_at_a_bound(on_bound, expected):
    fits = [
        fit("relaxation", 1.0, on_bound=on_bound),
        fit("mount", 300.0),
        fit("elsewhere", 300.0, place="rear"),
        fit("refuted", 20.0),
        fit("sensor", 300.0, slow=False),
    ]
    assert [item.name for item in _stuck(fits, SimpleNamespace(training=25.0))] == expected


@pytest.mark.parametrize(("bound", "expected"), [("c", ["mount"]), ("k", ["helper"])])
def test_what_sets_free_the_parameter_at_its_bound_is_fitted_to_its_end(bound, expected):
    """A damper's mount, left at a quarter of the gap, was named a relaxation beside which the damper went to nothing."""
    fits = [
        fit("relaxation", 1.0, on_bound=(bound,)),
        fit("mount", 7.5, freed=("c",), refined=False),
        fit("helper", 11.0, freed=("k",), refined=False),
        fit("friction", 12.0, freed=("c", "k")),
        fit("elsewhere", 7.5, place="rear", freed=("c", "k"), refined=False),
    ]
    assert [item.name for item in _stuck(fits, SimpleNamespace(training=25.0))] == expected


@pytest.mark.parametrize(("training", "refined", "expected"), [(9.3, True, ["dry"]), (0.9, True, []), (0.9, False, ["dry"])])
def test_a_special_case_that_does_worse_than_what_holds_it_or_was_not_refined_is_fitted_again(training, refined, expected):
    fits = [fit("asymmetric", 0.8), fit("dry", training, refined=refined), fit("hysteresis", 2.0)]
    for item in fits:
        item.last.holds = lambda other, own=item.last.name: (own, other.name) == ("asymmetric", "dry")
    assert [item.name for item in _missed_special_cases(fits, SimpleNamespace(training=11.5))] == expected
    assert _missed_special_cases([], SimpleNamespace(training=11.5)) == []


@pytest.mark.parametrize(
    ("left", "bounds", "effects", "expected"),
    [
        (5.6, ("k",), (), ["cubic"]),
        (3.9, ("k",), (), []),
        (5.6, (), (), []),
        (5.6, ("k",), ("friction",), []),
    ],
    ids=["nothing could be named", "something could", "a base within its bounds", "beside an effect"],
)
def test_what_was_screened_out_is_fitted_where_a_base_at_its_bounds_misled(left, bounds, effects, expected):
    """The first orders about such a base left out the spring that hardens, and parameters at a fifth of the file's stood in for it."""
    found = fit("friction", left)
    chosen = [SimpleNamespace(name=name, is_among=lambda others, own=name: own in [item.name for item in others]) for name in CHOSEN]
    current = SimpleNamespace(effects=effects, least_squares=SimpleNamespace(on_bound=bounds))
    assert [item.name for item in _screened_out(chosen, [found, fit("relaxation", 50.0)], current)] == expected
