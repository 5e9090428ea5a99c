"""A seat on a cab on a frame on an axle, each rubbing on the next, against projected Gauss-Seidel iterations in far shorter steps."""

from __future__ import annotations

import numba
import numpy as np
import pytest

from vehgen.codegen.coupling import FEWEST_SWEEPS, MOST_SWEEPS, sweeps_of
from vehgen.codegen.nonlinear_element import find_nonlinear
from vehgen.codegen.step_program import EquationTerms
from vehgen.mechanics import derive
from vehgen.simulate import simulate
from vehgen.vehicle import load_vehicle

SHORT = 5e-6
"""Step of the reference [s]."""
SECONDS = 1.2


@numba.njit
def exact(seat: float, bounds: np.ndarray) -> np.ndarray:
    """Return the accelerations of frame, cab and seat every ms."""
    mass = np.array([3000.0, 300.0, seat, 300.0])
    weight = mass.sum() * 9.80665
    z, v, rows = np.zeros(4), np.zeros(4), np.zeros((round(SECONDS * 1000) + 1, 3))
    every = round(1e-3 / SHORT)
    for i in range(round(SECONDS / SHORT) + 1):
        phase = 2 * np.pi * (5.0 * (i + 0.5) * SHORT - 0.5) / 0.5
        road = 0.025 * (1 - np.cos(phase)) if 0 < phase < 2 * np.pi else 0.0
        axle = 150e3 * (z[3] - z[0]) + 3e3 * (v[3] - v[0])
        cab = 30e3 * (z[0] - z[1]) + 500 * (v[0] - v[1])
        chair = 6e3 * (z[1] - z[2]) + 100 * (v[1] - v[2])
        force = np.array([axle - cab, cab - chair, chair, max(1e6 * (road - z[3]), -weight) - axle])
        free, held = v + SHORT * force / mass, np.zeros(3)
        for _ in range(40):
            for k, (low, high) in enumerate(((3, 0), (0, 1), (1, 2))):
                give = SHORT * (1 / mass[low] + 1 / mass[high])
                now = min(max(held[k] + (free[low] - free[high]) / give, -bounds[k]), bounds[k])
                free[low] -= SHORT * (now - held[k]) / mass[low]
                free[high] += SHORT * (now - held[k]) / mass[high]
                held[k] = now
        if i % every == 0:
            rows[i // every] = ((free - v) / SHORT)[:3]
        z, v = z + SHORT * free, free
    return rows


def chain(seat: float, bounds: tuple[float, ...]) -> str:
    axle, cab, chair = (f"laws: [{{dry_friction: {{force: {bound} N}}}}]" for bound in bounds)
    return (
        f"name: chain\nbodies:\n  frame: {{mass: 3 t, motions: [heave]}}\n  cab: {{mass: 300 kg, motions: [heave]}}\n"
        f"  seat: {{mass: {seat} kg, motions: [heave]}}\naxles: {{a: {{body: frame, x: 0 m, mass: 300 kg, "
        f"suspension: {{k: 150 kN/m, c: 3 kN s/m, {axle}}}, tyre: {{k: 1 MN/m, laws: [{{tyre_liftoff: {{}}}}]}}}}}}\n"
        f"links:\n  mount: {{frame: {{}}, cab: {{}}, k: 30 kN/m, c: 500 N s/m, {cab}}}\n"
        f"  cushion: {{cab: {{}}, seat: {{}}, k: 6 kN/m, c: 100 N s/m, {chair}}}\n"
    )


@pytest.mark.parametrize(("seat", "bounds"), [(80.0, (3000.0, 300.0, 60.0)), (80.0, (8000.0, 1500.0, 300.0)), (5.0, (3000.0, 300.0, 60.0))])
def test_accelerations_between_rubbing_links_are_those_of_an_exact_solution(tmp_path, seat, bounds):
    """A light seat's peak was more than seven times the true one, where one sweep's error passed for a slip."""
    (tmp_path / "chain.yaml").write_text(chain(seat, bounds), encoding="utf-8")
    sensors = ", ".join(f"{name}: {{body: {name}, channels: {{acceleration: {name}_a}}}}" for name in ("frame", "cab", "seat"))
    (tmp_path / "run.yaml").write_text(
        f"vehicle: chain.yaml\nspeed: 5 m/s\nduration: {SECONDS} s\nsample: 1 ms\n"
        f"road: [{{hump: {{shape: versine, length: 0.5 m, height: 50 mm, at: 0.5 m}}}}]\nsensors: {{{sensors}}}\n",
        encoding="utf-8",
    )
    found, true = simulate(tmp_path / "run.yaml").values[0], exact(seat, np.array(bounds))
    rms = np.sqrt(np.mean(found**2, axis=0) / np.mean(true**2, axis=0))
    assert rms == pytest.approx(1.0, abs=0.01)
    assert np.abs(found).max(axis=0) / np.abs(true).max(axis=0) == pytest.approx([1.0, 1.0, 1.0], abs=0.15)


def two_hinges() -> str:
    """Return a B-double whose nine suspensions and two hinges rub."""
    vehicle = load_vehicle("b_double")
    axles = ", ".join(f"{name}: {{suspension: {{laws: [{{dry_friction: {{force: 3 kN}}}}]}}}}" for name in vehicle.axles)
    hinges = ", ".join(f"{name}: {{laws: [{{dry_friction: {{force: 10 kN m}}}}]}}" for name in vehicle.hinges)
    return f"extends: b_double\nname: own\naxles: {{{axles}}}\nhinges: {{{hinges}}}\n"


def test_hinges_that_rub_between_rubbing_suspensions_converge_in_short_steps(tmp_path):
    """With three sweeps a step of 0.2 ms was refused: 7 kN were left."""
    (tmp_path / "train.yaml").write_text(two_hinges(), encoding="utf-8")
    found = []
    for step in ("1 ms", "0.2 ms"):
        (tmp_path / "run.yaml").write_text(
            f"vehicle: train.yaml\nspeed: 4 m/s\nduration: 4 s\nstep: {step}\nsample: 2 ms\n"
            "road: [{hump: {shape: versine, length: 0.5 m, height: 40 mm, at: 2 m}}]\n",
            encoding="utf-8",
        )
        found.append(simulate(tmp_path / "run.yaml").values[0])
    rms = np.sqrt(np.mean((found[0] - found[1]) ** 2, axis=0) / np.mean(found[1] ** 2, axis=0))
    assert rms.max() < 0.03


def count(text: str, tmp_path) -> int:
    (tmp_path / "own.yaml").write_text(text, encoding="utf-8")
    model = derive(load_vehicle(tmp_path / "own.yaml"))
    terms = EquationTerms(model)
    return sweeps_of(model, find_nonlinear(terms, terms.matrix(model.stiffness_entries, "K")))


def test_sweeps_are_as_many_as_light_bodies_between_links_ask_for(tmp_path):
    axles = ", ".join(f"axle{i}: {{suspension: {{laws: [{{dry_friction: {{force: 3 kN}}}}]}}}}" for i in range(1, 6))
    assert count(f"extends: tractor5\nname: own\naxles: {{{axles}}}\n", tmp_path) == FEWEST_SWEEPS
    assert (
        count("extends: tractor5\nname: own\nhinges: {fifth_wheel: {laws: [{dry_friction: {force: 10 kN m}}]}}\n", tmp_path)
        == FEWEST_SWEEPS
    )
    assert count(two_hinges(), tmp_path) == MOST_SWEEPS
    light, heavy = (count(chain(seat, (3000.0, 300.0, 60.0)), tmp_path) for seat in (5.0, 80.0))
    assert FEWEST_SWEEPS < light < heavy < MOST_SWEEPS
    assert count(chain(80.0, (1e5, 300.0, 1.0)), tmp_path) == MOST_SWEEPS
    assert count(chain(0.001, (0.001, 300.0, 300.0)), tmp_path) == FEWEST_SWEEPS
