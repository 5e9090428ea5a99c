"""What turns with a wheel: what sensors show of it, and how its radius is found."""

from dataclasses import replace

import numpy as np
import pytest
from benchmarks.hidden_effects.generator import Case, Effect, Hump, RunSpec, write_case

from vehgen.fit import wheel_orders
from vehgen.fit.adjustments import RunState
from vehgen.fit.linearisation import linearise
from vehgen.fit.misfit import Misfit
from vehgen.fit.noise import EVEN, Noise
from vehgen.fit.problem import make_problem
from vehgen.fit.trial import load_trials
from vehgen.fit.wheel_orders import ORDERS, WheelOrders, find_rolling_radii
from vehgen.road import MeasuredProfile

SIGMA = np.array([0.01, 5e-4, 0.01, 5e-4])
RADIUS = 0.31
RUNS = tuple(RunSpec((Hump(0.5, 0.03, 3.0 * speed),), speed, 7.0, f"at_{speed:g}") for speed in (3.0, 4.5))


def driven(tmp_path_factory, *effects):
    folder = tmp_path_factory.mktemp("driven")
    write_case(Case("sedan2", None, effects, RUNS, seed=5), folder, tmp_path_factory.mktemp("truth"))
    return load_trials(sorted(folder.glob("*.yaml")))


@pytest.fixture(scope="module")
def untrue(tmp_path_factory):
    """Return two runs of a sedan with an untrue rear wheel, by the independent generator."""
    return driven(tmp_path_factory, Effect("wheel_runout", "rear", {"amplitude": 0.003, "radius": RADIUS}))


@pytest.fixture(scope="module")
def sound(tmp_path_factory):
    """Return the same runs of the sedan with true wheels."""
    return driven(tmp_path_factory)


def misfit_of(trials, shared=()):
    problem = make_problem(trials)
    noises = {trial.name: Noise(EVEN, SIGMA) for trial in trials}
    misfit = Misfit(problem, noises, problem.space.start, shared=shared)
    return misfit, np.concatenate([problem.space.unit(problem.space.start), np.zeros(misfit.n_unknowns - misfit.n_parameters)])


def wheel_at(place, trials, radius=RADIUS, scale=0.001):
    return WheelOrders(place, scale, radius, 0.15, 0.9, {trial.name: SIGMA for trial in trials})


@pytest.mark.parametrize("place", ["front", "rear"])
def test_the_columns_are_what_the_kernel_answers_to_such_a_road(untrue, place):
    """A road of one turn a circumference under both axles, as the linear model answers it under one of them: by superposition."""
    trial = untrue[0]
    s = np.arange(-5.0, 40.0, 0.002)
    heights = 0.002 * np.cos(2 * s / RADIUS)
    track = replace(trial.scenario.track, parts=(MeasuredProfile(s, heights),))
    scenario = replace(trial.scenario, track=track)
    alone = np.asarray(trial.simulator.run(trial.simulator.parameters(trial.values), scenario).responses)[0]
    state, number = RunState(scenario), np.array([RADIUS])
    behind = dict(zip(("front", "rear"), trial.simulator.model.wheel_offsets(trial.values), strict=True))
    both = np.zeros_like(alone)
    for axle, way in behind.items():
        columns = wheel_at(axle, untrue).columns(trial, number, trial.values, state)[2:4]
        both += 0.002 * (np.cos(2 * way / RADIUS) * columns[0] - np.sin(2 * way / RADIUS) * columns[1])
    late = slice(len(alone) // 2, None)  # what began the run has died away
    assert np.abs(both[late] - alone[late]).max() < 0.02 * np.abs(alone[late]).max()
    assert ORDERS[1] == 2


def test_the_radius_is_found_and_the_wheel_taken_out(untrue, sound):
    """What is left is what is left of a sound car: that its parameters are not quite those of its file."""
    plain, x = misfit_of(untrue)
    assert find_rolling_radii(plain, x, 0.15, 0.9)[0] == pytest.approx(RADIUS, rel=0.005)
    turned, healthy = misfit_of(untrue, [wheel_at("rear", untrue)]), misfit_of(sound)
    before, after, least = (np.mean(one.residuals(at) ** 2) for one, at in ((plain, x), turned, healthy))
    assert before > 10 * least
    assert after < 1.1 * least


def test_a_radius_is_looked_for_in_parts_that_memory_holds(untrue, monkeypatch):
    plain, x = misfit_of(untrue)
    whole = find_rolling_radii(plain, x, 0.15, 0.9)
    monkeypatch.setattr(wheel_orders, "NUMBERS_AT_ONCE", 50_000)
    assert find_rolling_radii(plain, x, 0.15, 0.9) == whole


def test_another_axle_or_radius_explains_less(untrue):
    left = [
        np.mean(np.square(misfit.residuals(x)))
        for misfit, x in (misfit_of(untrue, [wheel_at(*one)]) for one in (("rear", untrue), ("front", untrue), ("rear", untrue, 0.33)))
    ]
    assert left[1] > 2 * left[0]
    assert left[2] > 5 * left[0]


def test_a_wheel_turns_as_fast_as_the_fit_supposes_the_run_to_be(untrue):
    """Else an error of the speed, which turns a wheel by several radians in a run, would be taken for one of the radius."""
    trial = untrue[0]
    faster = trial.scenario.adjusted(speed=1.02, anchor=trial.scenario.first_arrival)
    wheel = wheel_at("rear", untrue)
    here = wheel.columns(trial, np.array([RADIUS]), trial.values, RunState(faster))
    there = wheel.columns(trial, np.array([RADIUS / 1.02]), trial.values, RunState(trial.scenario))
    spans = [np.linalg.qr(part[:2].reshape(2, -1).T)[0] for part in (here, there)]  # but for where the turn begins
    assert np.linalg.svd(spans[0].T @ spans[1])[1].min() > 0.9999


def test_a_misfit_tells_a_wheel_how_fast_its_run_was(untrue, monkeypatch):
    misfit, x = misfit_of(untrue, [wheel_at("rear", untrue)])
    speed = x[: misfit.n_unknowns - misfit.n_errors].size + misfit.error_position(0, "speed")
    x[speed] = 1.0
    first, seen, columns = untrue[0], [], WheelOrders.columns
    monkeypatch.setattr(WheelOrders, "columns", lambda self, *known: seen.append(known[-1]) or columns(self, *known))
    misfit.motions(x)
    (sigma,) = {item.sigma for item in misfit.conditions(x) if item.name == "speed" and item.run == first.name}
    spans = [np.ptp(scenario.speed.distance(first.recording.time)) for scenario in (seen[0].scenario, first.scenario)]
    assert spans[0] / spans[1] == pytest.approx(1 + sigma)
    assert [len(state.vehicles) for state in seen] == [1, 1]


def test_derivatives_by_the_speed_hold_what_it_does_to_the_wheel(untrue):
    misfit, x = misfit_of(untrue, [wheel_at("rear", untrue)])
    speed, step = misfit.n_unknowns - misfit.n_errors + misfit.error_position(0, "speed"), 1e-3
    (block, *_), columns = linearise(misfit, x).spectra, list(misfit.columns(0))
    there, back = (misfit.whitened_spectrum(x + sign * step * np.eye(len(x))[speed])[0] for sign in (1, -1))
    np.testing.assert_allclose(
        block[columns.index(speed)], (there - back) / (2 * step), atol=0.02 * np.abs(there - back).max() / (2 * step)
    )
    still, y = misfit_of(untrue)
    other = linearise(still, y).spectra[0][list(still.columns(0)).index(speed - 1)]
    assert np.abs(block[columns.index(speed)] - other).max() > 0.2 * np.abs(other).max()


def test_the_vehicles_of_a_population_are_shaken_each_as_it_is(untrue):
    trial, wheel = untrue[0], wheel_at("rear", untrue)
    softer = {**trial.values, "kr": 0.5 * trial.values["kr"]}
    still = np.zeros((1, *trial.recording.values.shape))

    def answer(*vehicles):
        return wheel.response(
            trial, np.repeat(still, len(vehicles), axis=0), np.array([RADIUS]), RunState(trial.scenario, vehicles=vehicles)
        )

    together = answer(trial.values, softer)
    np.testing.assert_array_equal(together[0], answer(trial.values)[0])
    np.testing.assert_array_equal(together[1], answer(softer)[0])
    assert np.abs(together[0] - together[1]).max() > 1e-6


def test_a_run_whose_noise_is_not_known_is_left_alone(untrue):
    still = np.zeros((1, *untrue[0].recording.values.shape))
    assert WheelOrders("rear").response(untrue[0], still, np.array([RADIUS])) is still
