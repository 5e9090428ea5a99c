"""Dimension lines: rows of distances under the road, and heights of hinges over COGs."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass

from vehgen.mechanics import EquationsOfMotion
from vehgen.report.drawing.canvas import ACCENT, FAINT, Canvas, Spot, text_size
from vehgen.report.drawing.sketch import Sketch

_SAME_PLACE_M = 0.005
"""Marks nearer than this are one [m]."""


@dataclass(frozen=True)
class Chain:
    """A row of distances between neighbouring points (x, z) [m]."""

    name: str
    color: str
    points: Sequence[tuple[float, float]]

    def marks(self) -> list[tuple[float, float]]:
        """Return the points from rear to front, of those above each other the lowest."""
        found: list[tuple[float, float]] = []
        for x, z in sorted(self.points):
            if not found or x - found[-1][0] > _SAME_PLACE_M:
                found.append((x, z))
        return found


def length_text(value: float) -> str:
    """Write a length in metres to the millimetre, with two decimals where they do."""
    text = f"{value:.3f}"
    return text.removesuffix("0")


def draw_chains(canvas: Canvas, chains: Sequence[Chain], top: float, row: float, size: float) -> None:
    """Draw rows of dimensions, the first at `top` [m], `row` points apart."""
    end = max((chain.marks()[-1][0] for chain in chains), default=0.0)
    for place, chain in enumerate(chains):
        z = top - (place * row + 12) * canvas.point
        marks = chain.marks()
        tick = 3.5 * canvas.point
        for x, height in marks:
            canvas.line([x, x], [z - tick, z + tick], chain.color, 0.8)
            canvas.line([x, x], [z + tick, height], chain.color, 0.45, zorder=1, dotted=True)
        for (left, _), (right, _) in itertools.pairwise(marks):
            _draw_distance(canvas, left, right, z, size, chain.color)
        canvas.write(chain.name, (end + 8 * canvas.point, z, "left", "center"), size - 1, chain.color)


def _draw_distance(canvas: Canvas, left: float, right: float, z: float, size: float, color: str) -> None:
    text = length_text(right - left)
    wide = right - left > (text_size(text, size)[0] + 8) * canvas.point
    arrow = {"arrowstyle": "<|-|>", "color": color, "lw": 0.7, "shrinkA": 0, "shrinkB": 0, "mutation_scale": 5}
    if right - left > 14 * canvas.point:
        canvas.axes.annotate("", (left, z), (right, z), arrowprops=arrow)
    else:
        canvas.line([left, right], [z, z], color, 0.7)
    middle, gap = (left + right) / 2, 2 * canvas.point
    spots: list[Spot] = [(middle, z + gap, "center", "bottom")]
    if not wide:
        spots += [(middle, z - gap, "center", "top"), (left - gap, z + gap, "right", "bottom"), (right + gap, z + gap, "left", "bottom")]
        spots += [(left - gap, z - gap, "right", "top"), (right + gap, z - gap, "left", "top")]
    canvas.label(text, spots, size if wide else size - 1, color)


def draw_hinge_heights(canvas: Canvas, model: EquationsOfMotion, sketch: Sketch, size: float) -> None:
    """Draw how high a pin stands over the COGs of its two bodies, where the file tells."""
    for name, (x, z) in sketch.hinges.items():
        for body, point in model.vehicle.hinges[name].points.items():
            box = sketch.boxes[body]
            rise = z - box.z
            if not box.height_known or abs(rise) < 0.03 or not point.z.text:
                continue
            side = 1 if box.x > x else -1
            place = x + side * 16 * canvas.point
            canvas.line([box.x, place], [box.z, box.z], FAINT, 0.5, zorder=3, dotted=True)
            canvas.line([x, place], [z, z], FAINT, 0.5, zorder=3, dotted=True)
            arrow = {"arrowstyle": "<|-|>", "color": ACCENT, "lw": 0.7, "shrinkA": 0, "shrinkB": 0, "mutation_scale": 5}
            if abs(rise) > 14 * canvas.point:
                canvas.axes.annotate("", (place, box.z), (place, z), arrowprops=arrow)
            else:
                canvas.line([place, place], [box.z, z], ACCENT, 0.9)
            middle, gap = (z + box.z) / 2, 3 * canvas.point
            ways = (1, -1) if side > 0 else (-1, 1)
            heights = [middle, *(box.z + share * rise for share in (0.3, 0.7, 0.15, 0.85))]
            spots: list[Spot] = [(place + way * gap, at, "left" if way > 0 else "right", "center") for way in ways for at in heights]
            canvas.label(length_text(abs(rise)), spots, size, ACCENT)
