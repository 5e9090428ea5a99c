"""Dry friction whose slip ends within a step, against an integrator that stops at every event."""

import numpy as np
import pytest

from tests.oracles.laws import Branch, integrate
from vehgen.codegen import Excitation, Kernel
from vehgen.mechanics import Place, PointOutput, derive
from vehgen.road import ConstantSpeed, Hump, Track, wheel_inputs
from vehgen.simulate.benchmark import benchmark_model, population
from vehgen.vehicle import parse_vehicle

QUARTER = """
bodies: {body: {mass: 750 kg, motions: [heave]}}
axles:
  front: {body: body, mass: 90 kg, suspension: {k: 62.5 kN/m, c: 3.27 kN s/m, laws: [{dry_friction: {force: 600 N}}]}, tyre: {k: 673 kN/m}}
"""
WAVES = [(0.9, 0.012), (2.3, 0.005), (7.1, 0.0016), (13.7, 0.0011)]
"""Frequencies [Hz] and amplitudes [m] of the road under the wheel."""
DURATION, SAMPLE = 2.0, 0.01


def road(t):
    phases = [(2 * np.pi * hz, size) for hz, size in WAVES]
    return np.array([sum(size * np.sin(w * t) for w, size in phases)]), np.array([sum(size * w * np.cos(w * t) for w, size in phases)])


@pytest.fixture(scope="module")
def model():
    place = Place("P", "body")
    return derive(parse_vehicle(QUARTER), [PointOutput("a", place, "acceleration"), PointOutput("v", place, "velocity")])


@pytest.fixture(scope="module")
def exact(model):
    times = np.arange(round(DURATION / SAMPLE) + 1) * SAMPLE
    branch = Branch(np.array([-1.0, 1.0]), np.zeros(1), friction=600.0)
    return integrate(model.numeric(), [branch], road, times, [])[1][:, 0]


def sampled(model, dt):
    times = np.arange(round(DURATION / dt) + 1) * dt
    inputs = np.array([road(t) for t in times])
    excitation = Excitation(dt, inputs[:, 0], inputs[:, 1], np.zeros((len(times), 0)))
    return Kernel(model).run(np.array([list(model.values().values())]), excitation, round(SAMPLE / dt)).responses[0]


def test_steps_of_a_millisecond_place_the_jumps_between_the_samples(model, exact):
    found = sampled(model, 1e-3)[:, 0]
    jumps = np.abs(np.diff(exact)).max()
    assert jumps > 1.0
    off = np.abs(found - exact)
    assert (off > 0.05 * jumps).sum() <= 1
    assert np.median(off) < 0.002 * jumps


def test_halving_the_step_quarters_the_error_as_of_smooth_laws(model):
    finest = sampled(model, 6.25e-5)[:, 1]
    coarse, fine = (np.sqrt(np.mean((sampled(model, dt)[:, 1] - finest) ** 2)) for dt in (1e-3, 5e-4))
    assert coarse > 3 * fine


def test_three_sweeps_settle_suspensions_that_stick_on_one_body():
    """On a slow hump, a truck whose five suspensions mostly stick couples their forces most; twelve sweeps leave nothing to settle."""
    model = benchmark_model("dry friction on all suspensions")
    times = np.arange(3001) * 1e-3
    wheels = wheel_inputs(Track((Hump.from_shape("half_sine", 1.0, 0.4, 0.03),)), ConstantSpeed(2.0), model.wheel_offsets(), times)
    excitation = Excitation(1e-3, wheels.heights, wheels.rates, np.zeros((len(times), 0)))
    found, settled = (Kernel(model, sweeps=sweeps).run(population(model, 8), excitation, 10).responses for sweeps in (None, 12))
    error = np.sqrt(np.mean((found - settled) ** 2, axis=(0, 1)) / np.mean(settled**2, axis=(0, 1)))
    assert error.max() < 0.02
    assert error.min() < 0.001
