"""Which part stands on which in a drawing: heights of bodies above the road, and the springs between them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from vehgen.mechanics import EquationsOfMotion
from vehgen.vehicle.parts import GROUND

CLEARANCE = 0.12
"""The lowest body's outline stands this far above the wheels [m]."""
HALF_HEIGHT = 0.4
"""Half the height of an outline that the file does not give [m]."""
_STRUT, _GAP = 0.55, 0.4
"""Height of a link between two outlines that are far apart, and the room left for one between bodies that are stacked [m]."""
_BESIDE = 0.36
"""Links at one place are drawn this far apart [m]."""


@dataclass(frozen=True)
class Box:
    """A body: its COG, and the left, right, bottom and top of its outline [m].

    `declared` where the file gives its size; `height_known` where the COG stands at the height that the file gives relative to the first
    body (a beam stands at hub height instead).
    """

    x: float
    z: float
    left: float
    right: float
    bottom: float
    top: float
    declared: bool
    height_known: bool

    def edge(self, x: float, z: float) -> tuple[float, float]:
        """Return the point of the outline (or inside it) nearest to (x, z)."""
        return float(np.clip(x, self.left, self.right)), float(np.clip(z, self.bottom, self.top))

    def outline(self, count: int) -> list[tuple[float, float]]:
        """Return points along the outline, `count` on each of the long sides."""
        places = [float(x) for x in np.linspace(self.left, self.right, count)]
        return [*((x, self.bottom) for x in places), *((x, self.top) for x in reversed(places))]

    def corners(self) -> list[tuple[float, float]]:
        """Return the corners of the outline."""
        return [(self.left, self.bottom), (self.right, self.bottom), (self.right, self.top), (self.left, self.top)]


@dataclass(frozen=True)
class Strut:
    """A spring and damper at x between `bottom` and `top` [m]; `lower` and `upper` hold it (a body, the ground, or an axle's hub)."""

    x: float
    bottom: float
    top: float
    lower: str
    upper: str


def is_beam(model: EquationsOfMotion, body: str, reach: list[float]) -> bool:
    """Tell whether a body is a beam at hub height: short, not alone, and all its wheels sit on it without a suspension."""
    wheels = [axle for axle in model.vehicle.axles.values() if axle.body == body]
    rigid = bool(wheels) and all(axle.suspension is None for axle in wheels)
    return rigid and len(model.vehicle.bodies) > 1 and max(reach) - min(reach) < 3.0


def stack_heights(
    model: EquationsOfMotion,
    bodies: Mapping[str, tuple[float, float | None]],
    outlines: Mapping[str, tuple[float, float, float, bool]],
    links: Mapping[str, tuple[float, str, str]],
    radius: float,
) -> tuple[dict[str, float], float]:
    """Return COG heights above the road, and what was added to the heights that the file gives, to clear the wheels.

    A body without wheels stands on those with wheels that links join it to, as a coach on its bogies; what else links join stands on what
    comes before it in the file.
    """
    floor = 2 * radius + CLEARANCE
    beams = {name for name in bodies if is_beam(model, name, [outlines[name][0], outlines[name][1]])}
    known = {name: z for name, (_, z) in bodies.items() if z is not None and name not in beams}
    lift = max((floor + outlines[name][2] - z for name, z in known.items()), default=floor + HALF_HEIGHT)
    others = {name: [two if one == name else one for _, one, two in links.values() if name in (one, two)] for name in bodies}
    wheeled = {axle.body for axle in model.vehicle.axles.values()}
    below = {} if wheeled & set(known) else {name: floor + outlines[name][2] for name in wheeled - beams if name not in known}
    for name, z in known.items():
        tops = [below[other] + outlines[other][2] for other in others[name] if other in below]
        lift = max([lift, *(top + _GAP + outlines[name][2] - z for top in tops)])
    heights = {name: z + lift for name, z in known.items()} | dict.fromkeys(beams, radius) | below
    for name in [*bodies] * len(bodies):
        tops = [heights[other] + outlines[other][2] for other in others[name] if other in heights]
        if name not in heights and tops:
            heights[name] = max(tops) + _GAP + outlines[name][2]
    for name in bodies:
        heights.setdefault(name, floor + outlines[name][2])
    return heights, lift


def stand_suspension(x: float, axle: str, body: str, box: Box, radius: float) -> Strut:
    """Stand a suspension on its hub; a body high above holds it by an arm."""
    bottom = 1.15 * radius
    return Strut(x, bottom, max(min(box.bottom, bottom + max(_STRUT, 1.1 * radius)), bottom + 0.2), axle, body)


def stand_link(x: float, first: str, second: str, boxes: Mapping[str, Box]) -> Strut:
    """Put a link between two outlines; where they overlap, below the upper one."""
    if GROUND in (first, second):
        body = second if first == GROUND else first
        return Strut(x, 0.0, max(min(boxes[body].bottom, _STRUT), 0.2), GROUND, body)
    lower, upper = sorted((first, second), key=lambda name: boxes[name].z)
    top, bottom = boxes[upper].bottom, boxes[lower].top
    if top - bottom < 0.15:
        bottom = max(boxes[lower].bottom, top - 0.35)
    if top - bottom < 0.15:
        bottom = top - 0.25
    return Strut(x, max(bottom, top - _STRUT), top, lower, upper)


def set_apart(links: Mapping[str, Strut], hung: Mapping[str, bool], boxes: Mapping[str, Box]) -> dict[str, Strut]:
    """Return links that do not cover one another: of those between a body and the ground at one place some hang from above.

    Parameters
    ----------
    links
        By name, as they would stand alone.
    hung
        Whether the file names a link's body before the ground, as what hangs on it.
    boxes
        Outlines of the bodies.
    """
    placed: dict[str, Strut] = {}
    for name, strut in links.items():
        rivals = [other for other in links.values() if (other.lower, other.upper) == (strut.lower, strut.upper) and _meet(other, strut)]
        if strut.lower == GROUND and hung[name] and len(rivals) > 1:
            top = boxes[strut.upper].top
            strut = Strut(strut.x, top, top + _STRUT, strut.upper, GROUND)
        taken = [other for other in placed.values() if (other.lower, other.upper) == (strut.lower, strut.upper)]
        while any(_meet(other, strut) for other in taken):
            strut = replace(strut, x=strut.x + _BESIDE)
        placed[name] = strut
    return placed


def _meet(one: Strut, other: Strut) -> bool:
    return abs(one.x - other.x) < 0.9 * _BESIDE
