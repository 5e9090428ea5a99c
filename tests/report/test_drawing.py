"""The drawing is to scale, says the right numbers, and can be read."""

import itertools
from functools import cache

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.patches import Circle

from tests.bundled import few
from tests.report.vehicles import EVERY, HOSTILE, model, random_model
from vehgen.mechanics import derive
from vehgen.report import draw_modes, draw_vehicle, figure_svg
from vehgen.report.drawing.dimensions import Chain, length_text
from vehgen.report.drawing.mode_shapes import mode_movements
from vehgen.report.drawing.sketch import make_sketch
from vehgen.simulate import natural_modes
from vehgen.vehicle import parse_vehicle


def artists(figure):
    return {item.get_gid(): item for item in figure.axes[0].get_children() if item.get_gid()}


@cache
def drawn(name):
    """Return the drawing of a vehicle, to look at only."""
    return draw_vehicle(model(name))


def texts(figure):
    return [text.get_text() for text in figure.axes[0].texts if text.get_text()]


def positions(m, owner):
    values = m.values()
    places = {"axles": m.layout.axles, "bodies": {name: x for name, (x, _) in m.layout.bodies.items()}}[owner]
    return dict(zip(places, m.evaluate_list(places.values(), values), strict=True))


@pytest.mark.parametrize("name", few(EVERY))
def test_everything_is_drawn_at_its_place(name):
    m = model(name)
    found = artists(drawn(name))
    for axle, x in positions(m, "axles").items():
        wheel = found[f"wheel-{axle}"]
        assert isinstance(wheel, Circle)
        assert wheel.center == pytest.approx((x, wheel.radius))
        assert (f"unsprung-{axle}" in found) == (m.vehicle.axles[axle].suspension is not None)
    for body, x in positions(m, "bodies").items():
        cog = found[f"cog-{body}"].center
        assert cog[0] == pytest.approx(x)
        outline = found[f"body-{body}"].get_bbox()
        assert outline.x0 < cog[0] < outline.x1
        assert outline.y0 < cog[1] < outline.y1
    assert {f"hinge-{hinge}" for hinge in m.vehicle.hinges} <= set(found)


@pytest.mark.parametrize("name", few(EVERY))
def test_a_metre_is_as_long_in_every_direction(name):
    axes = drawn(name).axes[0]
    width, height = axes.figure.get_size_inches()
    (left, right), (low, high) = axes.get_xlim(), axes.get_ylim()
    assert width / (right - left) == pytest.approx(height / (high - low))
    assert axes.get_position().bounds == pytest.approx((0.0, 0.0, 1.0, 1.0))


def test_the_dimensions_of_the_five_axle_truck():
    shown = texts(drawn("tractor5"))
    for length in ("3.46", "1.34", "7.45", "1.23", "4.14", "2.43", "1.32", "0.97", "0.82"):
        assert length in shown


@pytest.mark.parametrize("name", few(EVERY))
def test_dimensions_are_the_distances_between_axles(name):
    m = model(name)
    shown = texts(drawn(name))
    places = sorted(positions(m, "axles").values())
    wanted = [length_text(right - left) for left, right in itertools.pairwise(places)]
    for length in set(wanted):
        assert shown.count(length) >= wanted.count(length)


@pytest.mark.parametrize("name", few(EVERY))
def test_heights_of_pins_over_cogs_are_true(name):
    m = model(name)
    found = artists(drawn(name))
    everything = m.vehicle.all_values(m.vehicle.values())
    for hinge_name, hinge in m.vehicle.hinges.items():
        pin = found[f"hinge-{hinge_name}"].center
        for body, point in hinge.points.items():
            cog = found[f"cog-{body}"].center
            assert pin[0] - cog[0] == pytest.approx(point.x.evaluate(everything))
            assert pin[1] - cog[1] == pytest.approx(point.z.evaluate(everything))


@pytest.mark.parametrize("name", few(EVERY))
def test_no_body_lies_in_the_wheels_and_all_is_above_the_road(name):
    sketch = make_sketch(model(name), model(name).values())
    for body, box in sketch.boxes.items():
        beam = box.top - box.bottom < 0.3
        assert box.bottom > 0
        assert beam or not sketch.axles or box.top > 2 * sketch.wheel_radius, body
    for strut in (*sketch.suspensions.values(), *sketch.links.values()):
        assert strut.top - strut.bottom > 0.1


@pytest.mark.parametrize("name", few(EVERY))
def test_names_are_all_there_and_do_not_hide_each_other(name):
    m = model(name)
    figure = drawn(name)
    shown = texts(figure)
    for group in (m.vehicle.bodies, m.vehicle.axles, m.vehicle.hinges, m.vehicle.links):
        for key, item in group.items():
            assert (item.title or key) in shown
    renderer = FigureCanvasAgg(figure).get_renderer()
    upright = [text for text in figure.axes[0].texts if text.get_text() and text.get_rotation() == 0]
    boxes = [text.get_window_extent(renderer) for text in upright]
    frame = figure.bbox
    for text, box in zip(upright, boxes, strict=True):
        assert frame.x0 - 1 <= box.x0 <= box.x1 <= frame.x1 + 1, text.get_text()
        assert frame.y0 - 1 <= box.y0 <= box.y1 <= frame.y1 + 1, text.get_text()
    for (one, a), (two, b) in itertools.combinations(zip(upright, boxes, strict=True), 2):
        width, height = min(a.x1, b.x1) - max(a.x0, b.x0), min(a.y1, b.y1) - max(a.y0, b.y0)
        smaller = min(a.width * a.height, b.width * b.height)
        shared = width * height / smaller if width > 0 and height > 0 else 0.0
        assert shared < 0.25, (one.get_text(), two.get_text())


def test_a_title_is_never_read_as_mathematics():
    shown = " ".join(texts(drawn("with_laws")))
    assert HOSTILE in shown


def test_the_figure_grows_with_the_vehicle_and_stays_legible():
    short, long = (drawn(name) for name in ("sedan2", "road_train"))
    assert long.get_size_inches()[0] > 2.5 * short.get_size_inches()[0]
    assert min(text.get_fontsize() for text in long.axes[0].texts if text.get_text()) >= 6.0


def test_only_what_acts_is_drawn():
    pattern = """
name: one
bodies: {{body: {{mass: 400 kg, motions: [heave]}}}}
axles: {{wheel: {{body: body, mass: 40 kg, suspension: {{k: 20 kN/m, c: {c}}}, tyre: {{k: 200 kN/m}}}}}}
"""
    without, with_damper = (len(draw_vehicle(derive(parse_vehicle(pattern.format(c=c)))).axes[0].lines) for c in ("0 N s/m", "1 kN s/m"))
    assert with_damper > without


def test_marks_at_one_place_are_one():
    chain = Chain("axles", "k", [(1.0, 0.0), (1.001, 2.0), (3.0, 0.0)])
    assert [x for x, _ in chain.marks()] == [1.0, 3.0]


@pytest.mark.parametrize(("value", "text"), [(3.46, "3.46"), (3.4600001, "3.46"), (3.925, "3.925"), (10.0, "10.00"), (0.1, "0.10")])
def test_lengths_have_two_or_three_decimals(value, text):
    assert length_text(value) == text


@pytest.mark.parametrize("name", few(EVERY))
def test_every_mode_has_its_panel_with_its_numbers(name):
    m = model(name)
    modes = natural_modes(m)
    figure = draw_modes(m, modes)
    shown = " ".join(texts(figure))
    for number, mode in enumerate(modes, 1):
        assert f"{number}. {mode.name}" in shown
        for value in (f"{mode.undamped_hz:.2f} Hz", f"{mode.damped_hz:.2f} Hz", f"{mode.damping_ratio:.3f}"):
            assert value in shown
        for body in m.vehicle.bodies:
            assert f"mode-{number}-{body}" in artists(figure)
    assert figure.get_size_inches()[0] < 12.0


@pytest.mark.parametrize("name", few(EVERY))
def test_bodies_stay_together_at_their_pins_and_keep_their_momentum(name):
    m = model(name)
    values = m.values()
    modes = natural_modes(m)
    sketch = make_sketch(m, values)
    everything = m.vehicle.all_values(m.vehicle.values())
    for mode, movement in zip(modes, mode_movements(m, modes, values), strict=True):
        for hinge_name, hinge in m.vehicle.hinges.items():
            one, two = (movement.point(sketch, body, *sketch.hinges[hinge_name]) for body in hinge.points)
            assert one == pytest.approx(two, abs=1e-9)
        momentum = sum(body.mass.evaluate(everything) * movement.bodies[key][0] for key, body in m.vehicle.bodies.items())
        assert momentum == pytest.approx(0.0, abs=1e-6)
        for axle, rise in movement.wheels.items():
            hop = [i for i, item in enumerate(m.coordinates) if item.name == f"hop.{axle}"]
            assert not hop or rise == mode.shape[hop[0]]


def test_modes_are_drawn_with_the_sign_of_the_convention():
    m = model("sedan2")
    mode = next(item for item in natural_modes(m) if "pitch" in item.name)
    movement = mode_movements(m, [mode], m.values())[0]
    sketch = make_sketch(m, m.values())
    _, _, pitch = movement.bodies["body"]
    nose, tail = (movement.point(sketch, "body", sketch.boxes["body"].x + x, sketch.boxes["body"].z)[1] for x in (1.0, -1.0))
    assert tail - nose == pytest.approx(2 * pitch)


def test_the_largest_motion_is_alike_in_all_modes():
    m = model("tractor5")
    figure = draw_modes(m, natural_modes(m))
    shapes = artists(figure)
    assert len([key for key in shapes if key.startswith("mode-")]) == 8 * 2
    assert all(np.isfinite(shape.get_xy()).all() for shape in shapes.values())


@pytest.mark.parametrize("seed", [0, 1, 2, *(pytest.param(seed, marks=pytest.mark.thorough) for seed in range(3, 12))])
def test_any_vehicle_can_be_drawn(seed):
    m = random_model(seed)
    figure = draw_vehicle(m)
    for axle, x in positions(m, "axles").items():
        assert artists(figure)[f"wheel-{axle}"].center[0] == pytest.approx(x)
    assert "nan" not in figure_svg(figure)
    assert figure_svg(draw_modes(m, natural_modes(m))).count("<g id=") > m.n_dof


def test_an_absurdly_long_vehicle_still_fits_a_file():
    text = "name: long\nbodies: {b: {mass: 1 t, pitch_inertia: 1 t m^2}}\naxles:\n"
    text += "".join(f"  w{x}: {{body: b, x: {x} m, tyre: {{k: 1 MN/m}}}}\n" for x in (0, 990))
    assert draw_vehicle(derive(parse_vehicle(text))).get_size_inches()[0] < 80


def test_a_hinged_beam_stands_at_its_hubs_and_gets_no_false_height():
    text = """
name: beam
bodies:
  frame: {mass: 10 t, pitch_inertia: 30 t m^2}
  beam: {mass: 300 kg, pitch_inertia: 100 kg m^2}
hinges: {pivot: {frame: {x: -2 m, z: -0.44 m}, beam: {x: 0 m, z: 0.17 m}}}
axles:
  front: {body: frame, x: 3 m, mass: 500 kg, suspension: {k: 300 kN/m, c: 10 kN s/m}, tyre: {k: 1 MN/m}}
  r1: {body: beam, x: 0.65 m, tyre: {k: 2 MN/m}}
  r2: {body: beam, x: -0.65 m, tyre: {k: 2 MN/m}}
"""
    m = derive(parse_vehicle(text))
    sketch = make_sketch(m, m.values())
    assert sketch.boxes["beam"].z == sketch.wheel_radius
    assert not sketch.boxes["beam"].height_known
    shown = texts(draw_vehicle(m))
    assert "0.44" in shown
    heights = {"0.17", length_text(sketch.hinges["pivot"][1] - sketch.wheel_radius)}
    assert not heights & set(shown)
