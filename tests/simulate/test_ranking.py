"""Populations of a search: as `run` has them, in single precision where that is safe and bit by bit in double elsewhere."""

from dataclasses import replace

import numpy as np
import pytest

from vehgen.measure.acquisition import AcquisitionChain
from vehgen.mechanics import Place
from vehgen.mechanics.outputs import ElementOutput, PointOutput
from vehgen.road import ConstantSpeed, Hump, MeasuredProfile, Track
from vehgen.simulate import Scenario, Simulator
from vehgen.simulate.ranking import rank_population
from vehgen.vehicle import parse_vehicle

OUTPUTS = [PointOutput(kind, Place("S", "body"), kind) for kind in ("acceleration", "pitch_rate")]
TRACK = Track((Hump.from_shape("half_sine", 2.0, 0.5, 0.03),))
PLAIN = Scenario(TRACK, ConstantSpeed(3.0), 3.0, 1e-3, 10)
IDEAL = AcquisitionChain("ideal", cut_off=46.0)


@pytest.fixture(scope="module")
def sedan():
    return Simulator("sedan2", OUTPUTS)


def population(simulator, n=40):
    factors = np.random.default_rng(4).uniform(0.9, 1.1, (n, 3))
    return simulator.parameters([{"kf": 62.5e3 * a, "cr": 4455.0 * b, "ktf": 673e3 * c} for a, b, c in factors])


class Peaks:
    """Peaks of all channels; remembers the precision of what it was given."""

    def __init__(self):
        self.numbers = set()

    def __call__(self, responses):
        self.numbers.add(responses.dtype.type)
        return np.abs(responses).max(axis=1)


def ranked(simulator, parameters, scenario):
    peaks = Peaks()
    found, failed = rank_population(simulator, parameters, scenario, peaks)
    return found, failed, peaks.numbers


@pytest.mark.parametrize("chain", [None, AcquisitionChain("butterworth", 4, 45.0), IDEAL])
@pytest.mark.parametrize("skipped", [0, 30])
def test_alike_recorders_are_simulated_in_single_precision(sedan, chain, skipped):
    chains = {} if chain is None else {output.name: chain for output in OUTPUTS}
    scenario = replace(PLAIN, chains=chains, skipped=skipped)
    parameters = population(sedan)
    found, failed, numbers = ranked(sedan, parameters, scenario)
    expected = Peaks()(sedan.run(parameters, scenario).responses)
    assert numbers == {np.float32}
    assert not failed.any()
    assert found.dtype == np.float64
    np.testing.assert_allclose(found, expected, rtol=2e-5)
    assert (found != expected).any()


def test_who_fails_is_told_and_the_others_are_as_they_were(sedan):
    parameters = population(sedan)
    expected = ranked(sedan, parameters, PLAIN)[0]
    parameters[[3, 35], 0] = np.nan
    found, failed, _ = ranked(sedan, parameters, PLAIN)
    assert np.flatnonzero(failed).tolist() == [3, 35]
    np.testing.assert_array_equal(found[~failed], expected[~failed])


def test_layouts_of_many_share_their_inputs_and_keep_their_places(sedan):
    parameters = population(sedan)
    parameters[::2, sedan.model.parameters.index("wheelbase")] += 0.3
    found, _, numbers = ranked(sedan, parameters, PLAIN)
    assert numbers == {np.float32}
    np.testing.assert_allclose(found, Peaks()(sedan.run(parameters, PLAIN).responses), rtol=2e-5)


def hill(height):
    distance = np.linspace(0, 20, 201)
    return Track((MeasuredProfile(distance, height * (1 - np.cos(np.pi * distance / 20)) / 2), *TRACK.parts))


@pytest.mark.parametrize(
    "change",
    [
        {"chains": {"acceleration": IDEAL}},
        {"initial": np.full(8, 1e-3)},
        {"track": hill(5.0)},
    ],
    ids=["recorders that differ", "a given initial state", "a hill"],
)
def test_what_is_not_safe_stays_double(sedan, change):
    scenario = replace(PLAIN, **change)
    parameters = population(sedan)
    found, _, numbers = ranked(sedan, parameters, scenario)
    assert numbers == {np.float64}
    np.testing.assert_array_equal(found, Peaks()(sedan.run(parameters, scenario).responses))


def test_a_low_hill_is_no_hill(sedan):
    assert ranked(sedan, population(sedan), replace(PLAIN, track=hill(0.4)))[2] == {np.float32}


def test_few_individuals_a_layout_stay_double(sedan):
    parameters = population(sedan)
    parameters[:, sedan.model.parameters.index("wheelbase")] += np.linspace(0, 0.3, 40)
    assert ranked(sedan, parameters, PLAIN)[2] == {np.float64}


@pytest.mark.parametrize("kind", ["a force law", "a whole load"])
def test_laws_and_loads_stay_double(kind):
    laws = "{laws: [{dry_friction: {force: 300 N}}]}" if kind == "a force law" else "{}"
    vehicle = parse_vehicle(f"extends: sedan2\naxles: {{rear: {{suspension: {laws}}}}}\n")
    outputs = [*OUTPUTS, ElementOutput("load", "rear", "tyre_load")] if kind == "a whole load" else OUTPUTS
    simulator = Simulator(vehicle, outputs)
    parameters = population(simulator)
    found, _, numbers = ranked(simulator, parameters, PLAIN)
    assert numbers == {np.float64}
    np.testing.assert_array_equal(found, Peaks()(simulator.run(parameters, PLAIN).responses))
