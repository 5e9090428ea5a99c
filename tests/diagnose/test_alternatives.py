"""Rivals of an effect that was found first, looked for anew beside what was found after it."""

import pytest
from benchmarks.hidden_effects.generator import Effect

from tests.diagnose.conftest import CUBIC, HUMPS
from vehgen.diagnose.pipeline import diagnose_trials
from vehgen.effects import EFFECTS

LATE = Effect("sensor_delay", "R", {"time": 0.06})
TRIED = [EFFECTS[name] for name in ("cubic_stiffness", "sensor_delay")]


@pytest.fixture(scope="module")
def found(trials_of):
    return diagnose_trials(trials_of(CUBIC, LATE, runs=HUMPS), TRIED)


@pytest.mark.slow
def test_a_late_phone_beside_another_effect_is_tied_with_the_other_phone_being_early(found):
    """In the round of the first effect the two differ, as the other effect is still missing."""
    effects = {item.name: item for item in found.verdict.effects}
    assert set(effects) == {"cubic_stiffness", "sensor_delay"}
    delay = effects["sensor_delay"]
    assert delay.alternatives == (f"sensor_delay at {'F' if delay.place == 'R' else 'R'}",)
    assert found.verdict.verdict == "ambiguous"
    assert found.verdict.next_experiment == EFFECTS["sensor_delay"].tie_advice
    assert abs(delay.parameters["delay"].value) == pytest.approx(0.06, abs=0.01)  # any clock may be 10 ms off


@pytest.mark.slow
def test_the_spring_beside_it_has_no_rival(found):
    (spring,) = [item for item in found.verdict.effects if item.name == "cubic_stiffness"]
    assert (spring.place, spring.alternatives) == ("rear", ())
