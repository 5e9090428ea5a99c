"""The vehicle to scale, with its dimensions."""

from __future__ import annotations

import itertools
from collections.abc import Mapping

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle, FancyBboxPatch, Wedge

from vehgen.mechanics import LinearModel
from vehgen.report.sketch import Box, Sketch, make_sketch
from vehgen.vehicle.model import GROUND

INK = "#1b2733"
FAINT = "#8a97a3"
FILLS = ("#cfe0ee", "#f3dfc1", "#d5e8d4", "#e6d6e8", "#f5e9a9", "#d9d9d9")
ACCENT = "#0b5fa5"


def draw_vehicle(model: LinearModel, values: Mapping[str, float] | None = None) -> Figure:
    """Draw a side view to scale: bodies, axles, hinges, links, COGs, and the dimensions along the road [m].

    Outlines that the file does not give (`size`) are dashed.
    """
    values = values or model.values()
    sketch = make_sketch(model, values)
    length = sketch.right - sketch.left
    rows = 2 if sketch.hinges or len(sketch.boxes) > 1 else 1
    crowded = _crowded(sketch)
    depth = 0.75 + 0.6 * rows + (0.9 if crowded else 0.0)
    height = sketch.top + depth + 1.0
    width = float(np.clip(0.75 * length, 7.5, 12.0 + 0.32 * length))
    figure = Figure(figsize=(width, width * height / (length + 2.6)), layout="constrained")
    axes = figure.add_subplot()
    axes.set_aspect("equal")
    axes.set_axis_off()
    axes.set_xlim(sketch.left - 1.3, sketch.right + 1.3)
    axes.set_ylim(-depth, sketch.top + 1.0)
    size = float(np.clip(9.0 * width / 12.0, 7.0, 10.0))
    axes.plot([sketch.left - 0.8, sketch.right + 0.8], [0, 0], color=INK, lw=1.2)
    for index, (name, box) in enumerate(sketch.boxes.items()):
        _draw_body(axes, model, name, box, FILLS[index % len(FILLS)], size)
    for name in sketch.axles:
        _draw_axle(axes, model, name, sketch, size, crowded)
    for name, (x, first, second) in sketch.links.items():
        _draw_link(axes, name, x, first, second, sketch, size)
    for name, (x, z) in sketch.hinges.items():
        for body in model.vehicle.hinges[name].points:
            edge = float(np.clip(z, sketch.boxes[body].bottom, sketch.boxes[body].top))
            axes.plot([x, x], [edge, z], color=ACCENT, lw=1.4, zorder=5)
        axes.add_patch(Circle((x, z), 0.09, facecolor="white", edgecolor=ACCENT, lw=1.6, zorder=6))
        axes.annotate(name, (x, z), (0, 9), textcoords="offset points", ha="center", va="bottom", fontsize=size - 1, color=ACCENT, zorder=7)
    low = -1.35 if crowded else -0.55
    _dimension_chain(axes, sorted({x for x, _ in sketch.axles.values()}), low, "axles", size, INK)
    if rows == 2:
        marks = sorted(
            {round(box.x, 6) for box in sketch.boxes.values() if box.right - box.left > 1.0} | {x for x, _ in sketch.hinges.values()}
        )
        _dimension_chain(axes, marks, low - 0.6, "COGs, hinges", size, ACCENT)
    _draw_convention(axes, sketch.right + 0.35, sketch.top + 0.15, size)
    axes.set_title(f"{model.vehicle.title or model.vehicle.name}  (to scale; lengths in metres)", loc="left", fontsize=size + 2, color=INK)
    return figure


def _draw_body(axes: Axes, model: LinearModel, name: str, box: Box, fill: str, size: float) -> None:
    style = "-" if box.declared else (0, (4, 2))
    patch = FancyBboxPatch(
        (box.left, box.bottom),
        box.right - box.left,
        box.top - box.bottom,
        boxstyle="round,pad=0,rounding_size=0.08",
        facecolor=fill,
        edgecolor=INK,
        lw=1.1,
        linestyle=style,
        alpha=0.9,
        zorder=2,
    )
    axes.add_patch(patch)
    radius = 0.12
    for quarter in range(4):
        color = INK if quarter % 2 else "white"
        axes.add_patch(Wedge((box.x, box.z), radius, 90 * quarter, 90 * quarter + 90, facecolor=color, edgecolor=INK, lw=0.6, zorder=5))
    label = model.vehicle.bodies[name].title or name
    small = box.top - box.bottom < 0.4
    place = ((box.left + box.right) / 2, box.bottom - 0.08) if small else (box.left + 0.1, box.top - 0.06)
    axes.text(*place, label, fontsize=size, ha="center" if small else "left", va="top", color=INK, zorder=6)


def _draw_axle(axes: Axes, model: LinearModel, name: str, sketch: Sketch, size: float, crowded: bool) -> None:
    x, hub = sketch.axles[name]
    axle = model.vehicle.axles[name]
    axes.add_patch(Circle((x, hub), sketch.wheel_radius, facecolor="#3b4650", edgecolor=INK, lw=0.8, alpha=0.85, zorder=3))
    axes.add_patch(Circle((x, hub), 0.45 * sketch.wheel_radius, facecolor="#e9edf0", edgecolor=INK, lw=0.6, zorder=3))
    if axle.suspension is not None:
        box = sketch.boxes[axle.body]
        _spring_damper(axes, x, hub, max(box.bottom, hub + 0.35), 0.16)
    turn = {"rotation": 35, "ha": "right", "rotation_mode": "anchor"} if crowded else {"ha": "center"}
    axes.text(x, -0.1, axle.title or name, fontsize=size - 1, va="top", color=INK, **turn)


def _crowded(sketch: Sketch) -> bool:
    """Tell whether neighbouring axles stand too close for their names to be written side by side."""
    places = sorted(x for x, _ in sketch.axles.values())
    longest = max((len(name) for name in sketch.axles), default=0)
    return any(right - left < 0.15 * longest for left, right in itertools.pairwise(places))


def _draw_link(axes: Axes, name: str, x: float, first: str, second: str, sketch: Sketch, size: float) -> None:
    ends = []
    for body in (first, second):
        ends.append((0.0, 0.0) if body == GROUND else (sketch.boxes[body].bottom, sketch.boxes[body].top))
    (low, high) = sorted(ends)
    bottom, top = low[1], high[0]
    if top - bottom < 0.25:
        middle = (top + bottom) / 2
        bottom, top = middle - 0.2, middle + 0.2
    _spring_damper(axes, x, bottom, top, 0.13, color=ACCENT)
    axes.annotate(name, (x, (bottom + top) / 2), (9, 0), textcoords="offset points", fontsize=size - 2, color=ACCENT, va="center", zorder=7)


def _spring_damper(axes: Axes, x: float, bottom: float, top: float, half: float, color: str = INK) -> None:
    """Draw a zigzag spring on the left and a dashpot on the right."""
    height = np.linspace(bottom, top, 11)
    zigzag = x - half + 0.5 * half * np.array([0, 0, 1, -1, 1, -1, 1, -1, 1, 0, 0])
    axes.plot(zigzag, height, color=color, lw=1.0, zorder=4)
    right, middle = x + half, (bottom + top) / 2
    axes.plot([right, right], [bottom, middle - 0.05], color=color, lw=1.0, zorder=4)
    axes.plot(
        [right - 0.06, right - 0.06, right + 0.06, right + 0.06],
        [middle + 0.09, middle - 0.05, middle - 0.05, middle + 0.09],
        color=color,
        lw=1.0,
        zorder=4,
    )
    axes.plot([right - 0.045, right + 0.045], [middle + 0.03] * 2, color=color, lw=1.4, zorder=4)
    axes.plot([right, right], [middle + 0.03, top], color=color, lw=1.0, zorder=4)


def _dimension_chain(axes: Axes, marks: list[float], z: float, label: str, size: float, color: str) -> None:
    """Draw dimensions between neighbouring marks, front first."""
    if len(marks) < 2:
        return
    for x in marks:
        axes.plot([x, x], [z - 0.1, z + 0.1], color=color, lw=0.8)
    for left, right in itertools.pairwise(marks):
        axes.annotate("", (left, z), (right, z), arrowprops={"arrowstyle": "<->", "color": color, "lw": 0.8, "shrinkA": 0, "shrinkB": 0})
        narrow = right - left < 0.9
        axes.text(
            (left + right) / 2,
            z + 0.05,
            f"{right - left:.2f}",
            ha="center",
            va="bottom",
            fontsize=size - (2.5 if narrow else 1),
            color=color,
        )
    axes.text(marks[-1] + 0.15, z, label, fontsize=size - 2, color=color, va="center")


def _draw_convention(axes: Axes, x: float, z: float, size: float) -> None:
    """Draw x forward, z up and the sense of positive pitch (nose down)."""
    arrow = {"arrowstyle": "-|>", "color": FAINT, "lw": 1.0, "shrinkA": 0, "shrinkB": 0}
    axes.annotate("", (x + 0.6, z), (x, z), arrowprops=arrow)
    axes.annotate("", (x, z + 0.6), (x, z), arrowprops=arrow)
    axes.text(x + 0.64, z, "x", fontsize=size - 1, color=FAINT, va="center")
    axes.text(x, z + 0.63, "z", fontsize=size - 1, color=FAINT, ha="center")
    bend = {**arrow, "connectionstyle": "arc3,rad=-0.45"}
    axes.annotate("", (x + 0.42, z + 0.1), (x + 0.1, z + 0.42), arrowprops=bend)
    axes.text(x + 0.38, z + 0.36, "pitch", fontsize=size - 2, color=FAINT)
