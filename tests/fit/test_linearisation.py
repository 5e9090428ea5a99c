"""Derivatives of a misfit by what its sensors do not know of themselves, held against differences of the whole misfit."""

import numpy as np
import pytest

from tests.fit.profile_world import FINE, SIGMA, fine_channels, misfit_of, read_run, rough_road
from tests.fit.profile_world import write_run as write_rough_run
from tests.fit.recordings import sedan_truth, write_run
from vehgen.diagnose.inputs.adjustments import ClockRate, RecorderFilter, RunLevel
from vehgen.fit import linearisation as module
from vehgen.fit.adjustments import Adjustment, Footprint, Gain, SensorDelay, SpeedScale, Tilt
from vehgen.fit.alignment import MOST_SHARPENED, MOST_SIGMAS, error_bounds
from vehgen.fit.linearisation import MOST_MISSED, Lineariser, linearise
from vehgen.fit.misfit import Misfit
from vehgen.fit.noise import EVEN, Noise
from vehgen.fit.nuisances import Nuisances
from vehgen.fit.problem import make_problem
from vehgen.fit.trial import load_trials
from vehgen.vehicle import bundled_models

MOVES = {"delay": 0.01, "speed": 0.02, "wander": 0.2, "odometer": 1.0, "axle_position": 1.0}
"""How many standard deviations take a wheel about as far as it comes in one step."""


@pytest.fixture(scope="module")
def late(tmp_path_factory):
    """A misfit at a point where the second sensor's clock is 30 ms late, and its pitch rate 3 ms later still."""
    road = rough_road()
    sampled = fine_channels(road, 12.0)[::FINE]
    misfit, x = misfit_of(read_run(tmp_path_factory.mktemp("late"), sampled, 12.0, road), Nuisances())
    start = misfit.n_parameters + len(misfit.shared)
    for i, item in enumerate(misfit.conditions(x)):
        x[start + i] = {"clock": 3.0, "lag": 2.0, "tilt": 1.0}.get(item.name, 0.3)
    return misfit, x


@pytest.mark.parametrize("one_sided", [True, False])
@pytest.mark.parametrize("name", ["clock", "lag", "tilt", "position", "gain"])
def test_derivatives_by_errors_of_sensors_are_those_of_the_whole_misfit(late, name, one_sided):
    """To a thousandth: a late clock moves the window under which its channels are compared, too."""
    misfit, x = late
    start = misfit.n_parameters + len(misfit.shared)
    spectra = linearise(misfit, x, one_sided=one_sided).spectra[0]
    for i, item in enumerate(misfit.conditions(x)):
        if item.name != name:
            continue
        step = 1e-3 * np.eye(len(x))[start + i]
        ahead, behind = misfit.whitened_spectrum(x + step)[0], misfit.whitened_spectrum(x - step)[0]
        expected = (ahead - behind) / 2e-3
        tolerance = 2e-3 if one_sided else 1e-4
        assert np.abs(spectra[start + i] - expected).max() < tolerance * np.abs(expected).max()


@pytest.mark.parametrize("one_sided", [True, False])
def test_derivatives_by_errors_of_runs_are_those_of_whole_simulations(late, tmp_path, one_sided):
    """Of speed, wander and road, which one simulation of several individuals takes together: over a rough road and over a hump.

    Differences are over moves of about a wheel's way in one step, as fits make them: over less, a measured road's are noise.
    """
    hump = load_trials(write_run(tmp_path, "hump", sedan_truth()))[0]
    whole, _ = misfit_of(hump, Nuisances())
    error = np.concatenate([np.zeros(whole.n_parameters), np.full(whole.n_unknowns - whole.n_parameters, 0.3)])
    for misfit, x in (late, (whole, error)):
        found = linearise(misfit, x, one_sided=one_sided)
        items = misfit.errors[0].items
        own = {item.name for item in misfit.errors[0].own}
        assert {name for name, *_ in found.slopes[0]} == (own - {"clock"}) | {"axle_position"}
        columns = misfit.columns(0)[-len(items) :]
        for item, column in zip(items, columns, strict=True):
            if not item.moves_vehicle:
                continue
            size = MOVES.get(item.name, 1e-5)
            step = size * np.eye(len(x))[column]
            expected = (misfit.whitened_spectrum(x + step)[0] - misfit.whitened_spectrum(x - step)[0]) / (2 * size)
            assert np.linalg.norm(found.spectra[0][column] - expected) < 2e-2 * np.linalg.norm(expected), item.name


@pytest.mark.parametrize("one_sided", [True, False])
def test_derivatives_by_a_length_between_axles_are_those_of_moves_of_a_step(tmp_path, one_sided):
    """As those by where an axle stands: a searched wheelbase moves the rear wheel along the same road."""
    text = bundled_models()["sedan2"].read_text(encoding="utf-8")
    (tmp_path / "long.yaml").write_text(text.replace("{value: 2.8 m,", "{value: 2.8 m, range: [2.7 m, 2.9 m],"), encoding="utf-8")
    road = rough_road()
    run = write_rough_run(tmp_path, fine_channels(road, 12.0)[::FINE], 12.0, road)
    problem = make_problem(load_trials(run, tmp_path / "long.yaml"), ("wheelbase", "kf"))
    trial = problem.trials[0]
    assert problem.lengths_between_axles(trial) == (0,)
    misfit = Misfit(problem, {trial.name: Noise(EVEN, SIGMA)}, problem.space.start, Nuisances(), (0.5, 40.0))
    x = np.concatenate([problem.space.unit(problem.space.start), np.full(misfit.n_errors, 0.3)])
    found = linearise(misfit, x, one_sided=one_sided).spectra[0]
    for place, size in enumerate((12.0 * trial.scenario.dt / 0.2, 1e-5)):
        step = size * np.eye(len(x))[place]
        expected = (misfit.whitened_spectrum(x + step)[0] - misfit.whitened_spectrum(x - step)[0]) / (2 * size)
        assert np.linalg.norm(found[place] - expected) < 2e-2 * np.linalg.norm(expected)


@pytest.mark.parametrize("one_sided", [True, False])
def test_a_speed_off_in_all_runs_changes_what_each_runs_own_does(late, one_sided):
    """Else one would seem to tell them apart, and fits ran off along what is the same."""
    known, x = late
    shared = (SpeedScale("all", 0.01, 1.0),)
    misfit = Misfit(known.problem, known.noises, known.problem.space.start, known.nuisances, known.band, shared)
    n = misfit.n_parameters
    at = np.concatenate([x[:n], [0.0], x[n:]])
    place, speed = next((i, item) for i, item in enumerate(misfit.errors[0].own) if item.name == "speed")
    column = misfit.own_columns(0).start + place
    at[column] = 0.0
    spectra = linearise(misfit, at, one_sided=one_sided).spectra[0]
    own = spectra[column] / speed.sigma
    assert np.linalg.norm(spectra[n] / 0.01 - own) < 1e-4 * np.linalg.norm(own)
    derive, moved = Lineariser(misfit, 5), at.copy()
    derive(at)
    moved[:n] -= 0.1
    moved[column] = 0.3
    spectra = derive(moved).spectra[0]  # derivatives that serve again are of one point, too
    own = spectra[column] / speed.sigma
    assert np.linalg.norm(spectra[n] / 0.01 - own) < 1e-4 * np.linalg.norm(own)


ADJUSTMENTS = {
    "speed": SpeedScale("all", 0.01, 1.0),
    "clock": ClockRate("all", 0.01, 1.0),
    "footprint": Footprint("all", 0.02, 0.1),
    "gain": Gain("F_az", 0.05, 1.0),
    "delay": SensorDelay("R", 0.005),
    "tilt": Tilt("F", 0.02),
    "level": RunLevel("all", 0.05, 1.0, run="hump"),
    "filter": RecorderFilter("all", 0.1, np.log(20.0), runs=("hump",), channels=("F_az",)),
}


@pytest.mark.parametrize("name", ADJUSTMENTS)
def test_derivatives_by_adjustments_are_those_of_the_whole_misfit(tmp_path, name):
    shared = (ADJUSTMENTS[name], *([Adjustment("F", 0.1)] if name == "tilt" else []))
    trial = load_trials(write_run(tmp_path, "hump", sedan_truth()))[0]
    problem = make_problem([trial], ("kf",))
    misfit = Misfit(problem, {trial.name: Noise(EVEN, SIGMA)}, problem.space.start, Nuisances(), (0.5, 40.0), shared)
    x = np.concatenate([problem.space.unit(problem.space.start), np.zeros(len(shared)), np.full(misfit.n_errors, 0.3)])
    step = 1e-3 * np.eye(len(x))[1]
    expected = (misfit.whitened_spectrum(x + step)[0] - misfit.whitened_spectrum(x - step)[0]) / 2e-3
    assert np.linalg.norm(expected) > 0.1
    assert np.linalg.norm(linearise(misfit, x).spectra[0][1] - expected) < 1e-2 * np.linalg.norm(expected)


def test_a_measured_force_changes_nothing_of_what_the_road_does(tmp_path):
    """Its gain, and what it is late, are errors of each run, by which it is another one in every drive nearby."""
    time, road = np.arange(0.0, 9.0, 0.01), rough_road()
    np.savetxt(tmp_path / "f.csv", np.column_stack([time, 300 * np.sin(6 * np.pi * time)]), delimiter=",", header="t,force", comments="")
    force = "forces:\n  shaker: {body: body, file: f.csv, unit: N}\n"
    misfit, x = misfit_of(read_run(tmp_path, fine_channels(road, 12.0)[::FINE], 12.0, road, extra=force), Nuisances())
    x[misfit.n_parameters :] = 0.3
    found = linearise(misfit, x).spectra[0]
    conditions = misfit.conditions(x)
    assert {"force_gain", "speed", "delay", "axle_position", "odometer"} <= {item.name for item in conditions}
    for column, item in enumerate(conditions, start=misfit.n_parameters):
        if item.name in MOVES or item.name.startswith("force"):
            size = MOVES.get(item.name, 1e-3)
            step = size * np.eye(len(x))[column]
            expected = (misfit.whitened_spectrum(x + step)[0] - misfit.whitened_spectrum(x - step)[0]) / (2 * size)
            assert np.linalg.norm(found[column] - expected) < 2e-2 * np.linalg.norm(expected), item.name


def test_derivatives_by_errors_of_runs_are_taken_anew_when_asked(late):
    misfit, x = late
    derive = Lineariser(misfit, 5)
    first = derive(x)
    moved = x + 0.2
    kept, anew = derive(moved), derive.linearise_anew(moved)
    own = misfit.own_columns(0).start
    assert kept.slopes[0] is first.slopes[0]
    assert all(not np.array_equal(anew.slopes[0][item], own) for item, own in first.slopes[0].items())
    assert anew.spectra[0][own] == pytest.approx(linearise(misfit, moved, one_sided=True).spectra[0][own])


def test_derivatives_that_follow_from_a_step_foretell_it_and_are_computed_after_so_many(late, monkeypatch):
    misfit, x = late
    computed = []
    monkeypatch.setattr(module, "linearise", lambda *known, **how: computed.append(1) or linearise(*known, **how))
    derive = Lineariser(misfit, 5, secants=2)
    lines = misfit.whitened_spectrum(x)
    derive(x, lines)
    points = [x + 0.01 * np.random.default_rng(number).normal(size=len(x)) for number in range(3)]
    at, before = x, lines
    for number, point in enumerate(points):
        after = misfit.whitened_spectrum(point)
        found = derive(point, after)
        assert len(computed) == (1 if number < 2 else 2)
        if number < 2:
            step = point - at
            np.testing.assert_allclose(np.tensordot(step, found.spectra[0], axes=1), after[0] - before[0], rtol=1e-9, atol=1e-9)
        at, before = point, after
    anew = derive.linearise_anew(points[0], misfit.whitened_spectrum(points[0]))
    assert len(computed) == 3
    np.testing.assert_allclose(anew.spectra[0], linearise(misfit, points[0], one_sided=True).spectra[0])


def test_derivatives_that_foretold_little_of_a_step_are_computed_anew(late):
    misfit, x = late
    own = misfit.own_columns(0).start
    derive, lines = Lineariser(misfit, 5, secants=2), misfit.whitened_spectrum(x)
    derive(x, lines)
    far = x.copy()
    far[own] += 8.0
    after = misfit.whitened_spectrum(far)
    told = np.linalg.norm(after[0] - lines[0] - 8.0 * linearise(misfit, x, one_sided=True).spectra[0][own])
    assert told > MOST_MISSED * np.linalg.norm(after[0] - lines[0])
    readings = own - sum(item.moves_vehicle for item in misfit.common)
    np.testing.assert_allclose(derive(far, after).spectra[0][:readings], linearise(misfit, far, one_sided=True).spectra[0][:readings])


def test_a_step_says_nothing_of_directions_that_it_does_not_take(late):
    misfit, x = late
    first = linearise(misfit, x)
    weights = (np.abs(first.spectra[0]) ** 2).sum(axis=(1, 2))
    step, other = np.zeros(len(x)), np.zeros(len(x))
    step[0], other[1] = 0.01, 1.0
    assert weights[0] > 0
    found = first.moved(step, misfit.whitened_spectrum(x), misfit.whitened_spectrum(x + step))
    np.testing.assert_array_equal(np.tensordot(other, found.spectra[0], axes=1), np.tensordot(other, first.spectra[0], axes=1))


def test_a_hump_may_be_worn_more_than_it_may_be_sharpened(tmp_path):
    misfit, x = misfit_of(load_trials([write_run(tmp_path, "hump", sedan_truth(), 2.5)])[0], Nuisances())
    low, high = error_bounds(misfit)
    wear = np.array([item.name == "wear" for item in misfit.conditions(x)])
    assert wear.any()
    assert set(low[wear]) == {-MOST_SHARPENED}
    assert set(low[~wear]) == {-MOST_SIGMAS}
    assert set(high) == {MOST_SIGMAS}
