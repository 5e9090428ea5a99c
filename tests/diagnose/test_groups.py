"""One law in several suspensions alike, several effects that only together explain the runs, and parameters that are far off."""

from dataclasses import replace

import pytest
from benchmarks.hidden_effects.generator import Effect

from tests.diagnose.conftest import HUMPS
from vehgen.diagnose.fits.candidate import Candidate
from vehgen.diagnose.fits.model_fit import ModelFit
from vehgen.diagnose.pipeline import diagnose_trials
from vehgen.diagnose.select.group_members import member_seeds, with_members
from vehgen.diagnose.select.ranking import SearchRound
from vehgen.effects import EFFECTS
from vehgen.vehicle import load_vehicle

FEW = [EFFECTS[name] for name in ("cubic_stiffness", "quadratic_damping", "sensor_gain")]
BOTH = (Effect("cubic_stiffness", "front", {"k3": 1.5e8}), Effect("cubic_stiffness", "rear", {"k3": 1.5e8}))


@pytest.mark.slow
def test_a_law_that_all_suspensions_have_alike_is_named_once(trials_of):
    verdict = diagnose_trials(trials_of(*BOTH, runs=HUMPS), FEW).verdict
    assert (verdict.verdict, [(item.name, item.place) for item in verdict.effects]) == ("named", [("cubic_stiffness", "all suspensions")])
    assert verdict.effects[0].parameters["k3"].value == pytest.approx(1.5e8, rel=0.05)
    assert verdict.gap.after < 1.1


@pytest.mark.slow
def test_a_stiffness_that_the_file_has_far_too_small_is_no_effect(trials_of):
    vehicle = load_vehicle("sedan2")
    true = vehicle.all_values(vehicle.values())
    verdict = diagnose_trials(trials_of(parameters=true | {"ktr": 2.5 * true["ktr"]}, runs=HUMPS), FEW).verdict
    assert verdict.effects == ()
    assert "ktr" in verdict.reason
    assert verdict.verdict in ("insufficient_data", "measurement_fault")


@pytest.mark.slow
def test_a_law_that_two_suspensions_have_in_different_strength_is_named_at_each(trials_of):
    apart = (Effect("dry_friction", "front", {"force": 500.0}), Effect("dry_friction", "rear", {"force": 1100.0}))
    verdict = diagnose_trials(trials_of(*apart), [EFFECTS[name] for name in ("dry_friction", "quadratic_damping")]).verdict
    assert verdict.verdict == "named", verdict.reason
    assert {(item.name, item.place): item.parameters["force"].value for item in verdict.effects} == {
        ("dry_friction", "front"): pytest.approx(500.0, rel=0.1),
        ("dry_friction", "rear"): pytest.approx(1100.0, rel=0.1),
    }


@pytest.mark.thorough
def test_a_group_is_taken_apart_at_its_axles_the_simplest_law_first(detection_of):
    base = detection_of(*BOTH, runs=HUMPS).base

    def fit(name, place, training, *axles):
        return replace(base, effects=(Candidate(EFFECTS[name], place, (), members=axles or (place,)),), training=training)

    every = [
        Candidate(EFFECTS[name], place, (), members=(place,)) for name in ("dry_friction", "asymmetric_friction") for place in ("a", "b")
    ]
    found = SearchRound(base, (), (), (fit("asymmetric_friction", "a and b", 5.0, "a", "b"), fit("dry_friction", "a", 9.0)))
    asked = []

    def fit_one(candidate) -> ModelFit:
        asked.append(candidate.label)
        return fit(candidate.effect.name, candidate.place, 7.0 if candidate.place == "b" else 8.0)

    apart = with_members(found, every, fit_one)
    assert sorted(asked) == ["asymmetric_friction at a", "asymmetric_friction at b", "dry_friction at b"]
    assert apart.fits[0] is found.fits[0]
    assert [item.label for item in member_seeds(apart)] == ["dry_friction at b", "asymmetric_friction at b"]
    single = replace(found, fits=found.fits[1:])
    assert with_members(single, every, fit_one) is single
    assert member_seeds(single) == []
