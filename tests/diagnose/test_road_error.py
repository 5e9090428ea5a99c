"""What roads add to the noise: errors of measured profiles against drawn ones, and roads under humps rougher than before them."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import scipy.signal

from tests.fit import recordings
from tests.fit.profile_world import FINE, SEARCHED, SIGMA, TRUTH, fine_channels, misfit_of, read_run, rough_road
from vehgen.diagnose.detect.road_error import MOST_ERROR_M, ProfileError, find_profile_error, road_noises
from vehgen.fit.misfit import Misfit
from vehgen.fit.noise import EVEN, Noise
from vehgen.fit.nuisances import Nuisances
from vehgen.fit.problem import make_problem
from vehgen.fit.road_answer import KNOT_WAVENUMBERS
from vehgen.fit.trial import load_trials

POINTS, SPEED = 0.05, 12.0
"""Spacing of the measured points [m], speed [m/s]."""
LEAD = Noise(EVEN, SIGMA)
QUIET = Nuisances(delay=0.0)


def levels(heights, spacing, knots):
    """Return Gd(n0) at knots, by Welch's method, of a road of heights `spacing` [m] apart."""
    wavenumber, density = scipy.signal.welch(heights, 1 / spacing, nperseg=int(80 / spacing))
    found = [density[(wavenumber > 0.8 * knot) & (wavenumber < 1.25 * knot)].mean() for knot in knots]
    return np.array(found) * knots**2 / 0.01


@pytest.mark.parametrize("spacing", [0.05, 0.2])
def test_points_that_are_off_make_a_road_of_this_spectrum(spacing):
    """The profile runs straight between its points: that is drawn, and taken to pieces by Welch's method."""
    errors = 3e-4 * np.random.default_rng(0).standard_normal(40000)
    fine = 0.005
    s = np.arange(0.0, len(errors) * spacing - spacing, fine)
    seen = KNOT_WAVENUMBERS * spacing < 0.7
    drawn = levels(np.interp(s, np.arange(len(errors)) * spacing, errors), fine, KNOT_WAVENUMBERS[seen])
    assert ProfileError(3e-4, 1e-12, 1.0, spacing).noise(LEAD).levels[seen] == pytest.approx(drawn, rel=0.25)


def test_a_drift_is_a_road_as_of_iso_8608_and_the_sensors_grow_louder():
    steps = 2e-5 * np.random.default_rng(1).standard_normal(200_000)
    noise = ProfileError(1e-9, 4e-10 / (0.05 * 2 * np.pi**2 * 0.01), 1.5, POINTS).noise(LEAD)
    low = KNOT_WAVENUMBERS < 4
    assert noise.levels[low] == pytest.approx(levels(np.cumsum(steps), POINTS, KNOT_WAVENUMBERS[low]), rel=0.35)
    assert noise.sigma == pytest.approx(1.5 * SIGMA)


@pytest.fixture(scope="module")
def driven():
    road = rough_road()
    return road, fine_channels(road, SPEED)[::FINE]


def found_in(folder, driven, error, sampled=None):
    """Return what is found where the profile's file is off by `error` [m], a number a point."""
    (s, heights), true = driven
    trial = read_run(folder, true if sampled is None else sampled, SPEED, (s, heights + error(len(s))), extra="acquisition: none\n")
    misfit, x = misfit_of(trial, QUIET)
    lines, answer = misfit.residual_spectrum(x)[0]
    return find_profile_error(trial, lines, answer, LEAD), misfit, x


@pytest.mark.parametrize("size", [1e-4, 3e-4])
def test_the_error_of_points_is_found(tmp_path, driven, size):
    found, misfit, x = found_in(tmp_path, driven, lambda n: size * np.random.default_rng(5).standard_normal(n))
    assert found.points == pytest.approx(size, rel=0.25)
    assert found.growth < 1.3
    noisy = type(misfit)(misfit.problem, {"run": found.noise(LEAD)}, misfit.problem.space.start, misfit.nuisances, misfit.band)
    before, after = (np.mean(np.abs(item.whitened_spectrum(x)[0]) ** 2) for item in (misfit, noisy))
    assert before > 1.5
    assert after == pytest.approx(1.0, abs=0.25)


def test_a_drift_is_told_from_points_that_are_off(tmp_path, driven):
    step = 1.5e-4
    found, _, _ = found_in(tmp_path, driven, lambda n: step * np.cumsum(np.random.default_rng(6).standard_normal(n)))
    assert found.drift == pytest.approx(step**2 / (POINTS * 2 * np.pi**2 * 0.01), rel=0.4)
    assert found.points < 1e-4


def test_a_profile_without_errors_has_next_to_none(tmp_path, driven):
    found, _, _ = found_in(tmp_path, driven, np.zeros)
    assert found.points < 3e-5
    assert found.drift < 1e-9
    assert found.growth == pytest.approx(1.0, abs=0.1)


def test_no_error_of_a_profile_explains_a_wrong_model(tmp_path, driven):
    found, misfit, x = found_in(tmp_path, driven, np.zeros, 10 * driven[1])
    assert found.points <= MOST_ERROR_M * 1.001
    assert found.growth <= 3.001
    noisy = type(misfit)(misfit.problem, {"run": found.noise(LEAD)}, misfit.problem.space.start, misfit.nuisances, misfit.band)
    assert np.mean(np.abs(noisy.whitened_spectrum(x)[0]) ** 2) > 3


STEP = 2e-4
LEVEL = STEP**2 / (POINTS * 2 * np.pi**2 * 0.01)
"""Gd(n0) of a random walk by STEP every POINTS [m^3]."""
STEADY_WALK_HZ = (0.5, 10.0)
"""At 2.5 m/s, waves longer than five points: shorter ones are cut by straight lines between them."""


def under_hump(folder, lead_level):
    """Return the noise found for a run over a hump on a road of LEVEL, where the lead-in showed another one."""
    trial = load_trials([recordings.write_run(folder, "run", TRUTH, 2.5, noise=0.0, rough=STEP)])[0]
    lead = {"run": Noise(np.full_like(EVEN, lead_level), 0.1 * SIGMA)}
    problem = make_problem([trial], SEARCHED)
    steady = replace(QUIET, speed=0.0, wander=0.0)
    misfit = Misfit(problem, lead, np.array([TRUTH[name] for name in SEARCHED]), steady, STEADY_WALK_HZ)
    fit = SimpleNamespace(misfit=misfit, x=np.concatenate([problem.space.unit(problem.space.start), np.zeros(misfit.n_errors)]))
    return road_noises(SimpleNamespace(least_squares=fit, validation_fit=None, parts=(fit,)), lead, lead)["run"], lead["run"]


@pytest.mark.parametrize(("share", "found"), [(0.75, 0.75), (1.3, 1.3), (0.1, 0.6), (6.0, 1.6)])
def test_the_road_under_a_hump_is_as_rough_as_the_run_says_within_bounds(tmp_path, share, found):
    noise, lead = under_hump(tmp_path, LEVEL / share)
    assert noise.levels == pytest.approx(found * lead.levels, rel=0.15)
    assert noise.sigma is lead.sigma


def test_an_even_road_stays_even(tmp_path):
    noise, lead = under_hump(tmp_path, EVEN[0])
    assert noise is lead
