"""Candidates whose fits went astray are not taken for refuted where the best fit may stand in for them."""

from types import SimpleNamespace

import pytest

from vehgen.diagnose.select.search import _stuck


def fit(name, training, place="front", on_bound=(), slow=True):
    effect = SimpleNamespace(shows_in_slow_motions=slow, n_numbers=lambda runs: 1)
    last = SimpleNamespace(place=place, effect=effect, name=name)
    inner = SimpleNamespace(on_bound=on_bound, misfit=SimpleNamespace(problem=SimpleNamespace(trials=(1, 2))))
    return SimpleNamespace(last=last, training=training, squares=1e3 * training, n_residuals=1000, least_squares=inner)


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
