"""What is known about a place at which an effect may live: loads and stiffnesses that set the scale of its parameters."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

import sympy as sp

from vehgen.effects.places import EVERY_TYRE, alike, members
from vehgen.mechanics import GRAVITY, EquationsOfMotion, derive, static_loads
from vehgen.mechanics.energies import pitch_inertia
from vehgen.vehicle import Vehicle
from vehgen.vehicle.parts import Spring

Size = Literal["k", "c", "kt", "m"]
"""Stiffness and damping of a suspension, link or hinge; stiffness of a tyre; mass of an axle."""
LEAST_HINGE_LOAD = 0.1
"""The load of a hinge counts as this share of the weight of the lighter of its bodies at least."""


@dataclass(frozen=True)
class Occurring:
    """The largest force [N] and travel [m] that occur at a spring."""

    force: float
    travel: float


@dataclass(frozen=True)
class EffectSite:
    """A place of a vehicle with its sizes.

    `load` [N] is the static load of the axle (of the link, the body's weight); of a hinge, that or a tenth of the weight of the lighter of
    its bodies, as the hitch of a balanced trailer carries next to nothing. `k` [N/m], `c` [N s/m] are its suspension's or link's; `kt`
    [N/m] its tyre's; `mass` [kg] and `inertia` [kg m^2] its body's; `length` [m] the distance between the body's outermost supports. On a
    rig without weight on axles `load` counts the largest force that occurs, too; `stroke` is the largest travel on any rig [m].
    """

    vehicle: Vehicle
    place: str
    load: float
    k: float
    c: float
    kt: float
    mass: float
    inertia: float
    length: float
    stroke: float = 0.0

    @property
    def travel(self) -> float:
        """A typical dynamic travel: a tenth of what the static load compresses the spring by, between 2 and 20 mm; half the stroke [m]."""
        if self.stroke > 0:
            return self.stroke / 2
        return min(max(0.1 * self.load / self.k, 0.002), 0.02) if self.k > 0 else 0.005

    @property
    def span(self) -> float:
        """The distance between its body's outermost supports, at least 1 m [m]."""
        return max(self.length, 1.0)

    @property
    def kind(self) -> str:
        """What holds a spring and damper there: `link`, `hinge` or `suspension`."""
        return "link" if self.place in self.vehicle.links else "hinge" if self.place in self.vehicle.hinges else "suspension"

    @property
    def spring(self) -> Spring:
        """The spring and damper of the suspension or link there."""
        found = self.vehicle.links[self.place] if self.kind == "link" else self.vehicle.axles[self.place].suspension
        assert found is not None
        return found

    def laws(self, kind: str, name: str) -> list[object]:
        """Return the force laws that a suspension, tyre, link or hinge carries already."""
        joints: dict[str, Mapping[str, Spring]] = {"hinge": self.vehicle.hinges, "link": self.vehicle.links}
        spring = joints[kind][name] if kind in joints else getattr(self.vehicle.axles[name], kind)
        return list(spring.laws)


def base_parameters(vehicle: Vehicle, place: str, sizes: Sequence[Size]) -> tuple[str, ...]:
    """Return the free parameters on which stiffnesses, dampings and masses at a place depend, in the vehicle's order.

    Parameters
    ----------
    vehicle
        The vehicle.
    place
        An axle, link, hinge, a group of axles, or all tyres; at any other place there are none.
    sizes
        Which of them.
    """
    wanted: set[str] = set()
    for name in members(vehicle, place):
        axle = vehicle.axles.get(name)
        spring = axle.suspension if axle is not None else vehicle.links.get(name) or vehicle.hinges.get(name)
        known = {} if spring is None else {"k": spring.k, "c": spring.c}
        if axle is not None:
            known["kt"] = axle.tyre.k
            known |= {} if axle.mass is None else {"m": axle.mass}
        wanted |= {used for size in sizes if size in known for used in known[size].names}
    while follow := {name for name in wanted if vehicle.parameters[name].equals is not None}:
        wanted = (wanted - follow).union(*(vehicle.parameters[name].definition.names for name in follow))
    return tuple(name for name in vehicle.free_parameters if name in wanted)


def undamped_tyres(vehicle: Vehicle, parameters: Collection[str]) -> tuple[str, ...]:
    """Return the axles to whose tyres a vehicle file gives no damping, and whose mass or tyre's stiffness depends on one of `parameters`.

    What such a tyre damps passes for a lighter axle on a softer tyre: recordings of bodies hardly tell the two apart.
    """
    values, searched = vehicle.all_values(vehicle.values()), set(vehicle.ranges())
    bare = [name for name, axle in vehicle.axles.items() if axle.tyre.c.evaluate(values) == 0 and searched.isdisjoint(axle.tyre.c.names)]
    return tuple(name for name in bare if not set(parameters).isdisjoint(base_parameters(vehicle, name, ("m", "kt"))))


class EffectLocator:
    """Looks up sites of one vehicle.

    Parameters
    ----------
    vehicle
        The vehicle.
    values
        Its free parameters [SI].
    occurring
        What occurs at suspensions and links of a rig, by name.
    """

    def __init__(self, vehicle: Vehicle, values: Mapping[str, float], occurring: Mapping[str, Occurring] | None = None) -> None:
        self.vehicle, self._occurring = vehicle, dict(occurring or {})
        self._model: EquationsOfMotion = derive(vehicle)
        known = {name: values.get(name, 0.0) for name in self._model.parameters}
        self._known = vehicle.all_values({name: known[name] for name in vehicle.free_parameters})
        self._loads = static_loads(self._model, known)
        layout = self._model.layout
        self._axles = self._evaluate(layout.axles, known)
        self._bodies = self._evaluate({name: x for name, (x, _) in layout.bodies.items()}, known)
        self._inertias = self._evaluate({name: pitch_inertia(body) for name, body in vehicle.bodies.items()}, known)

    def _evaluate(self, expressions: Mapping[str, sp.Expr], values: Mapping[str, float]) -> dict[str, float]:
        return dict(zip(expressions, self._model.evaluate_list(expressions.values(), values), strict=True))

    def site(self, place: str) -> EffectSite:
        """Return the site of an axle, link, hinge, body, axles joined by `+`; of all tyres or a group of axles, sized as their mean."""
        vehicle, known = self.vehicle, self._known
        names = members(vehicle, place)
        load = k = c = kt = 0.0
        body = names[0]
        for name in names:
            if name in vehicle.axles:
                axle = vehicle.axles[name]
                body = axle.body
                load += self._loads.axles[name]
                kt += axle.tyre.k.evaluate(known)
                if axle.suspension is not None:
                    k += axle.suspension.k.evaluate(known)
                    c += axle.suspension.c.evaluate(known)
            elif name in vehicle.links:
                link = vehicle.links[name]
                body = next(end for end, _ in link.ends if end in vehicle.bodies)
                load += abs(self._loads.elements["link", name])
                k += link.k.evaluate(known)
                c += link.c.evaluate(known)
            elif name in vehicle.hinges:
                joined = [
                    vehicle.bodies[end].mass.evaluate(known) * GRAVITY for end, _ in vehicle.hinges[name].ends if end in vehicle.bodies
                ]
                load += max(abs(self._loads.hinges[name]), LEAST_HINGE_LOAD * min(joined))
                body = vehicle.hinges[name].ends[1][0]
        occurs = [self._occurring[name] for name in names if name in self._occurring]
        load += sum(item.force for item in occurs)
        if body not in vehicle.bodies:
            body = next(iter(vehicle.bodies))
        mass = vehicle.bodies[body].mass.evaluate(known)
        marks = [self._axles[name] - self._bodies[body] for name, axle in vehicle.axles.items() if axle.body == body]
        marks += [joint.points[body].x.evaluate(known) for joint in vehicle.hinges.values() if body in joint.points]
        length = max(marks) - min(marks) if len(marks) > 1 else 1.0
        if names[0] in vehicle.bodies:
            load = mass * GRAVITY
        if place in EVERY_TYRE or alike(vehicle, place):
            load, k, c, kt = (size / len(names) for size in (load, k, c, kt))
        stroke = max((item.travel for item in occurs), default=0.0)
        if stroke > 0 and k == 0:
            k = load / stroke  # a scale for springs where there is none
        return EffectSite(vehicle, place, load, k, c, kt, mass, self._inertias[body], length, stroke)
