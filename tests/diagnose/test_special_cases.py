"""What holds a special case, as asymmetric friction does dry friction: which of the two is named, and where both are fitted."""

from types import SimpleNamespace

import pytest
from benchmarks.hidden_effects.generator import EFFECTS as HIDDEN
from benchmarks.hidden_effects.generator import Effect, laws
from benchmarks.hidden_effects.generator.effects import EffectKind, Value
from benchmarks.hidden_effects.generator.effects.kind import suspensions

from tests.diagnose.conftest import HUMPS
from vehgen.diagnose.fits.candidate import Candidate, list_candidates
from vehgen.diagnose.fits.screening import chosen_with_holders
from vehgen.diagnose.pipeline import diagnose_trials
from vehgen.diagnose.select import criteria
from vehgen.diagnose.select.criteria import same, tied
from vehgen.diagnose.select.fitter import Fitter
from vehgen.diagnose.select.ranking import holding, simplest_first
from vehgen.effects import EFFECTS

BASE = SimpleNamespace(training=20.0)


def fit(name, place, training):
    candidate = Candidate(EFFECTS[name], place, ())
    return SimpleNamespace(
        last=candidate,
        effects=(candidate,),
        key=((name, place),),
        training=training,
        validation=training,
        least_squares=SimpleNamespace(on_bound=(), adjusted_to_bounds=()),
    )


@pytest.mark.parametrize(("holder", "held"), [("asymmetric_friction", "dry_friction"), ("relaxation", "damper_mount")])
def test_a_special_case_that_does_as_well_goes_first_and_is_no_tie(holder, held):
    general, plain = fit(holder, "rear", 1.02), fit(held, "rear", 1.05)
    other = fit("hysteresis", "rear", 5.0)
    ranked = simplest_first([general, other, plain], BASE)
    assert ranked == [plain, general, other]
    assert same(plain.last, general.last)
    assert tied(SimpleNamespace(faint=False, current=BASE, fits=ranked), plain) == []
    assert holding(ranked, plain, BASE) == [general]


def test_a_special_case_that_leaves_more_stays_where_it_is():
    fits = [fit("asymmetric_friction", "rear", 1.02), fit("dry_friction", "rear", 2.0)]
    assert simplest_first(fits, BASE) == fits
    assert holding([fits[1], fits[0]], fits[0], BASE) == []


@pytest.mark.parametrize(("name", "place"), [("sensor_delay", "R"), ("engine_harmonic", "body")])
@pytest.mark.parametrize("told", [True, False])
def test_a_wrong_clock_or_a_line_that_may_be_none_is_no_tie(monkeypatch, name, place, told):
    """A law may be of any size; a fit of an error of none explains as much only because it was begun elsewhere."""
    monkeypatch.setattr(criteria, "is_told", lambda item: told)
    fits = [fit("sensor_gain", "R_az", 1.02), fit(name, place, 1.02), fit("hysteresis", "rear", 1.02)]
    assert tied(SimpleNamespace(faint=False, current=BASE, fits=fits), fits[0]) == (fits[1:] if told else fits[2:])


def test_friction_elsewhere_is_no_special_case():
    fits = [fit("asymmetric_friction", "rear", 1.02), fit("dry_friction", "front", 1.02)]
    assert simplest_first(fits, BASE) == fits
    assert len(tied(SimpleNamespace(faint=False, current=BASE, fits=fits), fits[0])) == 1


def test_what_holds_an_effect_is_not_looked_for_beside_it():
    plain, general = (Candidate(EFFECTS[name], "rear", (name,)) for name in ("dry_friction", "asymmetric_friction"))
    assert general.is_among([plain])
    assert plain.is_among([general])
    assert not general.is_among([Candidate(EFFECTS["dry_friction"], "front", ("other",))])


def test_what_holds_an_effect_is_fitted_where_that_one_is():
    every = [Candidate(EFFECTS[name], place, ()) for place in ("front", "rear") for name in ("dry_friction", "asymmetric_friction")]
    assert chosen_with_holders([*every, Candidate(EFFECTS["hysteresis"], "rear", ())], every[2:3]) == every[2:]


def add(setup, place, p):
    """Add dry friction and, once it slips, its other mean; a force that is constant is a spring whose end is a million metres away."""
    setup.suspension(place).dry += p["force"]
    setup.add_law(place, laws.PROGRESSIVE, 1e-6 * p["force"] * (p["ratio"] - 1) / (p["ratio"] + 1), -1e6)


@pytest.fixture
def lopsided(monkeypatch):
    """Friction that is stronger one way, for the independent generator."""
    values = Value("force", "N", "mean", (1, 2), (1, 2)), Value("ratio", "-", "ratio", (1, 2), (1, 2), neutral=1.0)
    monkeypatch.setitem(HIDDEN, "lopsided", EffectKind("lopsided", "f", suspensions, values, add))
    return lambda ratio: Effect("lopsided", "rear", {"force": 450.0, "ratio": ratio})


@pytest.mark.slow
@pytest.mark.parametrize(("ratio", "name"), [pytest.param(2.0, "asymmetric_friction", marks=pytest.mark.slow), (1.0, "dry_friction")])
def test_in_a_car_that_begins_at_rest_friction_is_named_as_it_is(trials_of, lopsided, ratio, name):
    """That friction is named where it is stronger one way, test_rigs.py asks of a rig, too, and in a tenth of the time."""
    tried = [EFFECTS[item] for item in ("dry_friction", "asymmetric_friction", "asymmetric_damping", "hysteresis")]
    verdict = diagnose_trials(trials_of(lopsided(ratio), runs=HUMPS), tried).verdict
    assert (verdict.verdict, [(item.name, item.place) for item in verdict.effects]) == ("named", [(name, "rear")])
    found = verdict.effects[0].parameters
    assert found["force"].value == pytest.approx(450.0, rel=0.1)
    assert "ratio" not in found or found["ratio"].value == pytest.approx(ratio, rel=0.1)


@pytest.mark.slow
def test_a_special_case_is_found_from_where_the_law_that_holds_it_ended(detection_of, lopsided):
    detection = detection_of(lopsided(1.0), runs=HUMPS)
    fitter = Fitter(detection, detection.base, [])
    vehicle = detection.trials[0].run.vehicle
    general, plain = (
        next(item for item in list_candidates(vehicle, detection.trials, [EFFECTS[name]]) if item.place == "rear")
        for name in ("asymmetric_friction", "dry_friction")
    )
    ended = fitter.fit(general)
    found = fitter.fit_within(plain, ended)
    assert found.last is plain
    assert found.training <= ended.training + 0.02
    assert found.least_squares.values[-1] == pytest.approx(450.0, rel=0.1)


def test_an_effect_of_a_group_is_the_same_at_an_axle_of_it_and_another_at_a_link_or_a_pair_that_shares_one():
    def at(place, *axles):
        return Candidate(EFFECTS["dry_friction"], place, (place,), members=axles)

    every, rear, front, link = at("all suspensions", "front", "mid", "rear"), at("rear", "rear"), at("front", "front"), at("mount", "mount")
    assert same(every, rear)
    assert same(rear, every)
    assert rear.is_among([every])
    assert not same(front, rear)
    assert not same(every, link)
    assert not link.is_among([every])
    assert not same(at("front and mid", "front", "mid"), at("mid and rear", "mid", "rear"))


def test_a_progressive_spring_is_no_tie_with_stops_that_are_met_in_bump_alone():
    stops, spring = fit("bump_stop", "rear", 1.02), fit("progressive_stiffness", "rear", 1.03)
    ranked = simplest_first([stops, spring], BASE)
    assert ranked == [spring, stops]
    assert tied(SimpleNamespace(faint=False, current=BASE, fits=ranked), spring) == []
    both_met = [stops, fit("progressive_stiffness", "rear", 2.0)]
    assert simplest_first(both_met, BASE) == both_met
