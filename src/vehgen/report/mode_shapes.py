"""Mode shapes drawn on the vehicle."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Polygon

from vehgen.mechanics import LinearModel
from vehgen.report.drawing import FAINT, FILLS, INK
from vehgen.report.sketch import Sketch, axle_motion, body_motion, make_sketch
from vehgen.simulate import Mode

_SWING = 0.5
"""The largest displacement of a mode as drawn [m]."""


def draw_modes(model: LinearModel, modes: Sequence[Mode], values: Mapping[str, float] | None = None) -> Figure:
    """Draw every mode over the vehicle at rest (grey), the largest motion alike in all."""
    values = values or model.values()
    sketch = make_sketch(model, values)
    length = sketch.right - sketch.left
    columns = 2 if length > 18 else 3 if length > 4 else 4
    columns = min(columns, len(modes))
    rows = -(-len(modes) // columns)
    width = 5.2 * columns if columns < 3 else 4.4 * columns
    panel = width / columns * (sketch.top + 1.3) / (length + 1.4) + 0.55
    figure = Figure(figsize=(width, panel * rows), layout="constrained")
    grid = figure.subplots(rows, columns, squeeze=False)
    for axes in grid.ravel()[len(modes) :]:
        axes.set_axis_off()
    for axes, mode in zip(grid.ravel(), modes, strict=False):
        _draw_mode(axes, model, mode, values, sketch)
    return figure


def _draw_mode(axes: Axes, model: LinearModel, mode: Mode, values: Mapping[str, float], sketch: Sketch) -> None:
    bodies = body_motion(model, values, mode.shape)
    wheels = axle_motion(model, bodies, values, mode.shape)
    swings = [abs(heave) for heave, _ in bodies.values()] + [abs(rise) for rise in wheels.values()]
    for name, (heave, pitch) in bodies.items():
        box = sketch.boxes[name]
        swings += [abs(heave - pitch * (edge - box.x)) for edge in (box.left, box.right)]
    scale = _SWING / max([*swings, 1e-12])
    axes.plot([sketch.left - 0.5, sketch.right + 0.5], [0, 0], color=FAINT, lw=0.8)
    for index, (name, box) in enumerate(sketch.boxes.items()):
        heave, pitch = (scale * item for item in bodies[name])
        corners = np.array([(box.left, box.bottom), (box.right, box.bottom), (box.right, box.top), (box.left, box.top)])
        axes.add_patch(Polygon(corners, closed=True, facecolor="none", edgecolor="#c3ccd3", lw=0.8))
        moved = corners + np.column_stack([np.zeros(4), heave - pitch * (corners[:, 0] - box.x)])
        axes.add_patch(Polygon(moved, closed=True, facecolor=FILLS[index % len(FILLS)], edgecolor=INK, lw=1.0, alpha=0.85))
    for name, (x, hub) in sketch.axles.items():
        axes.add_patch(Circle((x, hub), sketch.wheel_radius, facecolor="none", edgecolor="#c3ccd3", lw=0.8))
        axes.add_patch(Circle((x, hub + scale * wheels[name]), sketch.wheel_radius, facecolor="#56626d", edgecolor=INK, lw=0.8, alpha=0.85))
    axes.set_xlim(sketch.left - 0.7, sketch.right + 0.7)
    axes.set_ylim(-0.7, sketch.top + 0.6)
    axes.set_aspect("equal")
    axes.set_axis_off()
    axes.set_title(
        f"{mode.name}\n{mode.undamped_hz:.2f} Hz undamped, {mode.damped_hz:.2f} Hz damped, ratio {mode.damping_ratio:.3f}",
        fontsize=8.5,
        color=INK,
    )
