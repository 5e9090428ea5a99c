"""Further symbols of a drawing: springs and dampers about a pin, a ceiling, the line of a body that bends."""

from __future__ import annotations

import numpy as np

from vehgen.report.drawing.canvas import ACCENT, FAINT, INK, Canvas
from vehgen.report.drawing.stacking import Box

_SAG = 0.22
"""Depth of the bending line over the height of its body."""


def draw_pin_resistance(canvas: Canvas, x: float, z: float, spring: bool, damper: bool) -> None:
    """Draw a spiral spring and a rotary dashpot about a pin, on the sides where each acts."""
    point = canvas.point
    if spring:
        angle = np.linspace(0.5 * np.pi, 4.5 * np.pi, 60)
        radius = point * np.linspace(4.5, 11.0, angle.size)
        canvas.line(list(x + radius * np.cos(angle)), list(z + radius * np.sin(angle)), ACCENT, 1.0, 6.5)
    if damper:
        for distance, sweep in ((13.0, (0.15, 0.85)), (17.0, (0.15, 0.85)), (15.0, (0.5, 1.1))):
            angle = np.pi * np.linspace(*sweep, 30)
            canvas.line(list(x + distance * point * np.cos(angle)), list(z + distance * point * np.sin(angle)), ACCENT, 1.0, 6.5)
        for turn, reach, width in ((0.15, (13.0, 17.0), 1.0), (0.5, (13.6, 16.4), 1.6)):
            ahead, up = (float(direction(np.pi * turn)) * point for direction in (np.cos, np.sin))
            canvas.line([x + item * ahead for item in reach], [z + item * up for item in reach], ACCENT, width, 6.5)
    if spring or damper:
        size = (17.0 if damper else 11.0) * point
        canvas.take(x - size, z - 11.0 * point, x + size, z + size)


def draw_ceiling(canvas: Canvas, x: float, z: float) -> None:
    """Draw the ground from which something hangs."""
    half, step, size = 14 * canvas.point, 7 * canvas.point, 4 * canvas.point
    canvas.line([x - half, x + half], [z, z], INK, 1.3)
    hatch = [spot for left in np.arange(x - half, x + half, step) for spot in ((left, z), (left + size, z + size), (np.nan, np.nan))]
    canvas.line([a for a, _ in hatch], [b for _, b in hatch], FAINT, 0.6)
    canvas.take(x - half, z, x + half, z + size)


def draw_bending(canvas: Canvas, box: Box, length: float) -> None:
    """Draw the shape in which a body bends, a parabola over the length that bends, dash-dotted through its outline."""
    s = np.linspace(-1.0, 1.0, 41)
    depth = _SAG * (box.top - box.bottom)
    x, z = box.x + 0.5 * length * s, (box.top + box.bottom) / 2 + depth * (3 * s**2 - 1) / 2
    canvas.axes.plot(x, z, color=ACCENT, lw=1.1, linestyle=(0, (7, 2, 1, 2)), zorder=5.5)
