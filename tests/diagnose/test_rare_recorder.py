"""A gap behind a recorder as no other is: an effect through a usual one may explain all."""

from dataclasses import replace
from types import SimpleNamespace

import pytest

from tests.diagnose.conftest import CUBIC, HUMPS
from tests.diagnose.test_own_recorders import undeclared
from vehgen.diagnose import decision
from vehgen.diagnose import thresholds as limit
from vehgen.diagnose.decision import Decision
from vehgen.diagnose.detect.detection import detect, with_usual_recorder
from vehgen.measure.acquisition import AcquisitionChain


def ended(after, effects=("named",)):
    return SimpleNamespace(stopped=False, verdict=SimpleNamespace(effects=effects, gap=SimpleNamespace(after=after)))


@pytest.mark.thorough
@pytest.mark.parametrize(
    ("found", "is_told"), [(ended(limit.WEAK), True), (ended(limit.WEAK + 0.01), False), (ended(1.0, ()), False), (None, False)]
)
def test_it_is_told_where_it_leaves_noise(detection_of, monkeypatch, found, is_told):
    detection = detection_of(CUBIC, runs=HUMPS)
    monkeypatch.setattr(decision, "noise_by_its_law", lambda detection, first: None)
    monkeypatch.setattr(decision, "with_usual_recorder", lambda detection: None if found is None else detection)
    monkeypatch.setattr(Decision, "_explain_gap", lambda self, anew: found)
    made = Decision(detection, [], False, lambda *_: None)
    assert made._otherwise(SimpleNamespace()) is (found if is_told else None)
    assert not made.interrupted


@pytest.mark.slow
def test_a_usual_recorder_stands_in_place_of_a_rare_one(trials_of):
    found = detect(undeclared(trials_of(runs=HUMPS)))
    assert found.recorder is not None
    known = found.recorder.estimate
    rare = replace(known, best=replace(known.best, chain=AcquisitionChain("bessel", 8, 8.0)))
    usual, slow = (replace(found, recorder=replace(found.recorder, estimate=item)) for item in (known, rare))
    assert with_usual_recorder(usual) is None
    anew = with_usual_recorder(slow)
    assert anew is not None
    assert anew.recorder.is_usual(100.0)
    assert {trial.scenario.chain("F_az") for trial in anew.trials} == {anew.recorder.chain}
    assert anew.chi == pytest.approx(found.chi, abs=0.05)
