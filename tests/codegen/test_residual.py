"""The residual form of a step against textbook Newmark: any layout, any output, parameters at zero, long runs."""

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tests.oracles.layouts import random_layout, to_yaml
from tests.oracles.step_interpreter import interpret
from vehgen.codegen import Excitation, Kernel, write_kernel
from vehgen.codegen.linear_rows import as_rows
from vehgen.codegen.newmark import write_step
from vehgen.codegen.program import SETUP_PHASE, STEP_PHASE, Program
from vehgen.codegen.residual import write_residual_step
from vehgen.mechanics import ElementOutput, Place, PointOutput, derive
from vehgen.simulate import newmark_response
from vehgen.vehicle import bundled_models, load_vehicle, parse_vehicle

STEPS = 120
POINTS = ("acceleration", "velocity", "displacement", "pitch_acceleration", "pitch_rate", "fore_aft_acceleration")


def every_output(vehicle, rng, share):
    """Return outputs of all kinds, each with a probability of `share`, and at least one."""
    found = [
        PointOutput(f"{name}.{kind}", Place(name, name, height=0.7), kind)
        for name, body in vehicle.bodies.items()
        for kind in POINTS
        if body.motions is None or ("pitch" in body.motions and "heave" in body.motions)
    ]
    for name, axle in vehicle.axles.items():
        kinds = ["tyre_force", *(["suspension_force", "suspension_travel"] if axle.suspension else [])]
        found += [ElementOutput(f"{name}.{kind}", name, kind) for kind in kinds]
    found += [ElementOutput(f"{name}.{kind}", name, kind) for name in vehicle.links for kind in ("link_force", "link_travel")]
    chosen = [item for item in found if rng.random() < share]
    return chosen or found[:1]


def shaken(model, rng, steps=STEPS, dt=1e-3):
    """Return inputs that are not zero at the start, with rates and forces that have nothing to do with them."""
    inputs = np.cumsum(rng.normal(0, 1e-3, (steps + 1, len(model.inputs))), axis=0)
    rates = np.cumsum(rng.normal(0, 1e-2, inputs.shape), axis=0)
    return Excitation(dt, inputs, rates, rng.normal(0, 1e3, (steps + 1, len(model.forces))))


def assert_same(found, expected):
    """Equal to 1e-10 of the largest value of each channel, and of all channels for one that should be zero."""
    scale = np.maximum(np.abs(expected).max(axis=0), 1e-9 * np.abs(expected).max())
    error = np.abs(found - expected).max(axis=0) / np.where(scale > 0, scale, 1.0)
    assert error.max(initial=0.0) < 1e-10, error


@pytest.mark.parametrize("name", sorted(bundled_models()))
def test_every_bundled_vehicle(name):
    rng = np.random.default_rng(3)
    vehicle = load_vehicle(name)
    model = derive(vehicle, every_output(vehicle, rng, 0.4), [Place("push", next(iter(vehicle.bodies)))])
    excitation = shaken(model, rng, 60)
    assert_same(interpret(write_residual_step(model), model.values(), excitation, 4), newmark_response(model, excitation, 4))


@pytest.mark.thorough
@settings(max_examples=40, deadline=None, derandomize=True, suppress_health_check=[HealthCheck.too_slow])
@given(st.integers(0, 10**9), st.sampled_from(["", "k", "c", "kc"]))
def test_any_layout_with_some_springs_or_dampers_at_zero(seed, zero):
    rng = np.random.default_rng(seed)
    layout = random_layout(rng)
    parts = [*layout["links"].values(), *layout["hinges"].values()]
    parts += [axle[kind] for axle in layout["axles"].values() for kind in ("suspension", "tyre") if axle[kind]]
    for part in parts:
        for key in zero:
            if rng.random() < 0.4:
                part[key] = 0.0
    vehicle = parse_vehicle(to_yaml(layout))
    model = derive(vehicle, every_output(vehicle, rng, 0.3), [Place("push", "body0")])
    excitation = shaken(model, rng)
    assert_same(interpret(write_residual_step(model), model.values(), excitation, 3), newmark_response(model, excitation, 3))


@pytest.mark.parametrize("zeros", [["kS"], ["cS"], ["kS", "cS"], ["kT"], ["kT", "cT"], ["kS", "cS", "kT", "cT"]])
def test_parameters_that_become_zero_after_the_kernel_was_written(zeros):
    model = derive(load_vehicle("quarter_car"), [PointOutput(kind, Place("s", "body"), kind) for kind in POINTS[:3]])
    excitation = shaken(model, np.random.default_rng(8))
    values = {**model.values(), **dict.fromkeys(zeros, 0.0)}
    assert_same(interpret(write_residual_step(model), values, excitation, 2), newmark_response(model, excitation, 2, values))


BENT = """
name: bent
bodies:
  frame: {mass: 9 t, pitch_inertia: 60 t m^2, bending: {frequency: 7 Hz, damping_ratio: 0.03, length: 9 m}}
axles:
  front: {body: frame, x: 3 m, mass: 500 kg, suspension: {k: 400 kN/m, c: 12 kN s/m}, tyre: {k: 1.5 MN/m, c: 1 kN s/m}}
  rear: {body: frame, x: -2 m, tyre: {k: 2 MN/m}}
"""


def test_a_body_that_bends():
    vehicle = parse_vehicle(BENT)
    rng = np.random.default_rng(2)
    model = derive(vehicle, every_output(vehicle, rng, 1.0), [Place("push", "frame")])
    excitation = shaken(model, rng)
    assert_same(interpret(write_residual_step(model), model.values(), excitation, 1), newmark_response(model, excitation, 1))


@pytest.mark.parametrize("precision", ["double", "single"])
def test_compiled_kernels_of_both_forms_agree_over_five_minutes(precision):
    outputs = [PointOutput(kind, Place("s", "tractor"), kind) for kind in ("acceleration", "displacement")]
    model = derive(load_vehicle("tractor5"), outputs)
    kernel = Kernel(model, precision=precision)
    assert kernel.source.from_rest
    time = np.arange(300_001) * 1e-3
    inputs = 0.01 * np.sin(2 * np.pi * 1.7 * (time[:, None] - 0.1 * np.arange(len(model.inputs))))
    excitation = Excitation(1e-3, inputs, np.zeros_like(inputs), np.zeros((len(time), 0)))
    parameters = np.array([list(model.values().values())])
    rest = np.zeros((1, 2 * model.n_dof))
    expected = Kernel(model).run(parameters, excitation, 100, initial=rest).responses[0, -500:]
    found = kernel.run(parameters, excitation, 100).responses[0, -500:]
    error = np.abs(found - expected).max(axis=0) / np.abs(expected).max(axis=0)
    assert error.max() < (1e-10 if precision == "double" else 1e-3)


def test_the_form_with_fewer_operations_is_chosen():
    vehicle = load_vehicle("truck_walking_beam")
    few = derive(vehicle)
    many = derive(vehicle, [PointOutput(f"d{x}", Place(f"s{x}", body), "displacement") for x, body in enumerate(vehicle.bodies)])
    assert write_kernel(few).from_rest
    for model in (few, many):
        plain, residual = write_step(model).step_cost()[0], write_residual_step(model).step_cost()[0]
        source = write_kernel(model)
        assert source.operation_counts["step"] == (residual if source.from_rest else plain) <= plain
        assert not write_kernel(model, from_rest=False).from_rest


def test_rows_are_the_same_linear_function():
    program = Program()
    x, y = (program.leaf(name, STEP_PHASE) for name in "xy")
    a = program.leaf("a", SETUP_PHASE)
    inner = program.subtract(program.multiply(a, x), program.divide(y, a))
    result = program.add(program.multiply(a, inner), program.negate(program.add(inner, y)))
    (row,) = as_rows(program, [result])
    values = {x: 3.0, y: -2.0, a: 1.7}

    def value(node):
        if node in values:
            return values[node]
        if program.value(node) is not None:
            return program.value(node)
        left, *right = map(value, program.arguments[node])
        operations = {"+": float.__add__, "-": float.__sub__, "*": float.__mul__, "/": float.__truediv__}
        return -left if program.operations[node] == "neg" else operations[program.operations[node]](left, *right)

    assert value(row) == pytest.approx(value(result), rel=1e-14)
    assert program.cost([row])[0] == 3
