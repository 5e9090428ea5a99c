"""Where fits begin: delays of known signals, and runs that another program drove at another speed than their files say."""

import numpy as np
import pytest
import scipy.signal

from tests.fit.profile_world import FINE, fine_channels, misfit_of, read_run, rough_road
from tests.fit.recordings import sedan_truth, write_run
from vehgen.fit import alignment as module
from vehgen.fit.alignment import LATEST, align, best_delay, error_bounds
from vehgen.fit.least_squares import first_noises
from vehgen.fit.misfit import Misfit
from vehgen.fit.nuisances import Nuisances
from vehgen.fit.problem import make_problem
from vehgen.fit.trial import load_trials

DT, BAND = 0.01, (0.5, 8.0)


def slow_noise(n=800, channels=2):
    """Return channels of noise below 6 Hz that rise from nothing and fade."""
    white = np.random.default_rng(4).standard_normal((n, channels))
    sections = scipy.signal.butter(4, 6.0, fs=1 / DT, output="sos")
    return scipy.signal.sosfiltfilt(sections, white, axis=0) * scipy.signal.windows.tukey(n, 0.6)[:, None]


@pytest.mark.parametrize("samples", [-60, -3, 0, 1, 25, 90])
def test_a_delay_by_whole_samples_is_found(samples):
    signal = slow_noise()
    late, likeness = best_delay(np.roll(signal, samples, axis=0), signal, DT, BAND)
    assert late == pytest.approx(samples * DT)
    assert likeness > 0.97


def test_the_size_of_a_channel_says_nothing():
    signal = slow_noise()
    measured = np.roll(signal, 20, axis=0)
    assert best_delay(measured * [1.0, 1e-4], signal * [30.0, 1.0], DT, BAND) == pytest.approx(best_delay(measured, signal, DT, BAND))


def test_what_lies_outside_the_band_says_nothing():
    signal, time = slow_noise(), np.arange(800)[:, None] * DT
    measured = np.roll(signal, 20, axis=0) + 5 * np.sin(2 * np.pi * 20 * time)
    assert best_delay(measured, signal + 5 * np.cos(2 * np.pi * 20 * time), DT, BAND)[0] == pytest.approx(0.2)


def test_unlike_signals_are_told_by_their_likeness_and_no_delay_is_longer_than_the_longest():
    signal, other = slow_noise(channels=1), slow_noise(channels=2)[:, 1:]
    late, likeness = best_delay(signal, other, DT, BAND)
    assert likeness < 0.6
    assert abs(late) <= LATEST
    assert best_delay(np.roll(signal, 150, axis=0), signal, DT, BAND)[1] < 0.6


def test_a_speed_that_turns_fast_motions_by_whole_cycles_is_found(tmp_path):
    """At 12 m/s over 8 s, 2 % of speed shift the road's end by 0.17 s: two cycles of hop."""
    road = rough_road()
    trial = read_run(tmp_path, fine_channels(road, 11.75)[::FINE], 12.0, road, late=0.13)
    misfit, x = misfit_of(trial, Nuisances())
    x[: misfit.n_parameters] += 0.02
    errors = align(misfit, x[: misfit.n_parameters])
    begun = np.concatenate([x[: misfit.n_parameters], errors])
    found = {item.name: item.value for item in misfit.conditions(begun) if item.run}
    assert found["speed"] == pytest.approx(11.75 / 12 - 1, abs=2e-3)
    assert found["delay"] == pytest.approx(0.13, abs=0.01)
    assert not errors[: len(misfit.common)].any()
    unaligned = np.sum(misfit.residuals(x) ** 2)
    assert np.sum(misfit.residuals(begun) ** 2) < 0.1 * unaligned


@pytest.mark.parametrize(("astray", "known"), [(0.5, ""), (-0.5, ""), (0.0, ""), (0.5, "uncertainty: {odometer: 0}\n")])
def test_of_slow_motions_first_and_all_at_once_the_better_is_taken_over_a_measured_road(tmp_path, monkeypatch, astray, known):
    """Where slow motions lead a speed's wander astray, fast ones may hold it there."""
    road = rough_road()
    trial = read_run(tmp_path, fine_channels(road, 12.0)[::FINE], 12.0, road, extra=known)
    misfit, x = misfit_of(trial, Nuisances())
    moved = []

    def fitted(alone, start):
        moved.append(alone.band[1])
        at_once = moved.count(alone.band[1]) == 2
        return np.zeros_like(start) if at_once else np.full_like(start, astray)

    monkeypatch.setattr(module, "_fitted", fitted)
    errors = align(misfit, x[: misfit.n_parameters])
    assert moved == [3.0, 8.0, 20.0, 20.0]
    assert np.abs(errors[misfit.own_columns(0).start - misfit.n_parameters :]).max() < 1e-12


def test_a_run_whose_begin_is_known_is_left_as_it_is(tmp_path):
    trial = load_trials([write_run(tmp_path, "run", sedan_truth())])[0]
    misfit, x = misfit_of(trial, Nuisances(delay=0.0))
    assert not align(misfit, x[: misfit.n_parameters]).any()


def test_a_hump_of_which_little_is_known_does_not_vanish(tmp_path):
    run = write_run(tmp_path, "run", sedan_truth(), 2.5)
    run.write_text(run.read_text(encoding="utf-8") + "uncertainty: {height: 0.5, length: 0.9, speed: 0.3}\n", encoding="utf-8")
    problem = make_problem(load_trials([run]))
    misfit = Misfit(problem, first_noises(problem), problem.space.start)
    low, _ = error_bounds(misfit)
    least = {item.name: 1 + item.sigma * bound for item, bound in zip(misfit.conditions(np.zeros(misfit.n_unknowns)), low, strict=True)}
    assert [least[name] for name in ("height", "length", "speed")] == pytest.approx([0.1, 0.1, 0.1])
    assert (align(misfit, problem.space.unit(problem.space.start)) >= low).all()


@pytest.mark.parametrize("band", [(3.0, 40.0), (9.0, 40.0), (0.3, 2.0)])
def test_runs_are_laid_over_their_recordings_in_any_band(tmp_path, band):
    problem = make_problem(load_trials([write_run(tmp_path, "run", sedan_truth(), 2.5)]))
    misfit = Misfit(problem, first_noises(problem), problem.space.start, band=band)
    laid = dict(zip((item.name for item in misfit.errors[0].own), align(misfit, problem.space.unit(problem.space.start)), strict=False))
    assert abs(laid["delay"]) < 0.25
    assert abs(laid["speed"]) < 3.0
