"""Where to draw what: a side view of the vehicle in metres, from its layout and, where the file is silent, plausible outlines."""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import sympy as sp

from vehgen.mechanics import EquationsOfMotion
from vehgen.report.drawing.stacking import HALF_HEIGHT, Box, Strut, is_beam, set_apart, stack_heights, stand_link, stand_suspension
from vehgen.vehicle.parts import GROUND


@dataclass(frozen=True)
class Sketch:
    """Positions in metres: x forward from the first body's COG, z up from the road."""

    boxes: dict[str, Box]
    axles: dict[str, float]
    hinges: dict[str, tuple[float, float]]
    suspensions: dict[str, Strut]
    links: dict[str, Strut]
    arms: tuple[tuple[str, float, float], ...]
    wheel_radius: float

    @property
    def left(self) -> float:
        """The rearmost point."""
        return min([box.left for box in self.boxes.values()] + [x - self.wheel_radius for x in self.axles.values()])

    @property
    def right(self) -> float:
        """The foremost point."""
        return max([box.right for box in self.boxes.values()] + [x + self.wheel_radius for x in self.axles.values()])

    @property
    def top(self) -> float:
        """The highest point."""
        ends = [strut.top for strut in (*self.suspensions.values(), *self.links.values())]
        return max([box.top for box in self.boxes.values()] + [z for _, z in self.hinges.values()] + ends)


def _places(
    model: EquationsOfMotion, points: Mapping[str, tuple[sp.Expr, sp.Expr | None]], values: Mapping[str, float]
) -> dict[str, tuple[float, float | None]]:
    """Return points in numbers: ahead, and above where that is known [m]."""
    x = model.evaluate_list((x for x, _ in points.values()), values)
    heights = {name: z for name, (_, z) in points.items() if z is not None}
    z = dict(zip(heights, model.evaluate_list(heights.values(), values), strict=True))
    return {name: (place, z.get(name)) for name, place in zip(points, x, strict=True)}


def make_sketch(model: EquationsOfMotion, values: Mapping[str, float]) -> Sketch:
    """Place every part of a vehicle for drawing."""
    vehicle, layout = model.vehicle, model.layout
    bodies = _places(model, layout.bodies, values)
    pins = _places(model, layout.hinges, values)
    axles = dict(zip(layout.axles, model.evaluate_list(layout.axles.values(), values), strict=True))
    everything = vehicle.all_values({name: values[name] for name in vehicle.free_parameters})
    links: dict[str, tuple[float, str, str]] = {}
    for name, link in vehicle.links.items():
        (first, first_point), (second, second_point) = link.ends
        owner, point = (second, second_point) if first == GROUND else (first, first_point)
        links[name] = (bodies[owner][0] + point.x.evaluate(everything), first, second)
    radius = _wheel_radius([x for x, _ in bodies.values()], list(axles.values()))
    attached = _attached(model, axles, {name: x for name, (x, _) in pins.items()}, links)
    outlines = _outlines(model, {name: x for name, (x, _) in bodies.items()}, attached, everything)
    heights, lift = stack_heights(model, bodies, outlines, links, radius)
    hinges = {name: (x, heights[next(iter(vehicle.hinges[name].points))] if z is None else z + lift) for name, (x, z) in pins.items()}
    boxes = {}
    for name, (left, right, half, declared) in outlines.items():
        z = heights[name]
        low = [hinges[key][1] for key, hinge in vehicle.hinges.items() if name in hinge.points and not declared and half > 0.1]
        x, given = bodies[name]
        known = given is not None and abs(given + lift - z) < 1e-9
        boxes[name] = Box(x, z, left, right, min([z - half, *low]), z + half, declared, known)
    suspensions = {
        name: stand_suspension(axles[name], name, axle.body, boxes[axle.body], radius)
        for name, axle in vehicle.axles.items()
        if axle.suspension is not None
    }
    struts = {name: stand_link(x, first, second, boxes) for name, (x, first, second) in links.items()}
    struts = set_apart(struts, {name: second == GROUND for name, (_, _, second) in links.items()}, boxes)
    arms = [(body, *hinges[name]) for name, hinge in vehicle.hinges.items() for body in hinge.points]
    arms += [(strut.upper, strut.x, strut.top) for strut in (*suspensions.values(), *struts.values())]
    arms += [(strut.lower, strut.x, strut.bottom) for strut in struts.values()]
    arms += [(axle.body, axles[name], radius) for name, axle in vehicle.axles.items() if axle.suspension is None]
    return Sketch(boxes, axles, hinges, suspensions, struts, tuple(arm for arm in arms if arm[0] in boxes), radius)


def _wheel_radius(bodies: list[float], axles: list[float]) -> float:
    """Return 0.5 m for trucks, less for short vehicles and where wheels would touch [m]."""
    places = [*bodies, *axles]
    radius = float(np.clip(0.08 * (max(places) - min(places)) + 0.05, 0.3, 0.5))
    gaps = [right - left for left, right in itertools.pairwise(sorted(axles)) if right - left > 0.2]
    return min(radius, 0.47 * min(gaps, default=np.inf))


def _attached(
    model: EquationsOfMotion, axles: Mapping[str, float], hinges: Mapping[str, float], links: Mapping[str, tuple[float, str, str]]
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


def _outlines(
    model: EquationsOfMotion, places: Mapping[str, float], attached: Mapping[str, list[float]], everything: Mapping[str, float]
) -> dict[str, tuple[float, float, float, bool]]:
    """Return left, right, half the height [m] of every body and whether the file gives them."""
    outlines = {}
    for name, body in model.vehicle.bodies.items():
        x, reach = places[name], [*attached[name], places[name]]
        if body.bending is not None:
            half = body.bending.length.evaluate(everything) / 2
            reach += [x - half + 0.4, x + half - 0.4]
        if body.size is not None:
            half = body.size.length.evaluate(everything) / 2
            outlines[name] = (x - half, x + half, body.size.height.evaluate(everything) / 2, True)
        elif is_beam(model, name, reach):
            outlines[name] = (min(reach) - 0.1, max(reach) + 0.1, 0.09, False)
        elif max(reach) - min(reach) < 0.1:
            largest = 0.55 if name in {axle.body for axle in model.vehicle.axles.values()} else 0.9
            half = float(np.clip(0.42 * np.cbrt(max(body.mass.evaluate(everything), 1.0) / 1000.0), 0.2, largest))
            outlines[name] = (min(reach) - half, max(reach) + half, 0.9 * half, False)
        else:
            outlines[name] = (min(reach) - 0.4, max(reach) + 0.4, HALF_HEIGHT, False)
    return outlines
