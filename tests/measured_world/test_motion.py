"""The vehicles' motion against equations written down here, scipy's integrators, and vehgen, which shares no code with it."""

from dataclasses import replace

import numpy as np
import pytest
from benchmarks.hidden_effects.generator.cases import Case as Mechanics
from benchmarks.hidden_effects.generator.simulate import prepare
from benchmarks.hidden_effects.generator.vehicles import NOMINAL, nominal
from benchmarks.measured_world.driver import wandering
from benchmarks.measured_world.hump import Hump
from benchmarks.measured_world.modes import invariants, natural_modes
from benchmarks.measured_world.motion import move
from benchmarks.measured_world.sets import draw_case
from benchmarks.measured_world.solve import BANDS, bands
from benchmarks.measured_world.unseen import write_unseen
from scipy import interpolate, signal

import vehgen

HUMP = Hump("versine", 0.5, 0.03)


def moved(vehicle, drive, height, start=-1.0, end=3.0):
    case = draw_case("trial", 1, "coverage", 0 if vehicle == "sedan2" else 1, "logger")
    setup = prepare(Mechanics(vehicle, nominal(vehicle)))
    sensors = tuple(replace(sensor, height=0.3) for sensor in case.sensors)
    return setup, move(setup, sensors, {}, height, drive, start, end, np.random.default_rng(0))


def steady(speed):
    return wandering(speed, 0.0, 2.0, -12.0, 12.0, np.random.default_rng(0))


def test_a_sedan_moves_as_scipy_integrates_the_half_car():
    p = nominal("sedan2")
    front, rear = p["Lf"], p["wheelbase"] - p["Lf"]
    rows = np.array([[1.0, -front, -1.0, 0.0], [1.0, rear, 0.0, -1.0]])  # z, pitch (nose down), axles
    K = rows.T @ np.diag([p["kf"], p["kr"]]) @ rows + np.diag([0.0, 0.0, p["ktf"], p["ktr"]])
    C = rows.T @ np.diag([p["cf"], p["cr"]]) @ rows
    inverse = np.diag(1.0 / np.array([p["mH"], p["IZ"], p["mf"], p["mr"]]))
    A = np.block([[np.zeros((4, 4)), np.eye(4)], [-inverse @ K, -inverse @ C]])
    B = np.zeros((8, 2))
    B[6, 0], B[7, 1] = p["ktf"] / p["mf"], p["ktr"] / p["mr"]
    drive = wandering(3.0, 0.015, 2.0, -12.0, 12.0, np.random.default_rng(4))
    _, motion = moved("sedan2", drive, HUMP.heights)
    t = np.arange(-2.0, 3.0, 1e-4)
    s = drive.distance(t)
    u = np.column_stack([HUMP.heights(s), HUMP.heights(s - p["wheelbase"])])
    _, _, x = signal.lsim((A, B, np.eye(8), np.zeros((8, 2))), u, t - t[0])
    a = x @ A.T + u @ B.T
    known = motion.start + np.arange(len(motion.places["F"].up)) / 4000.0
    inside = (known > -0.5) & (known < 2.9)
    expected = interpolate.CubicSpline(t, np.column_stack([a[:, 4] - front * a[:, 5], x[:, 5], x[:, 1], 0.3 * a[:, 5]]))(known[inside])
    place = motion.places["F"]
    found = np.column_stack([place.up, place.rate, place.pitch, place.fore - drive.acceleration(known)])[inside]
    assert np.max(np.abs(found - expected), axis=0) == pytest.approx(np.zeros(4), abs=2e-3 * np.max(np.abs(expected)))


@pytest.mark.thorough
def test_a_truck_on_a_ramp_rises_with_it_and_keeps_its_loads():
    setup, motion = moved("tractor5", steady(5.0), lambda s: 0.01 * s)
    place = motion.places["L2"]
    assert place.pitch[-1] == pytest.approx(-0.01, abs=1e-6)  # nose up
    assert np.max(np.abs(place.up[-2000:])) < 1e-4
    static = setup.system.static_forces()
    weight = sum(body.mass for body in setup.layout.bodies.values()) + sum(axle.mass for axle in setup.layout.axles.values())
    assert sum(static[f"tyre:{axle}"] for axle in setup.layout.axles) == pytest.approx(9.81 * weight)
    assert motion.unloaded == pytest.approx(1.0, abs=0.2)


@pytest.mark.parametrize("vehicle", ["sedan2", "tractor5"])
def test_modes_and_nominal_values_are_those_of_the_bundled_vehicle(vehicle):
    found = natural_modes(vehicle, nominal(vehicle))
    expected = vehgen.natural_modes(vehicle).modes
    assert [mode["frequency"] for mode in found] == pytest.approx([mode.undamped_hz for mode in expected], rel=1e-6)
    assert [mode["damping_ratio"] for mode in found] == pytest.approx([mode.damping_ratio for mode in expected], rel=1e-6)


def test_ratios_of_the_truck_do_not_change_with_all_masses_and_stiffnesses():
    p = nominal("tractor5")
    scaled = {name: value * (1.5 if name[0] in "mIkc" else 1.0) for name, value in p.items()}
    one, other = invariants("tractor5", p), invariants("tractor5", scaled)
    assert [one[name] for name in one if name[0] in "mkc"] == pytest.approx([other[name] for name in one if name[0] in "mkc"])
    assert set(invariants("sedan2", nominal("sedan2"))) == {name for name, item in NOMINAL["sedan2"].items() if item.range}


def test_vehgen_drives_the_true_vehicle_over_unseen_roads_alike(tmp_path):
    case = draw_case("trial", 1, "coverage", 0, "logger")
    write_unseen(replace(case, unseen=case.unseen[:1]), tmp_path)
    units = {"m": "kg", "I": "kg m^2", "k": "N/m", "c": "N s/m", "L": "m", "w": "m"}
    lines = [f"  {name}: {{value: {value!r} {units[name[0]]}}}" for name, value in case.parameters.items()]
    true = tmp_path / "true.yaml"
    true.write_text("\n".join(["extends: sedan2.yaml", "parameters:", *lines]) + "\n")
    errors = bands(tmp_path / "unseen_A.yaml", true)
    assert np.abs([errors[name] for name in ("F_az", "F_q", "R_az", "R_q")]) == pytest.approx(np.zeros((4, len(BANDS))), abs=0.01)
    wrong = bands(tmp_path / "unseen_A.yaml", tmp_path / "sedan2.yaml")
    assert np.max(np.abs(wrong["F_az"])) > 0.02
