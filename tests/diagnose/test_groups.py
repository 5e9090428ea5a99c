"""One law in several suspensions alike, several effects that only together explain the runs, and parameters that are far off."""

import pytest
from benchmarks.hidden_effects.generator import Effect

from vehgen.diagnose.pipeline import diagnose_trials
from vehgen.effects import EFFECTS
from vehgen.vehicle import load_vehicle

FEW = [EFFECTS[name] for name in ("cubic_stiffness", "quadratic_damping", "sensor_gain")]
BOTH = (Effect("cubic_stiffness", "front", {"k3": 1.5e8}), Effect("cubic_stiffness", "rear", {"k3": 1.5e8}))


def test_a_law_that_all_suspensions_have_alike_is_named_once(trials_of):
    verdict = diagnose_trials(trials_of(*BOTH), FEW).verdict
    assert (verdict.verdict, [(item.name, item.place) for item in verdict.effects]) == ("named", [("cubic_stiffness", "all suspensions")])
    assert verdict.effects[0].parameters["k3"].value == pytest.approx(1.5e8, rel=0.05)
    assert verdict.gap.after < 1.1


def test_a_stiffness_that_the_file_has_far_too_small_is_no_effect(trials_of):
    vehicle = load_vehicle("sedan2")
    true = vehicle.all_values(vehicle.values())
    verdict = diagnose_trials(trials_of(parameters=true | {"ktr": 2.5 * true["ktr"]}), FEW).verdict
    assert verdict.effects == ()
    assert "ktr" in verdict.reason
    assert verdict.verdict in ("insufficient_data", "measurement_fault")
