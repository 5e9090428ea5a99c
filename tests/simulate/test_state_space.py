"""State space and frequency responses against what shares no code with them: scipy.signal, and the exact first-order hold."""

import json
import warnings

import numpy as np
import pytest
import scipy.signal

from vehgen.codegen import Excitation
from vehgen.errors import InputError, ModelWarning
from vehgen.mechanics import ElementOutput, Place, PointOutput, derive
from vehgen.simulate import FrequencyResponse, StateSpace, exact_response, frequency_response, natural_modes, state_space
from vehgen.vehicle import parse_vehicle

TRUCK = """
bodies: {body: {mass: 6 t, pitch_inertia: 20 t m^2}}
axles:
  front: {body: body, x: 2.1 m, mass: 400 kg, suspension: {k: 300 kN/m, c: 12 kN s/m}, tyre: {k: 1.6 MN/m, c: 3 kN s/m}}
  rear: {body: body, x: -1.7 m, mass: 700 kg, suspension: {k: 500 kN/m, c: 18 kN s/m}, tyre: {k: 3.2 MN/m}}
"""
DRIVER = Place("driver", "body", behind="front", distance=0.5)
COMFORT = (PointOutput("az", DRIVER, "acceleration"), PointOutput("q", DRIVER, "pitch_rate"))
WHEEL = ElementOutput("front_force", "front", "tyre_force")
FREQUENCY = np.array([0.5, 1.6, 4.0, 11.0, 25.0])


@pytest.fixture(scope="module")
def truck():
    return parse_vehicle(TRUCK, "truck")


@pytest.fixture(scope="module")
def drive():
    """A smooth road, so that its rate at the samples is no matter of definition."""
    t = np.arange(4001) * 1e-3
    inputs = np.column_stack(
        [0.02 * np.sin(2 * np.pi * 1.7 * t) ** 2, 0.01 * np.sin(2 * np.pi * 9.0 * t) * (t > 0.5) * (1 - np.cos(t - 0.5))]
    )
    return Excitation(1e-3, inputs, np.gradient(inputs, 1e-3, axis=0, edge_order=2), np.column_stack([400 * np.sin(3 * t)]))


def lsim(system, drive, columns):
    return scipy.signal.lsim((system.A, system.B, system.C, system.D), np.column_stack(columns), drive.time)[1]


@pytest.mark.parametrize("outputs", [COMFORT, (*COMFORT, WHEEL)])
def test_rates_of_a_damped_tyre_are_inputs_of_their_own(truck, drive, outputs):
    force = Place("engine", "body", behind="body")
    system = state_space(truck, outputs=outputs, forces=[force])
    assert system.inputs == ("road.front", "road.rear", "road.front.rate", "force.engine")  # the rear tyre has no damper
    found = lsim(system, drive, [drive.inputs, drive.rates[:, :1], drive.forces])
    exact = exact_response(derive(truck, outputs, [force]), drive)
    assert (np.abs(found - exact).max(axis=0) < 2e-3 * np.abs(exact).max(axis=0)).all()
    without = lsim(system, drive, [drive.inputs, 0 * drive.rates[:, :1], drive.forces])
    assert np.abs(without - exact)[:, 0].max() > 0.02 * np.abs(exact[:, 0]).max()  # so leaving the rates out would have been seen


def test_states_take_up_the_rates(truck, drive):
    system = state_space(truck, outputs=COMFORT, input_rates="states")
    assert system.inputs == ("road.front", "road.rear")
    still = Excitation(drive.dt, drive.inputs, drive.rates, np.zeros((len(drive.inputs), 0)))
    exact = exact_response(derive(truck, COMFORT), still)
    found = lsim(system, drive, [drive.inputs])
    assert (np.abs(found - exact).max(axis=0) < 2e-3 * np.abs(exact).max(axis=0)).all()


def test_an_output_that_feels_a_rate_cannot_lose_it(truck):
    with pytest.raises(InputError, match=r"front_force feels the rate of road.front directly.*`input_rates` must be 'inputs'"):
        state_space(truck, outputs=[WHEEL], input_rates="states")
    with pytest.raises(InputError, match="unknown choice 'state'; did you mean 'states'"):
        state_space(truck, input_rates="state")


def test_frequency_responses_are_those_of_scipy(truck):
    response = frequency_response(truck, FREQUENCY, outputs=(*COMFORT, WHEEL))
    system = state_space(truck, outputs=(*COMFORT, WHEEL))
    s = 2j * np.pi * FREQUENCY
    for i in range(3):
        numerators, denominator = scipy.signal.ss2tf(system.A, system.B, system.C[i : i + 1], system.D[i : i + 1], input=0)
        with_rate, _ = scipy.signal.ss2tf(system.A, system.B, system.C[i : i + 1], system.D[i : i + 1], input=2)
        expected = (np.polyval(numerators[0], s) + s * np.polyval(with_rate[0], s)) / np.polyval(denominator, s)
        assert response.values[:, i, 0] == pytest.approx(expected, rel=1e-6)


def test_axles_follow_each_other_over_one_road(truck):
    each = frequency_response(truck, FREQUENCY, outputs=COMFORT).values
    road = frequency_response(truck, FREQUENCY, outputs=COMFORT, speed=5.0)
    late = np.exp(-2j * np.pi * FREQUENCY * 3.8 / 5.0)
    assert road.inputs == ("road",)
    assert road.values[:, :, 0] == pytest.approx(each[:, :, 0] + late[:, None] * each[:, :, 1], rel=1e-12)
    still = frequency_response(truck, [0.01], outputs=[PointOutput("z", DRIVER, "displacement")], speed=100.0)
    assert abs(still.values[0, 0, 0]) == pytest.approx(1.0, abs=1e-3)  # over long waves it goes with the road


@pytest.mark.parametrize(
    ("law", "spring"),
    [("k: 200 kN/m, time: 10000 s", "k: 700 kN/m, c: 8 kN s/m"), ("k: 40 GN/m, time: 0.0000001 s", "k: 500 kN/m, c: 12 kN s/m")],
    ids=["a stiff one is a spring", "a quick one is a dashpot"],
)
def test_relaxation_counts_in_a_response(law, spring):
    text = "name: one\nbodies: {{b: {{mass: 4 t, motions: [heave]}}}}\n"
    text += "axles: {{a: {{body: b, mass: 400 kg, suspension: {{{}}}, tyre: {{k: 2 MN/m}}}}}}\n"
    one = parse_vehicle(text.format(f"k: 500 kN/m, c: 8 kN s/m, laws: [{{relaxation: {{{law}}}}}]"))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = frequency_response(one, FREQUENCY).values
    expected = frequency_response(parse_vehicle(text.format(spring)), FREQUENCY).values
    assert np.abs(found - expected).max() < 1e-3 * np.abs(expected).max()


def test_poles_are_the_modes(truck):
    poles = state_space(truck).poles
    radii = np.sort(np.abs(poles[poles.imag > 0])) / (2 * np.pi)
    assert radii == pytest.approx(sorted(mode.pole_hz for mode in natural_modes(truck)), rel=1e-9)


def test_parameters_by_name_and_by_set():
    by_set, own = state_space("tractor5", parameter_set="SHCM-1"), state_space("tractor5", values={"mT": 8000.0})
    assert not np.allclose(by_set.A, own.A)
    with pytest.raises(InputError, match="no parameter set 'SHCM'"):
        state_space("tractor5", parameter_set="SHCM")
    with pytest.raises(InputError, match="no parameter 'mt'"):
        frequency_response("tractor5", values={"mt": 1.0})


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"frequency": [-1.0]}, "`frequency`: a list of numbers from 0"),
        ({"frequency": "fast"}, "`frequency`: numbers in Hz"),
        ({"frequency": []}, "`frequency`"),
        ({"speed": 0.0}, "`speed`: must be above 0, found 0"),
        ({"speed": 1e6}, "`speed`: a speed is"),
    ],
)
def test_arguments_that_cannot_be_used(truck, arguments, message):
    with pytest.raises(InputError, match=message):
        frequency_response(truck, **arguments)


def test_force_laws_are_left_out_with_a_word():
    text = TRUCK.replace("c: 12 kN s/m}", "c: 12 kN s/m, laws: [{dry_friction: {force: 500 N}}]}")
    with pytest.warns(ModelWarning, match="force laws of vehicle are left out"):
        state_space(parse_vehicle(text))


def test_results_survive_json(truck):
    for result in (state_space(truck), frequency_response(truck, FREQUENCY, speed=3.0)):
        again = type(result).from_dict(json.loads(json.dumps(result.to_dict())))
        assert again == result
        assert again.plot().axes
        assert len(again.to_dataframe()) == len(again.table()[1])
    assert {StateSpace.KIND, FrequencyResponse.KIND} == {"state space", "frequency response"}
