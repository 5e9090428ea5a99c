"""Figures in pages: SVG that carries the values of its curves, so that a page can tell them to who points at one."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import numpy as np
from markupsafe import Markup, escape

from vehgen.report.figure_files import figure_svg, inline_svg

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D

POINTS_PER_INCH = 72
"""Matplotlib's SVG counts in points, from the upper left corner."""
SCALES = ("linear", "log")
"""Scales whose positions a page can compute."""


def inline_figure(figure: Figure, name: str, title: str) -> Markup:
    """Return a figure's element for use in a page: ids prefixed by `name`, a title for screen readers, and the values of its curves."""
    element = inline_svg(figure_svg(figure), name, str(escape(title)))
    panels = curve_values(figure)
    if not panels:
        return Markup(element)
    data = escape(json.dumps(panels, separators=(",", ":"), allow_nan=False))
    return Markup(element.replace("<svg", f'<svg data-curves="{data}"', 1))


def curve_values(figure: Figure) -> list[dict[str, Any]]:
    """Return what a page must know of a drawn figure to tell the values of its curves.

    Returns
    -------
    For every panel with named curves: of its axes `x` and `y` the `label`, whether it is logarithmic, its `limits` in the curves' units and
    where these lie in the SVG (`ends`); and of its `curves` the `name`, `x` and `y` as they can be seen, five digits of each.
    """
    return [panel for axes in figure.axes if axes.get_visible() and (panel := _panel(figure, axes)) is not None]


def _panel(figure: Figure, axes: Axes) -> dict[str, Any] | None:
    lines = [line for line in axes.lines if line.get_transform() is axes.transData and not str(line.get_label()).startswith("_")]
    if not lines or axes.get_xscale() not in SCALES or axes.get_yscale() not in SCALES:
        return None
    width, height = (POINTS_PER_INCH * float(size) for size in figure.get_size_inches())
    box = axes.get_position()
    across, up = axes.get_xlim(), axes.get_ylim()
    return {
        "x": _axis(axes.get_xlabel(), axes.get_xscale(), across, (width * box.x0, width * box.x1)),
        "y": _axis(axes.get_ylabel(), axes.get_yscale(), up, (height * (1 - box.y0), height * (1 - box.y1))),
        "curves": [_curve(line, across, up) for line in lines],
    }


def _axis(label: str, scale: str, limits: tuple[float, float], ends: tuple[float, float]) -> dict[str, Any]:
    return {
        "label": " ".join(label.split()),
        "log": scale == "log",
        "limits": list(map(float, limits)),
        "ends": [round(end, 2) for end in ends],
    }


def _curve(line: Line2D, across: tuple[float, float], up: tuple[float, float]) -> dict[str, Any]:
    x, y = (np.asarray(values, dtype=np.float64) for values in line.get_data())
    seen = np.isfinite(x) & np.isfinite(y) & (x >= min(across)) & (x <= max(across)) & (y >= min(up)) & (y <= max(up))
    return {"name": str(line.get_label()).strip(), "x": _written(x[seen]), "y": _written(y[seen])}


def _written(values: np.ndarray[Any, np.dtype[np.float64]]) -> list[float]:
    return [float(f"{value:.5g}") for value in values]
