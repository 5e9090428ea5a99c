"""Errors of forces and displacements over time."""

import numpy as np
import pytest

from vehgen.simulate import Signal
from vehgen.simulate.run_file.entries import ForceHarmonic


def test_a_measured_signal_comes_late_times_its_gain_beside_its_offset():
    signal = Signal(time=np.array([0.0, 1.0, 2.0]), values=np.array([0.0, 10.0, 10.0]))
    wrong = signal.with_errors(1.1, 2.0, 0.5).with_errors(2.0, 1.0)
    t = np.array([0.0, 0.5, 1.0, 1.5, 9.0])
    assert wrong.at(t) == pytest.approx([3.0, 3.0, 14.0, 25.0, 25.0])


def test_a_harmonic_one_turns_by_its_delay():
    signal = Signal(harmonic=ForceHarmonic(amplitude="3 N", frequency="2 Hz", phase="0.1 rad")).with_errors(late=0.02, offset=-1.0)
    t = np.linspace(0.0, 1.0, 7)
    assert signal.at(t) == pytest.approx(3.0 * np.sin(4 * np.pi * (t - 0.02) + 0.1) - 1.0)
