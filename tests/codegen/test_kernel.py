"""The generated kernel against textbook Newmark and the exact first-order-hold solution."""

import subprocess
import sys
import tracemalloc

import numpy as np
import pytest

from vehgen.codegen import Excitation, Kernel, compile_all, write_kernel
from vehgen.errors import InputError
from vehgen.mechanics import ElementOutput, Place, PointOutput, derive
from vehgen.mechanics.laws import LAWS
from vehgen.mechanics.superset import add_laws
from vehgen.road import ConstantSpeed, Hump, Track, wheel_inputs
from vehgen.simulate import exact_response, newmark_response
from vehgen.vehicle import bundled_models, load_vehicle, parse_vehicle

OUTPUTS = (
    PointOutput("L1_az", Place("L1", "tractor", behind="axle1", distance=-0.29), "acceleration"),
    PointOutput("L1_q", Place("L1", "tractor", behind="axle1", distance=-0.29), "pitch_rate"),
    PointOutput("L2_az", Place("L2", "semitrailer", behind="fifth_wheel", distance=9.32), "acceleration"),
    PointOutput("L2_q", Place("L2", "semitrailer", behind="fifth_wheel", distance=9.32), "pitch_rate"),
    ElementOutput("travel4", "axle4", "suspension_travel"),
    ElementOutput("tyre1", "axle1", "tyre_force"),
)


@pytest.fixture(scope="module")
def tractor():
    model = derive(load_vehicle("tractor5"), OUTPUTS)
    return model, Kernel(model)


def hump_excitation(model, dt, duration=9.0):
    time = np.arange(round(duration / dt) + 1) * dt
    track = Track((Hump.from_shape("half_sine", 1.003, 0.4, 0.03),))
    wheels = wheel_inputs(track, ConstantSpeed(2.0), model.wheel_offsets(), time)
    return Excitation(dt, wheels.heights, wheels.rates, np.zeros((len(time), 0)))


def relative(error, reference):
    return np.linalg.norm(error, axis=0) / np.linalg.norm(reference, axis=0)


def test_equals_the_numpy_oracle(tractor):
    model, kernel = tractor
    excitation = hump_excitation(model, 1e-3)
    rng = np.random.default_rng(5)
    base = np.array(list(model.values().values()))
    parameters = base * np.where(base != 0, rng.uniform(0.95, 1.05, (37, len(base))), 1.0)
    result = kernel.run(parameters, excitation, 10, threads=2)
    assert not result.failures
    for individual in (0, 17, 31, 32, 36):
        values = dict(zip(model.parameters, parameters[individual], strict=True))
        oracle = newmark_response(model, excitation, 10, values)
        np.testing.assert_allclose(result.responses[individual], oracle, rtol=0, atol=1e-10 * np.abs(oracle).max())
        np.testing.assert_allclose(relative(result.responses[individual] - oracle, oracle), 0, atol=1e-10)


def test_second_order_towards_the_exact_solution(tractor):
    model, kernel = tractor
    exact = exact_response(model, hump_excitation(model, 0.125e-3), 80)
    parameters = np.array([list(model.values().values())])
    errors = [
        relative(kernel.run(parameters, hump_excitation(model, dt), round(0.01 / dt)).responses[0] - exact, exact)
        for dt in (2e-3, 1e-3, 5e-4)
    ]
    assert errors[1].max() < 1e-3
    order = np.log2(np.array(errors[:-1]) / np.array(errors[1:]))
    assert order.min() > 1.8
    assert order.max() < 2.3


def test_blocks_threads_and_steps_do_not_change_an_individual(tractor):
    model, kernel = tractor
    excitation = hump_excitation(model, 1e-3, 4.0)
    parameters = np.repeat([list(model.values().values())], 70, axis=0)
    parameters[:, 0] *= np.linspace(0.9, 1.1, 70)
    one = kernel.run(parameters, excitation, 10, threads=1).responses
    two = kernel.run(parameters, excitation, 10, threads=2).responses
    np.testing.assert_array_equal(one, two)
    np.testing.assert_array_equal(kernel.run(parameters[40:41], excitation, 10).responses[0], one[40])
    fine = kernel.run(parameters[:1], excitation, 1).responses[0]
    np.testing.assert_array_equal(fine[::10], one[0])


def test_individuals_may_each_have_inputs_of_their_own(tractor):
    model, kernel = tractor
    excitation = hump_excitation(model, 1e-3, 3.0)
    parameters = np.repeat([list(model.values().values())], 21, axis=0)
    parameters[:, 0] *= np.linspace(0.9, 1.1, 21)
    factors = np.linspace(-1.0, 1.0, 21)[:, None, None]
    own = Excitation(1e-3, excitation.inputs * factors, excitation.rates * factors, np.zeros((21, *excitation.forces.shape)))
    found = kernel.run(parameters, own, 10).responses
    for i in (0, 3, 16, 20):
        alone = Excitation(1e-3, own.inputs[i], own.rates[i], own.forces[i])
        np.testing.assert_array_equal(found[i], kernel.run(parameters[i : i + 1], alone, 10).responses[0])
    with pytest.raises(InputError, match="inputs"):
        kernel.run(parameters[:20], own)


def test_a_failed_individual_is_named_and_harms_no_other(tractor):
    model, kernel = tractor
    excitation = hump_excitation(model, 1e-3, 4.0)
    parameters = np.repeat([list(model.values().values())], 3, axis=0)
    good = kernel.run(parameters[:1], excitation).responses[0]
    parameters[1, model.parameters.index("k1")] = np.nan
    result = kernel.run(parameters, excitation)
    assert list(result.failures) == [1]
    assert "k1" in result.failures[1]
    np.testing.assert_array_equal(result.responses[0], good)
    np.testing.assert_array_equal(result.responses[2], good)


def test_wrong_shapes_are_refused(tractor):
    model, kernel = tractor
    excitation = hump_excitation(model, 1e-3, 1.0)
    with pytest.raises(InputError, match="parameters have shape"):
        kernel.run(np.zeros((2, 3)), excitation)
    with pytest.raises(InputError, match="inputs"):
        kernel.run(np.zeros((1, len(model.parameters))), Excitation(1e-3, excitation.inputs[:, :2], excitation.rates, excitation.forces))


def test_source_is_the_same_every_time_and_readable(tractor):
    _, kernel = tractor
    again = write_kernel(derive(load_vehicle("tractor5"), OUTPUTS))
    assert again.text == kernel.source.text
    assert again.legend == kernel.source.legend
    assert "u0, v0: heave.tractor [m], rise of the COG of tractor" in again.legend
    assert "p_00: mT [kg]: " in again.legend


@pytest.mark.thorough
def test_compiled_code_is_found_again_by_another_process(tmp_path):
    program = (
        "import sys, time; from pathlib import Path; from vehgen.codegen import Kernel; from vehgen.mechanics import derive;"
        "from vehgen.vehicle import load_vehicle; k = Kernel(derive(load_vehicle('quarter_car')), Path(sys.argv[1]));"
        "k.compile(); print(k._module.run.cache_hits)"
    )
    runs = [
        subprocess.run([sys.executable, "-c", program, str(tmp_path)], capture_output=True, text=True, check=True).stdout.split()
        for _ in range(2)
    ]
    assert runs == [["0"], ["1"]]


BASELINE = {
    "b_double": 243,
    "damper_dyno": 14,
    "drop_test": 146,
    "quarter_car": 18,
    "road_train": 709,
    "sedan2": 42,
    "shaker": 32,
    "tractor5": 119,
    "tractor5_cab": 195,
    "tractor5_cargo": 119,
    "tractor5_module": 135,
    "tractor5_module_paper": 135,
    "truck_dolly_trailer": 216,
    "truck_walking_beam": 84,
    "vbi2d_2A3": 141,
}


def test_operation_counts_do_not_rise():
    counts = {name: write_kernel(derive(load_vehicle(path))).operation_counts["step"] for name, path in bundled_models().items()}
    assert counts.keys() == BASELINE.keys()
    for name, count in counts.items():
        assert count <= BASELINE[name], f"{name}: {count} operations per step, {BASELINE[name]} in the baseline"


NONLINEAR_BASELINE = {
    "asymmetric_damping": 498,
    "asymmetric_friction": 553,
    "bump_stop": 448,
    "cubic_stiffness": 548,
    "damper_free_play": 523,
    "dry_friction": 533,
    "elasto_plastic": 458,
    "hysteresis": 818,
    "progressive_stiffness": 408,
    "quadratic_damping": 563,
    "quadratic_stiffness": 548,
    "relaxation": 433,
    "tyre_liftoff": 496,
}


def test_operation_counts_of_laws_do_not_rise():
    """Each law on all five suspensions (tyres where it belongs there) of the five-axle vehicle."""
    assert NONLINEAR_BASELINE.keys() == LAWS.keys()
    for name, law in LAWS.items():
        kind = "suspension" if "suspension" in law.attaches_to else "tyre"
        vehicle = add_laws(load_vehicle("tractor5"), [(f"axle{i}", kind, name) for i in range(1, 6)]).vehicle
        count = write_kernel(derive(vehicle)).operation_counts["step"]
        assert count <= NONLINEAR_BASELINE[name], f"{name}: {count} operations per step, {NONLINEAR_BASELINE[name]} in the baseline"


def test_perturbed_lanes_and_direct_differentiation_agree():
    from vehgen.simulate.sensitivity import direct_sensitivities

    model = derive(load_vehicle("tractor5"), OUTPUTS)
    excitation = hump_excitation(model, 1e-3, 4.0)
    names = ["mS", "IT", "k1", "c4", "kt2", "a1", "b6", "b1", "L1.shift"]
    response, direct = direct_sensitivities(model, excitation, names, 10)
    parameters = np.array(list(model.values().values()))
    kernel = Kernel(model)
    np.testing.assert_allclose(response, kernel.run(parameters, excitation, 10).responses[0], atol=1e-9 * np.abs(response).max())
    for name, derivative in zip(names, direct, strict=True):
        column = model.parameters.index(name)
        step = 1e-4 * (abs(parameters[column]) or 1.0)
        pair = np.repeat(parameters[None], 2, axis=0)
        pair[0, column] += step
        pair[1, column] -= step
        above, below = kernel.run(pair, excitation, 10).responses
        difference = (above - below) / (2 * step)
        assert np.linalg.norm(difference - derivative) < 1e-5 * np.linalg.norm(derivative), name


def test_a_reduction_keeps_memory_small_and_answers_alike(tractor):
    model, kernel = tractor
    excitation = hump_excitation(model, 1e-3, 1.0)
    parameters = np.repeat([list(model.values().values())], 200, axis=0)
    parameters[:, 0] *= np.linspace(0.9, 1.1, 200)
    parameters[150, 0] = np.nan
    peaks, failures = kernel.reduce(parameters, excitation, lambda responses: np.abs(responses).max(axis=1))
    whole = kernel.run(parameters, excitation)
    np.testing.assert_array_equal(peaks, np.abs(whole.responses).max(axis=1))
    assert list(failures) == [150]


def test_a_hundred_thousand_individuals_need_the_memory_of_one_block():
    model = derive(load_vehicle("quarter_car"), (PointOutput("a", Place("s", "body"), "acceleration"),))
    kernel = Kernel(model)
    kernel.compile()
    n, block = 100_000, 1024
    parameters = np.repeat([list(model.values().values())], n, axis=0)
    parameters[:, model.parameters.index("kS")] *= np.linspace(0.8, 1.2, n)
    parameters[70_001, 0] = np.nan
    inputs = 0.01 * np.sin(np.linspace(0, np.pi, 201))[:, None]
    excitation = Excitation(1e-3, inputs, np.gradient(inputs, 1e-3, axis=0), np.zeros((201, 0)))

    def peak(responses):
        return np.abs(responses).max(axis=(1, 2))

    tracemalloc.start()
    peaks, failures = kernel.reduce(parameters, excitation, peak, decimation=2)
    most = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    responses = 8 * 101
    assert most < 3 * block * responses + 16 * n < 0.1 * n * responses
    assert peaks.shape == (n,)
    assert list(failures) == [70_001]
    some = [0, 1023, 1024, 54_321, n - 1]
    np.testing.assert_array_equal(peaks[some], peak(kernel.run(parameters[some], excitation, 2).responses))


@pytest.mark.thorough
def test_many_kernels_are_compiled_by_several_processes(tmp_path):
    """The cache is filled by others: this process only loads."""
    names = ("acceleration", "velocity", "displacement")
    place = Place("s", "body")
    vehicle = parse_vehicle("extends: quarter_car\nbodies: {body: {mass: 1.0625*mB}}\n")  # no other test compiles its kernels
    kernels = [Kernel(derive(vehicle, (PointOutput(name, place, name),)), tmp_path) for name in names]
    assert not any(kernel.is_compiled for kernel in kernels)
    compile_all([*kernels, kernels[0]], 2)
    for kernel in kernels:
        assert kernel.is_compiled
        assert kernel._module.run.cache_hits == 1
    compile_all(kernels, 2)


@pytest.mark.parametrize("precision", ["double", "single"])
@pytest.mark.parametrize("laws", ["", "laws: [{dry_friction: {force: 300 N}}]"])
def test_few_individuals_respond_as_they_do_among_many(precision, laws):
    """Fewer lanes are computed at once: the same numbers bit by bit. Drives of their own are read otherwise."""
    vehicle = parse_vehicle(f"extends: quarter_car\naxles: {{axle1: {{suspension: {{{laws}}}}}}}\n" if laws else "extends: quarter_car\n")
    model = derive(vehicle, (PointOutput("a", Place("s", "body"), "acceleration"),))
    kernel = Kernel(model, precision=precision)
    rng = np.random.default_rng(3)
    parameters = np.array(list(model.values().values())) * rng.uniform(0.9, 1.1, (35, len(model.parameters)))
    road = rng.normal(0, 0.001, (204, 1)).cumsum(axis=0)
    items, scale = (road, np.gradient(road, 1e-3, axis=0), np.zeros((204, 0))), np.linspace(0.5, 1.5, 35)
    shared, own = Excitation(1e-3, *items), Excitation(1e-3, *(scale[:, None, None] * item for item in items))
    whole, others = (kernel.run(parameters, excitation, 10).responses for excitation in (shared, own))
    for few in (slice(0, 1), slice(3, 11), slice(20, 29)):
        assert np.array_equal(kernel.run(parameters[few], shared, 10).responses, whole[few])
    for i in (0, 9, 17, 34):
        alone = kernel.run(parameters[i], Excitation(1e-3, *(scale[i] * item for item in items)), 10).responses[0]
        assert others[i] == pytest.approx(alone, abs=1e-6 if precision == "single" else 1e-12)


SINGLE_LAWS = "laws: [{dry_friction: {force: 300 N}}, {bump_stop: {k: 1 MN/m, clearance: 8 mm}}, {quadratic_damping: {c2: 5e3 N s^2/m^2}}]"


@pytest.mark.parametrize("name", ["tractor5", "sedan2", "laws"])
def test_single_precision_errs_below_a_thousandth(name):
    vehicle = (
        load_vehicle(name) if name != "laws" else parse_vehicle(f"extends: sedan2\naxles: {{front: {{suspension: {{{SINGLE_LAWS}}}}}}}\n")
    )
    body = next(iter(vehicle.bodies))
    model = derive(vehicle, [PointOutput(kind, Place("s", body), kind) for kind in ("acceleration", "pitch_rate", "displacement")])
    parameters = np.repeat([list(model.values().values())], 35, axis=0)
    parameters[:, 0] *= np.linspace(0.95, 1.05, 35)
    excitation = hump_excitation(model, 1e-3, 10.0)
    double = Kernel(model).run(parameters, excitation).responses
    single = Kernel(model, precision="single").run(parameters, excitation)
    assert not single.failures
    assert single.responses.dtype == np.float64
    error = np.linalg.norm(single.responses - double, axis=1) / np.linalg.norm(double, axis=1)
    assert 1e-8 < error.max() < 1e-3


def test_an_unknown_precision_is_refused(tractor):
    with pytest.raises(InputError, match="unknown precision 'singel'; did you mean 'single'"):
        Kernel(tractor[0], precision="singel")
