"""What a mistake makes of a tone is what it says it makes of a spectral line."""

from dataclasses import dataclass

import numpy as np
import pytest

from vehgen.diagnose.inputs.adjustments import RecorderFilter, RunDelay, RunGain, RunLevel
from vehgen.fit.adjustments import Gain, SensorDelay

RATE, HZ, N = 100.0, 4.0, 4000
LATE = np.arange(N // 4, 3 * N // 4)
"""Samples far from both ends; whole periods of the tone."""


@dataclass(frozen=True)
class Channel:
    name: str
    sensor: str


@dataclass(frozen=True)
class Recorded:
    channels: tuple[Channel, ...]
    dt: float = 1 / RATE


@dataclass(frozen=True)
class Run:
    """What adjustments of readings ask of a trial."""

    name: str
    recording: Recorded = Recorded((Channel("F_az", "F"), Channel("R_az", "R")))
    channels: tuple[str, ...] = ("F_az", "R_az")


def amplitudes(response):
    turn = np.exp(-2j * np.pi * HZ * LATE / RATE)
    return 2 * (response[0, LATE] * turn[:, None]).mean(axis=0)


@pytest.mark.parametrize(
    ("adjustment", "number", "expected"),
    [
        (Gain("R_az"), 1.2, [1.0, 1.2]),
        (SensorDelay("R"), 0.03, [1.0, np.exp(-2j * np.pi * HZ * 0.03)]),
        (RunGain("R_az", run="one"), 1.2, [1.0, 1.2]),
        (RunLevel("", run="one"), 0.8, [0.8, 0.8]),
        (RunDelay("F", run="one"), -0.02, [np.exp(2j * np.pi * HZ * 0.02), 1.0]),
        (RecorderFilter("", runs=("one",), channels=("F_az",)), np.log(HZ), [None, 1.0]),
    ],
    ids=lambda value: type(value).__name__,
)
def test_a_tone_is_changed_as_its_line_is(adjustment, number, expected):
    tone = np.cos(2 * np.pi * HZ * np.arange(N) / RATE)[None, :, None] * np.ones(2)
    found = amplitudes(adjustment.response(Run("one"), tone, np.array([number])))
    line = adjustment.read_lines(Run("one"), np.array([HZ]), np.array([number]), np.ones((1, 2), dtype=complex))
    np.testing.assert_allclose(line[0], found, atol=1e-4)
    for channel, value in zip(found, expected, strict=True):
        if value is None:
            assert abs(channel) == pytest.approx(0.5**0.5, abs=1e-3)  # a low-pass at its cut-off
        else:
            assert channel == pytest.approx(value, abs=1e-4)


@pytest.mark.parametrize(
    "adjustment",
    [RunGain("R_az", run="one"), RunLevel("", run="one"), RunDelay("F", run="one"), RecorderFilter("", runs=("one",), channels=("F_az",))],
    ids=lambda value: type(value).__name__,
)
def test_another_run_is_as_it_was(adjustment):
    tone = np.cos(2 * np.pi * HZ * np.arange(N) / RATE)[None, :, None] * np.ones(2)
    assert adjustment.response(Run("two"), tone, np.array([0.5])) is tone
    line = np.ones((1, 2), dtype=complex)
    assert adjustment.read_lines(Run("two"), np.array([HZ]), np.array([0.5]), line) is line
