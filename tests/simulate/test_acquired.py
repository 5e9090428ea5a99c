"""Simulated channels pass the chain of acquisition as a recorder's channels do: against scipy's filters on finely sampled responses."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.signal

from vehgen.measure.acquisition import UNKNOWN, AcquisitionChain
from vehgen.mechanics import Place
from vehgen.mechanics.outputs import ElementOutput, PointOutput
from vehgen.road import ConstantSpeed, Hump, Iso8608Road, Track
from vehgen.simulate import Scenario, Simulator
from vehgen.simulate.acquired import acquire, channel_factors

CHAIN = AcquisitionChain("butterworth", 4, 45.0)
IDEAL = AcquisitionChain("ideal", cut_off=46.0)
OUTPUTS = (
    PointOutput("az", Place("S", "tractor", behind="axle1"), "acceleration"),
    PointOutput("q", Place("S", "tractor", behind="axle1"), "pitch_rate"),
    ElementOutput("force", "axle1", "tyre_force"),
)


@pytest.fixture(scope="module")
def simulator():
    return Simulator("tractor5", OUTPUTS)


def over_a_hump(**changes):
    track = Track((Hump.from_shape("half_sine", 2.0, 0.5, 0.03),))
    return replace(Scenario(track, ConstantSpeed(4.0), 6.0, 1e-3, 10), **changes)


def on_a_road(**changes):
    return over_a_hump(track=Track((Iso8608Road("C", 1, 60.0),)), speed=ConstantSpeed(8.0), **changes)


def by_scipy(simulator, parameters, scenario, kind):
    """Return the samples of the response at every quarter of a step, filtered by scipy at that rate."""
    fine = replace(scenario, dt=scenario.dt / 4, decimation=1, duration=scenario.duration + 1.0, chains={})
    response = simulator.run(parameters, fine).responses
    rate = 1 / fine.dt
    if kind == "butterworth":
        filtered = scipy.signal.sosfilt(scipy.signal.butter(4, 45.0, fs=rate, output="sos"), response, axis=1)
    else:
        count, beta = scipy.signal.kaiserord(60.0, 0.08 * 46.0 * 2 / rate)
        taps = scipy.signal.firwin(count | 1, 46.0, window=("kaiser", beta), fs=rate)
        filtered = scipy.signal.oaconvolve(response, taps[None, :, None], axes=1)[:, len(taps) // 2 :]
    step = 4 * scenario.decimation
    return filtered[:, : round(scenario.duration / scenario.dt) * 4 + 1 : step]


@pytest.mark.parametrize("run", [over_a_hump, on_a_road])
@pytest.mark.parametrize(("kind", "chain"), [("butterworth", CHAIN), ("ideal", IDEAL)])
def test_channels_are_those_of_scipys_filter_at_a_finer_step(simulator, run, kind, chain):
    parameters = simulator.parameters([{}, {"k1": 1.5e6}])
    scenario = run(chains={output.name: chain for output in OUTPUTS})
    found = simulator.run(parameters, scenario).responses
    expected = by_scipy(simulator, parameters, scenario, kind)
    plain = simulator.run(parameters, run()).responses
    size = abs(expected).max(axis=(0, 1))
    assert (abs(found - expected).max(axis=(0, 1)) < 0.01 * size).all()
    if kind == "butterworth":
        assert (abs(plain - expected).max(axis=(0, 1)) > 0.05 * size)[0]


@pytest.mark.parametrize("run", [over_a_hump, on_a_road])
@pytest.mark.parametrize("chain", [CHAIN, IDEAL, AcquisitionChain("none", delay=0.0132)])
def test_filtering_the_excitation_is_filtering_the_channels(simulator, run, chain):
    parameters = simulator.parameters()
    alike = run(chains={output.name: chain for output in OUTPUTS})
    mixed = run(chains={"az": chain, "q": chain})
    together, apart = (simulator.run(parameters, item).responses[0] for item in (alike, mixed))
    np.testing.assert_allclose(apart[:, :2], together[:, :2], atol=2e-3 * abs(together[:, :2]).max())
    np.testing.assert_array_equal(apart[:, 2], simulator.run(parameters, run()).responses[0][:, 2])


def test_no_chain_and_point_samples_change_nothing(simulator):
    parameters, plain = simulator.parameters(), over_a_hump()
    expected = simulator.kernel.run(parameters, plain.excitation(simulator.wheel_offsets(parameters)[0]), plain.decimation).responses
    for chains in ({}, {"az": AcquisitionChain()}):
        np.testing.assert_array_equal(simulator.run(parameters, replace(plain, chains=chains)).responses, expected)


def test_half_the_step_keeps_the_filtered_channels(simulator):
    scenario = over_a_hump(chains={output.name: CHAIN for output in OUTPUTS})
    parameters = simulator.parameters()
    coarse = simulator.run(parameters, scenario).responses
    fine = simulator.run(parameters, replace(scenario, dt=scenario.dt / 2, decimation=20)).responses
    assert (abs(coarse - fine).max(axis=(0, 1)) < 0.01 * abs(fine).max(axis=(0, 1))).all()


def test_a_delay_moves_channels_by_whole_samples(simulator):
    parameters = simulator.parameters()
    late = simulator.run(parameters, over_a_hump(chains={"az": AcquisitionChain("none", delay=0.02)})).responses[0, :, 0]
    plain = simulator.run(parameters, over_a_hump()).responses[0, :, 0]
    np.testing.assert_allclose(late[2:], plain[:-2], atol=1e-3 * abs(plain).max())


def test_a_failed_individual_leaves_the_others_as_they_are(simulator):
    parameters = simulator.parameters([{}, {}])
    parameters[1, 0] = np.nan
    scenario = over_a_hump(chains={"az": CHAIN})
    result = acquire(simulator.kernel, parameters, scenario, simulator.wheel_offsets(parameters[:1])[0])
    assert list(result.failures) == [1]
    np.testing.assert_array_equal(result.responses[0], simulator.run(parameters[:1], scenario).responses[0])


def test_factors_of_spectral_lines_are_the_chains_responses():
    frequency = np.array([1.0, 30.0, 45.0])
    found = channel_factors(over_a_hump(chains={"az": CHAIN}), ("az", "q"), frequency)
    np.testing.assert_allclose(found[:, 0], CHAIN.response(frequency))
    np.testing.assert_array_equal(found[:, 1], 1.0)
    unknown = channel_factors(over_a_hump(chains={"az": UNKNOWN}), ("az",), np.array([44.0, 48.0, 50.5]))[:, 0]
    assert unknown == pytest.approx([1.0, 0.5, 0.0], abs=2e-3)  # what is kept every 10 ms holds nothing from 50 Hz on
