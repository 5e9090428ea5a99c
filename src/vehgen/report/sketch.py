"""Where to draw what: a side view of the vehicle in metres, from its layout and, where the file is silent, plausible outlines."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from vehgen.mechanics import LinearModel
from vehgen.mechanics.rows import Entries
from vehgen.mechanics.symbols import to_sympy
from vehgen.vehicle.model import GROUND

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Box:
    """A body: its COG, and the left, right, bottom and top of its outline [m]; `declared` where the file gives its size."""

    x: float
    z: float
    left: float
    right: float
    bottom: float
    top: float
    declared: bool


@dataclass(frozen=True)
class Sketch:
    """Positions in metres: x forward from the first body's COG, z up from the road."""

    boxes: dict[str, Box]
    axles: dict[str, tuple[float, float]]
    hinges: dict[str, tuple[float, float]]
    links: dict[str, tuple[float, str, str]]
    wheel_radius: float

    @property
    def left(self) -> float:
        """The rearmost point."""
        return min([box.left for box in self.boxes.values()] + [x - self.wheel_radius for x, _ in self.axles.values()])

    @property
    def right(self) -> float:
        """The foremost point."""
        return max([box.right for box in self.boxes.values()] + [x + self.wheel_radius for x, _ in self.axles.values()])

    @property
    def top(self) -> float:
        """The highest point."""
        return max(box.top for box in self.boxes.values())


def make_sketch(model: LinearModel, values: Mapping[str, float]) -> Sketch:
    """Place every part of a vehicle for drawing."""
    vehicle, layout = model.vehicle, model.layout
    entries = {(0, i): x for i, (x, _) in enumerate(layout.bodies.values())}
    entries |= {(1, i): z for i, (_, z) in enumerate(layout.bodies.values()) if z is not None}
    entries |= {(2, i): x for i, x in enumerate(layout.axles.values())}
    entries |= {(3, i): x for i, (x, _) in enumerate(layout.hinges.values())}
    entries |= {(4, i): z for i, (_, z) in enumerate(layout.hinges.values()) if z is not None}
    found = model.evaluate(entries, values)
    bodies = {name: (found[0, i], found.get((1, i))) for i, name in enumerate(layout.bodies)}
    axles = {name: found[2, i] for i, name in enumerate(layout.axles)}
    everything = vehicle.all_values({name: values[name] for name in vehicle.free_parameters})
    links = {}
    for name, link in vehicle.links.items():
        (first, first_point), (second, second_point) = link.ends
        owner, point = (second, second_point) if first == GROUND else (first, first_point)
        links[name] = (bodies[owner][0] + point.x.evaluate(everything), first, second)
    places = [x for x, _ in bodies.values()] + list(axles.values())
    span = max(max(places) - min(places), 2.0)
    radius = float(np.clip(0.06 * span, 0.3, 0.5))
    heights = _heights(model, bodies, links, radius)
    attached = _attached(model, axles, {name: found[3, i] for i, name in enumerate(layout.hinges)}, links)
    boxes = {}
    for name, body in vehicle.bodies.items():
        x, z = bodies[name][0], heights[name]
        if body.size is not None:
            half, up = body.size.length.evaluate(everything) / 2, body.size.height.evaluate(everything) / 2
            boxes[name] = Box(x, z, x - half, x + half, z - up, z + up, True)
            continue
        reach = [*attached[name], x]
        margin = 0.35 if len(reach) > 1 else 0.6
        half = 0.10 if _on_wheels(model, name) else 0.45
        boxes[name] = Box(x, z, min(reach) - margin, max(reach) + margin, z - half, z + half, False)
    shift = heights[next(iter(vehicle.bodies))] - (bodies[next(iter(vehicle.bodies))][1] or 0.0)
    hinges = {
        name: (found[3, i], found.get((4, i), 0.0) + shift if (4, i) in found else boxes[next(iter(vehicle.hinges[name].points))].z)
        for i, name in enumerate(layout.hinges)
    }
    return Sketch(boxes, {name: (x, radius) for name, x in axles.items()}, hinges, links, radius)


def _on_wheels(model: LinearModel, body: str) -> bool:
    """Tell whether wheels sit on the body without a suspension: it is a beam at hub height."""
    return any(axle.body == body and axle.suspension is None for axle in model.vehicle.axles.values()) and len(model.vehicle.bodies) > 1


def _heights(
    model: LinearModel, bodies: Mapping[str, tuple[float, float | None]], links: Mapping[str, tuple[float, str, str]], radius: float
) -> dict[str, float]:
    """Return COG heights above the road: relative heights where the file gives them, lifted clear of the wheels."""
    known = {name: z for name, (_, z) in bodies.items() if z is not None and not _on_wheels(model, name)}
    lift = 2 * radius + 0.75 - min(known.values(), default=0.0)
    heights = {name: z + lift for name, z in known.items()}
    for name in bodies:
        if name not in heights and _on_wheels(model, name):
            heights[name] = radius
    for name in bodies:
        if name not in heights:
            below = [first for _, first, second in links.values() if second == name and first in heights]
            above = [second for _, first, second in links.values() if first == name and second in heights]
            heights[name] = heights[below[0]] + 1.2 if below else heights[above[0]] - 0.8 if above else 2 * radius + 0.75
    return heights


def _attached(
    model: LinearModel, axles: Mapping[str, float], hinges: Mapping[str, float], links: Mapping[str, tuple[float, str, str]]
) -> dict[str, list[float]]:
    """Return, per body, the positions of the axles, hinges and links on it."""
    found: dict[str, list[float]] = {name: [] for name in model.vehicle.bodies}
    for name, axle in model.vehicle.axles.items():
        found[axle.body].append(axles[name])
    for name, hinge in model.vehicle.hinges.items():
        for body in hinge.points:
            found[body].append(hinges[name])
    for x, *ends in links.values():
        for body in ends:
            if body in found:
                found[body].append(x)
    return found


def body_motion(model: LinearModel, values: Mapping[str, float], shape: Array) -> dict[str, tuple[float, float]]:
    """Return (heave, pitch) of every body for a displacement vector `shape (n_dof,)`."""
    entries: Entries = {}
    for i, name in enumerate(model.vehicle.bodies):
        entries |= {(2 * i, j): value for j, value in model.motion.heave[name].items()}
        entries |= {(2 * i + 1, j): value for j, value in model.motion.pitch[name].items()}
    rows = np.zeros((2 * len(model.vehicle.bodies), model.n_dof))
    for place, value in model.evaluate(entries, values).items():
        rows[place] = value
    moved = rows @ shape
    return {name: (float(moved[2 * i]), float(moved[2 * i + 1])) for i, name in enumerate(model.vehicle.bodies)}


def axle_motion(
    model: LinearModel, bodies: Mapping[str, tuple[float, float]], values: Mapping[str, float], shape: Array
) -> dict[str, float]:
    """Return how far every wheel rises for a displacement vector `shape (n_dof,)`."""
    rises = {}
    names = [item.name for item in model.coordinates]
    for name, axle in model.vehicle.axles.items():
        if f"hop.{name}" in names:
            rises[name] = float(shape[names.index(f"hop.{name}")])
        else:
            heave, pitch = bodies[axle.body]
            rises[name] = heave - pitch * model.evaluate({(0, 0): to_sympy(axle.x)}, values)[0, 0]
    return rises
