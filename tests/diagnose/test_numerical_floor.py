"""What the simulation itself may be off by, beside the noise."""

from dataclasses import replace

import numpy as np
import pytest

from vehgen.diagnose.detect.numerical_floor import SmoothedProfile, numerical_floor, smooth_road
from vehgen.fit.misfit import Misfit
from vehgen.fit.resolution import halved
from vehgen.road import MeasuredProfile


@pytest.fixture(scope="module")
def fit(detection_of):
    return detection_of().base.least_squares


def with_trials(fit, change):
    misfit = fit.misfit
    problem = misfit.problem.with_trials([change(trial) for trial in misfit.problem.trials])
    return Misfit(problem, misfit.noises, fit.values, misfit.nuisances, misfit.band)


def coarser(trial):
    scenario = trial.scenario
    return replace(trial, scenario=replace(scenario, dt=2 * scenario.dt, decimation=scenario.decimation // 2))


def coarse_road(trial):
    def thin(part):
        return MeasuredProfile(part.distance[::8], part.heights[::8]) if isinstance(part, MeasuredProfile) else part

    track = trial.scenario.track
    return replace(trial, scenario=replace(trial.scenario, track=replace(track, parts=tuple(thin(part) for part in track.parts))))


@pytest.mark.thorough
def test_a_resolved_simulation_adds_next_to_nothing_to_the_noise(detection_of, fit):
    found = numerical_floor(fit.misfit, fit.x)
    assert set(found) == {trial.name for trial in fit.misfit.problem.trials}
    assert max(found.values()) < 0.05
    assert 1.06 <= detection_of().nothing_missing < 1.08


@pytest.mark.thorough
def test_what_one_run_may_err_by_excuses_no_other_run(detection_of):
    found = detection_of()
    base = replace(found.base, mean_squares=dict.fromkeys(found.base.mean_squares, 1.2))
    one = next(iter(base.mean_squares))
    rough = replace(found, base=base, numerical=dict.fromkeys(base.mean_squares, 0.0) | {one: 0.3})
    share = base.counts[one] / sum(base.counts.values())
    assert rough.nothing_missing**2 == pytest.approx(1.06**2 + 0.2 * share)
    noise = replace(rough, base=replace(base, mean_squares=base.mean_squares | {one: 0.9}))
    assert noise.nothing_missing == pytest.approx(1.06)


def test_the_error_told_of_a_coarse_step_is_its_distance_from_a_fine_one(fit):
    rough = with_trials(fit, coarser)
    told = numerical_floor(rough, fit.x)
    fine = with_trials(fit, lambda trial: halved(halved(trial)))
    for number, (one, other) in enumerate(zip(rough.simulate(fit.x), fine.simulate(fit.x), strict=True)):
        true = np.mean(np.abs(rough.whitened_signal(number, one - other)) ** 2)
        trial = rough.problem.trials[number]
        if smooth_road(trial) is trial:
            assert told[trial.name] == pytest.approx(true, rel=0.35)


def test_a_road_measured_at_few_points_tells_of_what_lies_between_them(fit):
    found, sparse = numerical_floor(fit.misfit, fit.x), numerical_floor(with_trials(fit, coarse_road), fit.x)
    assert sparse["rough"] > 10 * found["rough"]
    assert sparse["high"] == pytest.approx(found["high"], rel=0.01)


def test_a_spline_passes_through_the_points_of_a_profile():
    distance, heights = np.arange(6.0), np.array([0.3, 0.1, 0.4, 0.2, 0.2, 0.0])
    smooth = SmoothedProfile(MeasuredProfile(distance, heights))
    assert smooth.height(distance) == pytest.approx(heights - 0.3)
    assert smooth.height(np.array([-2.0, 9.0])) == pytest.approx([0.0, -0.3])


def test_another_way_to_simulate_adds_its_own_difference(fit):
    plain = numerical_floor(fit.misfit, fit.x)
    same = numerical_floor(fit.misfit, fit.x, [lambda trial: replace(trial)])
    assert same == pytest.approx(plain)
    more = numerical_floor(fit.misfit, fit.x, [coarser])
    assert all(more[name] > plain[name] for name in plain)
