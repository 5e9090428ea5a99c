"""What refers to what: parameters through `equals`, bodies through hinges, carriers and links."""

from __future__ import annotations

from collections.abc import Iterable

from vehgen.errors import InputError, did_you_mean, shown, trail_text
from vehgen.vehicle.model import Vehicle
from vehgen.vehicle.parts import GROUND

MAX_CHAIN = 100
"""So many parameters may follow one another through `equals`."""


class Groups:
    """Bodies in groups that are joined one by one."""

    def __init__(self, bodies: Iterable[str]) -> None:
        self._parent = {name: name for name in bodies}

    def root(self, body: str) -> str:
        """Return the body that stands for the group of a body."""
        while self._parent[body] != body:
            body = self._parent[body]
        return body

    def join(self, first: str, second: str) -> None:
        """Make one group of those of two bodies."""
        self._parent[self.root(second)] = self.root(first)


def check_circles(vehicle: Vehicle) -> None:
    """Refuse unknown symbols in `equals`, and chains of `equals` that bite their tail or are very long."""
    depths: dict[str, int] = {}

    def visit(name: str, trail: tuple[str, ...]) -> int:
        if name in trail:
            circle = trail_text((*trail[trail.index(name) :], name))
            raise InputError(f"circular `equals`: {circle}", vehicle.position("parameters", trail[-1], "equals"))
        definition = vehicle.parameters[name].equals
        if name in depths or definition is None:
            return depths.get(name, 0)
        place = vehicle.position("parameters", name, "equals")
        too_long = f"more than {MAX_CHAIN} parameters follow one another through `equals`"
        if len(trail) >= MAX_CHAIN:
            raise InputError(too_long, place)
        depths_below = [0]
        for symbol in definition.symbols:
            if symbol.name not in vehicle.parameters:
                raise InputError(
                    f"unknown symbol {shown(symbol.name)}; {did_you_mean(symbol.name, vehicle.parameters)}",
                    vehicle.position("parameters", name, "equals", offset=symbol.offset),
                )
            depths_below.append(visit(symbol.name, (*trail, name)))
        depths[name] = 1 + max(depths_below)
        if depths[name] > MAX_CHAIN:
            raise InputError(too_long, place)
        return depths[name]

    for name in vehicle.parameters:
        visit(name, ())


def check_connections(vehicle: Vehicle) -> None:
    """Refuse parts on bodies that are not there, bodies that nothing moves, and hinges on bodies that cannot be hinged."""
    for name, axle in vehicle.axles.items():
        _check_body(vehicle, axle.body, "axles", name, "body")
    for name, body in vehicle.bodies.items():
        if body.carried_by is not None:
            _check_body(vehicle, body.carried_by.body, "bodies", name, "carried_by", "body")
        elif not body.motions:
            message = f"body {name!r} has no motions and nothing carries it; give it `carried_by`"
            raise InputError(message, vehicle.position("bodies", name, key=True))
        if len(set(body.motions)) != len(body.motions):
            raise InputError("a motion is listed twice", vehicle.position("bodies", name, "motions"))
    for name, link in vehicle.links.items():
        for end in link.points:
            if end != GROUND:
                _check_body(vehicle, end, "links", name, end, key=True)
    for name, hinge in vehicle.hinges.items():
        for end in hinge.points:
            _check_body(vehicle, end, "hinges", name, end, key=True)
            body = vehicle.bodies[end]
            if set(body.motions) != {"heave", "pitch"} or body.carried_by is not None:
                message = f"a hinged body needs heave and pitch of its own and no carrier; {end!r} has not"
                raise InputError(message, vehicle.position("hinges", name, end, key=True))


def _check_body(vehicle: Vehicle, name: str, *path: str, key: bool = False) -> None:
    allowed = [*vehicle.bodies, *([GROUND] if path[0] == "links" else [])]
    if name not in allowed:
        raise InputError(f"no body {shown(name)}; {did_you_mean(name, allowed)}", vehicle.position(*path, key=key))


def check_hinges(vehicle: Vehicle) -> None:
    """Refuse loops of hinges."""
    groups = Groups(vehicle.bodies)
    for name, hinge in vehicle.hinges.items():
        (first, _), (second, _) = hinge.ends
        if groups.root(first) == groups.root(second):
            message = f"a loop of hinges: {first!r} and {second!r} are already joined through other hinges; use a link instead"
            raise InputError(message, vehicle.position("hinges", name, key=True))
        groups.join(first, second)


def check_carriers(vehicle: Vehicle) -> None:
    """Refuse bodies that carry each other in a circle."""
    for name in vehicle.bodies:
        trail = [name]
        while (carrier := vehicle.bodies[trail[-1]].carried_by) is not None:
            if carrier.body in trail:
                message = f"bodies carry each other in a circle: {trail_text((*trail, carrier.body))}"
                raise InputError(message, vehicle.position("bodies", name, "carried_by"))
            trail.append(carrier.body)


def check_placement(vehicle: Vehicle) -> None:
    """Refuse `at` for a body that is placed already, by hinges, carriers or links."""
    groups = Groups(vehicle.bodies)
    for joint in (*vehicle.hinges.values(), *vehicle.links.values()):
        if GROUND not in joint.points:
            groups.join(*joint.points)
    for name, body in vehicle.bodies.items():
        if body.carried_by is not None:
            groups.join(body.carried_by.body, name)
    placed = {groups.root(next(iter(vehicle.bodies)))}
    for name, body in vehicle.bodies.items():
        if body.at is not None:
            if groups.root(name) in placed:
                message = f"body {name!r} is placed already, by what connects it to the first body (or to one that has `at`); remove `at`"
                raise InputError(message, vehicle.position("bodies", name, "at", key=True))
            placed.add(groups.root(name))
