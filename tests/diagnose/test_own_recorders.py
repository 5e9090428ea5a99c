"""Sensors behind recorders of their own, and behind others than run files say: neither is a missing effect, nor taken for one."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import scipy.signal

from tests.diagnose.conftest import CUBIC, HUMPS, edited
from vehgen.diagnose import decision, without_gap
from vehgen.diagnose.decision import Decision
from vehgen.diagnose.detect.detection import detect, with_usual_recorder
from vehgen.diagnose.inputs.fault import MeasurementFault
from vehgen.diagnose.inputs.recorders import wrongly_declared
from vehgen.diagnose.pipeline import with_evidence
from vehgen.diagnose.select.ranking import SearchRound
from vehgen.fit import chain_estimate
from vehgen.fit.chain_estimate import ChainEstimate, ChainSearch
from vehgen.fit.chain_losses import ChainFit
from vehgen.fit.recorders import FoundRecorder
from vehgen.measure.acquisition import POINT_SAMPLES, UNKNOWN, AcquisitionChain

REAR_HZ = 20.0
BAND_HZ = (0.5, 20.0)


def undeclared(trials):
    """Return trials whose recorders nobody knows."""
    return [replace(item, scenario=replace(item.scenario, chains=dict.fromkeys(item.channels, UNKNOWN))) for item in trials]


def rear_low_passed(values):
    """Return recordings at 100 Hz whose rear sensor is behind a low-pass."""
    low_pass = scipy.signal.bessel(2, REAR_HZ, norm="mag", fs=100.0)
    return np.column_stack([values[:, :2], scipy.signal.lfilter(*low_pass, values[:, 2:], axis=0)])


@pytest.mark.slow
def test_a_healthy_vehicle_behind_two_recorders_lacks_nothing(trials_of, monkeypatch):
    """With one low-pass for all a gap would be left; up to 20 Hz, as chi of different bands cannot be compared."""
    trials = edited(undeclared(trials_of(runs=HUMPS)), rear_low_passed)
    found = detect(trials, BAND_HZ)
    assert found.recorder is not None
    (_, _), (channels, rear) = found.recorder.apart
    assert channels == ("R_az", "R_q")
    assert rear.best.chain.cut_off == pytest.approx(REAR_HZ, rel=0.1)
    assert found.chi < 1.03
    (note,) = with_evidence(Decision(found, [], False, lambda *_: None)._nothing(), lambda *_: None).verdict.notes
    assert note.startswith("the recorders' low-passes are not stated, and differ")
    one = with_usual_recorder(found)
    assert one is not None
    assert one.recorder is not None
    assert one.recorder.apart == ()
    assert one.recorder.is_usual(100.0)
    assert one.base.squares > found.base.squares + 100.0
    monkeypatch.setattr(chain_estimate, "FAR_BETTER", np.inf)
    shared = detect(trials, BAND_HZ)
    assert shared.recorder is not None
    assert shared.recorder.apart == ()
    assert shared.chi > found.chi + 0.03


@pytest.mark.slow
def test_a_missing_effect_is_not_taken_for_low_passes_of_the_sensors(trials_of):
    found = detect(undeclared(trials_of(CUBIC, runs=HUMPS)))
    assert found.recorder is not None
    assert found.recorder.apart == ()
    assert not found.is_quiet


@pytest.mark.thorough
@pytest.mark.parametrize("fallen", [149.0, 151.0])
@pytest.mark.parametrize("told", [None, "told"])
def test_one_recorder_and_an_effect_stand_in_place_of_each_sensors_own_where_they_explain_far_more(detection_of, monkeypatch, fallen, told):
    """By the fall that tells an effect; else all is as it was before."""
    stated = detection_of(CUBIC, runs=HUMPS)
    known = replace(stated, recorder=SimpleNamespace(apart=("F", "R")))
    one = replace(known)
    found = SearchRound(one.base, (), (), (one.base,))
    monkeypatch.setattr(without_gap, "with_usual_recorder", lambda detection: one)
    monkeypatch.setattr(without_gap, "faint_round", lambda detection, candidates, runner: found)
    monkeypatch.setattr(without_gap, "merit", lambda fit: known.base.squares - fallen)
    made = Decision(known, [], False, lambda *_: None)
    monkeypatch.setattr(made, "_faint", lambda found: told)
    assert made._by_one_recorder() == (told if fallen > 150 else None)
    assert made.detection is (one if told and fallen > 150 else known)
    assert with_usual_recorder(stated) is None, "run files declare them"


SLOW = AcquisitionChain("butterworth", 4, 12.0)


def declared(trials, **chains):
    """Return trials whose run files say of channels what `chains` has by sensor."""
    found = []
    for item in trials:
        stated = {name: chains.get(name[0], POINT_SAMPLES) for name in item.channels}
        found.append(replace(item, scenario=replace(item.scenario, chains=stated)))
    return found


@pytest.mark.slow
def test_a_recorder_that_is_not_what_run_files_say_is_told(trials_of):
    late = AcquisitionChain("none", delay=0.03)  # of R, which a clock tells
    (fault,) = wrongly_declared(detect(declared(trials_of(runs=HUMPS), F=SLOW, R=late)))
    assert (fault.kind, fault.channels) == ("recorder", ("F_az", "F_q"))
    assert "`acquisition` says a butterworth low-pass of order 4 at 12 Hz, but the recordings look as if made through" in fault.message
    assert fault.value is None or fault.value > 30.0


def test_a_recorder_that_is_what_run_files_say_is_not_blamed_for_an_effect(detection_of):
    assert wrongly_declared(detection_of(CUBIC, runs=HUMPS)) == ()


def test_what_nobody_declares_cannot_be_declared_wrongly(detection_of, monkeypatch):
    monkeypatch.setattr(ChainSearch, "of", None)  # a search would fail
    detection = detection_of(CUBIC, runs=HUMPS)
    sought = FoundRecorder(ChainEstimate(ChainFit(SLOW, 1.0), (), 1.0, True), (0.5, 40.0), False, ("F_az", "F_q", "R_az", "R_q"))
    assert wrongly_declared(replace(detection, recorder=sought)) == ()


@pytest.mark.parametrize("faint", [False, True])
def test_a_wrong_declaration_is_told_before_any_effect(detection_of, monkeypatch, faint):
    fault = MeasurementFault("recorder", (), ("F_az",), "F_az: `acquisition` says otherwise", "write unknown")
    for module in (decision, without_gap):
        monkeypatch.setattr(module, "wrongly_declared", lambda detection: (fault,))
    monkeypatch.setattr(decision, "plain_mistakes", lambda detection: ())
    monkeypatch.setattr(without_gap, "faint_look_again", lambda found, detection, runner: (found, detection))
    monkeypatch.setattr(without_gap, "faintly_told", lambda found, detection: found.current)
    detection = detection_of(CUBIC, runs=HUMPS)
    made = Decision(detection, [], False, lambda *_: None)
    told = made._faint(SearchRound(detection.base, (), (), ())) if faint else made.decide()
    assert told is not None
    assert (told.verdict.verdict, told.verdict.faults) == ("measurement_fault", (fault,))
