"""What a measured force tells that roads do not, and intervals of what rests on what is believed of sensors."""

import numpy as np
import pytest

from tests.calibrate.shaken_mass import shaken_mass
from vehgen.calibrate.identifiability import find_structure
from vehgen.calibrate.intervals import Uncertainty, errors_left_open, refit
from vehgen.fit.least_squares import FitOptions, fit_least_squares
from vehgen.fit.noise import EVEN, Noise
from vehgen.fit.nuisances import Nuisances
from vehgen.fit.problem import make_problem
from vehgen.fit.trial import load_trials


def test_a_measured_force_tells_how_heavy_a_mass_is(tmp_path):
    problem, _ = shaken_mass(tmp_path)
    structure = find_structure(problem, problem.space.start)
    assert structure.rank == 3
    assert structure.singular_values[-1] > 1e-3 * structure.singular_values[0]


def test_a_mass_that_is_released_is_told_in_proportion_only(tmp_path):
    shaken_mass(tmp_path)
    run = tmp_path / "run.yaml"
    text = run.read_text(encoding="utf-8")
    start = text.index("forces:")
    released = text[:start] + "initial: {mass: {displacement: 5 mm}}\n" + text[text.index("sensors:") :]
    run.write_text(released, encoding="utf-8")
    again = make_problem(load_trials([run]))
    assert find_structure(again, again.space.start).rank == 2


def test_a_bootstrap_redraws_what_is_believed_of_sensors(tmp_path):
    problem, sigma = shaken_mass(tmp_path, "uncertainty: {gain: 0.03, force_gain: 0.03}\n")
    fit = fit_least_squares(problem, problem.space.unit(problem.space.start), FitOptions(), noises={"run": Noise(EVEN, np.array([sigma]))})
    known = Uncertainty(fit, find_structure(problem, problem.space.start))
    left_open = errors_left_open(fit)
    told = {item.name: bool(own) for item, own in zip(fit.conditions(), left_open, strict=True)}
    assert told == {"gain": True, "force_gain": True, "force_offset": told["force_offset"], "delay": False}
    rows = np.array([refit(fit, seed, left_open) for seed in range(40)])
    for column, item in enumerate(known.parameters()):
        assert 1.645 * rows[:, column].std(ddof=1) == pytest.approx((item.high - item.low) / 2, rel=0.35)


def test_a_constant_force_stated_in_newtons_is_so_many_newtons(tmp_path):
    problem, _ = shaken_mass(tmp_path, "uncertainty: {force_offset: 5 N}\n")
    fit = fit_least_squares(problem, problem.space.unit(problem.space.start), FitOptions(max_steps=1, noise_rounds=1))
    assert {item.name: item.sigma for item in fit.conditions()}["force_offset"] == 5.0


def test_a_force_sensor_that_read_nothing_all_along_is_no_fault_of_the_program(tmp_path):
    problem, _ = shaken_mass(tmp_path)
    text = (tmp_path / "run.yaml").read_text(encoding="utf-8") + "uncertainty: {force_offset: 5 N}\n"
    (tmp_path / "run.yaml").write_text(text, encoding="utf-8")
    np.savetxt(tmp_path / "force.csv", np.column_stack([np.arange(1600) * 0.005, np.zeros(1600)]), delimiter=",", header="t,F", comments="")
    found = {item.name: item.sigma for item in Nuisances().of_all_runs(load_trials([tmp_path / "run.yaml"]))}
    assert found["force_offset"] == 5.0
    assert problem.space.size == 3
