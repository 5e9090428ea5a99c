"""Runs and their recordings: recordings that miss the hump, and clocks and speeds that are a little wrong."""

import numpy as np
import pytest

from tests.fit.recordings import sedan_truth, write_run
from vehgen.errors import InputError
from vehgen.fit.least_squares import fit_least_squares
from vehgen.fit.problem import make_problem
from vehgen.fit.trial import load_trials

TRUTH = sedan_truth()


def test_a_wrong_clock_and_speed_are_found_along_the_way(tmp_path):
    path = write_run(tmp_path, "late", TRUTH, 2.5)
    rows = np.loadtxt(tmp_path / "late.csv", delimiter=",", skiprows=1)
    rows[:, 0] += 0.13
    np.savetxt(tmp_path / "late.csv", rows, delimiter=",", header="t,F_az,F_q,R_az,R_q", comments="")
    path.write_text(path.read_text(encoding="utf-8").replace("speed: 2.5", "speed: 2.53"), encoding="utf-8")
    problem = make_problem(load_trials([path]))
    truth = np.array([TRUTH[name] for name in problem.space.names])
    fit = fit_least_squares(problem, problem.space.unit(truth * 1.05))
    found = {item.name: item.value for item in fit.conditions() if item.run}
    delay, speed = found["delay"], found["speed"]
    # the hump lies 4 m ahead; a wrong speed leaves the first wheel's arrival where it is
    assert delay + 4 / 2.53 == pytest.approx(0.13 + 4 / 2.5, abs=3e-3)
    assert 2.53 * (1 + speed) == pytest.approx(2.5, rel=2e-3)
    assert fit.values == pytest.approx(truth, rel=0.05)


def test_a_recording_that_ends_before_the_hump_is_refused(tmp_path):
    path = write_run(tmp_path, "short", TRUTH, 2.5)
    path.write_text(path.read_text(encoding="utf-8").replace("at: 4 m", "at: 30 m"), encoding="utf-8")
    with pytest.raises(InputError, match=r"ends after .* before the last axle"):
        load_trials([path])
