"""The noise of lead-ins: what no sensor and no linear vehicle on a rough road makes is counted where it is heard."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.signal

from vehgen.diagnose.detect.noise_floor import find_noise_floor
from vehgen.fit.noise import LOUDER_HZ

R_AZ = 2
"""The number of the rear acceleration among the channels."""


def humming(trial, size, seed):
    """Return a run in which one channel hums between 17 and 23 Hz, as laws make it of roughness."""
    hum = np.random.default_rng(seed).standard_normal(len(trial.recording.values))
    sections = scipy.signal.butter(4, (17.0, 23.0), "bandpass", fs=1 / trial.recording.dt, output="sos")
    values = trial.recording.values.copy()
    values[:, R_AZ] += size * scipy.signal.sosfiltfilt(sections, hum)
    return replace(trial, recording=replace(trial.recording, values=values))


def humps_of(trials):
    return [trial for trial in trials if trial.scenario.humps]


def test_a_channel_that_hums_is_louder_there_and_nowhere_else(trials_of):
    trials = humps_of(trials_of())
    loud = find_noise_floor([humming(trial, 0.2, seed) for seed, trial in enumerate(trials)]).noises
    band = LOUDER_HZ.index(15.0)
    for noise in loud.values():
        assert noise.louder[band, R_AZ] > 3
        others = noise.louder.copy()
        others[band - 1 : band + 2, R_AZ] = 1.0  # a short stretch smears it
        assert others.max() < 2


def test_healthy_lead_ins_are_no_louder_than_their_noise(trials_of):
    assert all(noise.louder is None for noise in find_noise_floor(humps_of(trials_of())).noises.values())


def test_harmonics_of_loud_runs_leave_a_quiet_run_its_noise(trials_of):
    random = np.random.default_rng(3)
    rough = next(trial for trial in trials_of() if trial.name == "rough")
    runs = []
    for number, (size, harmonics) in enumerate([(0.5, 0.6), (4.7, 0.35), (2.2, 0.0), (2.9, 1.2)]):
        motion = size * np.sin(2 * np.pi * 2.0 * rough.recording.time)[:, None]
        values = motion + random.normal(scale=np.hypot(0.05, harmonics), size=rough.recording.values.shape)
        runs.append(replace(rough, name=f"run{number}", recording=replace(rough.recording, values=values)))
    noises = find_noise_floor(runs).noises
    assert all(np.all(noise.sigma > 0.04) for noise in noises.values())


def test_noise_that_a_recorder_filters_is_not_taken_for_less(trials_of):
    """A low-pass at 43 Hz takes nineteen twentieths of the power off the top of the band, and hardly any of what is compared below."""
    trials = humps_of(trials_of())
    sections = scipy.signal.butter(8, 43.0, fs=1 / trials[0].recording.dt, output="sos")
    filtered = [
        replace(trial, recording=replace(trial.recording, values=scipy.signal.sosfilt(sections, trial.recording.values, axis=0)))
        for trial in trials
    ]
    plain, found = find_noise_floor(trials).noises, find_noise_floor(filtered).noises
    for trial in trials:
        assert found[trial.name].sigma == pytest.approx(plain[trial.name].sigma, rel=0.3)
