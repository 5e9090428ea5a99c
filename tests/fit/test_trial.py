"""Runs and their recordings: that miss the hump, whose clocks and speeds are a little wrong, that begin on a road nobody measured."""

from dataclasses import replace

import numpy as np
import pytest

from tests.fit.profile_world import FINE, RATE, fine_channels, misfit_of, motion_matrices, read_run, rough_road
from tests.fit.profile_world import write_run as write_profile_run
from tests.fit.recordings import sedan_truth, write_run
from vehgen.errors import InputError, ModelWarning
from vehgen.fit.least_squares import fit_least_squares
from vehgen.fit.nuisances import Nuisances
from vehgen.fit.problem import make_problem
from vehgen.fit.recording import read_recording
from vehgen.fit.trial import FORGOTTEN, MOST_LEFT_OUT, _quick_count, load_trials

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


@pytest.mark.parametrize("begin", [1.5, 1.7, 2.4])
def test_a_recording_may_begin_while_the_vehicle_is_on_the_hump_or_between_its_axles(tmp_path, begin):
    """The first wheel meets the hump at 1.6 s, the second at 2.72 s: what is simulated is the later part of the whole."""
    path = write_run(tmp_path, "cut", TRUTH, 2.5, noise=0.0)
    rows = np.loadtxt(tmp_path / "cut.csv", delimiter=",", skiprows=1)
    kept = rows[rows[:, 0] >= begin - 1e-9]
    np.savetxt(tmp_path / "cut.csv", kept, delimiter=",", header="t,F_az,F_q,R_az,R_q", comments="")
    (trial,) = load_trials([path])
    problem = make_problem([trial])
    found = problem.respond(np.array([[TRUTH[name] for name in problem.space.names]]), trial, trial.scenario)[0][0]
    assert np.abs(found - trial.recording.values).max() < 0.01 * np.abs(rows[:, 1:]).max()
    assert trial.scenario.first_arrival == pytest.approx(1.6, abs=1e-3)


SPEED, KNOWN_FROM = 12.0, 30.0
"""Of a run, and where its road's profile begins [m]."""


def driven_on_from_an_unknown_road(tmp_path, hump=False):
    """Return the trial of a recording that begins in full drive, where the profile begins: the road before is not in its file."""
    s, heights = rough_road()
    begin = int(KNOWN_FROM / SPEED * RATE)
    sampled = fine_channels((s, heights), SPEED, 12.0)[::FINE][begin:]
    known = s >= KNOWN_FROM - 1e-9
    road = s[known] - KNOWN_FROM, heights[known]
    if not hump:
        return read_run(tmp_path, sampled, SPEED, road)
    path = write_profile_run(tmp_path, sampled, SPEED, road)
    only_hump = "[{hump: {shape: half_sine, length: 0.5 m, height: 0.03 m, at: 4 m}}]"
    path.write_text(path.read_text().replace("[{profile: {file: road.csv, distance: s, height: h}}]", only_hump))
    return load_trials([path])[0]


def test_a_profile_that_ends_before_its_recording_is_told(tmp_path):
    s, heights = rough_road()
    sampled = fine_channels((s, heights), SPEED, 12.0)[::FINE]
    path = write_profile_run(tmp_path, sampled, SPEED, (s[s <= 60.0], heights[s <= 60.0]))
    with pytest.warns(ModelWarning, match="run: the measured profile ends at 60 m, the run at 95.88 m: from 5 s on the first wheel stays"):
        load_trials([path])


MORE_LEFT_OUT_S = MOST_LEFT_OUT * 8.0 + 2 / RATE
"""As many samples more may be left out as make transforms quick: 1 % of the recording, and one sample to each side."""


def chi2(trial):
    misfit, x = misfit_of(trial, Nuisances(delay=0.0))
    return np.mean(np.abs(misfit.whitened_spectrum(x)[0]) ** 2)


def test_a_run_that_continues_an_unknown_road_begins_when_the_vehicle_has_forgotten_it(tmp_path):
    """The slowest decay is that of the independent state matrix; the last axle comes 2.8 m behind the first."""
    trial = driven_on_from_an_unknown_road(tmp_path)
    slowest = 1 / -np.linalg.eigvals(motion_matrices()[0]).real.max()
    assert 0 <= trial.scenario.skipped / RATE - (2.8 / SPEED + FORGOTTEN * slowest) + 0.01 < MORE_LEFT_OUT_S
    assert trial.recording.time[0] == pytest.approx(trial.scenario.skipped / RATE)
    assert len(trial.recording.time) == len(trial.recording.values) == 800 - trial.scenario.skipped
    assert chi2(trial) < 1.3


def test_what_is_left_out_would_have_spoilt_the_fit(tmp_path):
    trial = driven_on_from_an_unknown_road(tmp_path)
    whole = read_recording(trial.run)
    assert chi2(replace(trial, recording=whole, scenario=replace(trial.scenario, skipped=0))) > 2


def test_what_is_simulated_is_kept_from_where_the_recording_is(tmp_path):
    trial = driven_on_from_an_unknown_road(tmp_path)
    (kept,) = misfit_of(trial, Nuisances())[0].motions(misfit_of(trial, Nuisances())[1])
    whole = replace(trial, recording=read_recording(trial.run), scenario=replace(trial.scenario, skipped=0))
    (all_of_it,) = misfit_of(whole, Nuisances())[0].motions(misfit_of(whole, Nuisances())[1])
    assert kept == pytest.approx(all_of_it[trial.scenario.skipped :], abs=1e-12)


def test_a_recording_that_begins_at_rest_or_runs_over_humps_alone_is_left_whole(tmp_path):
    road = rough_road()
    from_rest = read_run(tmp_path, fine_channels(road, SPEED)[::FINE], SPEED, road)
    assert (from_rest.scenario.skipped, len(from_rest.recording.time)) == (0, 800)
    assert driven_on_from_an_unknown_road(tmp_path, hump=True).scenario.skipped == 0


def test_no_more_than_half_of_a_short_recording_is_left_out(tmp_path):
    s, heights = rough_road()
    begin = int(KNOWN_FROM / SPEED * RATE)
    sampled = fine_channels((s, heights), SPEED, 12.0)[::FINE][begin : begin + 300]
    known = s >= KNOWN_FROM - 1e-9
    trial = read_run(tmp_path, sampled, SPEED, (s[known] - KNOWN_FROM, heights[known]))
    assert trial.scenario.skipped == 150


def test_what_never_decays_is_not_waited_for(tmp_path):
    s, heights = rough_road()
    sampled = np.random.default_rng(2).standard_normal((801, 4))
    undamped = "parameters: {cf: 0 N s/m, cr: 0 N s/m}\n"
    trial = read_run(tmp_path, sampled, SPEED, (s, heights), extra=undamped)
    assert 0 <= trial.scenario.skipped / RATE - 2.8 / SPEED + 0.01 < MORE_LEFT_OUT_S


@pytest.mark.parametrize(("count", "kept"), [(601, 600), (997, 990), (1561, 1560), (1000, 1000), (13, 13), (103, 102), (907, 900), (0, 0)])
def test_a_recording_is_cut_where_its_number_of_samples_makes_transforms_slow(count, kept):
    """601, 997, 103 and 907 are primes, 1561 is 7 times 223; 102, 2 times 3 times 17, is the best within 1 % below 103."""
    assert _quick_count(count) == kept


def test_a_recording_that_begins_when_the_hump_is_behind_says_so(tmp_path):
    path = write_run(tmp_path, "hump", TRUTH, 2.5)
    rows = np.loadtxt(tmp_path / "hump.csv", delimiter=",", skiprows=1)
    rows[:, 0] += 50.0
    np.savetxt(tmp_path / "hump.csv", rows, delimiter=",", header="t,F_az,F_q,R_az,R_q", comments="")
    with pytest.raises(InputError, match=r"begins at t = 50 s, 125.0 m on the way, when the last axle has left the hump at 4.0 m"):
        load_trials([path])
