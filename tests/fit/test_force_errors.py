"""Gain, zero and clock of a measured force, found by a fit from what a rig does under it."""

import numpy as np
import pytest

from vehgen.fit.least_squares import FitOptions, fit_least_squares
from vehgen.fit.noise import EVEN, Noise
from vehgen.fit.nuisances import Nuisances
from vehgen.fit.problem import Problem
from vehgen.fit.road_answer import road_answer, unstated_forces
from vehgen.fit.space import SearchSpace
from vehgen.fit.trial import load_trials

RIG = """name: rig
gravity: {gravity}
bodies: {{block: {{mass: 20 kg, motions: [heave]}}}}
links: {{mount: {{ground: {{}}, block: {{}}, k: {k}, c: 80 N s/m}}}}
"""
RUN = """vehicle: rig.yaml
band: [0.3 Hz, 40 Hz]
acquisition: none
forces: {shaker: {body: block, file: force.csv, time: t, force: F, unit: N}}
sensors: {gauge: {body: block, channels: {displacement: y, velocity: v}}}
recording: recording.csv
"""
NOTHING = SearchSpace((), np.zeros(0), np.zeros(0), np.zeros(0))


def exact(time, force, dt, k):
    """Return displacement and velocity of the block under a force, by small explicit steps (classical Runge-Kutta)."""
    state, found = np.zeros(2), np.zeros((len(time), 2))

    def slope(y, push):
        return np.array([y[1], (push - k * y[0] - 80.0 * y[1]) / 20.0])

    for i in range(len(time)):
        found[i] = state
        a, b, c = force(time[i]), force(time[i] + dt / 2), force(time[i] + dt)
        one = slope(state, a)
        two = slope(state + dt / 2 * one, b)
        three = slope(state + dt / 2 * two, b)
        state = state + dt / 6 * (one + 2 * two + 2 * three + slope(state + dt * three, c))
    return found


@pytest.mark.parametrize(
    ("gravity", "k", "beside", "zero"),
    [("true", 40e3, 0.0, 0.0), ("false", 300.0, 0.0, 2.0), ("false", 0.0, 4.0, 0.0)],
    ids=["held", "held softly, with a false zero", "free, with a constant force"],
)
def test_errors_of_a_force_are_found(tmp_path, gravity, k, beside, zero):
    dt, t = 1e-3, np.arange(0.0, 8.0, 1e-3)
    random = np.random.default_rng(5)
    parts = list(zip(random.uniform(5, 15, 12), np.linspace(0.4, 20, 12), random.uniform(0, 6, 12), strict=True))

    def recorded(s):
        return pushes(s, parts)

    def acting(s):
        return 1.02 * recorded(s - 0.004) * (s >= 0.004) + beside

    motion = exact(t, acting, dt, k)
    np.savetxt(tmp_path / "force.csv", np.column_stack([t, recorded(t) + zero]), delimiter=",", header="t,F", comments="")
    sigma = np.array([2e-6, 2e-4])
    noisy = motion + sigma * random.standard_normal(motion.shape)
    np.savetxt(tmp_path / "recording.csv", np.column_stack([t, noisy])[::10], delimiter=",", header="t,y,v", comments="")
    (tmp_path / "rig.yaml").write_text(RIG.format(gravity=gravity, k=f"{k} N/m"), encoding="utf-8")
    (tmp_path / "run.yaml").write_text(RUN, encoding="utf-8")
    (trial,) = load_trials([tmp_path / "run.yaml"])
    options = FitOptions(Nuisances(gain=0, clock=0), (0.3, 40.0))
    fit = fit_least_squares(Problem((trial,), NOTHING), np.zeros(0), options, noises={trial.name: Noise(EVEN, sigma)})
    found = {item.name: item.value for item in fit.conditions()}
    assert found["force_gain"] == pytest.approx(0.02, abs=2e-3)
    assert found["delay"] == pytest.approx(0.004, abs=2e-4)
    assert found["force_offset"] == pytest.approx(beside - 1.02 * zero, abs=0.05)
    assert fit.chi2 < 1.3


@pytest.mark.parametrize("stated", [True, False])
def test_white_errors_of_a_force_come_to_the_channels_through_the_rig(tmp_path, stated):
    """One-sided densities: 2 dt sigma^2 of the force, times the square of 1/(k - m w^2 + i c w) of the displacement."""
    t = np.arange(0.0, 4.0, 1e-2)
    np.savetxt(tmp_path / "force.csv", np.column_stack([t, 7 * np.sin(9 * t)]), delimiter=",", header="t,F", comments="")
    np.savetxt(tmp_path / "recording.csv", np.column_stack([t, t, t]), delimiter=",", header="t,y,v", comments="")
    (tmp_path / "rig.yaml").write_text(RIG.format(gravity="true", k="40e3 N/m"), encoding="utf-8")
    (tmp_path / "run.yaml").write_text(RUN.replace("unit: N", "unit: N, noise: 3 N") if stated else RUN, encoding="utf-8")
    (trial,) = load_trials([tmp_path / "run.yaml"])
    frequency = np.array([2.0, 7.0, 15.0])
    s = 2j * np.pi * frequency
    own = np.sqrt(2 * 1e-2) / (40e3 + 80.0 * s + 20.0 * s**2)
    answer = road_answer(trial, frequency, trial.values)
    through, other = (answer.forced, answer.unstated) if stated else (answer.unstated, answer.forced)
    factor = 3.0 if stated else 1.0
    assert other is None
    np.testing.assert_allclose(through[:, :, 0], factor * np.column_stack([own, s * own]), rtol=1e-9)
    assert unstated_forces(trial) == pytest.approx([0.0 if stated else 7 / np.sqrt(2)], rel=0.03)
    assert next(item.sigma for item in Nuisances().of_run(trial) if item.name == "delay") == pytest.approx(1e-2)


def test_a_constant_force_beside_a_measured_one_is_a_tenth_of_the_loudest_runs(tmp_path):
    t = np.arange(0.0, 4.0, 1e-2)
    (tmp_path / "rig.yaml").write_text(RIG.format(gravity="true", k="40e3 N/m"), encoding="utf-8")
    np.savetxt(tmp_path / "recording.csv", np.column_stack([t, t, t]), delimiter=",", header="t,y,v", comments="")
    for name, size in (("loud", 70.0), ("quiet", 7.0)):
        table = np.column_stack([t, size * np.sin(2 * np.pi * 5 * t)])
        np.savetxt(tmp_path / f"{name}.csv", table, delimiter=",", header="t,F", comments="")
        (tmp_path / f"{name}.yaml").write_text(RUN.replace("force.csv", f"{name}.csv"), encoding="utf-8")
    loud, quiet = load_trials([tmp_path / "loud.yaml", tmp_path / "quiet.yaml"])
    for trials, rms in (([loud, quiet], 70 / np.sqrt(2)), ([quiet, loud], 70 / np.sqrt(2)), ([quiet], 7 / np.sqrt(2))):
        (sigma,) = (item.sigma for item in Nuisances().of_all_runs(trials) if item.name == "force_offset")
        assert sigma == pytest.approx(0.1 * rms, rel=1e-6)


def pushes(s, pieces):
    """Return a force of sines at times, that grows from nothing [N]."""
    return sum(a * np.sin(2 * np.pi * f * s + p) for a, f, p in pieces) * (1 - np.exp(-2 * s))


def test_a_load_cells_noise_is_found_beside_the_sensors(tmp_path):
    cell, k = 2.0, 4e3
    t = np.arange(0.0, 8.0, 1e-3)
    for number in range(2):
        random = np.random.default_rng(number)
        pieces = list(zip(random.uniform(10, 30, 20), np.linspace(0.4, 15, 20), random.uniform(0, 6, 20), strict=True))
        motion = exact(t, lambda s, pieces=pieces: pushes(s, pieces), 1e-3, k)
        force = pushes(t, pieces) + cell * random.standard_normal(len(t))
        np.savetxt(tmp_path / "force.csv", np.column_stack([t, force]), delimiter=",", header="t,F", comments="")
        noisy = motion + np.array([2e-7, 3e-4]) * random.standard_normal(motion.shape)
        np.savetxt(tmp_path / f"recording{number}.csv", np.column_stack([t, noisy])[::10], delimiter=",", header="t,y,v", comments="")
        own = RUN.replace("recording.csv", f"recording{number}.csv").replace("force.csv", f"force{number}.csv")
        (tmp_path / "force.csv").rename(tmp_path / f"force{number}.csv")
        (tmp_path / f"run{number}.yaml").write_text(own, encoding="utf-8")
    (tmp_path / "rig.yaml").write_text(RIG.format(gravity="true", k=f"{k} N/m"), encoding="utf-8")
    trials = load_trials([tmp_path / "run0.yaml", tmp_path / "run1.yaml"])
    fit = fit_least_squares(Problem(tuple(trials), NOTHING), np.zeros(0), FitOptions(Nuisances(gain=0, clock=0), (0.3, 40.0)))
    for trial in trials:
        noise = fit.misfit.noises[trial.name]
        assert noise.acting == pytest.approx([cell * np.sqrt(1e-3 / 1e-2)], rel=0.15)  # as dense as white noise at the recording's rate
        assert noise.sigma == pytest.approx([2e-7, 3e-4], rel=0.5)
