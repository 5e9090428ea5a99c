"""A run whose recording shows a mistake by itself is left out where three others tell what is missing."""

import numpy as np
import pytest
from benchmarks.hidden_effects.generator import Effect, Hump, RunSpec

from tests.diagnose.conftest import HUMPS, edited
from vehgen.diagnose.inputs.fault import MeasurementFault
from vehgen.diagnose.left_out import LeftOut, leave_out
from vehgen.diagnose.pipeline import diagnose_trials
from vehgen.diagnose.result import Decided, DiagnosisModels
from vehgen.diagnose.verdict import Gap, Verdict
from vehgen.effects import effects_named
from vehgen.report.pages.diagnosis_page import diagnosis_page

RUNS = (*HUMPS, RunSpec((Hump(0.5, 0.03, 5.0),), 3.0, 5.0, "middle"))
FRICTION = Effect("dry_friction", "rear", {"force": 800.0})


def clip(values):
    level = 0.6 * np.abs(values[:, 0]).max()
    values[:, 0] = np.clip(values[:, 0], -level, level)
    return values


def hold(values):
    start = int(np.abs(values[:, 1]).argmax())
    values[start : start + 60, 1] = values[start, 1]
    return values


@pytest.mark.parametrize(("change", "kinds", "channel"), [(clip, ["clipped"], "F_az"), (hold, ["clipped", "stuck"], "F_q")])
def test_a_run_that_shows_its_mistake_is_left_out_of_four(trials_of, change, kinds, channel):
    rest, left_out = leave_out(edited(trials_of(runs=RUNS), change, only="high"))
    assert {trial.name for trial in rest} == {"low", "middle", "fast"}
    assert [trial.name for trial in left_out.trials] == ["high"]
    assert [(item.kind, item.runs, item.channels) for item in left_out.faults] == [(kind, ("high",), (channel,)) for kind in kinds]


def test_nothing_is_left_out_of_good_runs_nor_where_too_few_would_remain(trials_of):
    whole = trials_of(runs=RUNS)
    assert leave_out(whole) == (list(whole), LeftOut())
    three = edited([trial for trial in whole if trial.name != "middle"], clip, only="high")
    assert leave_out(three) == (three, LeftOut())


@pytest.mark.thorough
def test_friction_is_named_beside_a_clipped_run(trials_of):
    found = diagnose_trials(edited(trials_of(FRICTION, runs=RUNS), clip, only="high"), effects_named(["dry_friction", "cubic_stiffness"]))
    verdict = found.verdict
    assert (verdict.verdict, [(item.name, item.place) for item in verdict.effects]) == ("named", [("dry_friction", "rear")])
    assert [(item.kind, item.runs) for item in verdict.faults] == [("clipped", ("high",))]
    assert any(note.startswith("high left out: high: F_az is clipped at ") for note in verdict.notes)
    assert {item.run for item in verdict.gap.runs} == {"low", "middle", "fast"}
    assert sum(path.endswith("high.csv") for path in found.evidence.origin.inputs) == 1


@pytest.mark.thorough
def test_where_nothing_is_missing_the_mistake_is_told_and_what_the_other_runs_say(trials_of):
    verdict = diagnose_trials(edited(trials_of(runs=RUNS), clip, only="high"), effects_named(["dry_friction", "cubic_stiffness"])).verdict
    assert verdict.verdict == "measurement_fault"
    assert verdict.reason.startswith("The measurement is at fault: high: F_az is clipped at ")
    assert any(note.startswith("without high: Nothing is missing") for note in verdict.notes)


def test_a_mistake_of_the_other_runs_stands_beside_that_of_the_run_left_out(trials_of):
    gain = MeasurementFault("gain", ("low",), ("R_az",), "low: R_az reads 20 % too much", "calibrate it", 1.2)
    verdict = Verdict("measurement_fault", "The measurement is at fault: low", (), Gap(2.0, 2.0, 1.0), faults=(gain,))
    decided = Decided(DiagnosisModels(None, (), ()), verdict)
    _, left_out = leave_out(edited(trials_of(runs=RUNS), clip, only="high"))
    told = left_out.told_beside(decided)
    assert [item.kind for item in told.verdict.faults] == ["clipped", "gain"]
    assert told.verdict.notes == ("without high: The measurement is at fault: low",)
    assert told.verdict.reason.startswith("The measurement is at fault: high: F_az is clipped at ")
    assert told.verdict.reason.endswith("; low: R_az reads 20 % too much")
    assert told.models.left_out == left_out.trials
    assert LeftOut().told_beside(decided) is decided


@pytest.mark.parametrize("stopped", [True, False])
def test_of_a_stopped_diagnosis_only_that_is_told_beside_the_run_left_out(trials_of, stopped):
    """Else a mistake stands in the place of a verdict that asks for more; what it asks for would not put the mistake right."""
    verdict = Verdict("insufficient_data", "No verdict: it was stopped", (), Gap(2.0, 2.0, 1.0), next_experiment="run it to its end")
    _, left_out = leave_out(edited(trials_of(runs=RUNS), clip, only="high"))
    told = left_out.told_beside(Decided(DiagnosisModels(None, (), ()), verdict, stopped)).verdict
    assert [item.kind for item in told.faults] == ["clipped"]
    assert told.verdict == ("insufficient_data" if stopped else "measurement_fault")
    assert told.next_experiment == ("run it to its end" if stopped else None)
    assert told.reason.startswith("No verdict" if stopped else "The measurement is at fault: high")


@pytest.mark.thorough
@pytest.mark.parametrize("whole", [True, False])
def test_a_page_says_whether_what_it_shows_has_the_mistake_in_it(trials_of, whole):
    runs = edited(trials_of(runs=RUNS if not whole else HUMPS), clip, only="high")
    page = diagnosis_page(diagnose_trials(runs, effects_named(["dry_friction"])))
    assert ("shows the gap with the mistake in it" in page) is whole
    assert ("Runs with a mistake are left out of what follows" in page) is not whole
