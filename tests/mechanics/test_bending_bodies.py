"""What hangs on a body that bends turns with it: against motions in absolute coordinates, of which constraints leave a null space."""

import numpy as np
import pytest
from scipy.linalg import eigvalsh, null_space

from vehgen.simulate import natural_modes
from vehgen.vehicle import parse_vehicle

BEAM = "pitch_inertia: 4 t m^2, bending: {length: 4 m, frequency: 15 Hz, damping_ratio: 0.02, z: AXIS m}"
AXLE = "mass: 400 kg, suspension: {k: 400 kN/m, c: 9 kN s/m}, tyre: {k: 2 MN/m}"
HINGED = f"""name: hinged
bodies:
  a: {{mass: 3 t, {BEAM}}}
  b: {{mass: 3 t, {BEAM}}}
hinges: {{mid: {{a: {{x: -2 m, z: 0.4 m}}, b: {{x: 1.5 m, z: 0.1 m}}, k: 20 MN m/rad}}}}
axles:
  f: {{body: a, x: 1 m, {AXLE}}}
  r: {{body: b, x: -1 m, {AXLE}}}
"""
CARRIED = f"""name: carried
bodies:
  frame: {{mass: 5 t, pitch_inertia: 30 t m^2, bending: {{length: 8 m, frequency: 6 Hz, damping_ratio: 0.02, z: AXIS m}}}}
  load: {{mass: 2 t, pitch_inertia: 4 t m^2, motions: [], carried_by: {{body: frame, x: -2.5 m, z: HEIGHT m}}}}
axles:
  f: {{body: frame, x: 3 m, {AXLE}}}
  r: {{body: frame, x: -2 m, {AXLE}}}
"""


def rise(x, length):
    """Return what heave, pitch and bending raise at x: a free beam's shape (3 s^2 - 1)/2, s = 2 x/length."""
    return np.array([0.0, 1.0, -x, (3 * (2 * x / length) ** 2 - 1) / 2])


def turn(x, length):
    """Return what they turn there, nose-down positive: less the slope of what they raise."""
    return np.array([0.0, 0.0, 1.0, -12 * x / length**2])


def forward(x, z, length, axis):
    """Return what fore-aft motion and pitch move forward, and bending by what lies above or below the axis about which fibres do not."""
    return np.array([1.0, 0.0, z, 0.0]) + (z - axis) * np.array([0.0, 0.0, 0.0, -12 * x / length**2])


def frequencies(masses, springs, constraints):
    """Return undamped natural frequencies [Hz], `springs` pairs of row and stiffness; motions that nothing holds are left out."""
    free = null_space(np.array(constraints))
    stiffness = sum(k * np.outer(row, row) for row, k in springs)
    squares = eigvalsh(free.T @ stiffness @ free, free.T @ np.diag(masses) @ free)
    found = np.sqrt(np.maximum(squares, 0.0)) / (2 * np.pi)
    return found[found > 1e-3]


def told(text):
    return sorted(mode.undamped_hz for mode in natural_modes(parse_vehicle(text)))


def axle_springs(rows, hops):
    return [spring for row, hop in zip(rows, hops, strict=True) for spring in ((row - hop, 4e5), (hop, 2e6))]


@pytest.mark.parametrize("axis", [0.0, -0.3])
def test_a_hinge_between_bending_bodies_turns_with_their_ends(axis):
    beam = [3000.0, 3000.0, 4000.0, 600.0]
    a, b = np.eye(10)[:4].T, np.eye(10)[4:8].T
    hops = np.eye(10)[8:]
    springs = [(np.eye(10)[i], (2 * np.pi * 15) ** 2 * 600) for i in (3, 7)]
    springs += axle_springs([a @ rise(1.0, 4), b @ rise(-1.0, 4)], hops)
    springs.append((b @ turn(1.5, 4) - a @ turn(-2.0, 4), 20e6))
    pin = [a @ rise(-2.0, 4) - b @ rise(1.5, 4), a @ forward(-2.0, 0.4, 4, axis) - b @ forward(1.5, 0.1, 4, axis)]
    assert told(HINGED.replace("AXIS", str(axis))) == pytest.approx(frequencies([*beam, *beam, 400.0, 400.0], springs, pin), rel=1e-6)


@pytest.mark.parametrize(("height", "axis"), [(0.0, 0.0), (0.8, 0.0), (0.8, -0.5)])
def test_a_load_turns_with_the_place_that_carries_it(height, axis):
    masses = [5000.0, 5000.0, 30000.0, 1000.0, 2000.0, 2000.0, 4000.0, 400.0, 400.0]
    frame, load, hops = np.eye(9)[:4].T, np.eye(9)[4:7], np.eye(9)[7:]
    springs = [(np.eye(9)[3], (2 * np.pi * 6) ** 2 * 1000), *axle_springs([frame @ rise(3.0, 8), frame @ rise(-2.0, 8)], hops)]
    place = [forward(-2.5, height, 8, axis), rise(-2.5, 8), turn(-2.5, 8)]
    fixed = [own - frame @ row for own, row in zip(load, place, strict=True)]
    found = told(CARRIED.replace("HEIGHT", str(height)).replace("AXIS", str(axis)))
    assert found == pytest.approx(frequencies(masses, springs, fixed), rel=1e-6)


def test_a_load_that_is_carried_moves_as_one_on_two_stiff_links():
    links = "links:\n" + "".join(
        f"  {name}: {{frame: {{x: {-2.5 + x} m}}, load: {{x: {x} m}}, k: 50 GN/m}}\n" for name, x in (("one", 0.1), ("two", -0.1))
    )
    carried = CARRIED.replace("AXIS", "0").replace("HEIGHT", "0")
    linked = carried.replace(", motions: [], carried_by: {body: frame, x: -2.5 m, z: 0 m}", "") + links
    assert told(linked)[:5] == pytest.approx(told(carried), rel=5e-3)
