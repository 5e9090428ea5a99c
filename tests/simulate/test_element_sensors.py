"""Sensors of axles and links: load cells, string pots, accelerometers on hubs; against plain arithmetic."""

import numpy as np
import pytest

from vehgen.errors import InputError
from vehgen.fit.trial import load_trials
from vehgen.simulate import load_run, simulate
from vehgen.vehicle import load_vehicle

DYNO = """name: dyno
gravity: false
bodies: {head: {mass: 5 kg, motions: [heave]}}
links:
  damper: {ground: {}, head: {}, c: 2 kN s/m, laws: [{dry_friction: {force: 80 N}}]}
  load_cell: {head: {}, ground: {}, k: 50 MN/m, c: 5 kN s/m}
"""
RUN = """vehicle: dyno.yaml
duration: 2 s
step: 0.1 ms
sample: 5 ms
acquisition: none
displacements: {damper: {harmonic: {amplitude: 20 mm, frequency: 1 Hz}}}
sensors:
  cell: {link: load_cell, channels: {link_force: F}}
  pot: {link: damper, channels: {link_travel: s}}
"""
QUARTER = """vehicle: quarter_car.yaml
speed: 5 m/s
duration: 3 s
road: [{hump: {shape: half_sine, length: 0.5 m, height: 30 mm, at: 1 m}}]
sensors:
  hub: {axle: AXLE, channels: {acceleration: a, displacement: z, suspension_travel: d}}
  seat: {body: BODY, channels: {displacement: y}}
"""


@pytest.fixture
def dyno(tmp_path):
    def write(run=RUN):
        (tmp_path / "dyno.yaml").write_text(DYNO, encoding="utf-8")
        (tmp_path / "run.yaml").write_text(run, encoding="utf-8")
        return tmp_path / "run.yaml"

    return write


def test_a_load_cell_reads_what_a_damper_and_its_friction_pass_on(dyno):
    found = simulate(load_run(dyno()))
    rate = 0.02 * 2 * np.pi * np.cos(2 * np.pi * found.time)
    sliding = np.abs(rate) > 0.02
    late = found.time > 0.05
    expected = 2e3 * rate + 80.0 * np.sign(rate)
    force = -found.values[0, :, 0]  # the ground counts as the lower end
    assert force[sliding & late] == pytest.approx(expected[sliding & late], abs=4.0)
    assert found.values[0, :, 1] == pytest.approx(0.02 * np.sin(2 * np.pi * found.time), abs=2e-5)


def test_a_hub_moves_as_its_axle(tmp_path):
    vehicle = load_vehicle("quarter_car.yaml")
    axle, body = next(iter(vehicle.axles)), next(iter(vehicle.bodies))
    (tmp_path / "run.yaml").write_text(QUARTER.replace("AXLE", axle).replace("BODY", body), encoding="utf-8")
    found = simulate(load_run(tmp_path / "run.yaml"))
    a, z, travel, y = found.values[0].T
    assert travel == pytest.approx(z - y, abs=1e-12)
    smooth = np.gradient(np.gradient(z, found.time), found.time)
    assert np.std(smooth[2:-2] - a[2:-2]) < 0.2 * np.std(a)
    assert np.ptp(z) > 0.02


def test_a_recorded_force_is_read_in_its_unit(dyno):
    path = dyno()
    response = simulate(load_run(path))
    table = np.column_stack([response.time, response.values[0, :, 0] / 1e3, response.values[0, :, 1]])
    np.savetxt(path.with_name("recording.csv"), table, delimiter=",", header="t,F,s", comments="")
    text = RUN.replace("link_force: F", "link_force: {column: F, unit: kN, noise: 2 N}") + "recording: recording.csv\n"
    (trial,) = load_trials([dyno(text)])
    assert trial.channels == ("F", "s")
    assert trial.recording.values[:, 0] == pytest.approx(response.values[0, : len(trial.recording.values), 0], abs=1e-6)
    assert trial.recording.channels[0].noise == 2.0


@pytest.mark.parametrize(
    ("sensor", "words", "line"),
    [
        ("cell: {link: load_sell, channels: {link_force: F}}", "no link 'load_sell'", 8),
        ("cell: {link: load_cell, channels: {pitch_rate: F}}", "unknown quantity 'pitch_rate'", 8),
        ("cell: {link: load_cell, body: head, channels: {link_force: F}}", "belongs to an `axle`, a `link` or a `hinge`", 8),
        ("cell: {link: load_cell, x: 1 m, channels: {link_force: F}}", "no place along a body", 8),
        ("cell: {link: load_cell}", "has `channels`", 8),
    ],
)
def test_sensors_that_cannot_be_are_refused_at_their_place(dyno, sensor, words, line):
    with pytest.raises(InputError, match=words) as caught:
        load_run(dyno(RUN.replace("cell: {link: load_cell, channels: {link_force: F}}", sensor)))
    assert caught.value.position.line == line


def test_the_hub_of_a_wheel_that_sits_on_its_body_moves_as_that_does(tmp_path):
    """A forklift has no suspension: its front wheels heave as the frame does there."""
    (tmp_path / "lift.yaml").write_text(
        "name: lift\nbodies: {frame: {mass: 3 t, pitch_inertia: 2 t m^2}}\n"
        "axles:\n  front: {body: frame, x: 0.8 m, tyre: {k: 1 MN/m, c: 2 kN s/m}}\n  rear: {body: frame, x: -0.9 m, tyre: {k: 1 MN/m}}\n",
        encoding="utf-8",
    )
    sensors = "sensors: {hub: {axle: front, channels: {acceleration: a}}, place: {body: frame, x: 0.8 m, channels: {acceleration: b}}}\n"
    run = "vehicle: lift.yaml\nspeed: 2 m/s\nduration: 3 s\nroad: [{hump: {shape: half_sine, length: 0.5 m, height: 30 mm, at: 1 m}}]\n"
    (tmp_path / "run.yaml").write_text(run + sensors, encoding="utf-8")
    found = simulate(load_run(tmp_path / "run.yaml")).values[0]
    assert np.abs(found[:, 0]).max() > 1.0
    assert found[:, 0] == pytest.approx(found[:, 1], abs=1e-9)
