"""An engine's line: what sensors show of it, and how it is found."""

from dataclasses import replace

import numpy as np
import pytest

from vehgen.fit.adjustments import RunState
from vehgen.fit.harmonic import Harmonic, find_line, harmonic_adjustments
from vehgen.fit.misfit import Misfit
from vehgen.fit.noise import EVEN, Noise
from vehgen.fit.problem import make_problem
from vehgen.fit.trial import load_trials
from vehgen.simulate import load_run, simulate

RUN = """
vehicle: sedan2.yaml
speed: 2 m/s
duration: 6 s
step: 0.5 ms
sample: 10 ms
road:
  - hump: {shape: half_sine, length: 0.5 m, height: 0.03 m, at: 4 m}
sensors:
  F: {body: body, behind: front, channels: {acceleration: F_az, pitch_rate: F_q}}
  R: {body: body, behind: rear, channels: {acceleration: R_az, pitch_rate: R_q}}
"""
FORCE = """forces:
  engine: {body: body, x: 0 m, harmonic: {amplitude: 300 N, frequency: 21 Hz}}
"""
SIGMA = np.array([0.01, 5e-4, 0.01, 5e-4])
CHANNELS = ("F_az", "F_q", "R_az", "R_q")


def record(folder, text, road=True):
    """Return what the kernel's sensors read, `shape (601, 4)`."""
    if not road:
        text = text[: text.index("road:")] + text[text.index("sensors:") :]
    path = folder / "source.yaml"
    path.write_text(text, encoding="utf-8")
    response = simulate(load_run(path))
    return np.column_stack([response.channel(name)[0] for name in CHANNELS])


def trial_of(folder, values):
    table = np.column_stack([np.arange(len(values)) * 0.01, values])
    np.savetxt(folder / "run.csv", table, delimiter=",", header="t," + ",".join(CHANNELS), comments="")
    (folder / "run.yaml").write_text(RUN.replace("step: 0.5 ms\nsample: 10 ms", "recording: run.csv"), encoding="utf-8")
    return load_trials([folder / "run.yaml"])


@pytest.fixture(scope="module")
def shaken(tmp_path_factory):
    """Return the response to the engine alone, and a trial of hump, engine and noise."""
    folder = tmp_path_factory.mktemp("engine")
    alone = record(folder, RUN + FORCE, road=False)
    noise = np.random.default_rng(3).standard_normal(alone.shape) * SIGMA
    return alone, trial_of(folder, record(folder, RUN) + alone + noise)


def test_the_columns_are_what_the_kernel_answers_to_a_harmonic_force(shaken):
    alone, (trial,) = shaken
    alone = alone[: len(trial.recording.time)]
    columns = Harmonic("body", sigma={trial.name: SIGMA}).columns(trial, np.array([21.0, 0.0]), trial.values, RunState(trial.scenario))
    late = slice(300, None)  # the start of the force has died away
    factors = np.linalg.lstsq(columns[:2, late].reshape(2, -1).T, alone[late].ravel(), rcond=None)[0]
    assert np.hypot(*factors) == pytest.approx(300.0, rel=0.01)
    left = alone[late] - np.einsum("knc,k->nc", columns[:2, late], factors)
    assert np.abs(left).max() < 0.02 * np.abs(alone[late]).max()


def test_a_line_is_found_where_it_is_and_taken_out(shaken):
    _, trials = shaken
    problem = make_problem(trials)
    noises = {trials[0].name: Noise(EVEN, SIGMA)}
    plain = Misfit(problem, noises, problem.space.start)
    x = np.concatenate([problem.space.unit(problem.space.start), np.zeros(plain.n_unknowns - plain.n_parameters)])
    (frequency, drift), *_ = find_line(plain, x)
    assert frequency == pytest.approx(21.0, abs=0.05)
    assert drift == pytest.approx(0.0, abs=0.002)
    lined = Misfit(problem, noises, problem.space.start, shared=harmonic_adjustments("body", {trials[0].name: SIGMA}))
    numbers = [(frequency - lined.shared[0].neutral) / lined.shared[0].scale, drift / lined.shared[1].scale]
    before = np.mean(plain.residuals(x) ** 2)
    after = np.mean(lined.residuals(np.concatenate([x[: plain.n_parameters], numbers, x[plain.n_parameters :]])) ** 2)
    assert before > 20
    assert after < 2.5


def test_a_line_drifts_from_where_the_recording_begins(shaken):
    _, (trial,) = shaken
    later = replace(trial, recording=replace(trial.recording, time=trial.recording.time + 20.0))
    line, state = Harmonic("body", sigma={trial.name: SIGMA}), RunState(trial.scenario)
    here, there = (line.columns(item, np.array([21.0, 0.02]), trial.values, state) for item in (trial, later))
    np.testing.assert_allclose(there, here, atol=1e-9 * np.abs(here).max())


def test_a_line_suits_sensors_whose_clocks_differ(tmp_path):
    """One sensor is 7 ms late, a seventh of the line's period: heave and pitch cannot make up for that."""
    late = 0.007
    dense = RUN.replace("sample: 10 ms", "sample: 1 ms")
    hump, engine = record(tmp_path, dense), record(tmp_path, dense + FORCE, road=False)
    fine = hump + engine[: len(hump)]
    on_time = np.arange(0, len(fine), 10)
    values = np.column_stack([fine[on_time, :2], fine[np.maximum(on_time - round(1000 * late), 0), 2:]])
    trials = trial_of(tmp_path, values + np.random.default_rng(3).standard_normal(values.shape) * SIGMA)
    noises = {trials[0].name: Noise(EVEN, SIGMA)}
    problem = make_problem(trials)
    misfit = Misfit(problem, noises, problem.space.start, shared=harmonic_adjustments("body", {trials[0].name: SIGMA}))
    x = np.zeros(misfit.n_unknowns)
    x[: misfit.n_parameters] = problem.space.unit(problem.space.start)
    x[misfit.n_parameters] = (21.0 - misfit.shared[0].neutral) / misfit.shared[0].scale
    x[misfit.n_unknowns - misfit.n_errors + misfit.error_position(0, "clock")] = late / misfit.nuisances.clock
    assert np.mean(misfit.residuals(x) ** 2) < 2.5
