"""A trial's frequency responses pass the same chain as its simulated channels."""

from dataclasses import replace

import numpy as np
import pytest

from tests.fit.test_harmonic import CHANNELS, FORCE, RUN, SIGMA, record, trial_of
from vehgen.fit.adjustments import RunState
from vehgen.fit.harmonic import Harmonic
from vehgen.fit.road_answer import road_answer
from vehgen.fit.trial import load_trials
from vehgen.fit.wheel_orders import WheelOrders
from vehgen.measure.acquisition import AcquisitionChain

CHAIN = AcquisitionChain("butterworth", 4, 30.0, 0.003)
DECLARED = "acquisition: {filter: butterworth, order: 4, cut_off: 30 Hz, delay: 3 ms}\n"


@pytest.fixture(scope="module")
def trial(tmp_path_factory):
    folder = tmp_path_factory.mktemp("filtered")
    (plain,) = trial_of(folder, record(folder, RUN) + np.random.default_rng(0).standard_normal((601, 4)) * SIGMA)
    text = (folder / "run.yaml").read_text(encoding="utf-8")
    (folder / "filtered.yaml").write_text(text + DECLARED, encoding="utf-8")
    (filtered,) = load_trials([folder / "filtered.yaml"])
    return plain, filtered


def test_a_run_files_chain_reaches_the_trial(trial):
    plain, filtered = trial
    assert {filtered.scenario.chain(name) for name in CHANNELS} == {CHAIN}
    assert not any(plain.scenario.chain(name).is_known for name in CHANNELS)
    frequency = np.array([5.0, 21.0])
    np.testing.assert_allclose(filtered.channel_factors(frequency), np.repeat(CHAIN.response(frequency)[:, None], 4, axis=1))


def test_the_columns_of_a_line_are_what_filtered_channels_show_of_a_harmonic_force(trial, tmp_path):
    _, filtered = trial
    shaken = record(tmp_path, RUN + FORCE + DECLARED, road=False)
    line, state = Harmonic("body", sigma={filtered.name: SIGMA}), RunState(filtered.scenario)
    columns = line.columns(filtered, np.array([21.0, 0.0]), filtered.values, state)
    late = slice(300, 560)  # the start-up has died away
    coefficients = np.linalg.lstsq((columns[:2, late] / SIGMA).reshape(2, -1).T, (shaken[late] / SIGMA).ravel(), rcond=None)[0]
    np.testing.assert_allclose(coefficients, [0.0, -300.0], atol=6.0)


def test_what_turns_with_a_wheel_comes_as_late_and_as_weak_as_a_recorder_has_it(trial):
    """At 2 m/s a wheel of 30 mm turns 10.6 times a second: its third order lies just above the cut-off."""
    plain, filtered = trial
    known = np.array([0.03]), plain.values, RunState(plain.scenario)
    wheel = WheelOrders("rear")
    bare, seen = (wheel.columns(item, *known) for item in (plain, filtered))
    for order in (1, 3):
        first = 2 * (order - 1)
        turning = [columns[first] - 1j * columns[first + 1] for columns in (bare, seen)]
        ratio = CHAIN.response(np.array([order * 2.0 / (2 * np.pi * 0.03)]))[0]
        np.testing.assert_allclose(turning[1], ratio * turning[0], atol=2e-3 * np.abs(turning[0]).max())


def test_the_roads_way_into_the_channels_is_filtered(trial):
    plain, filtered = trial
    frequency = np.array([10.0, 25.0, 35.0])
    bare = replace(plain, scenario=replace(plain.scenario, chains={}))
    gains = [road_answer(item, frequency, item.values).gain for item in (bare, filtered)]
    powers = [(np.abs(gain) ** 2).sum(axis=2) for gain in gains]
    np.testing.assert_allclose(powers[1], powers[0] * np.abs(CHAIN.response(frequency))[:, None] ** 2, rtol=0.02)
