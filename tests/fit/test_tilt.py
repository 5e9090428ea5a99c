"""Readings of a tilted sensor against an independent simulation that carries the fore-aft motion as a coordinate of its own."""

import numpy as np
import pytest
from benchmarks.hidden_effects.generator import SENSORS, SILENT, Case, Effect, Hump, RunSpec, SensorSpec, nominal, simulate_case, write_case

from vehgen.fit.adjustments import Tilt
from vehgen.fit.trial import load_trials
from vehgen.mechanics import Place, PointOutput
from vehgen.simulate import Simulator

RUN = RunSpec((Hump(0.5, 0.03, 4.0),), 2.5, 9.0, "hump")
ANGLE = 0.517


def recorded(vehicle, angle, sensors, place, **more):
    effects = (Effect("sensor_tilt", place, {"angle": angle}),) if angle else ()
    return Case(vehicle, nominal(vehicle), effects, (RUN,), sensors, SILENT, **more)


def raised(vehicle, height):
    return tuple(SensorSpec(item.name, item.body, item.behind, item.distance, height) for item in SENSORS[vehicle])


@pytest.mark.parametrize(("vehicle", "sensor", "height"), [("tractor5", "L1", 0.0), ("tractor5", "L2", 0.8), ("sedan2", "F", -0.4)])
def test_a_tilted_sensor_reads_the_fore_aft_motion_of_its_place(tmp_path, vehicle, sensor, height):
    case = recorded(vehicle, ANGLE, raised(vehicle, height), sensor)
    (tmp_path / "seen").mkdir()
    (tmp_path / "hidden").mkdir()
    write_case(case, tmp_path / "seen", tmp_path / "hidden")
    (trial,) = load_trials(sorted((tmp_path / "seen").glob("*.yaml")))
    level = trial.simulator.run(trial.simulator.parameters(trial.values), trial.scenario).responses
    found = Tilt(sensor).response(trial, level, np.array([ANGLE, height]))[0]
    column = trial.channels.index(f"{sensor}_az")
    kept = slice(50, -50)
    measured = trial.recording.values[kept, column]
    error, without = (np.abs(measured - item[kept, column]).max() for item in (found, level[0]))
    assert error < 0.02 * np.abs(measured).max()
    assert without > 5 * error
    n, dt = len(trial.recording.time), trial.recording.dt
    lines = Tilt(sensor).read_lines(trial, np.fft.rfftfreq(n, dt), np.array([ANGLE, height]), np.fft.rfft(level, axis=-2))
    read = np.fft.irfft(lines, n, axis=-2)[0]
    assert np.std((read - found)[kept, column]) < 0.02 * np.abs(measured).max()  # but for a pitch's mean, which is not in its rate
    assert np.array_equal(np.delete(lines, column, axis=-1), np.delete(np.fft.rfft(level, axis=-2), column, axis=-1))


def test_the_fore_aft_acceleration_of_a_place_is_that_of_an_independent_simulation(tmp_path):
    """What a sensor tilted by a right angle reads, but for gravity's share."""
    case = recorded("tractor5", np.pi / 2, raised("tractor5", 0.7), "L2", step=2e-4)
    (tmp_path / "seen").mkdir()
    (tmp_path / "hidden").mkdir()
    write_case(case, tmp_path / "seen", tmp_path / "hidden")
    place = Place("L2", "semitrailer", behind="fifth_wheel", distance=9.115, height=0.7)
    outputs = [PointOutput("x", place, "fore_aft_acceleration"), PointOutput("turn", place, "pitch")]
    (trial,) = load_trials(sorted((tmp_path / "seen").glob("*.yaml")))
    simulator = Simulator(trial.run.vehicle, outputs)
    found = simulator.run(simulator.parameters(), trial.scenario).responses[0]
    clean = simulate_case(case)[0].clean["L2_az"]
    assert found[:, 0] - 9.81 * found[:, 1] == pytest.approx(clean[: len(found)], abs=0.01 * np.abs(clean).max())
