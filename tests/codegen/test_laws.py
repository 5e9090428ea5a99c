"""Every force law in the kernel against scipy integrators that know nothing of it."""

import numpy as np
import pytest
import sympy as sp

from tests.oracles.laws import Branch, integrate, integrate_plastic
from vehgen.codegen import Excitation, Kernel
from vehgen.mechanics import Place, PointOutput, derive, static_loads
from vehgen.mechanics.laws import LAWS
from vehgen.mechanics.laws.base import LawState
from vehgen.mechanics.static_loads import element_rows
from vehgen.vehicle import parse_vehicle

SPEED, START, LENGTH, HEIGHT = 4.0, 0.2, 0.8, 0.03
VEHICLES = {
    "sedan2": ("body", "body", ["front", "rear"], 1.0),
    "tractor5": ("tractor", "semitrailer", [f"axle{i}" for i in range(1, 6)], 6.0),
}


def positive(x):
    return max(x, 0.0)


def bouc_wen(d, v, s, travel=0.003, beta=0.6):
    return np.array([(v - (beta * abs(v) * abs(s[0]) + (1 - beta) * v * s[0]) * s[0]) / travel])


def carried(d, v, s, half):
    return np.array([v if (d - s[0] >= half and v > 0) or (d - s[0] <= -half and v < 0) else 0.0])


# law -> (what the file says, by force scale F; the same in numpy)
CASES = {
    "cubic_stiffness": (lambda F: f"{{k3: {F / 0.02**3} N/m^3}}", lambda F: {"force": lambda d, v, s: F / 0.02**3 * d**3}),
    "quadratic_stiffness": (lambda F: f"{{k2: {F / 0.05**2} N/m^2}}", lambda F: {"force": lambda d, v, s: F / 0.05**2 * d**2}),
    "progressive_stiffness": (
        lambda F: f"{{k: {F / 0.01} N/m, start: 4 mm}}",
        lambda F: {"force": lambda d, v, s: F / 0.01 * positive(d - 0.004)},
    ),
    "bump_stop": (
        lambda F: f"{{k: {F / 0.002} N/m, clearance: 10 mm, rebound: 12 mm}}",
        lambda F: {"force": lambda d, v, s: F / 0.002 * (positive(d - 0.010) - positive(-d - 0.012))},
    ),
    "asymmetric_damping": (
        lambda F: f"{{c: {F / 0.2} N s/m, ratio: 0.4, blow_off: 0.1 m/s, relief: 0.5}}",
        lambda F: {
            "force": lambda d, v, s: F / 0.2 * (0.4 * (positive(v) - 0.5 * positive(v - 0.1)) - (positive(-v) - 0.5 * positive(-v - 0.1)))
        },
    ),
    "quadratic_damping": (lambda F: f"{{c2: {F / 0.1} N s^2/m^2}}", lambda F: {"force": lambda d, v, s: F / 0.1 * v * abs(v)}),
    "damper_free_play": (
        lambda F: f"{{c: {F / 0.2} N s/m, play: 6 mm}}",
        lambda F: {
            "force": lambda d, v, s: F / 0.2 * carried(d, v, s, 0.003)[0],
            "rates": lambda d, v, s: carried(d, v, s, 0.003),
            "n_states": 1,
        },
    ),
    "relaxation": (
        lambda F: f"{{k: {F / 0.02} N/m, time: 30 ms}}",
        lambda F: {"force": lambda d, v, s: s[0], "rates": lambda d, v, s: np.array([F / 0.02 * v - s[0] / 0.03]), "n_states": 1},
    ),
    "hysteresis": (
        lambda F: f"{{force: {F} N, travel: 3 mm, beta: 0.6}}",
        lambda F: {"force": lambda d, v, s: F * s[0], "rates": bouc_wen, "n_states": 1},
    ),
    "elasto_plastic": (
        lambda F: f"{{force: {F / 3} N, k: {F / 0.005} N/m}}",
        lambda F: {
            "force": lambda d, v, s: s[0],
            "rates": lambda d, v, s: np.array([F / 0.005 * v]),
            "n_states": 1,
            "bound": F / 3,
        },
    ),
    "dry_friction": (lambda F: f"{{force: {F / 4} N}}", lambda F: {"friction": F / 4}),
    "asymmetric_friction": (lambda F: f"{{force: {F / 4} N, ratio: 2}}", lambda F: {"friction": F / 4, "middle": F / 12}),
    "tyre_liftoff": (lambda F: "{}", None),
    "law": (
        lambda F: f"{{force: a*d*abs(d), parameters: {{a: {F / 0.02**2} N/m^2}}}}",
        lambda F: {"force": lambda d, v, s: F / 0.02**2 * d * abs(d)},
    ),
}


def vehicle_with(name, text, part):
    axles = "".join(f"  {axle}: {{{part}: {{laws: [{text}]}}}}\n" for axle in VEHICLES[name][2])
    return parse_vehicle(f"extends: {name}\naxles:\n{axles}")


def road(offsets, height=HEIGHT):
    def at(t):
        local = t * SPEED - offsets - START
        inside = (local > 0) & (local < LENGTH)
        w = np.where(inside, height * np.sin(np.pi * local / LENGTH), 0.0)
        return w, np.where(inside, height * np.pi / LENGTH * SPEED * np.cos(np.pi * local / LENGTH), 0.0)

    return at


def channels(name):
    front, rear, _, back = VEHICLES[name]
    return (
        PointOutput("front", Place("L1", front), "acceleration"),
        PointOutput(
            "rear",
            Place("L2", rear, behind="fifth_wheel" if name == "tractor5" else None, distance=back if name == "tractor5" else 0.0),
            "acceleration",
        ),
        PointOutput("front_z", Place("L1", front), "displacement"),
    )


def compare(name, law, duration, height=HEIGHT):
    text, reference = CASES[law]
    F = 6000.0 if name == "tractor5" else 900.0
    part = "tyre" if law == "tyre_liftoff" else "suspension"
    model = derive(vehicle_with(name, f"{{{law}: {text(F)}}}", part), channels(name))
    numeric = model.numeric()
    offsets = model.wheel_offsets()
    drive_road = road(offsets, height)
    dt = 1e-3
    time = np.arange(round(duration / dt) + 1) * dt
    samples = [drive_road(t) for t in time]
    excitation = Excitation(dt, np.array([w for w, _ in samples]), np.array([dw for _, dw in samples]), np.zeros((len(time), 0)))
    result = Kernel(model).run(np.array([list(model.values().values())]), excitation, 10)
    rows, _ = element_rows(model, model.values())
    loads = static_loads(model)
    branches = []
    for i, element in enumerate(model.elements):
        if element.laws:
            inputs = np.zeros(len(model.inputs))
            for j in element.input_row:
                inputs[j] = 1.0
            made = reference(F) if reference else liftoff(model, element.name, loads)
            branches.append(Branch(rows[i], inputs, **made))
    times = time[::10]
    breaks = sorted((START + o + e) / SPEED for o in offsets for e in (0.0, LENGTH))
    if branches[0].bound:
        q, a = integrate_plastic(numeric, branches, drive_road, times, 40)
    else:
        q, a = integrate(numeric, branches, drive_road, times, breaks)
    outputs = numeric.outputs
    expected = a @ outputs["acceleration"].T + q @ outputs["displacement"].T
    return result, result.responses[0], expected


def liftoff(model, axle, loads):
    values = model.values()
    number = [*model.vehicle.axles].index(axle)
    k = values[f"kt{number + 1}"] if "kt1" in values else values["ktf" if axle == "front" else "ktr"]
    return {"force": lambda d, v, s: positive(-(loads.axles[axle] + k * d))}


@pytest.mark.parametrize("law", sorted(CASES))
@pytest.mark.parametrize("name", ["sedan2", pytest.param("tractor5", marks=pytest.mark.thorough)])
def test_law_against_scipy(name, law):
    result, found, expected = compare(
        name, law, 2.0 if name == "sedan2" else 3.7, height=0.06 if law == "tyre_liftoff" and name == "sedan2" else HEIGHT
    )
    assert not result.failures
    error = np.linalg.norm(found - expected, axis=0) / np.linalg.norm(expected, axis=0)
    assert error.max() < (1e-2 if law == "damper_free_play" else 5e-3), error  # a knock is read as one that takes a step of 1 ms
    assert error[2] < 5e-4, error


def test_every_law_of_the_library_is_compared():
    assert set(LAWS) | {"law"} == set(CASES)


@pytest.mark.parametrize(("ratio", "relief"), [(0.1, 0.9), (0.2, 0.55), (1.0, 0.0)])
def test_a_damper_takes_energy_however_far_its_valves_open(ratio, relief):
    motion = LawState(*sp.symbols("d v h k c static", real=True))
    force = LAWS["asymmetric_damping"].write(motion, {"c": 1.0, "ratio": ratio, "blow_off": 0.1, "relief": relief}).force
    for rate in (-3.0, -0.2, -0.05, 0.05, 0.2, 3.0):
        assert float(force.subs(motion.v, rate)) * rate > 0
