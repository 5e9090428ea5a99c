"""Runs that begin displaced or in motion, against exact solutions."""

import numpy as np
import pytest

from vehgen.errors import InputError
from vehgen.simulate import load_run, simulate

RIG = """name: rig
bodies: {block: {mass: 20 kg, motions: [heave]}}
links: {mount: {ground: {}, block: {}, k: 40 kN/m, c: 80 N s/m}}
"""
RUN = """vehicle: rig.yaml
duration: 2 s
step: 0.2 ms
sample: 2 ms
initial: {initial}
sensors: {{gauge: {{body: block, channels: {{displacement: y}}}}}}
"""


def response(folder, initial, vehicle=RIG):
    (folder / "rig.yaml").write_text(vehicle, encoding="utf-8")
    (folder / "run.yaml").write_text(RUN.format(initial=initial), encoding="utf-8")
    return simulate(load_run(folder / "run.yaml"))


def test_a_released_mass_decays_as_the_exact_solution(tmp_path):
    found = response(tmp_path, "{block: {displacement: 12 mm, velocity: -0.3 m/s}}")
    rate, natural = 80.0 / 40.0, np.sqrt(40e3 / 20.0)
    damped = np.sqrt(natural**2 - rate**2)
    t = found.time
    exact = np.exp(-rate * t) * (0.012 * np.cos(damped * t) + (-0.3 + rate * 0.012) / damped * np.sin(damped * t))
    assert found.values[0, :, 0] == pytest.approx(exact, abs=3e-5)


def test_a_hinged_vehicle_begins_with_the_pitch_of_its_semitrailer(tmp_path):
    (tmp_path / "run.yaml").write_text(
        "vehicle: tractor5.yaml\nspeed: 2 m/s\nduration: 0.2 s\ninitial: {semitrailer: {pitch: 0.5 deg}, axle1: {velocity: 10 mm/s}}\n"
        "sensors: {box: {body: semitrailer, channels: {pitch: q}}}\noutputs: {tyre: {axle: axle1, quantity: tyre_force}}\n",
        encoding="utf-8",
    )
    found = simulate(load_run(tmp_path / "run.yaml"))
    assert found.values[0, 0, 0] == pytest.approx(np.radians(0.5), rel=1e-12)
    assert np.abs(found.values[0, :, 1]).max() > 1.0


@pytest.mark.parametrize(
    ("initial", "words"),
    [
        ("{blok: {displacement: 1 mm}}", "no body or axle 'blok'"),
        ("{block: {pitch: 1 deg}}", "free are heave.block"),
        ("{block: {displacement: 1 s}}", "expected m"),
    ],
)
def test_what_cannot_begin_so_is_refused_at_its_place(tmp_path, initial, words):
    with pytest.raises(InputError, match=words) as caught:
        response(tmp_path, initial)
    assert caught.value.position.line == 5
