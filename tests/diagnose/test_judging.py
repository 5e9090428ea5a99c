"""Which mistakes of the measurement win: over one another, and over effects."""

from types import SimpleNamespace

import pytest

from tests.diagnose.conftest import CUBIC, HUMPS
from vehgen.diagnose import decision, ending
from vehgen.diagnose.combining import Combiner
from vehgen.diagnose.decision import Decision
from vehgen.diagnose.inputs import judging
from vehgen.diagnose.inputs.fault import Hypothesis, MeasurementFault, always
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
    monkeypatch.setattr(judging, "BaseRefits", lambda detection: case)
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
    ],
    ids=["one run's speed", "not all of the gap", "all speeds", "a hump"],
)
def test_a_wrong_speed_of_some_runs_is_told_before_effects_are_tried(monkeypatch, detection_of, kind, runs, at_once, told):
    """A truck's strained base had supposed four things of a run 9 % too fast, and effects were tried for ten minutes beside it."""
    fault = MeasurementFault(kind, runs, (), f"the {kind} is another", "measure it")
    monkeypatch.setattr(ending, "find_mistakes", lambda detection: judging.Undone((fault,), 0.01, at_once, None))
    found = Decision(detection_of(CUBIC, runs=HUMPS), [], False, lambda *_: None)._one_speed()
    assert (found is not None and found.verdict.faults == (fault,)) == told
