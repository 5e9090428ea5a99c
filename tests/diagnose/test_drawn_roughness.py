"""Drawn roads: for a linear vehicle they say what its frequency response says; for one with friction they find the road that was there."""

import shutil
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from benchmarks.hidden_effects.generator import Effect, Hump, RandomRoad, RunSpec

from vehgen.diagnose.curves import residual_curves, response_curves
from vehgen.diagnose.detect import drawn_roughness
from vehgen.diagnose.detect.drawn_roughness import DrawnRun, _asked, find_levels, noises_of_laws
from vehgen.diagnose.detect.noise_floor import are_same_noises, find_noise_floor, lead_in_lines
from vehgen.diagnose.fits.candidate import build_problem, list_candidates
from vehgen.effects import EFFECTS, EffectLocator
from vehgen.fit.adjustments import Gain
from vehgen.fit.lead_in import lead_in
from vehgen.fit.least_squares import LeastSquaresFit
from vehgen.fit.misfit import Misfit
from vehgen.fit.noise import SMALLEST_LEVEL, DrawnRoughness, Noise
from vehgen.fit.problem import make_problem
from vehgen.fit.road_answer import KNOT_WAVENUMBERS, road_answer
from vehgen.fit.trial import load_trials
from vehgen.simulate import SimulatorPool

FORCE = 400.0
FRICTION = Effect("dry_friction", "front", {"force": FORCE})
STUCK = tuple(
    RunSpec((Hump(0.5, 0.04, 4.0 * speed), RandomRoad("A", seed)), speed, 8.0, f"run{seed}") for seed, speed in ((1, 4.0), (2, 5.0))
)
CLASS_A = 16e-6
BAND_HZ = 0.5, 40.0


@pytest.mark.slow
def test_roads_drawn_under_a_linear_vehicle_answer_as_its_frequency_response_does(detection_of):
    fit = detection_of().base.least_squares
    number = next(i for i, trial in enumerate(fit.misfit.problem.trials) if trial.scenario.humps)
    trial = fit.misfit.problem.trials[number]
    levels = CLASS_A * 2.0 ** np.arange(len(KNOT_WAVENUMBERS))
    noise = Noise(levels, np.full(len(trial.channels), 1e-9))
    values = fit.misfit.problem.values_of(fit.values, trial)
    expected = noise.density(road_answer(trial, fit.misfit.frequency(number), values))
    found = DrawnRun(fit, number, noise).density(levels, 200).density
    frequency = fit.misfit.frequency(number)
    for low, high in ((2.0, 6.0), (6.0, 12.0), (12.0, 25.0)):
        inside = (frequency >= low) & (frequency < high)
        ours, theirs = (np.mean(item[inside], axis=0) for item in (found, expected))
        size = np.sqrt(np.diag(theirs).real)
        assert np.abs((ours - theirs) / size[:, None] / size[None, :]).max() < 0.15


@pytest.mark.thorough
def test_the_noise_of_a_linear_vehicle_stays_as_it_is(detection_of):
    detection = detection_of()
    assert noises_of_laws(detection.base, detection.floor.noises) is detection.floor.noises


def unmeasured(record, folder, runs):
    """Trials of a vehicle with friction, on roads that the run files do not tell of."""
    shutil.copytree(record(FRICTION, runs=runs)[0].parent, folder, dirs_exist_ok=True)
    for path in folder.glob("run*.yaml"):
        path.write_text("".join(line for line in path.read_text().splitlines(keepends=True) if "profile:" not in line))
    return load_trials(sorted(folder.glob("run*.yaml")))


def as_it_is(trials, noises, shared=(), numbers=(), force=FORCE):
    """The vehicle with its friction, fitted to nothing."""
    vehicle = trials[0].run.vehicle
    locator, base = EffectLocator(vehicle, trials[0].values), make_problem(trials)
    (candidate,) = [item for item in list_candidates(vehicle, trials, [EFFECTS["dry_friction"]], noises) if item.place == "front"]
    problem = build_problem(candidate, base, locator, SimulatorPool())
    point = problem.space.start.copy()
    point[-1] = force
    misfit = Misfit(problem, noises, point, None, BAND_HZ, shared)
    x = np.concatenate([problem.space.unit(point), numbers, np.zeros(misfit.n_errors)])
    return LeastSquaresFit(misfit, x, 1.0, 0.0)


@pytest.fixture(scope="module")
def stuck(record, tmp_path_factory):
    """Runs with friction over humps, and the noise of a linear vehicle."""
    trials = unmeasured(record, tmp_path_factory.mktemp("stuck"), STUCK)
    return trials, find_noise_floor(trials, BAND_HZ).noises


@pytest.fixture(scope="module")
def stuck_fit(stuck):
    return as_it_is(*stuck)


@pytest.mark.thorough
def test_a_smooth_road_under_stuck_friction_is_not_taken_for_a_rough_one(stuck, stuck_fit):
    trials, noises = stuck
    runs = [DrawnRun(stuck_fit, number, noises[trial.name]) for number, trial in enumerate(trials)]
    inside = (KNOT_WAVENUMBERS > 0.3) & (KNOT_WAVENUMBERS < 4)
    for run, levels in zip(runs, find_levels(runs), strict=True):
        linear, own = (np.exp(np.log(item[inside]).mean()) for item in (run.lead.levels, levels))
        assert CLASS_A / 4 < own < 4 * CLASS_A
        assert linear > 2 * own


def test_a_vehicle_that_passes_nothing_on_asks_for_no_roughness(stuck, stuck_fit, monkeypatch):
    """Stuck friction may pass on less of a road than a linear vehicle shows of the smallest level."""
    trials, noises = stuck
    n = len(trials[0].channels)

    def nothing(self, levels, count, *, hump=True):
        frequency = self.fit.misfit.frequency(self.number)
        return DrawnRoughness(frequency, np.zeros((len(frequency), n, n), dtype=np.complex128), np.zeros((1, n)))

    monkeypatch.setattr(DrawnRun, "density", nothing)
    even = np.full(len(KNOT_WAVENUMBERS), 1.5 * SMALLEST_LEVEL)
    runs = [DrawnRun(stuck_fit, number, Noise(even, 1e-5 * noises[trial.name].sigma)) for number, trial in enumerate(trials)]
    for run, levels in zip(runs, find_levels(runs), strict=True):
        lead = lead_in_lines(lead_in(run.trial), BAND_HZ)
        assert np.all(_asked(run, even, lead) >= 0)
        assert np.all(levels >= SMALLEST_LEVEL)


@pytest.mark.thorough
def test_roughness_shifts_nothing_of_what_a_linear_vehicle_does(detection_of):
    fit = detection_of().base.least_squares
    number = next(i for i, trial in enumerate(fit.misfit.problem.trials) if trial.scenario.humps)
    levels = np.full(len(KNOT_WAVENUMBERS), CLASS_A)
    drawn = DrawnRun(fit, number, Noise(levels, np.full(len(fit.misfit.problem.trials[number].channels), 1e-9))).density(levels, 4)
    assert np.abs(drawn.shift).max() < 1e-9 * np.abs(fit.misfit.simulate(fit.x)[number]).max()


@pytest.mark.slow
def test_what_roughness_shakes_loose_of_friction_is_what_recordings_lack_on_average(record, tmp_path_factory):
    """Eight passes over one hump, each on another road that no run file tells of: the true vehicle leaves the shift, and what differs."""
    runs = tuple(RunSpec((Hump(0.5, 0.04, 16.0), RandomRoad("A", seed)), 4.0, 8.0, f"run{seed}") for seed in range(11, 19))
    trials = unmeasured(record, tmp_path_factory.mktemp("shaken"), runs)
    noises = find_noise_floor(trials, BAND_HZ).noises
    fit = as_it_is(trials, noises)
    levels = np.full(len(KNOT_WAVENUMBERS), CLASS_A)
    shift = DrawnRun(fit, 0, noises[trials[0].name]).density(levels, 16).shift
    left = np.mean([trial.recording.values - motion for trial, motion in zip(trials, fit.misfit.simulate(fit.x), strict=True)], axis=0)
    over = slice(round(3.9 / trials[0].recording.dt), round(6.0 / trials[0].recording.dt))
    share = np.sum(left[over] * shift[over], axis=0) / np.sum(shift[over] ** 2, axis=0)
    assert share[0] == pytest.approx(1.0, abs=0.25)  # the acceleration above the friction, then pitch rates
    assert share[[1, 3]] == pytest.approx(1.0, abs=0.4)
    assert np.corrcoef(left[over, 0], shift[over, 0])[0, 1] > 0.6


@pytest.fixture(scope="module")
def shaken(stuck, stuck_fit):
    """What four roads make of the first run."""
    trials, noises = stuck
    return DrawnRun(stuck_fit, 0, noises[trials[0].name]).density(np.full(len(KNOT_WAVENUMBERS), CLASS_A), 4)


def test_roughness_moves_a_vehicle_towards_what_it_does_without_friction(stuck, stuck_fit, shaken):
    loose = as_it_is(*stuck, force=1.0)
    moved = loose.misfit.simulate(loose.x)[0] - stuck_fit.misfit.simulate(stuck_fit.x)[0]
    for i in range(4):
        assert np.corrcoef(shaken.shift[:, i], moved[:, i])[0, 1] > 0.3
    assert 0.05 < np.linalg.norm(shaken.shift) / np.linalg.norm(moved) < 1.0


def test_what_roughness_adds_is_read_as_the_sensors_read(stuck, shaken):
    """A channel that reads twice too much reads twice the shift, four times the density."""
    trials, noises = stuck
    channel = trials[0].channels[0]
    fit = as_it_is(trials, noises, (Gain(channel, 0.1, 1.0, 0.1, 3.0),), (10.0,))
    found = DrawnRun(fit, 0, noises[trials[0].name]).density(np.full(len(KNOT_WAVENUMBERS), CLASS_A), 4)
    times = np.array([2.0, 1.0, 1.0, 1.0])
    np.testing.assert_allclose(found.shift, shaken.shift * times, rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(found.density, shaken.density * np.outer(times, times), rtol=1e-9, atol=1e-15)


def test_a_shift_that_was_taken_off_before_is_not_taken_off_again(stuck, stuck_fit, monkeypatch):
    trials, noises = stuck
    left = []
    monkeypatch.setattr(drawn_roughness, "ROADS_DRAWN", 4)
    monkeypatch.setattr(drawn_roughness, "find_levels", lambda runs: [np.full(len(KNOT_WAVENUMBERS), CLASS_A) for _ in runs])
    monkeypatch.setattr(drawn_roughness, "under_hump", lambda lines, answer, drawn: left.append(lines) or drawn)
    first = noises_of_laws(SimpleNamespace(least_squares=stuck_fit, parts=(stuck_fit,)), noises)
    again = as_it_is(trials, first)
    noises_of_laws(SimpleNamespace(least_squares=again, parts=(again,)), noises)
    plain = trials[0].recording.values - stuck_fit.misfit.simulate(stuck_fit.x)[0]
    expected = stuck_fit.misfit.signal_lines(0, plain - first[trials[0].name].drawn.shift)
    np.testing.assert_allclose(left[0], expected, rtol=0, atol=1e-9 * np.abs(expected).max())
    np.testing.assert_allclose(left[2], expected, rtol=0, atol=1e-9 * np.abs(expected).max())


@pytest.mark.parametrize(("share", "same"), [(0.0, True), (1e-6, True), (1.0, False)])
def test_noises_that_shift_recordings_otherwise_are_others(stuck, stuck_fit, shaken, share, same):
    trials, noises = stuck
    name = trials[0].name
    ours, theirs = (noises | {name: replace(noises[name], drawn=replace(shaken, shift=size * shaken.shift))} for size in (0.0, share))
    assert are_same_noises(ours, theirs, SimpleNamespace(parts=(stuck_fit,))) is same


def test_curves_show_what_was_compared(stuck, shaken):
    """What roughness shifts is no residual: the simulated curve holds it, the measured one stays as it was recorded."""
    trials, noises = stuck
    fit = as_it_is(trials[:1], {trials[0].name: replace(noises[trials[0].name], drawn=shaken)})
    part = SimpleNamespace(validation_fit=fit, least_squares=fit)
    first = response_curves(SimpleNamespace(last=part))[0]
    np.testing.assert_allclose(first.measured, trials[0].recording.values[:, 0], rtol=1e-4)
    np.testing.assert_allclose(first.simulated, fit.misfit.simulate(fit.x)[0][:, 0] + shaken.shift[:, 0], rtol=1e-4, atol=1e-6)
    _, histories = residual_curves(SimpleNamespace(detection=SimpleNamespace(base=part), chosen=[part]))
    np.testing.assert_allclose(histories[0].simulated, np.array(first.measured) - np.array(first.simulated), rtol=1e-3, atol=1e-4)


def test_a_shift_is_taken_off_its_own_recording_alone():
    """A hypothesis of exchanged recordings compares one of another length by this run's noise."""
    shift = np.full((20, 2), 0.3)
    density = np.zeros((3, 2, 2), dtype=np.complex128)
    noise = Noise(np.ones(len(KNOT_WAVENUMBERS)), np.ones(2), drawn=DrawnRoughness(np.arange(3.0), density, shift))
    assert noise.unshifted(np.ones((20, 2))) == pytest.approx(0.7)
    assert noise.rougher(2.0).unshifted(np.ones((20, 2))) == pytest.approx(0.7)
    assert noise.unshifted(np.ones((21, 2))) == pytest.approx(1.0)
    assert Noise(noise.levels, noise.sigma).unshifted(np.ones((20, 2))) == pytest.approx(1.0)
