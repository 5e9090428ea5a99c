"""Kernels in single precision against textbook Newmark, kernels in double, and scipy's exact response: within 1e-4 of the peak."""

import numpy as np
import pytest
import scipy.signal

from tests.oracles.layouts import random_layout, to_yaml
from vehgen.codegen import Excitation, Kernel, write_kernel
from vehgen.codegen.population_run import BLOCK_SIZE
from vehgen.mechanics import Place, PointOutput, derive
from vehgen.simulate import newmark_response
from vehgen.vehicle import load_vehicle, parse_vehicle

DT = 1e-3


def sensed(vehicle):
    """Return a model with what a phone on each body measures."""
    outputs = [PointOutput(f"{name}.a", Place(name, name), "acceleration") for name in vehicle.bodies]
    turning = [name for name, body in vehicle.bodies.items() if body.motions is None or "pitch" in body.motions]
    return derive(vehicle, [*outputs, *(PointOutput(f"{name}.q", Place(name, name), "pitch_rate") for name in turning)])


def humps(n_inputs, steps):
    """Return half-sine humps of 3 cm under one input after the other, with their exact rates."""
    time = np.arange(steps + 1) * DT
    phase = (time[:, None] - 0.1 - 0.15 * np.arange(n_inputs)) / 0.2
    on = (phase >= 0) & (phase <= 1)
    rates = np.where(on, 0.03 * np.pi / 0.2 * np.cos(np.pi * phase), 0.0)
    return Excitation(DT, np.where(on, 0.03 * np.sin(np.pi * phase), 0.0), rates, np.zeros((steps + 1, 0)))


def error_over_peak(found, expected):
    """Return the largest error of each channel over its largest value."""
    return np.abs(found - expected).max(axis=-2) / np.abs(expected).max(axis=-2)


@pytest.mark.thorough
@pytest.mark.parametrize("name", ["quarter_car", "sedan2", "tractor5", "tractor5_cab", "b_double", "vbi2d_2A3"])
def test_bundled_vehicles_err_by_less_than_1e_4_of_the_peak(name):
    model = sensed(load_vehicle(name))
    excitation = humps(len(model.inputs), 4000)
    kernel = Kernel(model, precision="single")
    assert kernel.source.from_rest
    parameters = np.repeat([list(model.values().values())], BLOCK_SIZE + 3, axis=0)
    found = kernel.run(parameters, excitation, 10)
    assert not found.failures
    textbook = newmark_response(model, excitation, 10)
    double = Kernel(model).run(parameters[:1], excitation, 10).responses[0]
    for individual in (0, BLOCK_SIZE, BLOCK_SIZE + 2):
        assert error_over_peak(found.responses[individual], textbook).max() < 1e-4
        assert 0 < error_over_peak(found.responses[individual], double).max() < 1e-4


@pytest.mark.parametrize("seed", [0, 1, *(pytest.param(seed, marks=pytest.mark.thorough) for seed in range(2, 8))])
def test_random_layouts_err_by_less_than_1e_4_of_the_peak(seed):
    vehicle = parse_vehicle(to_yaml(random_layout(np.random.default_rng(seed))))
    model = sensed(vehicle)
    excitation = humps(len(model.inputs), 1500)
    found = Kernel(model, precision="single").run([list(model.values().values())], excitation, 5).responses[0]
    expected = newmark_response(model, excitation, 5)
    moving = np.abs(expected).max(axis=0) > 1e-9 * np.abs(expected).max()
    assert error_over_peak(found, expected)[moving].max() < 1e-4


def test_scipys_response_is_met_as_well_as_by_double_precision():
    """Two masses over each other, written down here; steps of 0.1 ms, where the rule itself errs by 1e-5."""
    m, mt, k, c, kt = 1000.0, 100.0, 4e4, 3e3, 5e5
    text = f"axles: {{a: {{body: b, x: 0 m, mass: {mt} kg, suspension: {{k: {k} N/m, c: {c} N s/m}}, tyre: {{k: {kt} N/m}}}}}}"
    vehicle = parse_vehicle(f"bodies: {{b: {{mass: {m} kg, motions: [heave]}}}}\n{text}")
    model = derive(vehicle, [PointOutput("a", Place("s", "b"), "acceleration")])
    time = np.arange(20_001) * 1e-4
    w = 0.01 * (1 - np.cos(2 * np.pi * 2 * time))
    rates = 0.01 * 2 * np.pi * 2 * np.sin(2 * np.pi * 2 * time)
    excitation = Excitation(1e-4, w[:, None], rates[:, None], np.zeros((len(time), 0)))
    below = [[0, 0, 1, 0], [0, 0, 0, 1], [-k / m, k / m, -c / m, c / m], [k / mt, -(k + kt) / mt, c / mt, -c / mt]]
    _, expected, _ = scipy.signal.lsim((below, [[0], [0], [0], [kt / mt]], [below[2]], [[0]]), w, time)
    found = Kernel(model, precision="single").run([list(model.values().values())], excitation, 10).responses[0]
    assert error_over_peak(found, expected[::10].reshape(-1, 1)).max() < 1e-4


def test_a_reduction_gets_the_numbers_of_the_kernel_and_run_gives_double():
    model = sensed(load_vehicle("sedan2"))
    excitation, seen = humps(2, 500), set()
    parameters = np.repeat([list(model.values().values())], 70, axis=0)
    parameters[:, 0] *= np.linspace(0.9, 1.1, 70)
    parameters[40, 0] = np.nan

    def peak(responses):
        seen.add((responses.dtype.type, len(responses)))
        return np.abs(responses).max(axis=(1, 2))

    kernel = Kernel(model, precision="single")
    peaks, failures = kernel.reduce(parameters, excitation, peak, threads=2)
    whole = kernel.run(parameters, excitation)
    assert seen == {(np.float32, BLOCK_SIZE), (np.float32, 70 - 2 * BLOCK_SIZE)}
    assert whole.responses.dtype == np.float64
    np.testing.assert_array_equal(peaks, np.abs(whole.responses).max(axis=(1, 2)))
    assert list(failures) == list(whole.failures) == [40]


def test_lanes_fill_a_vector_in_either_precision_or_two_where_a_step_is_short():
    short, long = sensed(load_vehicle("sedan2")), sensed(load_vehicle("tractor5"))
    assert [write_kernel(model).lanes for model in (short, long)] == [16, 8]
    assert [write_kernel(model, precision="single").lanes for model in (short, long)] == [32, 16]
    assert write_kernel(short).text != write_kernel(short, precision="single", lanes=16).text
