"""Errors at their bounds: freed where a gap is small, and many of them given up for a single mistake that leaves noise."""

from dataclasses import replace
from types import SimpleNamespace

import pytest

from tests.diagnose.conftest import CUBIC, HUMPS
from vehgen.diagnose import decision
from vehgen.diagnose.decision import Decision
from vehgen.diagnose.detect.detection import FREE_SIGMAS, Detection
from vehgen.diagnose.inputs import judging
from vehgen.diagnose.inputs.fault import MeasurementFault

SPEED = MeasurementFault("speed", ("fast",), (), "the speed in fast was 12 % higher", "measure it")
AXLE = MeasurementFault("axle_position", (), ("rear",), "rear runs 0.3 m further behind", "measure it")


def silent(*known):
    """Tell nothing of progress."""


@pytest.mark.parametrize("closes", [True, False])
@pytest.mark.parametrize("small", [True, False])
def test_a_small_gap_is_tried_with_errors_as_large_as_they_will(monkeypatch, detection_of, small, closes):
    """Held at four standard deviations, a speed 12 % off left chi 1.1: too weak to name, and no mistake was looked for."""
    detection = detection_of(runs=HUMPS) if small else detection_of(CUBIC, runs=HUMPS)
    freed = replace(detection)
    monkeypatch.setattr(Detection, "is_quiet", property(lambda self: closes and self is freed))
    monkeypatch.setattr(decision, "is_strained", lambda fit: True)
    monkeypatch.setattr(decision, "supposing", lambda item, most: freed if most == FREE_SIGMAS else None)
    monkeypatch.setattr(decision, "supposed_mistakes", lambda item: (SPEED,) if item is freed else ())
    monkeypatch.setattr(decision, "plain_mistakes", lambda item: (AXLE,))
    monkeypatch.setattr(Decision, "_strained", lambda self, mistakes: self._mistaken(mistakes))
    told = Decision(detection, [], False, silent).decide()
    assert told.verdict.faults == ((SPEED,) if small and closes else (AXLE,))
    assert (told.models.detection is freed) == (small and closes)


@pytest.mark.parametrize(("at_once", "mistakes", "simpler"), [(True, 2, True), (False, 2, False), (True, 1, False)])
def test_a_single_mistake_that_leaves_noise_goes_before_many_errors(monkeypatch, detection_of, at_once, mistakes, simpler):
    """An axle 0.3 m elsewhere was told as eight speeds that wander."""
    detection = detection_of(runs=HUMPS)
    found = SimpleNamespace(verdict=SimpleNamespace(faults=(AXLE,)))

    def explain(self):
        self.undone = self.detection, SimpleNamespace(at_once=at_once)
        return found

    monkeypatch.setattr(Detection, "is_quiet", property(lambda self: False))
    monkeypatch.setattr(decision, "supposing", lambda item, most: replace(item))
    monkeypatch.setattr(Decision, "_one_mistake", lambda self: None)
    monkeypatch.setattr(Decision, "_explain_gap", explain)
    monkeypatch.setattr(decision, "one_error", lambda *_: SimpleNamespace(stopped=False, fits=()))
    monkeypatch.setattr(decision, "explains_easily", lambda item: False)
    told = Decision(detection, [], False, silent)._strained((SPEED,) * mistakes)
    assert (told is found) == simpler
    assert told.verdict.faults == ((AXLE,) if simpler else (SPEED,) * mistakes)


@pytest.mark.parametrize(("by_rate", "told"), [(0.001, "clock_rate"), (0.02, "axle_position"), (None, "axle_position")])
def test_axles_elsewhere_are_held_against_a_clock_that_runs_fast(monkeypatch, by_rate, told):
    """A clock 10 % fast was told as a wheelbase 10 % longer."""

    def judged(case, generators):
        left = 0.01 if generators == (judging.axle_hypotheses,) else by_rate
        kind = AXLE if generators == (judging.axle_hypotheses,) else replace(AXLE, kind="clock_rate")
        hypothesis = SimpleNamespace(limit=0.5)
        return [] if left is None else [SimpleNamespace(left=left, hypothesis=hypothesis, faults=(kind,), explains=lambda excess: True)]

    monkeypatch.setattr(judging, "base_refits", lambda detection: SimpleNamespace(excess=1.0))
    monkeypatch.setattr(judging, "_judge", judged)
    assert [item.kind for item in judging.timing_mistakes(None)] == [told]


@pytest.mark.parametrize("verdict", ["too_weak", "named"])
@pytest.mark.parametrize("quiet", [True, False])
@pytest.mark.parametrize("strained", [True, False])
def test_a_gap_that_closes_on_a_second_look_is_none(monkeypatch, detection_of, verdict, quiet, strained):
    """Another hump in one run left chi 3.6, and 1.01 by the noise found with the best effect: that ended as too weak."""
    first = detection_of(runs=HUMPS)
    second = replace(first)

    def explain(self):
        self.detection = second
        self.rounds.append("of the first look")
        return SimpleNamespace(verdict=SimpleNamespace(verdict=verdict))

    monkeypatch.setattr(Detection, "is_quiet", property(lambda self: quiet and self is second))
    monkeypatch.setattr(decision, "plain_mistakes", lambda item: ())
    monkeypatch.setattr(decision, "wrongly_declared", lambda item: ())
    monkeypatch.setattr(decision, "supposed_mistakes", lambda item: (SPEED,) if strained else ())
    monkeypatch.setattr(Decision, "_explain_gap", explain)
    monkeypatch.setattr(Decision, "_strained", lambda self, mistakes: mistakes)
    monkeypatch.setattr(Decision, "_quiet", lambda self: "quiet")
    made = Decision(first, [], False, silent)
    told = made.decide()
    if verdict == "named" or not quiet:
        assert told.verdict.verdict == verdict
    else:
        assert told == ((SPEED,) if strained else "quiet")
    assert bool(made.rounds) == (verdict == "named" or not quiet)
