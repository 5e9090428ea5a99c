"""What hinges transmit: against the reactions of free-body balances, static loads, and stiff links in place of pins."""

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tests.oracles.layouts import random_layout, to_yaml
from tests.oracles.newton_euler import assemble, hinge_reactions
from vehgen.codegen import Excitation, Kernel
from vehgen.errors import InputError
from vehgen.mechanics import ElementOutput, Place, derive, static_loads
from vehgen.road import ConstantSpeed, Track
from vehgen.simulate import Scenario, Simulator, exact_response, load_run, simulate
from vehgen.simulate.frequency import force_response, transfer_functions
from vehgen.vehicle import load_vehicle, parse_vehicle

LIGHT = settings(max_examples=25, deadline=None, derandomize=True, suppress_health_check=[HealthCheck.too_slow])
TRAIN = """name: train
gravity: {gravity}
bodies:
  front: {{mass: 3000 kg, pitch_inertia: 6000 kg m^2}}
  middle: {{mass: 8000 kg, pitch_inertia: 40000 kg m^2, bending: {{length: 9 m, frequency: 7 Hz, damping_ratio: 0.03}}}}
  rear: {{mass: 2000 kg, pitch_inertia: 5000 kg m^2}}
  load: {{mass: 1000 kg, motions: [], carried_by: {{body: middle, x: 1 m}}}}
  cab: {{mass: 400 kg, motions: [heave], carried_by: {{body: middle, x: -2 m}}}}
{joints}
axles:
  one: {{body: front, x: 1.5 m, mass: 500 kg, suspension: {{k: 300 kN/m, c: 10 kN s/m, laws: [{{dry_friction: {{force: 2 kN}}}}]}},
      tyre: {{k: 1.5 MN/m}}}}
  two: {{body: middle, x: -3 m, mass: 700 kg, suspension: {{k: 500 kN/m, c: 20 kN s/m, laws: [{{cubic_stiffness: {{k3: 80 MN/m^3}}}}]}},
      tyre: {{k: 2 MN/m, c: 1 kN s/m}}}}
  three: {{body: rear, x: -1 m, tyre: {{k: 800 kN/m, c: 8 kN s/m}}}}
"""
PINS = """hinges:
  fifth: {front: {x: -1 m}, middle: {x: 4 m}}
  drawbar: {rear: {x: 2 m}, middle: {x: -4 m}, c: 2 kN m s/rad}
links:
  mount: {middle: {x: -2 m}, cab: {}, k: 200 kN/m, c: 4 kN s/m}
  post: {ground: {}, front: {x: 0.5 m}, k: 100 kN/m, c: 2 kN s/m}"""
LINKS = """hinges: {}
links:
  fifth: {front: {x: -1 m}, middle: {x: 4 m}, k: 5000 MN/m, c: 2 MN s/m}
  drawbar: {rear: {x: 2 m}, middle: {x: -4 m}, k: 5000 MN/m, c: 2 MN s/m}
  mount: {middle: {x: -2 m}, cab: {}, k: 200 kN/m, c: 4 kN s/m}
  post: {ground: {}, front: {x: 0.5 m}, k: 100 kN/m, c: 2 kN s/m}"""
RUN = """vehicle: train.yaml
speed: 5 m/s
duration: 2.5 s
step: 0.5 ms
sample: 5 ms
road: [{hump: {shape: versine, length: 1 m, height: 30 mm, at: 1 m}}]
forces:
  shaker: {body: middle, x: -1 m, harmonic: {amplitude: 4 kN, frequency: 4 Hz, phase: 0 deg}}
  ram: {body: rear, harmonic: {amplitude: 2 kN, frequency: 2 Hz}}
displacements: {post: {harmonic: {amplitude: 5 mm, frequency: 3 Hz}}}
sensors:
"""


@LIGHT
@given(st.integers(0, 10**9))
def test_hinges_transmit_the_reactions_of_free_bodies(seed):
    rng = np.random.default_rng(seed)
    layout = random_layout(rng)
    outputs = [ElementOutput(name, name, "hinge_force") for name in layout["hinges"]]
    model = derive(parse_vehicle(to_yaml(layout)), outputs)
    numeric, other = model.numeric(), assemble(layout)
    names = [item.name for item in model.coordinates]
    q, v = rng.normal(0, 0.01, len(names)), rng.normal(0, 0.1, len(names))
    w, dw = rng.normal(0, 0.01, len(model.inputs)), rng.normal(0, 0.1, len(model.inputs))
    a = np.linalg.solve(numeric.M, numeric.P @ w + numeric.Q @ dw - numeric.K @ q - numeric.C @ v)
    rows = numeric.outputs
    found = rows["acceleration"] @ a + rows["velocity"] @ v + rows["displacement"] @ q + rows["input"] @ w + rows["input_rate"] @ dw
    order = [names.index(name) for name in other.coordinates]
    expected = list(hinge_reactions(layout, q[order], v[order], w, dw).values())
    scale = np.abs(numeric.K @ q).max()
    np.testing.assert_allclose(found, expected, atol=1e-8 * scale)


def train(tmp_path, joints, sensors, gravity="true"):
    (tmp_path / "train.yaml").write_text(TRAIN.format(joints=joints, gravity=gravity), encoding="utf-8")
    (tmp_path / "run.yaml").write_text(RUN + sensors, encoding="utf-8")
    return load_run(tmp_path / "run.yaml")


@pytest.mark.parametrize("gravity", ["true", "false"])
def test_a_pin_presses_as_a_stiff_link_in_its_place(tmp_path, gravity):
    pins = "".join(f"  {name}: {{hinge: {name}, channels: {{hinge_force: F_{name}}}}}\n" for name in ("fifth", "drawbar"))
    links = "".join(f"  {name}: {{link: {name}, channels: {{link_force: F_{name}}}}}\n" for name in ("fifth", "drawbar"))
    pinned = simulate(train(tmp_path, PINS.replace(", c: 2 kN m s/rad", ""), pins, gravity))
    linked = simulate(train(tmp_path, LINKS, links, gravity))
    assert [(item.quantity, item.unit) for item in pinned.channels] == [("hinge_force", "N")] * 2
    ours, theirs = pinned.values[0], linked.values[0]
    assert (theirs.std(axis=0) > 500).all()
    assert (np.abs(ours - theirs).std(axis=0) < 0.02 * theirs.std(axis=0)).all()


def test_at_rest_a_hinge_carries_its_static_load():
    vehicle = load_vehicle("truck_dolly_trailer")
    names = list(vehicle.hinges)
    outputs = [ElementOutput(f"{kind} {name}", name, f"hinge_{kind}") for kind in ("load", "force") for name in names]
    simulator = Simulator(vehicle, outputs)
    flat = Scenario(Track(()), ConstantSpeed(1.0), 0.05, 1e-3, 10)
    response = simulator.run(simulator.parameters(), flat).responses[0]
    loads = static_loads(vehicle).hinges
    assert min(abs(load) for load in loads.values()) > 100
    assert response[:, : len(names)] == pytest.approx(np.tile([loads[name] for name in names], (len(response), 1)))
    assert response[:, len(names) :] == pytest.approx(0.0, abs=1e-6)


def test_kernel_exact_solution_and_frequency_response_agree_on_forced_hinges(tmp_path):
    text = TRAIN.replace(", laws: [{{dry_friction: {{force: 2 kN}}}}]", "").replace(", laws: [{{cubic_stiffness: {{k3: 80 MN/m^3}}}}]", "")
    vehicle = parse_vehicle(text.format(joints=PINS, gravity="true"))
    outputs = [ElementOutput(name, name, "hinge_force") for name in vehicle.hinges]
    model = derive(vehicle, outputs, [Place("shaker", "middle"), Place("ram", "rear")])
    time, omega, push = np.arange(4001) * 5e-4, 2 * np.pi * 3, np.array([4e3, 1e3 * np.exp(1j)])
    numeric = model.numeric()
    A, B = numeric.state_matrices()
    steady = np.linalg.solve(1j * omega * np.eye(len(A)) - A, B[:, -2:] @ push).imag
    still = np.zeros((len(time), len(model.inputs)))
    excitation = Excitation(5e-4, still, still, np.imag(np.exp(1j * omega * time[:, None]) * push))
    exact = exact_response(model, excitation, 10, initial=steady)
    kernel = Kernel(model, tmp_path).run(np.array([list(model.values().values())]), excitation, 10, steady[None]).responses[0]
    expected = np.imag(np.exp(1j * omega * time[::10, None]) * (transfer_functions(numeric, np.array([3.0]))[1][0] @ push))
    assert np.abs(exact - expected).max() < 1e-4 * np.abs(expected).max()
    assert np.abs(kernel - expected).max() < 1e-3 * np.abs(expected).max()


def test_a_hinge_with_a_damper_has_a_moment_and_an_angle(tmp_path):
    sensors = "  pin: {hinge: drawbar, channels: {hinge_moment: M, hinge_angle: a}}\n"
    sensors += "  rear: {body: rear, channels: {pitch: r}}\n  middle: {body: middle, x: -4 m, channels: {pitch: m}}\n"
    found = simulate(train(tmp_path, PINS, sensors))
    assert [item.unit for item in found.channels[:2]] == ["N m", "rad"]
    moment, angle, rear, middle = found.values[0].T
    assert angle == pytest.approx(middle - rear, abs=1e-12)
    assert np.ptp(angle) > 1e-3
    assert moment == pytest.approx(2e3 * np.gradient(angle, found.time), abs=0.05 * np.abs(moment).max())


@pytest.mark.parametrize(
    ("sensor", "words"),
    [
        ("  pin: {hinge: drawbr, channels: {hinge_force: F}}", "train has no hinge 'drawbr'; did you mean 'drawbar'"),
        ("  pin: {hinge: drawbar, channels: {link_force: F}}", "unknown quantity 'link_force' of a sensor"),
        ("  pin: {hinge: drawbar, link: mount, channels: {link_force: F}}", "belongs to an `axle`, a `link` or a `hinge`"),
    ],
)
def test_hinges_that_are_not_there_are_refused_at_their_place(tmp_path, sensor, words):
    with pytest.raises(InputError, match=words) as caught:
        train(tmp_path, PINS, sensor + "\n")
    assert caught.value.position.line == RUN.count("\n") + 1


def test_an_output_of_a_hinge_is_written_as_any_other(tmp_path):
    run = train(tmp_path, PINS, "  nose: {body: front}\noutputs: {pin: {hinge: fifth, quantity: hinge_load}}\n")
    assert [item.name for item in run.outputs()] == ["nose_acceleration", "nose_pitch_rate", "pin"]
    with pytest.raises(InputError, match="unknown quantity 'tyre_load' of a hinge"):
        train(tmp_path, PINS, "  nose: {body: front}\noutputs: {pin: {hinge: fifth, quantity: tyre_load}}\n")
    with pytest.raises(InputError, match="'mount' is no hinge"):
        derive(run.vehicle, [ElementOutput("F", "mount", "hinge_force")])


@pytest.mark.parametrize(
    ("kind", "name", "parameter"), [("suspension", "two", "k2"), ("link", "mount", "k_mount"), ("hinge", "drawbar", "kh")]
)
def test_a_spring_grown_stiffer_acts_as_its_added_force_on_all_that_reads_it(kind, name, parameter):
    text = TRAIN.replace(", laws: [{{dry_friction: {{force: 2 kN}}}}]", "").replace(", laws: [{{cubic_stiffness: {{k3: 80 MN/m^3}}}}]", "")
    text = text.replace("k: 500 kN/m", "k: k2").format(joints=PINS, gravity="true").replace("k: 200 kN/m", "k: k_mount")
    text = text.replace("c: 2 kN m s/rad", "k: kh, c: 2 kN m s/rad")
    text += "parameters: {k2: {value: 500 kN/m}, k_mount: {value: 200 kN/m}, kh: {value: 50 kN m/rad}}\n"
    outputs = [ElementOutput("pin", "fifth", "hinge_force"), ElementOutput("own", "drawbar", "hinge_force")]
    outputs += [ElementOutput("moment", "drawbar", "hinge_moment"), ElementOutput("spring", "two", "suspension_force")]
    outputs += [ElementOutput("mount", "mount", "link_force")]
    model = derive(parse_vehicle(text), outputs)
    number = model.element_number(kind, name)
    travel = derive(parse_vehicle(text), [ElementOutput("d", name, {"hinge": "hinge_angle"}.get(kind, f"{kind}_travel"))])
    frequency, values, step = np.array([0.7, 2.0, 9.0]), model.values(), 1e-4
    near = [
        transfer_functions(model.numeric({**values, parameter: values[parameter] * (1 + sign * step)}), frequency)[0] for sign in (1, -1)
    ]
    slope = (near[0] - near[1]) / (2 * step * values[parameter])
    answer = force_response(model, values, (model.elements[number].row,), frequency, number)
    expected = -answer * transfer_functions(travel.numeric(values), frequency)[0]
    np.testing.assert_allclose(slope, expected, atol=1e-6 * np.abs(expected).max())
