"""Places of a drawing ringed in red: where a diagnosis finds that the model errs."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Any

from matplotlib.patches import Ellipse, Rectangle

from vehgen.mechanics import EquationsOfMotion
from vehgen.report.drawing.canvas import Canvas
from vehgen.report.drawing.sketch import Sketch
from vehgen.report.drawing.stacking import Strut

RING_COLOUR = "#d1350f"


def marked_parts(model: EquationsOfMotion, labels: Iterable[str]) -> list[tuple[str, str]]:
    """Return the parts, (kind, name), that labels of places speak of, such as `tyre rear`, `axle4 and axle5`, `all suspensions`.

    An axle named alone stands for its suspension, or its tyre where it has none.
    """
    vehicle, found = model.vehicle, []
    for label in labels:
        words = re.findall(r"\w+", label)
        axles = [word for word in words if word in vehicle.axles]
        if "suspensions" in words or "tyres" in words:
            axles = list(vehicle.axles)
        for name in axles:
            kind = "tyre" if {"tyre", "tyres"} & set(words) or vehicle.axles[name].suspension is None else "suspension"
            found.append((kind, name))
        for kind, parts in (("link", vehicle.links), ("hinge", vehicle.hinges), ("body", vehicle.bodies)):
            found += [(kind, word) for word in words if word in parts]
    return list(dict.fromkeys(found))


def draw_marks(canvas: Canvas, sketch: Sketch, parts: Iterable[tuple[str, str]]) -> None:
    """Ring parts of a drawing."""
    pad = 9 * canvas.point
    style: dict[str, Any] = {"fill": False, "edgecolor": RING_COLOUR, "lw": 2.2, "zorder": 8}
    for kind, name in parts:
        gid = f"marked-{kind}-{name}"
        if kind == "body":
            box = sketch.boxes[name]
            width, height = box.right - box.left, box.top - box.bottom
            canvas.axes.add_patch(Rectangle((box.left - pad / 2, box.bottom - pad / 2), width + pad, height + pad, gid=gid, **style))
            continue
        x, low, high = _extent(sketch, kind, name)
        half = sketch.wheel_radius + pad / 2 if kind == "tyre" else 1.6 * pad
        canvas.axes.add_patch(Ellipse((x, (low + high) / 2), 2 * half, high - low + 2 * pad, gid=gid, **style))


def _extent(sketch: Sketch, kind: str, name: str) -> tuple[float, float, float]:
    """Return where a part stands along the vehicle, and its lower and upper end [m]."""
    if kind == "tyre":
        return sketch.axles[name], 0.0, 2 * sketch.wheel_radius
    if kind == "hinge":
        x, z = sketch.hinges[name]
        return x, z, z
    strut: Strut = sketch.suspensions[name] if kind == "suspension" else sketch.links[name]
    return strut.x, strut.bottom, strut.top
