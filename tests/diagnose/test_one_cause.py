"""An error that all runs suppose alike: named as one of all runs, and not where each run's is its own."""

from dataclasses import replace

import pytest
from benchmarks.hidden_effects.generator import Effect

from tests.diagnose.conftest import HUMPS
from vehgen.diagnose.decision import Decision
from vehgen.diagnose.detect.detection import detect
from vehgen.diagnose.inputs.conditions import alike_in_all_runs
from vehgen.effects import EFFECTS
from vehgen.fit.nuisances import Condition

LATE = Effect("sensor_delay", "R", {"time": 0.013})
CHOSEN = [EFFECTS[name] for name in ("sensor_delay", "speed_error", "cubic_stiffness")]


def verdict_of(detection):
    return Decision(detection, CHOSEN, False, lambda *_: None).decide().verdict


def at_other_speeds(trials, *errors):
    """Return trials whose true speeds are those of their files times 1 + error."""
    pairs = zip(trials, errors, strict=True)
    return [replace(trial, scenario=trial.scenario.adjusted(speed=1 / (1 + error))) for trial, error in pairs]


@pytest.mark.thorough
def test_a_clock_that_is_as_late_in_all_runs_is_named_or_the_other_as_early(detection_of):
    detection = detection_of(LATE, runs=HUMPS)
    assert detection.is_quiet, "each run may have a clock of its own"
    found = verdict_of(detection)
    assert (found.verdict, {item.name for item in found.effects}) == ("ambiguous", {"sensor_delay"})
    assert found.next_experiment == EFFECTS["sensor_delay"].tie_advice
    for named, delay in zip(sorted(found.effects, key=lambda item: item.place), (-0.013, 0.013), strict=True):
        low, high = named.parameters["delay"].interval
        assert low < delay < high, named.place
        assert high - low < 0.003
    assert found.gap.before > 1.3
    assert found.gap.after < 1.06


@pytest.mark.thorough
def test_speeds_that_are_all_off_the_same_way_are_one_error_beside_small_ones(trials_of):
    detection = detect(at_other_speeds(trials_of(runs=HUMPS), 0.03, 0.043, 0.035))
    assert detection.is_quiet
    found = verdict_of(detection)
    (named,) = found.effects
    assert (found.verdict, named.name) == ("named", "speed_error")
    low, high = named.parameters["scale"].interval
    assert low < 1.036 < high
    assert high - low < 0.04


@pytest.mark.thorough
def test_speeds_that_no_run_may_have_are_one_error_of_all(trials_of):
    """A base holds each at 4 %: it loses the runs' phase, and leaves more than noise, or supposes what cannot be believed."""
    errors = 0.06, 0.07, 0.055
    found = verdict_of(detect(at_other_speeds(trials_of(runs=HUMPS), *errors)))
    (named,) = found.effects
    assert (found.verdict, named.name) == ("named", "speed_error")
    low, high = named.parameters["scale"].interval
    assert low < 1 + sum(errors) / 3 < high
    assert found.gap.after < 1.06


@pytest.mark.thorough
@pytest.mark.parametrize("errors", [(0.03, -0.03, 0.03), (0.012, 0.016, 0.014)], ids=["either way", "small"])
def test_speeds_that_runs_may_well_have_are_no_error_of_all(trials_of, errors):
    assert verdict_of(detect(at_other_speeds(trials_of(runs=HUMPS), *errors))).verdict == "no_missing_effect"


@pytest.mark.thorough
def test_an_error_that_the_library_does_not_have_is_not_named(detection_of):
    found = Decision(detection_of(LATE, runs=HUMPS), CHOSEN[1:], False, lambda *_: None).decide().verdict
    assert found.verdict == "no_missing_effect"
    assert any("the clock of R in all runs is" in note for note in found.notes)


@pytest.mark.parametrize(
    ("speeds", "told"), [((0.012, 0.021, 0.035, 0.024), True), ((0.012, 0.021, 0.035), False), ((-0.001, 0.03, 0.035, 0.03), False)]
)
def test_what_every_run_supposes_and_is_far_off_together_is_told(speeds, told):
    """Speeds known to 1 %: four whose sum is more than four of its standard deviations off, and none the other way."""
    conditions = [Condition(f"run{i}", "speed", "", value, "", 0.01) for i, value in enumerate(speeds)]
    found = alike_in_all_runs(conditions, [f"run{i}" for i in range(len(speeds))])
    more = ("every run supposes it, each another amount, in the mean: the speed in all runs was 2.3 % more than stated",)
    assert found == (more if told else ())
