"""What a measured force tells that roads do not, and how sure what is believed, or told by noise, leaves a calibration."""

import numpy as np
import pytest

from tests.calibrate.shaken_mass import shaken_mass
from vehgen.calibrate.bootstrap import errors_left_open, refit
from vehgen.calibrate.identifiability import find_structure
from vehgen.calibrate.intervals import Uncertainty
from vehgen.calibrate.validation import _noise_rms
from vehgen.fit.least_squares import FitOptions, fit_least_squares
from vehgen.fit.noise import EVEN, Noise
from vehgen.fit.nuisances import Nuisances
from vehgen.fit.prior_data import load_prior_data
from vehgen.fit.problem import make_problem
from vehgen.fit.trial import load_trials
from vehgen.measure import record_psd, welch_psd


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


@pytest.mark.slow
def test_a_bootstrap_redraws_what_is_believed_of_sensors(tmp_path):
    problem, sigma = shaken_mass(tmp_path, "uncertainty: {gain: 0.03, force_gain: 0.03}\n")
    fit = fit_least_squares(problem, problem.space.unit(problem.space.start), FitOptions(), noises={"run": Noise(EVEN, np.array([sigma]))})
    known = Uncertainty(fit, find_structure(problem, problem.space.start))
    left_open = errors_left_open(fit)
    told = {item.name: bool(own) for item, own in zip(fit.conditions(), left_open, strict=True)}
    assert {name: told[name] for name in ("gain", "force_gain", "delay")} == {"gain": True, "force_gain": True, "delay": False}
    rows = np.array([refit(fit, np.random.default_rng(seed), left_open) for seed in range(40)])
    for column, item in enumerate(known.parameters()):
        assert 1.645 * rows[:, column].std(ddof=1) == pytest.approx((item.high - item.low) / 2, rel=0.35)


def test_a_constant_force_stated_in_newtons_is_so_many_newtons(tmp_path):
    problem, _ = shaken_mass(tmp_path, "uncertainty: {force_offset: 5 N}\n")
    fit = fit_least_squares(problem, problem.space.unit(problem.space.start), FitOptions(max_steps=1, noise_rounds=1))
    assert {item.name: item.sigma for item in fit.conditions()}["force_offset"] == 5.0


def test_a_force_sensor_that_read_nothing_all_along_is_no_fault_of_the_program(tmp_path):
    shaken_mass(tmp_path, "uncertainty: {force_offset: 5 N}\n")
    np.savetxt(tmp_path / "force.csv", np.column_stack([np.arange(1600) * 0.005, np.zeros(1600)]), delimiter=",", header="t,F", comments="")
    found = {item.name: item.sigma for item in Nuisances().of_all_runs(load_trials([tmp_path / "run.yaml"]))}
    assert found["force_offset"] == 5.0


def test_facts_are_drawn_about_the_vehicle_as_surely_as_they_are_known(tmp_path):
    problem, _ = shaken_mass(tmp_path)
    (tmp_path / "facts.yaml").write_text("parameters: {M: {value: 100 kg, uncertainty: 5 kg}}\n", encoding="utf-8")
    facts, random = load_prior_data(tmp_path / "facts.yaml", problem), np.random.default_rng(0)
    drawn = np.array([facts.drawn(problem.space.start, random).facts[0].value for _ in range(400)])
    assert drawn.mean() == pytest.approx(110.0, abs=1.0)
    assert drawn.std() == pytest.approx(5.0, rel=0.12)


def test_the_level_of_white_noise_is_told_alike_by_one_record_and_by_many_segments():
    values, bands = np.random.default_rng(1).standard_normal(60000), ((2.0, 5.0),)
    for (frequency, density), segments in ((record_psd(values, 0.01), 0.5), (welch_psd(values, 0.01, 4.0), 150.0)):
        assert _noise_rms(frequency, density, bands, segments) == pytest.approx(np.sqrt(3 * 2 * 0.01), rel=0.05)
