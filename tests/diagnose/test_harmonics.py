"""Harmonics of a rig that is driven at one frequency."""

from types import SimpleNamespace

import numpy as np
import pytest

from vehgen.diagnose.detect.harmonics import distortions, driving_frequency
from vehgen.fit.noise import EVEN, Noise
from vehgen.fit.trial import load_trials

RUN = """
vehicle: sedan2.yaml
speed: 2 m/s
recording: run.csv
forces:
  shaker: {body: body, x: 0 m, harmonic: {amplitude: 500 N, frequency: 4 Hz}}
sensors:
  F: {body: body, behind: front, channels: {acceleration: F_az, pitch_rate: F_q}}
"""


@pytest.fixture
def detection(tmp_path):
    t = np.arange(1001) * 0.01
    turn = 2 * np.pi * 4.0 * t
    random = np.random.default_rng(2)
    symmetric = np.sin(turn) + 0.1 * np.sin(3 * turn + 0.3) + 0.02 * np.sin(5 * turn)
    lopsided = 0.5 * np.sin(turn) + 0.05 * np.cos(2 * turn)
    table = np.column_stack([t, symmetric, lopsided]) + np.column_stack([0 * t, 1e-3 * random.standard_normal((len(t), 2))])
    np.savetxt(tmp_path / "run.csv", table, delimiter=",", header="t,F_az,F_q", comments="")
    (tmp_path / "run.yaml").write_text(RUN, encoding="utf-8")
    trials = tuple(load_trials([tmp_path / "run.yaml"]))
    floor = SimpleNamespace(noises={trials[0].name: Noise(EVEN, np.full(2, 1e-3))})
    return SimpleNamespace(trials=trials, floor=floor)


def test_odd_laws_show_odd_multiples_and_lopsided_ones_even(detection):
    symmetric, lopsided = distortions(detection)
    assert symmetric.odd == pytest.approx(np.hypot(0.1, 0.02), rel=0.01)
    assert symmetric.even < 4 * symmetric.noise < 0.001
    assert lopsided.even == pytest.approx(0.1, rel=0.02)
    assert lopsided.odd < 4 * lopsided.noise < 0.001


def test_a_hump_does_not_allow_it(tmp_path, detection):
    assert driving_frequency(detection.trials[0]) == 4.0
    text = RUN.replace("forces:", "road:\n  - hump: {shape: half_sine, length: 0.5 m, height: 0.03 m, at: 4 m}\nforces:")
    (tmp_path / "hump.yaml").write_text(text, encoding="utf-8")
    assert driving_frequency(load_trials([tmp_path / "hump.yaml"])[0]) is None
