"""Errors of runs and sensors: each is found in recordings that another program made with it."""

from dataclasses import fields, replace

import numpy as np
import pytest
import scipy.ndimage
import scipy.signal

from tests.fit.profile_world import fine_channels, low_passed, misfit_of, read_run, rough_road
from tests.fit.recordings import DT, sedan_truth, write_run
from vehgen.fit.alignment import MOST_SIGMAS
from vehgen.fit.least_squares import FitOptions, fit_least_squares
from vehgen.fit.linearisation import linearise
from vehgen.fit.misfit import Misfit
from vehgen.fit.noise import EVEN, Noise
from vehgen.fit.nuisances import LOW_PASS, Nuisances, asked_nuisances, wander_knots
from vehgen.fit.problem import make_problem
from vehgen.fit.trial import load_trials
from vehgen.measure.acquisition import AcquisitionChain
from vehgen.road import Hump, MeasuredProfile

TRUTH = sedan_truth()
SIGMA = np.array([0.02, 1e-3, 0.02, 1e-3])
CHANNELS = ("F_az", "F_q", "R_az", "R_q")


def changed(tmp_path, change, speed=2.5, text=lambda text: text, noise=1.0):
    """Return a trial whose recording `change` has gone over, `shape (n, 4)`, with noise of `noise` times SIGMA."""
    path = write_run(tmp_path, "run", TRUTH, speed, noise=0.0)
    rows = np.loadtxt(tmp_path / "run.csv", delimiter=",", skiprows=1)
    rows[:, 1:] = change(rows[:, 1:]) + noise * SIGMA * np.random.default_rng(3).normal(size=rows[:, 1:].shape)
    np.savetxt(tmp_path / "run.csv", rows, delimiter=",", header="t,F_az,F_q,R_az,R_q", comments="")
    path.write_text(text(path.read_text(encoding="utf-8")), encoding="utf-8")
    return load_trials([path])[0]


def fitted(trial, noise=1.0, **deviations):
    """Return what a fit finds beside the parameters named, all others true."""
    problem = make_problem([trial], ("kf",))
    problem = problem.with_trials([replace(trial, values={**trial.values, **TRUTH})])
    noises = {trial.name: Noise(EVEN, noise * SIGMA)}
    start = problem.space.unit(np.array([TRUTH[name] for name in problem.space.names]))
    fit = fit_least_squares(problem, start, FitOptions(Nuisances(**deviations)), noises=noises)
    return fit, {(item.name, item.place): item.value for item in fit.conditions()}


def late(values, seconds):
    """Return channels that come later, by their Fourier transform."""
    padded = np.vstack([values, np.zeros_like(values)])
    turned = np.fft.rfft(padded, axis=0) * np.exp(-2j * np.pi * np.fft.rfftfreq(len(padded), DT) * seconds)[:, None]
    return np.fft.irfft(turned, len(padded), axis=0)[: len(values)]


def test_a_late_clock_of_one_sensor_is_found(tmp_path):
    fit, found = fitted(changed(tmp_path, lambda v: np.hstack([v[:, :2], late(v[:, 2:], 0.017)])))
    assert found["clock", "R"] == pytest.approx(0.017, abs=1e-3)
    assert fit.chi2 == pytest.approx(1.0, abs=0.1)


def test_a_gyroscope_that_lags_its_accelerometer_is_found(tmp_path):
    def lagging(values):
        return np.column_stack([values[:, 0], late(values[:, 1:2], 0.003), values[:, 2], late(values[:, 3:], 0.001)])

    fit, found = fitted(changed(tmp_path, lagging))
    assert found["lag", "F"] - found["lag", "R"] == pytest.approx(0.002, abs=3e-4)
    assert fit.chi2 == pytest.approx(1.0, abs=0.1)


def test_a_hump_with_worn_edges_is_found(tmp_path):
    """The edges are worn in the file's place: points of the drawing under a Gaussian mean of 10 mm."""
    trial = changed(tmp_path, lambda v: v)
    hump = trial.scenario.humps[0]
    s = np.arange(-0.05, hump.length + 0.05, 1e-3)
    sharper = hump.height(hump.at + s) - (scipy.ndimage.gaussian_filter1d(hump.height(hump.at + s), 10.0) - hump.height(hump.at + s))
    track = replace(trial.scenario.track, parts=(Hump.from_points(hump.at + s[0], s, sharper),))
    _, found = fitted(replace(trial, scenario=replace(trial.scenario, track=track)), length=0.0, form=0.0, skew=0.0)
    assert found["wear", ""] == pytest.approx(100.0, rel=0.2)


def test_what_an_unknown_low_pass_takes_off_is_found_and_a_declared_one_takes_nothing(tmp_path):
    def filtered(values):
        padded = np.vstack([values, np.zeros_like(values)])
        share = np.fft.rfftfreq(len(padded), DT) * 2 * DT
        factor = np.exp(-0.4 * share**2 - 1j * share**3)[:, None]
        return np.fft.irfft(np.fft.rfft(padded, axis=0) * factor, len(padded), axis=0)[: len(values)]

    fit, found = fitted(changed(tmp_path, filtered), wear=0.0, form=0.0, skew=0.0, length=0.0)
    for sensor in ("F", "R"):
        assert found["roll_off", sensor] == pytest.approx(0.4, abs=0.12)
        assert found["dispersion", sensor] == pytest.approx(1.0, abs=0.5)
    assert fit.chi2 == pytest.approx(1.0, abs=0.1)
    declared = changed(tmp_path, lambda v: v, text=lambda text: text + "acquisition: none\n")
    assert not {item.name for item in Nuisances().of_all_runs([declared])} & set(LOW_PASS)


def test_an_axle_that_runs_elsewhere_is_found(tmp_path):
    """The recording is of a wheelbase of 2.8 m; of two axles another speed would do as well."""
    trial = changed(tmp_path, lambda v: v)
    believed = replace(trial, values={**trial.values, "wheelbase": 2.808})
    fit, found = fitted(believed, speed=0.0, wander=0.0)
    assert found["axle_position", "rear"] == pytest.approx(-0.008, abs=2e-3)
    assert fit.chi2 == pytest.approx(1.0, abs=0.1)
    exact, _ = fitted(believed, speed=0.0, wander=0.0, axle_position=0.0)
    assert exact.loss > fit.loss + 10


def test_an_odometer_that_counts_too_much_is_found(tmp_path):
    """The speed makes up for it but for how late the rear axle follows; over humps alone there is no such error."""
    s, heights = rough_road()
    trial = read_run(tmp_path, low_passed(fine_channels((s, heights), 10.0), 8, 30.0), 10.0, (1.006 * s, heights))
    trial = replace(trial, scenario=replace(trial.scenario, chains=dict.fromkeys(trial.channels, AcquisitionChain("butterworth", 8, 30.0))))

    def fit(**deviations):
        misfit, x = misfit_of(trial, Nuisances(axle_position=0.0, wander=0.0, **deviations))
        unit = misfit.split(x)[0]
        return fit_least_squares(misfit.problem, unit, FitOptions(misfit.nuisances, (0.5, 20.0)), noises=misfit.noises)

    found = {item.name: item.value for item in fit().conditions() if not item.place}
    assert found["odometer"] == pytest.approx(0.006, abs=1e-3)
    assert found["speed"] == pytest.approx(0.006, abs=1e-3)
    assert fit(odometer=0.0).loss > fit().loss + 10
    hump = load_trials([write_run(tmp_path, "hump", TRUTH)])[0]
    assert "odometer" not in {item.name for item in Nuisances().of_run(hump)}


def test_a_distance_that_is_searched_has_no_error_beside(tmp_path):
    path = write_run(tmp_path, "run", TRUTH)
    assert "axle_position" in {item.name for item in Nuisances().of_all_runs(load_trials([path]))}
    searched = tmp_path / "searched.yaml"
    searched.write_text("extends: sedan2.yaml\nparameters: {wheelbase: {range: [2.7 m, 2.9 m]}}\n", encoding="utf-8")
    path.write_text(path.read_text(encoding="utf-8").replace("sedan2.yaml", "searched.yaml"), encoding="utf-8")
    assert "axle_position" not in {item.name for item in Nuisances().of_all_runs(load_trials([path]))}


def test_a_gain_is_found(tmp_path):
    _, found = fitted(changed(tmp_path, lambda v: v * [1.0, 1.0, 1.025, 1.0]))
    assert found["gain", "R_az"] == pytest.approx(0.025, abs=8e-3)
    assert abs(found["gain", "F_az"]) < 8e-3


def test_a_place_off_along_the_body_is_found(tmp_path):
    def shifted(values):
        acceleration = scipy.signal.resample(values[:, 3], 8 * len(values))
        return values - np.column_stack([np.zeros((len(values), 2)), 0.05 * np.gradient(acceleration, DT / 8)[::8], np.zeros(len(values))])

    fit, found = fitted(changed(tmp_path, shifted), gain=0.0, tilt=0.0)
    assert found["position", "R"] == pytest.approx(0.05, abs=5e-3)
    assert fit.chi2 == pytest.approx(1.0, abs=0.1)


def test_a_tilted_sensor_reads_its_share_of_gravity(tmp_path):
    def tilted(values):
        pitch = np.cumsum(values[:, 1]) * DT
        return values * [np.cos(0.05), 1, 1, 1] + np.column_stack([-9.81 * np.sin(0.05) * pitch, *np.zeros((3, len(values)))])

    _, found = fitted(changed(tmp_path, tilted, noise=0.1), 0.1, gain=0.0, position=0.0, tilt=0.2)
    assert found["tilt", "F"] == pytest.approx(0.05, abs=5e-3)


def test_a_hump_as_long_as_it_is(tmp_path):
    trial = changed(tmp_path, lambda v: v, text=lambda text: text.replace("length: 0.5 m", "length: 0.49 m"))
    _, found = fitted(trial)
    assert trial.scenario.humps[0].length * (1 + found["length", ""]) == pytest.approx(0.5, rel=6e-3)


def test_no_error_exceeds_its_bound(tmp_path):
    fit, found = fitted(changed(tmp_path, lambda v: v * [1.0, 1.0, 1.3, 1.0]))
    assert found["gain", "R_az"] == pytest.approx(MOST_SIGMAS * 0.01, rel=1e-6)
    assert fit.chi2 > 3


def test_a_run_file_says_how_well_it_knows_itself(tmp_path):
    stated = "uncertainty: {speed: 0.05 m/s, clock: 0 s, gain: 0.03, position: 5 cm, axle_position: 2 mm}\n"
    trial = changed(tmp_path, lambda v: v, text=lambda text: text + stated)
    sigmas = {(item.name, item.place): item.sigma for item in (*Nuisances().of_run(trial), *Nuisances().of_all_runs([trial]))}
    assert sigmas["speed", ""] == pytest.approx(0.05 / 2.5)
    assert ("clock", "R") not in sigmas
    asked = {item.name: item.sigma for item in asked_nuisances(speed=0.04, height=None).of_run(trial)}
    assert asked["speed"] == 0.04
    assert asked["height"] == Nuisances().height
    assert sigmas["gain", "F_q"] == 0.03
    assert sigmas["position", "F"] == pytest.approx(0.05)
    assert sigmas["axle_position", "rear"] == pytest.approx(0.002)


def test_deviations_in_units_are_shares_of_what_the_run_has(tmp_path):
    stated = "uncertainty: {speed: 0.03, wander: 0.1 m/s, length: 1 cm}\n"
    trial = changed(tmp_path, lambda v: v, text=lambda text: text + stated)
    sigmas = {(item.name, item.place): item.sigma for item in Nuisances().of_run(trial)}
    wander = [sigma for (name, _), sigma in sigmas.items() if name == "wander"]
    assert wander == pytest.approx([0.04] * len(wander_knots(trial)))
    assert Nuisances().speed_spread(trial) == pytest.approx(0.05)
    assert sigmas["length", ""] == pytest.approx(0.01 / 0.5)
    humps = (*trial.scenario.track.parts, Hump.from_shape("half_sine", 12.0, 0.2, 0.01))
    two = replace(trial, scenario=replace(trial.scenario, track=replace(trial.scenario.track, parts=humps)))
    assert next(item.sigma for item in Nuisances().of_run(two) if item.name == "length") == pytest.approx(0.01 / 0.5)  # of the longest
    assert sigmas["wear", ""] == pytest.approx(64.0)  # edges are rounded by 8 mm
    assert [place for name, place in sigmas if name == "clock"] == ["R"]  # against that of the first


def test_a_long_run_has_knots_of_its_wander_farther_apart(tmp_path):
    trial = changed(tmp_path, lambda v: v)
    profile = MeasuredProfile(np.linspace(0.0, 200.0, 2001), np.zeros(2001))
    for duration, count in ((9.5, 11), (60.0, 16)):
        track = replace(trial.scenario.track, parts=(*trial.scenario.track.parts, profile))
        knots = wander_knots(replace(trial, scenario=replace(trial.scenario, track=track, duration=duration)))
        assert len(knots) == count
        assert np.diff(knots) == pytest.approx(duration / (count - 1))


def test_a_wander_has_knots_while_wheels_are_on_the_hump(tmp_path):
    trial = changed(tmp_path, lambda v: v, speed=1.0)
    knots = wander_knots(trial)
    met = trial.scenario.first_arrival
    assert knots[0] == pytest.approx(met - 0.3, abs=0.01)
    assert knots[-1] == pytest.approx(met + (2.8 + trial.scenario.humps[0].length) / 1.0 + 0.3, abs=0.01)
    assert wander_knots(replace(trial, scenario=trial.scenario.adjusted(speed=20.0))) == []


def test_derivatives_are_those_of_the_residuals(tmp_path):
    trial = changed(tmp_path, lambda v: v)
    problem = make_problem([trial], ("kf", "cr"))
    misfit = Misfit(problem, {trial.name: Noise(EVEN, SIGMA)}, problem.space.start)
    random = np.random.default_rng(5)
    x = np.concatenate([problem.space.unit(problem.space.start), 0.5 * random.normal(size=misfit.n_errors)])
    found = linearise(misfit, x)
    numerical = np.column_stack([(misfit.residuals(x + step) - misfit.residuals(x - step)) / 2e-4 for step in 1e-4 * np.eye(len(x))])
    scale = np.abs(numerical).max(axis=0)
    assert np.all(np.abs(found.jacobian - numerical).max(axis=0) < 0.02 * scale + 1e-6)
    information, gradient = found.normal(misfit.whitened_spectrum(x), x)
    assert information == pytest.approx(found.jacobian.T @ found.jacobian, rel=1e-9, abs=1e-6)
    assert gradient == pytest.approx(found.jacobian.T @ misfit.residuals(x), rel=1e-9, abs=1e-6)


def test_a_fit_of_known_noise_weighs_roughness_by_the_errors_that_it_begins_at(tmp_path):
    """Of a road far louder than sensors four channels agree only as well as their gains do: 3 % of one look like noise of the sensors."""
    rough, spacing = 5e-4, 0.05  # a random walk's density: 2 rough^2 / (spacing (2 pi n)^2)
    path = write_run(tmp_path, "run", TRUTH, noise=0.0, rough=rough, seed=4)
    rows = np.loadtxt(tmp_path / "run.csv", delimiter=",", skiprows=1)
    sigma = 0.05 * SIGMA
    rows[:, 1:] = rows[:, 1:] * [1.03, 1.0, 1.0, 1.0] + sigma * np.random.default_rng(3).normal(size=rows[:, 1:].shape)
    np.savetxt(tmp_path / "run.csv", rows, delimiter=",", header="t,F_az,F_q,R_az,R_q", comments="")
    path.write_text(path.read_text(encoding="utf-8") + "acquisition: none\n", encoding="utf-8")
    trial = load_trials([path])[0]
    problem = make_problem([replace(trial, values={**trial.values, **TRUTH})], ("kf",))
    noises = {trial.name: Noise(np.full(len(EVEN), 2 * rough**2 / (spacing * (0.2 * np.pi) ** 2)), sigma)}
    unit = problem.space.unit(np.array([TRUTH["kf"]]))
    options = FitOptions(Nuisances(**{item.name: 0.0 for item in fields(Nuisances) if item.name not in ("delay", "gain", "asked")}))
    blind = fit_least_squares(problem, unit, options, noises=noises)
    fit = fit_least_squares(problem, unit, options, noises=noises, start=blind.misfit.split(blind.x)[1])
    gains = {item.place: item.value for item in fit.conditions() if item.name == "gain"}
    assert gains["F_az"] - gains["R_az"] == pytest.approx(0.03, abs=0.003)
    assert fit.loss < blind.loss - 50
