"""Axes in metres at a known scale, with the symbols of a vehicle drawing and labels that keep out of each other's way."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cache

import numpy as np
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties
from matplotlib.patches import Circle, Polygon, Wedge
from matplotlib.patheffects import withStroke
from matplotlib.text import Text
from matplotlib.textpath import text_to_path

INK = "#1b2733"
FAINT = "#7b8894"
GHOST = "#c3ccd3"
ACCENT = "#0b5fa5"
FILLS = ("#cfe0ee", "#f3dfc1", "#d5e8d4", "#e6d6e8", "#f5e9a9", "#dcdcdc")
"""Light enough for dark text; neighbours differ in hue, and every body carries its name, so that greyscale loses nothing."""

Rectangle = tuple[float, float, float, float]
"""Left, bottom, right, top [m]."""
Spot = tuple[float, float, str, str]
"""x, z [m], horizontal and vertical alignment of a text."""


@cache
def text_size(text: str, size: float, bold: bool = False) -> tuple[float, float]:
    """Return width and height of a line of text in points; nothing in it is read as mathematics."""
    font = FontProperties(size=size, weight="bold" if bold else "normal")
    width, _, _ = text_to_path.get_text_width_height_descent(text, font, ismath=False)
    return float(width), 1.25 * size


def wrap(text: str, size: float, width: float, bold: bool = False) -> list[str]:
    """Break a text between words into lines of at most `width` points."""
    lines: list[str] = []
    for word in text.split():
        longer = f"{lines[-1]} {word}" if lines else word
        if lines and text_size(longer, size, bold)[0] <= width:
            lines[-1] = longer
        else:
            lines.append(word)
    return lines or [""]


class Canvas:
    """A figure whose axes count metres at `scale` inches a metre; it knows which places are taken."""

    def __init__(self, frame: Rectangle, scale: float) -> None:
        self.left, self.bottom, self.right, self.top = frame
        self.scale = scale
        self.figure = Figure(figsize=((self.right - self.left) * scale, (self.top - self.bottom) * scale))
        self.axes = self.figure.add_axes((0.0, 0.0, 1.0, 1.0))
        self.axes.set_axis_off()
        self.axes.set_xlim(self.left, self.right)
        self.axes.set_ylim(self.bottom, self.top)
        self.axes.set_aspect("equal")
        self.taken: list[Rectangle] = []

    @property
    def point(self) -> float:
        """A typographic point (1/72 inch) in metres of the drawing."""
        return 1.0 / (72.0 * self.scale)

    def take(self, left: float, bottom: float, right: float, top: float) -> None:
        """Keep labels out of a rectangle."""
        self.taken.append((left, bottom, right, top))

    def line(
        self, x: Sequence[float], z: Sequence[float], color: str = INK, width: float = 1.0, zorder: float = 4, dotted: bool = False
    ) -> None:
        """Draw a line; NaN breaks it."""
        style = (0, (1, 3)) if dotted else "-"
        self.axes.plot(x, z, color=color, lw=width, zorder=zorder, linestyle=style, solid_capstyle="round", solid_joinstyle="round")

    def dots(self, centres: Sequence[tuple[float, float]], size: float, fill: str, edge: str, zorder: float) -> None:
        """Draw circles of a diameter in points."""
        if centres:
            x, z = zip(*centres, strict=True)
            self.axes.plot(x, z, "o", markersize=size, markerfacecolor=fill, markeredgecolor=edge, markeredgewidth=0.8, zorder=zorder)

    def write(
        self, text: str, spot: Spot, size: float, color: str = INK, bold: bool = False, rotation: float = 0.0, halo: bool = False
    ) -> Text:
        """Write a text at a spot, whatever is there; a halo lifts it off lines."""
        x, z, horizontal, vertical = spot
        weight = "bold" if bold else "normal"
        written = self.axes.text(x, z, text, fontsize=size, color=color, ha=horizontal, va=vertical, fontweight=weight, parse_math=False)
        written.set(zorder=9, rotation=rotation, rotation_mode="anchor")
        if halo:
            written.set_path_effects([withStroke(linewidth=2.0, foreground="white", alpha=0.75)])
        return written

    def extent(self, text: str, spot: Spot, size: float, bold: bool = False) -> Rectangle:
        """Return the rectangle that a text would cover."""
        x, z, horizontal, vertical = spot
        width, height = (item * self.point for item in text_size(text, size, bold))
        left = x - {"left": 0.0, "center": 0.5, "right": 1.0}[horizontal] * width
        low = z - {"bottom": 0.0, "center": 0.5, "top": 1.0}[vertical] * height
        return left, low, left + width, low + height

    def label(
        self,
        text: str,
        spots: Sequence[Spot],
        size: float,
        color: str = INK,
        bold: bool = False,
        avoid: Sequence[Rectangle] = (),
        anchor: tuple[float, float] | None = None,
        home: Rectangle | None = None,
    ) -> Text:
        """Write a text at a spot that is free, or else where it covers least; earlier spots are preferred.

        Parameters
        ----------
        avoid
            Rectangles that it would rather not cover.
        anchor
            What it names [m]; a thin line leads there from a label that had to go far away.
        home
            The outline of what it names; beside it no line is needed.
        """
        frame = (self.left, self.bottom, self.right, self.top)

        def cost(rank: int, spot: Spot) -> float:
            place = self.extent(text, spot, size, bold)
            area = (place[2] - place[0]) * (place[3] - place[1])
            outside = area - _overlap(place, frame)
            covered = sum(_overlap(place, other) for other in self.taken) + 20.0 * outside
            return 4.0 * covered + 0.012 * rank * area + 0.2 * sum(_overlap(place, other) for other in avoid)

        costs = [cost(rank, spot) for rank, spot in enumerate(spots)]
        spot = spots[int(np.argmin(costs))]
        place = self.extent(text, spot, size, bold)
        self.take(*place)
        target = home or (*anchor, *anchor) if anchor else place
        if anchor is not None and _gap(place, target) > 14.0 * self.point:
            end = (float(np.clip(anchor[0], place[0], place[2])), float(np.clip(anchor[1], place[1], place[3])))
            self.line([anchor[0], end[0]], [anchor[1], end[1]], color=color, width=0.6, zorder=8)
        return self.write(text, spot, size, color, bold, halo=True)

    def around(self, x: float, z: float, near: float = 5.0) -> Iterator[Spot]:
        """Yield spots around a point, nearest first; `near` in points."""
        for distance in (near, near + 8.0, near + 20.0, near + 34.0, near + 50.0):
            d = distance * self.point
            yield x, z + d, "center", "bottom"
            yield x + d, z, "left", "center"
            yield x - d, z, "right", "center"
            yield x + 0.7 * d, z + 0.7 * d, "left", "bottom"
            yield x - 0.7 * d, z + 0.7 * d, "right", "bottom"
            yield x, z - d, "center", "top"
            yield x + 0.7 * d, z - 0.7 * d, "left", "top"
            yield x - 0.7 * d, z - 0.7 * d, "right", "top"

    def cog(self, x: float, z: float, radius: float, name: str) -> None:
        """Draw the quartered circle of a centre of gravity."""
        for quarter in range(4):
            fill = INK if quarter % 2 else "white"
            self.axes.add_patch(Wedge((x, z), radius, 90 * quarter, 90 * quarter + 90, facecolor=fill, edgecolor="none", zorder=6))
        self.axes.add_patch(Circle((x, z), radius, fill=False, edgecolor=INK, lw=0.8, zorder=6, gid=f"cog-{name}"))
        self.take(x - radius, z - radius, x + radius, z + radius)

    def arm(self, ends: tuple[tuple[float, float], tuple[float, float]], fill: str) -> None:
        """Draw a rigid arm that tapers from a body's edge to a point away from it."""
        (x, z), (tip_x, tip_z) = ends
        wide, narrow = 7.0 * self.point, 2.5 * self.point
        corners = [(x - wide, z), (x + wide, z), (tip_x + narrow, tip_z), (tip_x - narrow, tip_z)]
        self.axes.add_patch(Polygon(corners, closed=True, facecolor=fill, edgecolor=INK, lw=0.7, zorder=2.5))
        self.take(tip_x - wide, min(z, tip_z), tip_x + wide, max(z, tip_z))

    def spring_damper(
        self, x: float, bottom: float, top: float, spring: bool, damper: bool, color: str = INK, half: float = 5.0, law: bool = False
    ) -> None:
        """Draw a zigzag spring and a dashpot side by side, `half` points from x; an arrow across them stands for a force law."""
        reach = half * self.point if spring and damper else 0.0
        if spring:
            self._zigzag(x - reach, bottom, top, 0.7 * half * self.point, color)
        if damper:
            self._dashpot(x + reach, bottom, top, 0.6 * half * self.point, color)
        if reach:
            for z in (bottom, top):
                self.line([x - reach, x + reach], [z, z], color, 1.0)
        if law:
            size = max(0.5 * (top - bottom), 5.0 * self.point)
            middle, width = (bottom + top) / 2, (half + 4.0) * self.point
            tail, head = (x - width, middle - 0.7 * size), (x + width, middle + 0.7 * size)
            style = {"arrowstyle": "-|>", "color": "#b3400a", "lw": 1.1, "shrinkA": 0, "shrinkB": 0, "mutation_scale": 8}
            self.axes.annotate("", head, tail, arrowprops=style, zorder=7)
        reach += half * self.point
        self.take(x - reach, bottom, x + reach, top)

    def _zigzag(self, x: float, bottom: float, top: float, half: float, color: str) -> None:
        heights = bottom + (top - bottom) * np.array([0, 0.15, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.85, 1])
        self.line(list(x + half * np.array([0, 0, 1, -1, 1, -1, 1, -1, 1, 0, 0])), list(heights), color, 1.0)

    def _dashpot(self, x: float, bottom: float, top: float, half: float, color: str) -> None:
        height, middle = top - bottom, (bottom + top) / 2
        cup = min(0.16 * height, 4.5 * self.point)
        self.line([x, x], [bottom, middle - cup], color, 1.0)
        self.line([x - half, x - half, x + half, x + half], [middle + cup, middle - cup, middle - cup, middle + cup], color, 1.0)
        self.line([x - 0.75 * half, x + 0.75 * half], [middle, middle], color, 1.4)
        self.line([x, x], [middle, top], color, 1.0)


def within(inner: Rectangle, outer: Rectangle) -> bool:
    """Tell whether a rectangle lies inside another."""
    return inner[0] >= outer[0] and inner[1] >= outer[1] and inner[2] <= outer[2] and inner[3] <= outer[3]


def _gap(one: Rectangle, other: Rectangle) -> float:
    """Return the distance between two rectangles [m]."""
    dx, dz = (max(one[i] - other[i + 2], other[i] - one[i + 2], 0.0) for i in (0, 1))
    return float(np.hypot(dx, dz))


def _overlap(one: Rectangle, other: Rectangle) -> float:
    width = min(one[2], other[2]) - max(one[0], other[0])
    height = min(one[3], other[3]) - max(one[1], other[1])
    return width * height if width > 0 and height > 0 else 0.0
