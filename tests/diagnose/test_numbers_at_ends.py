"""An effect whose number ends at the end of its range may stand in for another one."""

from dataclasses import replace
from types import SimpleNamespace

import pytest

from tests.diagnose.conftest import CUBIC, HUMPS
from vehgen.diagnose import ending
from vehgen.diagnose.decision import Decision
from vehgen.diagnose.fits.candidate import Candidate
from vehgen.diagnose.pipeline import diagnose_trials
from vehgen.diagnose.select.fitter import Fitter
from vehgen.diagnose.select.ranking import numbers_at_ends, simplest_first
from vehgen.effects import EFFECTS

TRUE_K3 = CUBIC.values["k3"]


def cubic_up_to(k3, detection):
    """Return the library's effect that reaches up to `k3` at the rear suspension."""
    effect = EFFECTS["cubic_stiffness"]
    reach = effect.search_dimensions("rear", Fitter(detection, detection.base, ()).locator)[0].high
    parameter = effect.parameters[0]
    return replace(effect, parameters=(replace(parameter, starts=(0.1,), high=parameter.high * k3 / reach),))


@pytest.mark.slow
def test_a_law_at_the_end_of_its_range_is_named_where_other_runs_surely_show_it(trials_of, detection_of, monkeypatch):
    """As a stop in rebound that no run meets; not where the other runs leave open whether it closes half of the gap."""
    near = cubic_up_to(0.97 * TRUE_K3, detection_of(CUBIC, runs=HUMPS))
    named = diagnose_trials(trials_of(CUBIC, runs=HUMPS), [near])
    assert named.verdict.verdict == "named"
    assert any("on the bound of its range: cubic_stiffness_rear_k3" in note for note in named.verdict.notes)
    monkeypatch.setattr(ending, "gain_interval", lambda *_: (0.4, 1.0))
    unsure = diagnose_trials(trials_of(CUBIC, runs=HUMPS), [near])
    assert unsure.verdict.verdict == "not_in_library"
    assert "only with k3 at the end of its range, and other runs do not surely show half of it" in unsure.verdict.reason


@pytest.mark.parametrize("unfinished", [False, True])
def test_a_law_at_the_end_of_its_range_is_not_named_where_it_leaves_more_than_noise(monkeypatch, unfinished):
    """A mount with fluid was named a relaxation of the largest stiffness, with chi 1.11 left."""
    monkeypatch.setattr(ending, "excluded", lambda fit: ())
    monkeypatch.setattr(ending, "estimate", lambda fit: {})
    monkeypatch.setattr(ending, "numbers_at_ends", lambda fit: ["k"])
    monkeypatch.setattr(ending, "gain_interval", lambda *_: (0.9, 1.0))
    monkeypatch.setattr(ending, "unfinished", lambda fit, base: unfinished)
    made = SimpleNamespace(base=None, validation_runs=(), _words=lambda *_: "a stop")
    told = Decision._imitation(made, SimpleNamespace(last=None, chi=1.11))
    assert ("chi 1.11 is left" in told) is unfinished
    assert bool(told) is unfinished


def fit(name, training, on_bound=()):
    effect = EFFECTS[name]
    own = Candidate(effect, "rear", tuple(f"{name}_{item.name}" for item in effect.parameters))
    least_squares = SimpleNamespace(on_bound=on_bound, adjusted_to_bounds=())
    return SimpleNamespace(last=own, training=training, validation=training, least_squares=least_squares)


def test_what_does_as_well_within_its_range_goes_before_what_ends_at_its_end():
    bent, inside = fit("bump_stop", 1.01, ("mr", "bump_stop_k")), fit("cubic_stiffness", 1.02)
    assert numbers_at_ends(bent) == ["k"]
    base = SimpleNamespace(training=20.0)
    assert simplest_first([bent, inside], base) == [inside, bent]
    assert simplest_first([bent, fit("cubic_stiffness", 2.0)], base)[0] is bent
    strained = fit("bump_stop", 1.01, ("mr",))
    assert simplest_first([strained, inside], base) == [strained, inside]


@pytest.mark.parametrize(
    ("stop", "spring", "first"), [((), (), "spring"), ((), ("k",), "stop"), (("k",), ("k",), "spring"), (("k",), (), "spring")]
)
def test_a_special_case_goes_before_what_holds_it_unless_it_alone_ends_at_its_end(stop, spring, first):
    """A stop that only bump met was told as a spring that joins in there, of the largest stiffness that such a spring may have."""
    general = fit("bump_stop", 1.01, tuple(f"bump_stop_{name}" for name in stop))
    special = fit("progressive_stiffness", 1.012, tuple(f"progressive_stiffness_{name}" for name in spring))
    wanted = {"stop": general, "spring": special}[first]
    assert simplest_first([general, special], SimpleNamespace(training=20.0))[0] is wanted
