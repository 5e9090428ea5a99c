"""Rigs without gravity: nothing presses, nothing need hold a mass, and motions are those of exact solutions."""

import numpy as np
import pytest

from vehgen.errors import InputError
from vehgen.mechanics import derive, is_held, static_loads
from vehgen.simulate import load_run, natural_modes, simulate
from vehgen.vehicle import load_vehicle, parse_vehicle

CARRIAGE = """name: carriage
gravity: {gravity}
parameters: {{M: {{value: 90 kg}}, c: {{value: 200 N s/m}}}}
bodies: {{carriage: {{mass: M, motions: [heave]}}}}
links: {{rail: {{ground: {{}}, carriage: {{}}, c: c{law}}}}}
"""
RUN = """vehicle: carriage.yaml
duration: 2 s
step: 0.5 ms
sample: 5 ms
forces: {push: {body: carriage, file: force.csv, time: t, force: F}}
sensors: {encoder: {body: carriage, channels: {displacement: q, velocity: v}}}
"""


@pytest.fixture
def carriage(tmp_path):
    def write(law="", gravity="false", force=50.0):
        (tmp_path / "carriage.yaml").write_text(CARRIAGE.format(gravity=gravity, law=law), encoding="utf-8")
        (tmp_path / "force.csv").write_text(f"t,F\n0,{force}\n2,{force}\n", encoding="utf-8")
        (tmp_path / "run.yaml").write_text(RUN, encoding="utf-8")
        return tmp_path / "carriage.yaml", tmp_path / "run.yaml"

    return write


def pushed(time, force, mass=90.0, damping=200.0):
    """Return displacement and velocity of a mass on a damper under a constant force, from rest."""
    rate = damping / mass
    return force / damping * (time - (1 - np.exp(-rate * time)) / rate), force / damping * (1 - np.exp(-rate * time))


def test_what_nothing_holds_moves_as_the_exact_solution(carriage):
    _, run = carriage()
    response = simulate(load_run(run))
    q, v = pushed(response.time, 50.0)
    assert response.values[0, :, 0] == pytest.approx(q, abs=1e-6)
    assert response.values[0, :, 1] == pytest.approx(v, abs=2e-5)


def test_friction_takes_its_force_off_what_slides(carriage):
    _, run = carriage(law=", laws: [{dry_friction: {force: 20 N}}]")
    response = simulate(load_run(run))
    q, _ = pushed(response.time, 30.0)
    assert response.values[0, :, 0] == pytest.approx(q, abs=2e-5)


def test_friction_that_is_not_overcome_holds(carriage):
    _, run = carriage(law=", laws: [{dry_friction: {force: 20 N}}]", force=15.0)
    assert np.abs(simulate(load_run(run)).values[0, :, 0]).max() < 1e-5


def test_a_stop_counts_its_clearance_from_where_the_rig_begins(carriage):
    _, run = carriage(law=", laws: [{bump_stop: {k: 1 MN/m, clearance: 1 m, rebound: 50 mm}}]")
    response = simulate(load_run(run))
    q, _ = pushed(response.time, 50.0)
    free = q < 0.0499
    assert response.values[0, free, 0] == pytest.approx(q[free], abs=1e-6)
    assert response.values[0, :, 0].max() < 0.052 < q.max()


def test_no_weight_no_loads_and_a_mode_of_no_frequency(carriage):
    vehicle, _ = carriage()
    model = derive(load_vehicle(vehicle))
    loads = static_loads(model)
    assert loads.elements == {("link", "rail"): 0.0}
    assert model.total_weight() == 0.0
    assert model.total_mass() == 90.0
    assert natural_modes(model).modes[0].undamped_hz == 0.0
    assert not is_held(model, model.values())


def test_with_gravity_something_must_hold_it(carriage):
    vehicle, _ = carriage(gravity="true")
    with pytest.raises(InputError, match="nothing holds heave"):
        static_loads(load_vehicle(vehicle))


TWO_AXLES = """
bodies:
  van: {mass: 2 t, pitch_inertia: 4 t m^2}
  pallet: {mass: 400 kg, motions: [MOTION], pitch_inertia: 50 kg m^2, carried_by: {body: van, x: -1 m}}
axles:
  front: {body: van, x: 1.5 m, tyre: {k: 200 kN/m}}
  rear: {body: van, x: REAR, tyre: {k: 200 kN/m}}
links: {floor: {van: {x: -1 m}, pallet: {x: 0 m}, k: 1.5 MN/m}}
"""


def test_what_falls_is_named_not_what_it_takes_along():
    """Both axles under one place: the van turns about it, and the pallet, on a stiff floor, goes with the van."""
    with pytest.raises(InputError, match=r"nothing holds (heave|pitch)\.van against gravity"):
        static_loads(parse_vehicle(TWO_AXLES.replace("MOTION", "heave").replace("REAR", "1.5 m")))


def test_a_motion_that_neither_spring_nor_weight_decides_stays_at_rest():
    """A body that only turns, held at its COG: its mass stands on the van, whose loads are those of a rigid one."""
    loads = static_loads(parse_vehicle(TWO_AXLES.replace("MOTION", "pitch").replace("REAR", "-1.5 m")))
    assert loads.axles == pytest.approx({"front": 9.81 * (1000 + 400 * 0.5 / 3), "rear": 9.81 * (1000 + 400 * 2.5 / 3)}, rel=1e-9)
    assert loads.elements["link", "floor"] == pytest.approx(0.0, abs=1e-6)


def test_a_body_that_turns_freely_falls_where_its_weight_turns_it():
    """Held 1 mm beside its COG."""
    beside = TWO_AXLES.replace("pallet: {x: 0 m}", "pallet: {x: 0.001 m}").replace("van: {x: -1 m}", "van: {x: -0.999 m}")
    with pytest.raises(InputError, match=r"nothing holds pitch\.pallet against gravity"):
        static_loads(parse_vehicle(beside.replace("MOTION", "heave, pitch").replace("REAR", "-1.5 m")))
