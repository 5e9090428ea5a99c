"""Drawings tell how bodies stand on one another, what hinges resist, and what bends."""

import numpy as np
import pytest

from tests.report.vehicles import model
from vehgen.mechanics import derive
from vehgen.report import draw_modes, draw_vehicle
from vehgen.report.drawing.mode_shapes import mode_movements
from vehgen.report.drawing.sketch import make_sketch
from vehgen.simulate import natural_modes
from vehgen.vehicle import parse_vehicle

COACH = """
bodies:
  coach: {mass: 30 t, pitch_inertia: 900 t m^2, bending: {frequency: 9 Hz, length: 24 m}}
  bogie_1: {mass: 3 t, pitch_inertia: 2 t m^2}
  bogie_2: {mass: 3 t, pitch_inertia: 2 t m^2}
links:
  air_1: {coach: {x: 9 m}, bogie_1: {}, k: 800 kN/m, c: 30 kN s/m}
  air_2: {bogie_2: {}, coach: {x: -9 m}, k: 800 kN/m}
axles:
  w1: {body: bogie_1, x: 1.25 m, mass: 1.5 t, suspension: {k: 2 MN/m}, tyre: {k: 500 MN/m}}
  w2: {body: bogie_1, x: -1.25 m, mass: 1.5 t, suspension: {k: 2 MN/m}, tyre: {k: 500 MN/m}}
  w3: {body: bogie_2, x: 1.25 m, mass: 1.5 t, suspension: {k: 2 MN/m}, tyre: {k: 500 MN/m}}
  w4: {body: bogie_2, x: -1.25 m, mass: 1.5 t, suspension: {k: 2 MN/m}, tyre: {k: 500 MN/m}}
"""


@pytest.fixture(scope="module")
def coach():
    return derive(parse_vehicle(COACH))


def lines(figure):
    return len(figure.axes[0].lines)


def test_a_coach_stands_on_its_bogies(coach):
    sketch = make_sketch(coach, coach.values())
    for bogie in ("bogie_1", "bogie_2"):
        assert sketch.boxes[bogie].bottom > 2 * sketch.wheel_radius
        assert sketch.boxes["coach"].bottom > sketch.boxes[bogie].top + 0.2
    for strut in sketch.links.values():
        assert strut.upper == "coach"
        assert strut.bottom == pytest.approx(sketch.boxes[strut.lower].top)


def test_a_load_cell_hangs_from_above_and_two_links_at_one_place_stand_apart():
    sketch = make_sketch(model("damper_dyno"), model("damper_dyno").values())
    damper, cell = sketch.links["damper"], sketch.links["load_cell"]
    assert damper.top <= sketch.boxes["crosshead"].bottom < sketch.boxes["crosshead"].top <= cell.bottom < cell.top <= sketch.top
    both = "bodies: {a: {mass: 1 t, motions: [heave]}}\nlinks: {one: {ground: {}, a: {}, k: 1 kN/m}, two: {ground: {}, a: {}, c: 1 kN s/m}}"
    m = derive(parse_vehicle(both))
    one, two = make_sketch(m, m.values()).links.values()
    assert abs(one.x - two.x) > 0.3
    assert (one.bottom, one.top) == (two.bottom, two.top)


def test_a_body_that_bends_is_drawn_bent_as_its_own_motion_says(coach):
    modes = natural_modes(coach)
    number = next(i for i, mode in enumerate(modes) if mode.name == "coach bending")
    movement = mode_movements(coach, modes, coach.values())[number]
    sketch = make_sketch(coach, coach.values())
    box = sketch.boxes["coach"]
    shape = dict(zip((item.name for item in coach.coordinates), modes[number].shape, strict=True))
    for x in (-12.0, 0.0, 5.0, 12.0):
        s = x / 12.0
        rise = shape["heave.coach"] - x * shape["pitch.coach"] + shape["bending.coach"] * (3 * s**2 - 1) / 2
        assert movement.point(sketch, "coach", box.x + x, box.z)[1] == pytest.approx(rise)
    patches = {patch.get_gid(): patch for patch in draw_modes(coach, modes).axes[0].patches}
    drawn = np.asarray(patches[f"mode-{number + 1}-coach"].get_xy())
    assert len(drawn) > 30
    assert box.right - box.left == pytest.approx(24.0)


def test_a_hinge_shows_what_resists_it():
    free, sprung, damped = (
        draw_vehicle(derive(parse_vehicle(f"extends: tractor5\nhinges: {{fifth_wheel: {{{keys}}}}}")))
        for keys in ("k: 0 N m", "k: 2 MN m", "k: 2 MN m, c: 20 kN m s")
    )
    assert lines(free) < lines(sprung) < lines(damped)


@pytest.mark.parametrize(
    ("labels", "parts"),
    [
        (["suspension axle4"], {"suspension-axle4"}),
        (["tyre axle1", "hinge fifth_wheel"], {"tyre-axle1", "hinge-fifth_wheel"}),
        (["axle4 and axle5"], {"suspension-axle4", "suspension-axle5"}),
        (["all suspensions"], {f"suspension-axle{i}" for i in range(1, 6)}),
        (["link seat", "cab"], {"link-seat", "body-cab"}),
        (["nowhere", "<b>"], set()),
    ],
)
def test_places_of_a_diagnosis_are_ringed(labels, parts):
    patches = draw_vehicle(model("tractor5_cab"), marked=labels).axes[0].patches
    assert {patch.get_gid() for patch in patches if (patch.get_gid() or "").startswith("marked-")} == {f"marked-{part}" for part in parts}
