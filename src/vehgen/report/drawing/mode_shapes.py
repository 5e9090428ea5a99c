"""Mode shapes drawn on the vehicle."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Polygon
from numpy.typing import NDArray

from vehgen.mechanics import EquationsOfMotion
from vehgen.mechanics.rows import SparseMatrix
from vehgen.mechanics.symbols import to_sympy
from vehgen.report.drawing.canvas import FAINT, FILLS, GHOST, INK, Canvas, text_size, wrap
from vehgen.report.drawing.sketch import Sketch, make_sketch
from vehgen.simulate import Mode

Array = NDArray[np.float64]
_TITLE_GAP, _LINE_HEIGHT = 14.0, 11.5
"""Space around a panel and height of a line of text, in points."""
_BENT_POINTS = 17
"""Points along the long sides of a body that bends."""
_BREAK = (np.nan, np.nan)


@dataclass(frozen=True)
class Movement:
    """How a mode moves every part: (forward, up, pitch) of each body's COG [m, rad], rise of each wheel [m].

    `bending` holds what bends: how far its ends rise against heave and pitch, and over what length it bends [m].
    """

    bodies: dict[str, tuple[float, float, float]]
    wheels: dict[str, float]
    bending: dict[str, tuple[float, float]] = field(default_factory=dict)

    def point(self, sketch: Sketch, body: str, x: float, z: float) -> tuple[float, float]:
        """Return how far a body's point moves forward and up [m]."""
        forward, up, pitch = self.bodies[body]
        box = sketch.boxes[body]
        rise, length = self.bending.get(body, (0.0, 1.0))
        return forward + pitch * (z - box.z), up - pitch * (x - box.x) + rise * (6 * ((x - box.x) / length) ** 2 - 0.5)


def mode_movements(model: EquationsOfMotion, modes: Sequence[Mode], values: Mapping[str, float]) -> list[Movement]:
    """Return the movement of every part in every mode, fore-aft motion of hinged bodies included."""
    bodies, n = list(model.vehicle.bodies), model.n_dof
    rows = [row for name in bodies for row in (model.motion.fore_aft[name], model.motion.heave[name], model.motion.pitch[name])]
    for name, axle in model.vehicle.axles.items():
        rows.append(model.motion.hop[name] if name in model.motion.hop else model.motion.rise(axle.body, to_sympy(axle.x)))
    bent, everything = model.motion.bending, model.vehicle.all_values({name: values[name] for name in model.vehicle.free_parameters})
    lengths = {name: bending.length.evaluate(everything) for name in bent if (bending := model.vehicle.bodies[name].bending) is not None}
    rows += [bent[name].row for name in lengths]
    masses = [term.inertia for group in model.energies.fore_aft.values() for term in group]
    entries: SparseMatrix = {(i, j): value for i, row in enumerate(rows) for j, value in row.items()}
    matrix = model.evaluate_matrix(entries, (len(rows), n), values)
    weights = np.array(model.evaluate_list(masses, values))
    start = 0
    for group in model.energies.fore_aft.values():
        members = [3 * bodies.index(term.owner) for term in group]
        share = weights[start : start + len(group)]
        if share.sum() > 0:
            matrix[members] -= share @ matrix[members] / share.sum()
        start += len(group)
    found = []
    for mode in modes:
        moved = matrix @ mode.shape
        places = {name: (float(moved[3 * i]), float(moved[3 * i + 1]), float(moved[3 * i + 2])) for i, name in enumerate(bodies)}
        wheels = {name: float(moved[3 * len(bodies) + i]) for i, name in enumerate(model.vehicle.axles)}
        ends = moved[3 * len(bodies) + len(wheels) :]
        found.append(Movement(places, wheels, {name: (float(end), lengths[name]) for name, end in zip(lengths, ends, strict=True)}))
    return found


@dataclass
class _Strokes:
    """What all panels share, gathered so that each kind is drawn once: points of lines (broken by NaN) and centres of circles."""

    rest: list[tuple[float, float]] = field(default_factory=list)
    roads: list[tuple[float, float]] = field(default_factory=list)
    struts: list[tuple[float, float]] = field(default_factory=list)
    arms: list[tuple[float, float]] = field(default_factory=list)
    wheels_at_rest: list[tuple[float, float]] = field(default_factory=list)
    wheels: list[tuple[float, float]] = field(default_factory=list)
    pins: list[tuple[float, float]] = field(default_factory=list)

    def draw(self, canvas: Canvas, radius: float) -> None:
        """Draw everything."""
        for points, color, width, zorder in (
            (self.rest, GHOST, 0.9, 1.5),
            (self.roads, FAINT, 0.7, 1.0),
            (self.struts, FAINT, 0.9, 2.2),
            (self.arms, INK, 1.0, 3.0),
        ):
            if points:
                canvas.line([x for x, _ in points], [z for _, z in points], color, width, zorder)
        wheel = 2 * radius / canvas.point
        canvas.dots(self.wheels_at_rest, wheel, "none", GHOST, 1.5)
        canvas.dots(self.wheels, wheel, "#aab4bd", INK, 3.0)
        canvas.dots(self.wheels, 0.2 * wheel, INK, INK, 3.1)
        canvas.dots(self.pins, 3.6, "white", INK, 4.0)


def draw_modes(model: EquationsOfMotion, modes: Sequence[Mode], values: Mapping[str, float] | None = None) -> Figure:
    """Draw every mode over the vehicle at rest (grey), the largest motion alike in all."""
    values = values or model.values()
    sketch = make_sketch(model, values)
    length = sketch.right - sketch.left
    swing = float(np.clip(0.028 * length, 0.2, 1.0))
    columns = min(2 if length > 9 else 3 if length > 3 else 4, max(len(modes), 1))
    rows = max(-(-len(modes) // columns), 1)
    wide = 11.4 / columns if columns > 2 else 5.7
    scale = min((wide - 2 * _TITLE_GAP / 72) / length, 0.9)
    point = 1 / (72 * scale)
    width = max(wide / scale, length + 2 * _TITLE_GAP * point)
    titles = [_titles(i, mode, width / point - 2 * _TITLE_GAP) for i, mode in enumerate(modes, 1)]
    head = max((_LINE_HEIGHT * len(lines) for lines in titles), default=0.0) * point
    height = sketch.top + 2 * swing + head + 2 * _TITLE_GAP * point
    canvas, strokes = Canvas((0.0, 0.0, columns * width, rows * height), scale), _Strokes()
    for place, movement in enumerate(mode_movements(model, modes, values)):
        left, top = place % columns * width, (rows - place // columns) * height
        for line, text in enumerate(titles[place]):
            last = line == len(titles[place]) - 1
            spot = (left + _TITLE_GAP * point, top - (0.6 * _TITLE_GAP + _LINE_HEIGHT * line) * point, "left", "top")
            canvas.write(text, spot, 8.0 if last else 9.0, INK, bold=not last)
        origin = (left + _TITLE_GAP * point - sketch.left, top - height + swing + 0.5 * _TITLE_GAP * point)
        _draw_mode(canvas, strokes, sketch, model, movement, swing, origin, place + 1)
    strokes.draw(canvas, sketch.wheel_radius)
    return canvas.figure


def _titles(number: int, mode: Mode, width: float) -> list[str]:
    """Return a mode's name, on as many lines as it needs, and its numbers."""
    data = f"{mode.undamped_hz:.2f} Hz undamped, {mode.damped_hz:.2f} Hz damped, damping ratio {mode.damping_ratio:.3f}"
    if text_size(data, 8.0)[0] > width:
        data = f"{mode.undamped_hz:.2f} Hz, damped {mode.damped_hz:.2f} Hz, ratio {mode.damping_ratio:.3f}"
    return [*wrap(f"{number}. {mode.name}", 9.0, width, bold=True), data]


def _draw_mode(
    canvas: Canvas,
    strokes: _Strokes,
    sketch: Sketch,
    model: EquationsOfMotion,
    movement: Movement,
    swing: float,
    origin: tuple[float, float],
    number: int,
) -> None:
    largest = max((abs(rise) for rise in movement.wheels.values()), default=0.0)
    for name, box in sketch.boxes.items():
        ends = [movement.point(sketch, name, x, z) for x, z in box.corners()]
        largest = max([largest, *(max(abs(forward), abs(up)) for forward, up in ends)])
    factor = swing / max(largest, 1e-12)
    shift, ground = origin
    radius = sketch.wheel_radius

    def moved(body: str, x: float, z: float) -> tuple[float, float]:
        forward, up = movement.point(sketch, body, x, z) if body in sketch.boxes else (0.0, 0.0)
        return x + shift + factor * forward, z + ground + factor * up

    hubs = {name: (x + shift, radius + ground + factor * movement.wheels[name]) for name, x in sketch.axles.items()}
    strokes.roads += [(sketch.left + shift, ground), (sketch.right + shift, ground), _BREAK]
    strokes.wheels_at_rest += [(x + shift, radius + ground) for x in sketch.axles.values()]
    strokes.wheels += hubs.values()
    for body, x, z in sketch.arms:
        strokes.arms += [moved(body, *sketch.boxes[body].edge(x, z)), moved(body, x, z), _BREAK]
    for name, strut in sketch.suspensions.items():
        strokes.struts += [hubs[name], moved(strut.upper, strut.x, strut.top), _BREAK]
    for strut in sketch.links.values():
        strokes.struts += [moved(strut.lower, strut.x, strut.bottom), moved(strut.upper, strut.x, strut.top), _BREAK]
    for name, (x, z) in sketch.hinges.items():
        strokes.pins.append(moved(next(iter(model.vehicle.hinges[name].points)), x, z))
    for index, (name, box) in enumerate(sketch.boxes.items()):
        corners = box.outline(_BENT_POINTS if name in movement.bending else 2)
        strokes.rest += [(x + shift, z + ground) for x, z in (*corners, corners[0])] + [_BREAK]
        shape = [moved(name, x, z) for x, z in corners]
        fill = FILLS[index % len(FILLS)]
        patch = Polygon(shape, closed=True, facecolor=fill, edgecolor=INK, lw=0.9, alpha=0.85, zorder=2.5, gid=f"mode-{number}-{name}")
        canvas.axes.add_patch(patch)
