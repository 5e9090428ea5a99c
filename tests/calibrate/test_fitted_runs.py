"""What a calibration says of its runs: scored, drawn and warned of at the speed, clock and height that it found."""

import numpy as np
import pytest
import scipy.signal

from tests.fit.recordings import sedan_truth, write_run
from vehgen.calibrate.calibration import Settings, calibrate_problem
from vehgen.calibrate.fitted_runs import fitted_responses, least_tyre_loads
from vehgen.calibrate.genetic import GeneticSearch
from vehgen.calibrate.result import CalibrationSummary
from vehgen.calibrate.summary import summarise
from vehgen.fit.problem import make_problem
from vehgen.fit.trial import load_trials

TRUE_SPEED, STATED_SPEED = 2.5, 2.45
SPEED_TOLERANCE = 3e-3
"""How far off a speed may be told, as a share: by the fit's own information its standard deviation is 0.0022."""


def misstated_run(folder):
    """Write two runs; the speed of the second is stated 2 % too low."""
    right, wrong = (write_run(folder, name, sedan_truth(), TRUE_SPEED, seed=i) for i, name in enumerate(("right", "wrong")))
    wrong.write_text(wrong.read_text(encoding="utf-8").replace(f"speed: {TRUE_SPEED}", f"speed: {STATED_SPEED}"), encoding="utf-8")
    return make_problem(load_trials([declared(right), declared(wrong)]))


def declared(run):
    """Return a run whose file says that its recorder filters nothing."""
    run.write_text(run.read_text(encoding="utf-8") + "acquisition: none\n", encoding="utf-8")
    return run


@pytest.fixture(scope="module")
def calibration(tmp_path_factory):
    return calibrate_problem(misstated_run(tmp_path_factory.mktemp("runs")), Settings(search=GeneticSearch(1, 10, 0), starts=2))


@pytest.fixture(scope="module")
def summary(calibration):
    return summarise(calibration)


def test_a_good_fit_is_scored_and_drawn_as_one_where_the_speed_was_misstated(summary):
    assert max(summary.objective.values()) < 0.03
    for curve in summary.histories:
        assert np.std(curve.measured - curve.simulated) < 0.02 * np.std(curve.measured), (curve.run, curve.channel)


@pytest.mark.thorough
def test_what_is_drawn_leaves_the_noise_alone_where_noise_is_small(tmp_path):
    """In steps of 1 ms it would leave up to 1.7 times the noise: the simulation's own error."""
    noise = 0.0005
    runs = [declared(write_run(tmp_path, f"at_{speed:.0f}", sedan_truth(), speed, noise=noise, seed=int(speed))) for speed in (2.0, 3.0)]
    found = calibrate_problem(make_problem(load_trials(runs)), Settings(search=GeneticSearch(1, 10, 0), starts=1))
    for trial, response in zip(found.problem.trials, fitted_responses(found), strict=True):
        left = np.std(trial.recording.values - response, axis=0) / np.std(trial.recording.values, axis=0)
        assert left == pytest.approx(noise, rel=0.1)


def test_tyre_loads_are_those_of_the_runs_as_they_were(calibration, tmp_path):
    trials = load_trials([declared(write_run(tmp_path, "right", sedan_truth(), TRUE_SPEED))])
    right = calibrate_problem(make_problem(trials), Settings(search=GeneticSearch(1, 10, 0), starts=1))
    alone = least_tyre_loads(right)
    found = least_tyre_loads(calibration)
    assert found == pytest.approx(alone, abs=0.01)


def test_each_run_tells_its_speed_clock_and_chi2_with_what_was_known(summary):
    found = {(item.run, item.name): item for item in summary.conditions}
    assert set(found) >= {(run, name) for run in ("right", "wrong") for name in ("delay", "speed", "height", "length")}
    wrong = found["wrong", "speed"]
    assert wrong.value == pytest.approx(TRUE_SPEED / STATED_SPEED - 1, abs=SPEED_TOLERANCE)
    assert wrong.prior == 0.01
    assert wrong.sigmas == pytest.approx(wrong.value / wrong.prior)
    assert abs(found["right", "speed"].value) < SPEED_TOLERANCE
    assert found["right", "delay"].unit == "s"
    assert set(summary.run_chi2) == {"right", "wrong"}
    assert all(value == pytest.approx(1.0, abs=0.2) for value in summary.run_chi2.values())


@pytest.mark.thorough
def test_each_step_of_dhcm_is_simulated_at_its_own_clock(tmp_path):
    problem = misstated_run(tmp_path)
    found = calibrate_problem(problem, Settings(method="dhcm", search=GeneticSearch(1, 10, 0), starts=2))
    assert {item.step for item in summarise(found).conditions} == {"sensor F", "sensor R"}
    for trial, response in zip(problem.trials, fitted_responses(found), strict=True):
        assert (np.std(trial.recording.values - response, axis=0) < 0.05 * np.std(trial.recording.values, axis=0)).all()


@pytest.mark.slow
def test_a_recorder_that_no_file_declares_is_found_and_told(tmp_path):
    trials = load_trials([write_run(tmp_path, "run", sedan_truth(), TRUE_SPEED)])
    found = summarise(calibrate_problem(make_problem(trials), Settings(search=GeneticSearch(1, 10, 0), starts=1)))
    told = found.recorder[0]
    assert set(told.channels) == {"F_az", "F_q", "R_az", "R_q"}
    assert told.told.startswith("the recorder's low-pass is not stated")
    assert told.compared_to <= found.band[1]
    assert CalibrationSummary.from_dict(found.to_dict()).recorder == found.recorder
    assert {(item.name, item.place) for item in found.conditions} >= {("roll_off", "F"), ("dispersion", "R")}


@pytest.mark.slow
def test_low_passes_of_sensors_are_told_one_by_one(tmp_path):
    run = write_run(tmp_path, "run", sedan_truth(), TRUE_SPEED)
    file = tmp_path / "run.csv"
    values = np.loadtxt(file, delimiter=",", skiprows=1)
    values[:, 3:] = scipy.signal.lfilter(*scipy.signal.butter(2, 12.0, fs=1 / (values[1, 0] - values[0, 0])), values[:, 3:], axis=0)
    np.savetxt(file, values, delimiter=",", header="t,F_az,F_q,R_az,R_q", comments="")
    found = summarise(calibrate_problem(make_problem(load_trials([run])), Settings(search=GeneticSearch(1, 10, 0), starts=3)))
    front, rear = found.recorder
    assert (front.channels, rear.channels) == (("F_az", "F_q"), ("R_az", "R_q"))
    assert rear.cut_off == pytest.approx(12.0, rel=0.1)
    assert front.cut_off is None or front.cut_off > 30.0
    assert front.told == rear.told
    assert "(R_az, R_q)" in rear.told


def test_a_declared_recorder_is_taken_as_it_is(summary):
    assert summary.recorder == ()


def test_a_summary_of_before_the_conditions_is_still_read(summary):
    data = summary.to_dict()
    for name in ("conditions", "run_chi2", "recorder"):
        del data[name]
    assert CalibrationSummary.from_dict(data).conditions == ()
