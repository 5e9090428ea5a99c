"""A vehicle as an SVG whose parts can move: mode shapes and a drive over a hump, for a script of the page to set in motion.

Every element says where its points rest (`data-rest`) and how they move: in a mode `data-move`, the displacement at full swing; in
a drive `data-rows`, how far each coordinate moves each point. Without the script a page shows the mode at full swing, the drive at rest.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from markupsafe import Markup, escape

from vehgen.mechanics import EquationsOfMotion
from vehgen.report.drawing.mode_shapes import Movement, mode_movements
from vehgen.report.drawing.sketch import Sketch, make_sketch
from vehgen.simulate import Mode
from vehgen.simulate.hump_drive import DRIVE_HUMP_HEIGHT, DRIVE_HUMP_LENGTH, DRIVE_SPEED, FRAMES_PER_SECOND, HumpDrive

_UNIT = 100
"""User units of the drawing a metre."""
_BENT_SIDES = 17
_SHOWN_HUMP_M = 0.3
"""A hump is drawn so high; all motion is magnified alike [m]."""
Points = list[tuple[float, float]]


@dataclass(frozen=True)
class Part:
    """A polygon, polyline or circle: its style, the name and points [m] at rest, and what each point is fixed to (a part of the sketch)."""

    style: str
    title: str
    points: Points
    owners: list[str]
    radius: float = 0.0


def mode_pictures(model: EquationsOfMotion, modes: Sequence[Mode], values: Mapping[str, float]) -> list[Markup]:
    """Return a moving picture of every mode, the largest motion alike in all."""
    sketch = make_sketch(model, values)
    swing = float(np.clip(0.028 * (sketch.right - sketch.left), 0.2, 1.0))
    found = []
    for mode, movement in zip(modes, mode_movements(model, modes, values), strict=True):
        parts = list(_parts(model, sketch, movement))
        moves = [
            [_displacement(sketch, movement, owner, *point) for owner, point in zip(part.owners, part.points, strict=True)]
            for part in parts
        ]
        largest = max((abs(item) for row in moves for pair in row for item in pair), default=0.0)
        factor = swing / max(largest, 1e-12)
        body = "".join(_moving(part, [(factor * x, factor * z) for x, z in row]) for part, row in zip(parts, moves, strict=True))
        ghost = "".join(_shape(replace(part, style="rest"), part.points, "") for part in parts if part.style.startswith(("body", "wheel")))
        found.append(_picture(sketch, swing, f"Mode shape: {mode.name}", ghost + body, "data-mode"))
    return found


def drive_picture(model: EquationsOfMotion, values: Mapping[str, float], drive: HumpDrive) -> Markup:
    """Return a moving picture of a drive over a hump, its motion magnified."""
    sketch = make_sketch(model, values)
    units = [Mode("", 0.0, 0.0, 0.0, row, row) for row in np.eye(model.n_dof)]
    movements = mode_movements(model, units, values)
    still = replace(movements[0], bending={name: (0.0, length) for name, (_, length) in movements[0].bending.items()})
    factor = _SHOWN_HUMP_M / DRIVE_HUMP_HEIGHT
    body = ""
    for part in _parts(model, sketch, still):
        rows = [
            [
                [j, round(_UNIT * dx, 2), round(-_UNIT * dz, 2)]
                for j, movement in enumerate(movements)
                for dx, dz in [_displacement(sketch, movement, owner, *point)]
                if max(abs(dx), abs(dz)) > 1e-6
            ]
            for owner, point in zip(part.owners, part.points, strict=True)
        ]
        body += _shape(
            part, part.points, f' data-rest="{_written(part.points)}" data-rows="{escape(json.dumps(rows, separators=(",", ":")))}"'
        )
    first = max(sketch.axles.values())
    arch = [(first + drive.start + DRIVE_HUMP_LENGTH * s, _SHOWN_HUMP_M * float(np.sin(np.pi * s))) for s in np.linspace(0.0, 1.0, 13)]
    hump = _shape(Part("hump", "hump", arch, []), arch, f' data-speed="{_UNIT * DRIVE_SPEED / FRAMES_PER_SECOND:.2f}"')
    frames = json.dumps([[round(float(item), 4) for item in row] for row in factor * drive.q], separators=(",", ":"))
    data = f'data-drive="{FRAMES_PER_SECOND}" data-frames="{frames}"'
    return _picture(sketch, 2 * _SHOWN_HUMP_M, "Drive over a hump", hump + body, data)


def _parts(model: EquationsOfMotion, sketch: Sketch, movement: Movement) -> Iterator[Part]:
    """Yield what is drawn, from back to front."""
    vehicle, radius = model.vehicle, sketch.wheel_radius
    for name, strut in sketch.suspensions.items():
        yield Part("spring", f"suspension of {name}", [(strut.x, radius), (strut.x, strut.top)], [f"wheel {name}", strut.upper])
    for name, strut in sketch.links.items():
        title = vehicle.links[name].title or name
        yield Part("spring", title, [(strut.x, strut.bottom), (strut.x, strut.top)], [strut.lower, strut.upper])
    for index, (name, box) in enumerate(sketch.boxes.items()):
        outline = box.outline(_BENT_SIDES if name in movement.bending else 2)
        yield Part(f"body b{index % 6}", vehicle.bodies[name].title or name, outline, [name] * len(outline))
    for body, x, z in sketch.arms:
        yield Part("arm", vehicle.bodies[body].title or body, [sketch.boxes[body].edge(x, z), (x, z)], [body, body])
    for name, x in sketch.axles.items():
        yield Part("wheel", vehicle.axles[name].title or name, [(x, radius)], [f"wheel {name}"], radius)
    for name, (x, z) in sketch.hinges.items():
        yield Part("pin", vehicle.hinges[name].title or name, [(x, z)], [next(iter(vehicle.hinges[name].points))], 0.08)


def _displacement(sketch: Sketch, movement: Movement, owner: str, x: float, z: float) -> tuple[float, float]:
    """Return how far a point moves forward and up [m]."""
    if owner.startswith("wheel "):
        return 0.0, movement.wheels[owner.removeprefix("wheel ")]
    return movement.point(sketch, owner, x, z) if owner in sketch.boxes else (0.0, 0.0)


def _moving(part: Part, moves: Points) -> str:
    """Return an element at full swing, with where it rests and how it moves."""
    there = [(x + dx, z + dz) for (x, z), (dx, dz) in zip(part.points, moves, strict=True)]
    return _shape(part, there, f' data-rest="{_written(part.points)}" data-move="{_written(moves)}"')


def _shape(part: Part, points: Points, data: str) -> str:
    title = f"<title>{escape(part.title)}</title>"
    if part.radius:
        (x, z) = points[0]
        place = f'cx="{_UNIT * x:.1f}" cy="{-_UNIT * z:.1f}" r="{_UNIT * part.radius:.1f}"'
        return f'<circle class="{part.style}" {place}{data}>{title}</circle>'
    kind = "polyline" if part.style in ("spring", "arm") else "polygon"
    return f'<{kind} class="{part.style}" points="{_written(points)}"{data}>{title}</{kind}>'


def _written(points: Points) -> str:
    return " ".join(f"{_UNIT * x:.1f},{-_UNIT * z:.1f}" for x, z in points)


def _picture(sketch: Sketch, swing: float, title: str, body: str, data: str) -> Markup:
    """Return the element: the road, and what stands on it; it fits the width of the page."""
    left, right, top = sketch.left - 0.6, sketch.right + 0.6, sketch.top + swing + 0.1
    low = -0.15 - swing
    box = f"{_UNIT * left:.0f} {-_UNIT * top:.0f} {_UNIT * (right - left):.0f} {_UNIT * (top - low):.0f}"
    road = f'<line class="road" x1="{_UNIT * (left - 99):.0f}" y1="0" x2="{_UNIT * (right + 99):.0f}" y2="0"/>'
    return Markup(f'<svg class="moving" viewBox="{box}" role="img" {data}><title>{escape(title)}</title>{road}{body}</svg>')
