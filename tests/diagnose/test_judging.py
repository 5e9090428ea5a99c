"""Which mistakes of the measurement win: over one another, and over effects."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from benchmarks.hidden_effects.generator import nominal, perturbed

from tests.diagnose.conftest import CUBIC, HUMPS
from vehgen.diagnose import decision, ending
from vehgen.diagnose.combining import Combiner
from vehgen.diagnose.decision import Decision
from vehgen.diagnose.detect.detection import detect
from vehgen.diagnose.inputs import judging
from vehgen.diagnose.inputs.fault import Hypothesis, MeasurementFault, always
from vehgen.diagnose.inputs.refits import BaseRefits
from vehgen.diagnose.select.ranking import SearchRound
from vehgen.effects import EFFECTS

FAULT = MeasurementFault("hump", ("high",), (), "the hump in high is another than the file says", "measure it")


def supposed(kind, left, sigmas):
    """Return a hypothesis with its refit: what it leaves, and what it supposes of runs beside."""
    fit = SimpleNamespace(x=None, misfit=SimpleNamespace(adjusted=lambda x: x), conditions=lambda: [SimpleNamespace(sigmas=sigmas)])
    return Hypothesis((), always(MeasurementFault(kind, (), (), kind, "")), 0.25), (fit, left)


@pytest.mark.parametrize(
    ("others", "told"),
    [((0.01, 0.5), "easy"), ((0.2, 0.5), "strained"), ((0.01, 4.0), "strained")],
    ids=["leaves noise", "leaves more than noise", "strained too"],
)
def test_of_mistakes_that_leave_noise_one_that_supposes_nothing_else_is_told(monkeypatch, others, told):
    both = [supposed("strained", -0.05, 4.0), supposed("easy", *others)]
    fits = {id(hypothesis): fit for hypothesis, fit in both}
    monkeypatch.setattr(judging, "PLAIN", ())
    monkeypatch.setattr(judging, "SUBTLE", tuple(lambda case, item=item: [item] for item, _ in both))
    case = SimpleNamespace(excess=3.0, first_excess=3.0, judge=lambda item: fits[id(item)], accept=lambda *_: setattr(case, "excess", 0.0))
    monkeypatch.setattr(judging, "base_refits", lambda detection: case)
    undone = judging.find_mistakes(None)
    assert [fault.kind for fault in undone.faults] == [told]
    assert undone.at_once == (told == "easy"), "what supposes something beyond belief does not tell all"


@pytest.mark.parametrize(("kind", "unsure", "told"), [("low_pass", True, True), ("low_pass", False, False), ("hump", True, False)])
def test_a_low_pass_wins_over_an_effect_that_leaves_something_where_it_does_nearly_as_well(kind, unsure, told):
    """A footprint left 0.066 of the excess of recordings through a low-pass at 8 Hz, which itself left 0.111: it had cut the noise, too."""
    found = (SimpleNamespace(kind=kind),)
    undone = judging.Undone(found, 0.111, False, None)
    detection, footprint = SimpleNamespace(is_quiet=False, chi=5.667), SimpleNamespace(chi=1.745)
    assert judging.explain_gap(detection, footprint, unsure, undone=undone) == (found if told else ())


@pytest.mark.parametrize("at_once", [True, False])
def test_pairs_of_effects_are_not_looked_for_where_one_mistake_leaves_noise(monkeypatch, detection_of, at_once):
    asked = []
    monkeypatch.setattr(ending, "find_mistakes", lambda detection: judging.Undone((FAULT,), 0.01, at_once, None))
    monkeypatch.setattr(Combiner, "pair", lambda *_: asked.append("pair") or [])
    monkeypatch.setattr(Combiner, "together", lambda *_: [])
    monkeypatch.setattr(decision, "with_members", lambda first, *_: first)
    found = Decision(detection_of(CUBIC, runs=HUMPS), [EFFECTS["asymmetric_damping"]], False, lambda *_: None)
    found.rounds = [SimpleNamespace(fits=(), passed=())]
    found._combine(found.rounds[0])
    assert asked == ([] if at_once else ["pair"])
    assert found._other_mistakes(found.rounds[0]).verdict.faults == (FAULT,)


@pytest.mark.parametrize("passed", [(), ("suspension rear",)])
def test_another_vehicle_is_not_told_where_one_force_at_a_place_explains_the_gap(monkeypatch, detection_of, passed):
    other = MeasurementFault("other_parameters", (), (), "the recordings are of a vehicle with other parameters", "check the file")
    monkeypatch.setattr(ending, "find_mistakes", lambda detection: judging.Undone((other,), 0.01, False, None))
    found = Decision(detection_of(CUBIC, runs=HUMPS), [EFFECTS["asymmetric_damping"]], False, lambda *_: None)
    told = found._other_mistakes(SimpleNamespace(fits=(), passed=passed))
    assert (told is None) == bool(passed)


@pytest.mark.parametrize(
    ("kind", "runs", "at_once", "told"),
    [
        ("speed", ("high",), True, True),
        ("speed", ("high",), False, False),
        ("speed", ("low", "high", "fast"), True, False),
        ("hump", ("high",), True, False),
        ("low_pass", ("low", "high", "fast"), True, True),
        ("clock_or_speed", (), True, True),
        ("clock_or_speed", (), False, False),
    ],
    ids=["one run's speed", "not all of the gap", "all speeds", "a hump", "a low-pass", "a clock", "a clock and more"],
)
def test_a_wrong_speed_of_some_runs_is_told_before_effects_are_tried(monkeypatch, detection_of, kind, runs, at_once, told):
    """A truck's strained base had supposed four things of a run 9 % too fast, and effects were tried for ten minutes beside it."""
    fault = MeasurementFault(kind, runs, (), f"the {kind} is another", "measure it")
    monkeypatch.setattr(ending, "find_mistakes", lambda detection: judging.Undone((fault,), 0.01, at_once, None))
    found = Decision(detection_of(CUBIC, runs=HUMPS), [], False, lambda *_: None)._one_mistake()
    assert (found is not None and found.verdict.faults == (fault,)) == told


def test_a_low_pass_may_be_a_tyre_that_smooths_where_runs_do_not_differ_in_speed(monkeypatch, detection_of):
    fault = MeasurementFault("low_pass", ("low", "high", "fast"), (), "low-passed at 8 Hz", "record faster")
    monkeypatch.setattr(ending, "find_mistakes", lambda detection: judging.Undone((fault,), 0.01, True, None))
    monkeypatch.setattr(ending.limit, "VARIED_SPEEDS", 2.1)
    assert Decision(detection_of(CUBIC, runs=HUMPS), [], False, lambda *_: None)._one_mistake() is None


def test_refits_begin_at_a_vehicle_that_is_known(detection_of):
    """From the file's values they had ended far off, and a speed in km/h of the validation run alone was not told."""
    known, lacking = (detection_of(*effects, runs=HUMPS) for effects in ((), (CUBIC,)))
    space = known.problem.space
    assert BaseRefits(known).begin == pytest.approx(space.unit(known.base.least_squares.values))
    assert BaseRefits(lacking).begin == pytest.approx(space.unit(space.start))


def test_the_vehicle_is_known_by_the_other_runs_where_one_is_wrong(trials_of):
    """The base bends to a run that was driven faster than stated; those without it tell the vehicle, and what it does in that run."""
    truth = perturbed("sedan2", 3)
    wrong = [replace(item, scenario=item.scenario.adjusted(speed=0.8)) if item.name == "high" else item for item in trials_of(runs=HUMPS)]
    case = BaseRefits(detect(wrong))
    assert case.odd == "high"
    off = {name: abs(np.log(case.known[name] / truth[name])) for name in ("kf", "kr", "cf", "cr")}
    filed = {name: abs(np.log(nominal("sedan2")[name] / truth[name])) for name in off}
    assert sum(off.values()) < 0.5 * sum(filed.values())
    low = next(item for item in case.trials if item.name == "low")
    by_known, by_file = case.predict(low), BaseRefits.predict(SimpleNamespace(known={}, shared=(), numbers=()), low)
    recorded = low.recording.values
    assert np.sum((by_known - recorded) ** 2) < 0.5 * np.sum((by_file - recorded) ** 2)


@pytest.mark.parametrize("mistake", ["mistake", None])
def test_a_mistake_that_an_effect_imitates_is_told(monkeypatch, detection_of, mistake):
    found = Decision(detection_of(CUBIC, runs=HUMPS), [], False, lambda *_: None)
    monkeypatch.setattr(decision, "passes", lambda fit, base: True)
    monkeypatch.setattr(Decision, "_too_weak", lambda self, *_: None)
    monkeypatch.setattr(Decision, "_imitation", lambda self, best: "it imitates what the model misses")
    monkeypatch.setattr(Decision, "_other_mistakes", lambda self, first: mistake)
    monkeypatch.setattr(Decision, "_unknown", lambda self, first, reason: reason)
    assert found._add(SimpleNamespace(fits=("tilt",))) == (mistake or "it imitates what the model misses")


@pytest.mark.parametrize(("effects", "told"), [((), "mistake"), ((CUBIC,), "out of range")], ids=["unseen", "seen"])
def test_a_gap_of_validation_runs_alone_is_first_held_against_mistakes(monkeypatch, detection_of, effects, told):
    decision_of = Decision(detection_of(*effects, runs=HUMPS), list(EFFECTS.values()), False, lambda *_: None)
    monkeypatch.setattr(Decision, "_search_round", lambda self, current: SearchRound(current, (), (), ()))
    monkeypatch.setattr(decision, "freed_instead", lambda first, base: base)
    monkeypatch.setattr(Decision, "_other_mistakes", lambda self, first: "mistake")
    monkeypatch.setattr(Decision, "_out_of_range", lambda self, freed: "out of range")
    assert decision_of._explain_gap() == told


@pytest.mark.slow
def test_exchanged_channels_of_a_stranger_are_told(monkeypatch, trials_of):
    """Noise is told so large there that the base explains the runs, of whose energy it leaves four fifths."""
    swapped = []
    for trial in trials_of(runs=HUMPS):
        values = trial.recording.values.copy()
        values[:, :2] = values[:, 1::-1]
        swapped.append(replace(trial, recording=replace(trial.recording, values=values)))
    detection = detect(swapped)
    stranger = MeasurementFault("stranger", (), (), "they have nothing to do with the vehicle", "check them")
    fits = detection.base.least_squares
    monkeypatch.setattr(judging, "unrelated_recording", lambda fit: (stranger,) if fit is fits else ())
    found = [(item.kind, item.channels) for item in judging.supposed_mistakes(detection)]
    assert ("exchanged", tuple(sorted(detection.trials[0].channels[:2]))) in found
    assert "stranger" not in [kind for kind, _ in found]
