"""Sensors behind recorders of their own, which no file declares: neither a missing effect, nor taken for one."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.signal

from tests.diagnose.conftest import CUBIC, HUMPS, edited
from vehgen.diagnose.decision import Decision
from vehgen.diagnose.detect.detection import detect
from vehgen.diagnose.pipeline import with_evidence
from vehgen.fit import chain_estimate
from vehgen.measure.acquisition import UNKNOWN

REAR_HZ = 20.0


def undeclared(trials):
    """Return trials whose recorders nobody knows."""
    return [replace(item, scenario=replace(item.scenario, chains=dict.fromkeys(item.channels, UNKNOWN))) for item in trials]


def rear_low_passed(values):
    """Return recordings at 100 Hz whose rear sensor is behind a low-pass."""
    low_pass = scipy.signal.bessel(2, REAR_HZ, norm="mag", fs=100.0)
    return np.column_stack([values[:, :2], scipy.signal.lfilter(*low_pass, values[:, 2:], axis=0)])


def test_a_healthy_vehicle_behind_two_recorders_lacks_nothing(trials_of, monkeypatch):
    """With one low-pass for all a gap would be left."""
    trials = edited(undeclared(trials_of(runs=HUMPS)), rear_low_passed)
    found = detect(trials)
    assert found.recorder is not None
    (_, _), (channels, rear) = found.recorder.apart
    assert channels == ("R_az", "R_q")
    assert rear.best.chain.cut_off == pytest.approx(REAR_HZ, rel=0.1)
    assert found.chi < 1.03
    (note,) = with_evidence(Decision(found, [], False, lambda *_: None)._nothing(), lambda *_: None).verdict.notes
    assert note.startswith("the recorders' low-passes are not stated, and differ")
    monkeypatch.setattr(chain_estimate, "APART_FALL", np.inf)
    shared = detect(trials)
    assert shared.recorder is not None
    assert shared.recorder.apart == ()
    assert shared.chi > found.chi + 0.03


def test_a_missing_effect_is_not_taken_for_low_passes_of_the_sensors(trials_of):
    found = detect(undeclared(trials_of(CUBIC, runs=HUMPS)))
    assert found.recorder is not None
    assert found.recorder.apart == ()
    assert not found.is_quiet
