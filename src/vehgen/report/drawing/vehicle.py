"""The vehicle to scale, with its dimensions."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Circle, FancyBboxPatch, Rectangle

from vehgen.files.expressions import Expression
from vehgen.mechanics import EquationsOfMotion, ModelLike, all_values, as_model
from vehgen.mechanics.symbols import to_sympy
from vehgen.report.drawing.canvas import ACCENT, FAINT, FILLS, INK, Canvas, Spot, text_size, within, wrap
from vehgen.report.drawing.dimensions import Chain, draw_chains, draw_hinge_heights
from vehgen.report.drawing.marks import draw_marks, marked_parts
from vehgen.report.drawing.sketch import Sketch, make_sketch
from vehgen.report.drawing.symbols import draw_bending, draw_ceiling, draw_pin_resistance
from vehgen.vehicle.parts import GROUND, Axle, Hinge, Spring

_TEXT = 8.5
_ROW, _TILT = 25.0, 35.0
"""Height of a row of dimensions in points; slope of crowded names in degrees."""


def draw_vehicle(
    model: ModelLike, values: Mapping[str, float] | None = None, *, parameter_set: str | None = None, marked: Sequence[str] = ()
) -> Figure:
    """Draw a side view to scale: bodies, axles, hinges, links, COGs, and their distances [m].

    Parameters
    ----------
    model, values, parameter_set
        As in :func:`vehgen.natural_modes`.
    marked
        Places to ring, as a diagnosis calls them: `tyre rear`, `axle4 and axle5`, `fifth_wheel`.

    Notes
    -----
    Outlines that the file does not give (`size`) are dashed, and so are heights above the road: it gives heights only relative to
    each other.
    """
    model = as_model(model)
    values = all_values(model, values, parameter_set)
    sketch = make_sketch(model, values)
    names = {name: axle.title or name for name, axle in model.vehicle.axles.items()}
    canvas, depth, chains = _canvas(model, sketch, names)
    _draw_road(canvas, sketch)
    for index, name in enumerate(sketch.boxes):
        _draw_body(canvas, name, sketch, FILLS[index % len(FILLS)])
    for name, axle in model.vehicle.axles.items():
        _draw_axle(canvas, name, axle, sketch)
    for name, link in model.vehicle.links.items():
        strut = sketch.links[name]
        canvas.spring_damper(strut.x, strut.bottom, strut.top, _acts(link.k), _acts(link.c), ACCENT, law=bool(link.laws))
        if strut.upper == GROUND:
            draw_ceiling(canvas, strut.x, strut.top)
    everything = model.vehicle.all_values({name: values[name] for name in model.vehicle.free_parameters})
    for name, body in model.vehicle.bodies.items():
        if body.bending is not None:
            draw_bending(canvas, sketch.boxes[name], body.bending.length.evaluate(everything))
    for name, (x, z) in sketch.hinges.items():
        _draw_hinge(canvas, name, x, z, model.vehicle.hinges[name])
    draw_hinge_heights(canvas, model, sketch, _TEXT - 1)
    draw_chains(canvas, chains, -depth, _ROW, _TEXT - 0.5)
    _name_axles(canvas, sketch, names)
    _name_parts(canvas, model, sketch)
    draw_marks(canvas, sketch, marked_parts(model, marked))
    return canvas.figure


def _acts(quantity: Expression) -> bool:
    """Tell whether a stiffness or damping is anything but a plain zero."""
    return bool(to_sympy(quantity) != 0)


def _canvas(model: EquationsOfMotion, sketch: Sketch, names: Mapping[str, str]) -> tuple[Canvas, float, list[Chain]]:
    """Choose the scale and the room around the vehicle; also returns how far below the road the dimensions begin [m], and these."""
    length = sketch.right - sketch.left
    scale = float(np.clip(10.3 / length, min(0.45, 60.0 / length), 1.15))
    point = 1 / (72 * scale)
    margin = max(64 * point, (7.2 / scale - length) / 2)
    left, right = sketch.left - margin, sketch.right + margin
    width = (right - left) / point - 24
    title = wrap(model.vehicle.title or model.vehicle.name, 12, width, bold=True)
    notes = wrap(_notes(model, sketch), 8, width)
    head = 15 * len(title) + 11 * len(notes) + 46
    crowded = _crowded(sketch, names, point)
    chains = _chains(model, sketch, 0.0 if crowded else -19 * point)
    slant = max((text_size(name, _TEXT)[0] for name in names.values()), default=0.0) * math.sin(math.radians(_TILT))
    depth = (20 + slant if crowded else 26) * point
    canvas = Canvas((left, -depth - (len(chains) * _ROW + 14) * point, right, sketch.top + head * point), scale)
    z = canvas.top - 8 * point
    for texts, size, step, color in ((title, 12, 15, INK), (notes, 8, 11, FAINT)):
        for text in texts:
            canvas.write(text, (left + 12 * point, z, "left", "top"), size, color, bold=size == 12)
            z -= step * point
    canvas.take(left, z, right, canvas.top)
    _draw_convention(canvas, right - 52 * point, canvas.top - (head + 12) * point)
    canvas.take(left, -depth, right, -2 * point)
    return canvas, depth, chains


def _notes(model: EquationsOfMotion, sketch: Sketch) -> str:
    notes = ["To scale; lengths in metres; heights above the road are assumed."]
    if not all(box.declared for box in sketch.boxes.values()):
        notes.append("Dashed outlines are not in the vehicle file.")
    if any(element.laws for element in model.elements):
        notes.append("An arrow across a symbol: a force law.")
    if any(body.bending is not None for body in model.vehicle.bodies.values()):
        notes.append("A dash-dotted line: how a body bends.")
    return " ".join(notes)


def _chains(model: EquationsOfMotion, sketch: Sketch, road: float) -> list[Chain]:
    """Choose what is dimensioned in a row: the axles; COGs and hinges from the front axle; carried bodies from their carriers."""
    axles = [(x, road) for x in sketch.axles.values()]
    carried = {name: body.carried_by.body for name, body in model.vehicle.bodies.items() if body.carried_by is not None}
    main = [(box.x, box.z) for name, box in sketch.boxes.items() if name not in carried]
    chains = [Chain("axles", INK, axles), Chain("COGs and hinges", ACCENT, [*main, *sketch.hinges.values(), *sorted(axles)[-1:]])]
    if carried:
        pairs = {*carried, *carried.values()}
        chains.append(Chain("carried bodies", "#6b4a86", [(box.x, box.z) for name, box in sketch.boxes.items() if name in pairs]))
    return [chain for chain in chains if len(chain.marks()) > 1]


def _draw_road(canvas: Canvas, sketch: Sketch) -> None:
    left, right = sketch.left - 20 * canvas.point, sketch.right + 20 * canvas.point
    canvas.line([left, right], [0, 0], INK, 1.3)
    step, size = 9 * canvas.point, 4 * canvas.point
    hatch = [point for x in np.arange(left + size, right, step) for point in ((x, 0.0), (x - size, -size), (np.nan, np.nan))]
    canvas.line([x for x, _ in hatch], [z for _, z in hatch], FAINT, 0.6)


def _draw_body(canvas: Canvas, name: str, sketch: Sketch, fill: str) -> None:
    box = sketch.boxes[name]
    for body, x, z in sketch.arms:
        edge = box.edge(x, z)
        if body == name and edge != (x, z):
            canvas.arm((edge, (x, z)), fill)
    corner = min(4 * canvas.point, 0.4 * (box.top - box.bottom))
    patch = FancyBboxPatch(
        (box.left, box.bottom), box.right - box.left, box.top - box.bottom, boxstyle=f"round,pad=0,rounding_size={corner}",
        facecolor=fill, edgecolor=INK, lw=1.0, linestyle="-" if box.declared else (0, (4, 2)), alpha=0.85, zorder=2, gid=f"body-{name}",
    )  # fmt: skip
    canvas.axes.add_patch(patch)
    thin = 1.5 * canvas.point
    for x in (box.left, box.right):
        canvas.take(x - thin, box.bottom, x + thin, box.top)
    for z in (box.bottom, box.top):
        canvas.take(box.left, z - thin, box.right, z + thin)
    canvas.cog(box.x, box.z, min(6 * canvas.point, 0.35 * (box.top - box.bottom)), name)


def _draw_axle(canvas: Canvas, name: str, axle: Axle, sketch: Sketch) -> None:
    x, radius = sketch.axles[name], sketch.wheel_radius
    canvas.axes.add_patch(Circle((x, radius), radius, facecolor="#aab4bd", edgecolor=INK, lw=0.9, zorder=3, gid=f"wheel-{name}"))
    canvas.axes.add_patch(Circle((x, radius), 0.72 * radius, facecolor="#eef1f3", edgecolor=FAINT, lw=0.5, zorder=3))
    canvas.take(x - radius, 0, x + radius, 2 * radius)
    half = min(5.0, 0.17 * radius / canvas.point)
    canvas.spring_damper(x, 0.0, 0.85 * radius, _acts(axle.tyre.k), _acts(axle.tyre.c), half=half, law=bool(axle.tyre.laws))
    if axle.suspension is None:
        canvas.axes.add_patch(Circle((x, radius), 0.13 * radius, facecolor="white", edgecolor=INK, lw=1.0, zorder=5))
        return
    block = Rectangle((x - 0.32 * radius, 0.85 * radius), 0.64 * radius, 0.3 * radius, facecolor=INK, zorder=5, gid=f"unsprung-{name}")
    canvas.axes.add_patch(block)
    spring: Spring = axle.suspension
    strut = sketch.suspensions[name]
    canvas.spring_damper(strut.x, strut.bottom, strut.top, _acts(spring.k), _acts(spring.c), law=bool(spring.laws))


def _draw_hinge(canvas: Canvas, name: str, x: float, z: float, hinge: Hinge) -> None:
    radius = 3.6 * canvas.point
    canvas.axes.add_patch(Circle((x, z), radius, facecolor="white", edgecolor=ACCENT, lw=1.6, zorder=7, gid=f"hinge-{name}"))
    canvas.take(x - radius, z - radius, x + radius, z + radius)
    draw_pin_resistance(canvas, x, z, _acts(hinge.k), _acts(hinge.c))
    if hinge.laws:
        canvas.spring_damper(x, z - 2 * radius, z + 2 * radius, spring=False, damper=False, law=True)


def _crowded(sketch: Sketch, names: Mapping[str, str], point: float) -> bool:
    """Tell whether neighbouring axles stand too close for their names to be written side by side."""
    ordered = sorted((x, text_size(names[name], _TEXT)[0] * point) for name, x in sketch.axles.items())
    return any(right - left < (one + two) / 2 + 5 * point for (left, one), (right, two) in itertools.pairwise(ordered))


def _name_axles(canvas: Canvas, sketch: Sketch, names: Mapping[str, str]) -> None:
    crowded = _crowded(sketch, names, canvas.point)
    for name, x in sketch.axles.items():
        if crowded:
            canvas.write(names[name], (x + 3 * canvas.point, -9 * canvas.point, "right", "top"), _TEXT, rotation=_TILT, halo=True)
        else:
            canvas.write(names[name], (x, -7 * canvas.point, "center", "top"), _TEXT, halo=True)


def _name_parts(canvas: Canvas, model: EquationsOfMotion, sketch: Sketch) -> None:
    """Write the names of bodies, hinges and links where there is room."""
    boxes = {name: (box.left, box.bottom, box.right, box.top) for name, box in sketch.boxes.items()}
    pad = 4 * canvas.point
    for name, box in sketch.boxes.items():
        text = model.vehicle.bodies[name].title or name
        inside: list[Spot] = [
            (box.left + pad, box.top - pad, "left", "top"),
            (box.right - pad, box.top - pad, "right", "top"),
            (box.left + pad, box.bottom + pad, "left", "bottom"),
            (box.right - pad, box.bottom + pad, "right", "bottom"),
            *((box.left + share * (box.right - box.left), box.top - pad, "center", "top") for share in (0.3, 0.5, 0.7)),
            *((box.left + share * (box.right - box.left), box.z, "center", "center") for share in (0.15, 0.3, 0.5, 0.7, 0.85)),
        ]
        spots = [spot for spot in inside if within(canvas.extent(text, spot, _TEXT, bold=True), boxes[name])]
        spots += [(box.x, box.top + pad, "center", "bottom"), (box.x, box.bottom - pad, "center", "top")]
        spots += canvas.around(box.x, box.z, 8.0)
        avoid = [other for key, other in boxes.items() if key != name]
        canvas.label(text, spots, _TEXT, bold=True, avoid=avoid, anchor=(box.x, box.z), home=boxes[name])
    for name, (x, z) in sketch.hinges.items():
        title = model.vehicle.hinges[name].title or name
        canvas.label(title, list(canvas.around(x, z, 7.0)), _TEXT - 0.5, ACCENT, anchor=(x, z))
    for name, strut in sketch.links.items():
        title = model.vehicle.links[name].title or name
        middle, half = (strut.bottom + strut.top) / 2, 10 * canvas.point
        home = (strut.x - half, strut.bottom, strut.x + half, strut.top)
        canvas.label(title, list(canvas.around(strut.x, middle, 12.0)), _TEXT - 0.5, ACCENT, anchor=(strut.x, middle), home=home)


def _draw_convention(canvas: Canvas, x: float, z: float) -> None:
    """Draw x forward, z up and the sense of positive pitch (nose down)."""
    arm, arrow = 26 * canvas.point, {"arrowstyle": "-|>", "color": FAINT, "lw": 1.0, "shrinkA": 0, "shrinkB": 0, "mutation_scale": 9}
    canvas.axes.annotate("", (x + arm, z), (x, z), arrowprops=arrow)
    canvas.axes.annotate("", (x, z + arm), (x, z), arrowprops=arrow)
    bend = {**arrow, "connectionstyle": "arc3,rad=-0.45"}
    canvas.axes.annotate("", (x + 0.72 * arm, z + 0.16 * arm), (x + 0.16 * arm, z + 0.72 * arm), arrowprops=bend)
    for text, spot in (("x", (x + 1.1 * arm, z, "left", "center")), ("z", (x, z + 1.1 * arm, "center", "bottom"))):
        canvas.write(text, spot, _TEXT - 0.5, FAINT)
    canvas.write("pitch", (x + 0.62 * arm, z + 0.6 * arm, "left", "bottom"), _TEXT - 1, FAINT)
    canvas.take(x - 6 * canvas.point, z - 6 * canvas.point, canvas.right, z + 1.6 * arm)
