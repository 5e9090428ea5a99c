"""Offsets and drifts of channels: each is told with its own size."""

import numpy as np

from tests.diagnose.conftest import HUMPS as RUNS
from tests.diagnose.conftest import edited
from vehgen.diagnose.detect.detection import detect
from vehgen.diagnose.inputs.amplitudes import drift_hypotheses
from vehgen.diagnose.inputs.refits import BaseRefits

F_Q, R_Q = 1, 3


def test_each_channel_is_told_with_its_own_offset(trials_of):
    def offset(values):
        for column, share in ((F_Q, 0.5), (R_Q, 2.0)):
            values[:, column] += share * np.std(values[:, column])
        return values

    (supposed,) = drift_hypotheses(BaseRefits(detect(edited(trials_of(runs=RUNS), offset, "low"))))
    told = {fault.channels[0]: int(fault.message.split("by up to ")[1].split(" %")[0]) for fault in supposed.describe(np.zeros(0))}
    assert 40 < told["F_q"] < 70
    assert 150 < told["R_q"] < 250
