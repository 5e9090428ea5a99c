"""A channel that reads more in one run than in the others: where it is looked for, and from which gain on it is a mistake."""

from types import SimpleNamespace

import numpy as np
import pytest

from vehgen.diagnose.inputs.amplitudes import gain_hypotheses


@pytest.mark.parametrize(("gain", "told"), [(1.25, 1), (0.75, 1), (1.04, 0), (0.95, 0)])
def test_a_gain_that_sensors_may_have_is_not_the_mistake_behind_a_gap(gain, told):
    trials = [SimpleNamespace(name=name, channels=("F_az", "R_az", "F_q")) for name in ("low", "high", "fast")]
    levels = [np.zeros(3), np.array([0.2, 0.0, 0.0]), np.zeros(3)]
    case = SimpleNamespace(trials=trials, comparisons=[SimpleNamespace(levels=item) for item in levels])
    (hypothesis,) = gain_hypotheses(case)
    assert hypothesis.numbers == pytest.approx((np.exp(0.2),))
    faults = hypothesis.describe(np.array([gain]))
    assert [(item.kind, item.runs, item.channels, item.value) for item in faults] == [("gain", ("high",), ("F_az",), gain)] * told
