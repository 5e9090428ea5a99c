"""An effect whose number ends at the end of its range stands in for another one: it is not named."""

from dataclasses import replace
from types import SimpleNamespace

from tests.diagnose.conftest import CUBIC, HUMPS
from vehgen.diagnose.fits.candidate import Candidate
from vehgen.diagnose.pipeline import diagnose_trials
from vehgen.diagnose.select.fitter import Fitter
from vehgen.diagnose.select.range_ends import numbers_at_ends
from vehgen.diagnose.select.special_cases import simplest_first
from vehgen.effects import EFFECTS

TRUE_K3 = CUBIC.values["k3"]


def cubic_up_to(k3, detection):
    """Return the library's effect that reaches up to `k3` at the rear suspension."""
    effect = EFFECTS["cubic_stiffness"]
    reach = effect.search_dimensions("rear", Fitter(detection, detection.base, ()).locator)[0].high
    parameter = effect.parameters[0]
    return replace(effect, parameters=(replace(parameter, starts=(0.1,), high=parameter.high * k3 / reach),))


def test_a_law_that_closes_the_gap_at_the_end_of_its_range_is_not_named(trials_of, detection_of):
    near = cubic_up_to(0.97 * TRUE_K3, detection_of(CUBIC, runs=HUMPS))
    found = diagnose_trials(trials_of(CUBIC, runs=HUMPS), [near])
    assert found.verdict.verdict == "not_in_library"
    assert "only with k3 at the end of its range" in found.verdict.reason
    wider = cubic_up_to(1.3 * TRUE_K3, detection_of(CUBIC, runs=HUMPS))
    assert diagnose_trials(trials_of(CUBIC, runs=HUMPS), [wider]).verdict.verdict == "named"


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
