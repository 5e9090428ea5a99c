"""Numbers of sensors and runs: those that stand, and those that are bounded."""

import numpy as np
import pytest

from vehgen.fit.adjustments import Adjustment, Gain, SensorDelay
from vehgen.fit.least_squares import FitOptions, fit_least_squares
from vehgen.fit.misfit import Nuisances
from vehgen.fit.noise import EVEN, Noise
from vehgen.fit.problem import make_problem
from vehgen.fit.trial import load_trials
from vehgen.simulate import load_run, simulate

RUN = """
vehicle: sedan2.yaml
speed: 2 m/s
duration: 5 s
sample: 10 ms
road:
  - hump: {shape: half_sine, length: 0.5 m, height: 0.03 m, at: 4 m}
sensors:
  F: {body: body, behind: front, channels: {acceleration: F_az, pitch_rate: F_q}}
  R: {body: body, behind: rear, channels: {acceleration: R_az, pitch_rate: R_q}}
"""
CHANNELS = ("F_az", "F_q", "R_az", "R_q")
SIGMA = np.array([0.01, 5e-4, 0.01, 5e-4])


@pytest.fixture(scope="module")
def problem(tmp_path_factory):
    """Return runs whose channel F_az reads a fifth too much."""
    folder = tmp_path_factory.mktemp("gain")
    (folder / "source.yaml").write_text(RUN, encoding="utf-8")
    response = simulate(load_run(folder / "source.yaml"))
    values = np.column_stack([response.channel(name)[0] for name in CHANNELS]) * np.array([1.2, 1.0, 1.0, 1.0])
    values += np.random.default_rng(1).standard_normal(values.shape) * SIGMA
    table = np.column_stack([np.arange(len(values)) * 0.01, values])
    np.savetxt(folder / "run.csv", table, delimiter=",", header="t," + ",".join(CHANNELS), comments="")
    (folder / "run.yaml").write_text(RUN.replace("sample: 10 ms", "recording: run.csv"), encoding="utf-8")
    return make_problem(load_trials([folder / "run.yaml"]), ["kf"])


def fitted(problem, *shared):
    noises = {problem.trials[0].name: Noise(EVEN, SIGMA)}
    nuisances = Nuisances(delay=0.05, speed=0.005)
    options = FitOptions(nuisances, (0.5, 40.0), prior_sigma=0.1)
    fit = fit_least_squares(problem, problem.space.unit(problem.space.start), options, noises=noises, shared=shared)
    return fit.misfit.adjusted(fit.x)


def test_a_free_number_is_found(problem):
    assert fitted(problem, Gain("F_az", 0.05, 1.0)) == pytest.approx([1.2], abs=0.005)


def test_a_number_of_scale_zero_stands(problem):
    assert fitted(problem, Gain("F_az", 0.0, 1.03), SensorDelay("R", 0.0, 0.02)).tolist() == [1.03, 0.02]


def test_a_number_keeps_within_its_bounds(problem):
    assert fitted(problem, Gain("F_az", 0.05, 1.0, 0.9, 1.1)) == pytest.approx([1.1], abs=1e-6)
    assert Adjustment("", 0.5, 1.0, 0.0, 3.0).bounds == (-2.0, 4.0)
