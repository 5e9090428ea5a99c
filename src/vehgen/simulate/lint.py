"""What looks wrong in a vehicle although its file can be read."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping

import numpy as np
import sympy as sp

from vehgen.errors import InputError
from vehgen.files.number_text import five_digits, kilonewtons, on_terminal
from vehgen.mechanics.energies import pitch_inertia
from vehgen.mechanics.equations_of_motion import GRAVITY, EquationsOfMotion
from vehgen.mechanics.law_terms import RATE, STATIC, TRAVEL
from vehgen.mechanics.static_loads import static_deflections, static_loads
from vehgen.mechanics.symbols import to_sympy
from vehgen.simulate.modes import natural_modes
from vehgen.vehicle.checks.silenced import is_silenced
from vehgen.vehicle.parts import GROUND

DEFLECTION = {"suspension": 0.35, "tyre": 0.15}
"""Suspensions and tyres that weight presses in by more [m] would long stand on their stops and rims."""
LIFT = 0.03
"""What follows may lift what pulls it by this share of its own weight: a full trailer's drawbar carries next to nothing."""
GYRATION = (0.12, 0.75)
"""Radius of gyration over the span of what is attached to a body: a uniform rod has 0.29, two masses at its ends 0.5."""
BODY_BAND = (0.5, 5.0)
"""Where body modes of road vehicles lie, Hz."""
LEAST_PUSH = 1e-6
"""A law that pushes at rest with less than this share of the weight does not."""
AXLE_GAP = 0.6
"""Two axles closer than this [m] would share a wheel's space."""
LINK_GAP = 0.1
"""Ends of a link that stand farther apart along the vehicle than this [m] are a mistake, as a link acts vertically."""
MOUNT_BAND = (0.5, 30.0)
"""Where modes of what is mounted on a body lie, Hz: seats and cabs low, engines high."""
Finding = tuple[str, str, str]
"""The kind of a warning, the part that it speaks of, and what it says."""


def lint(model: EquationsOfMotion, values: Mapping[str, float] | None = None) -> list[str]:
    """Return one sentence for each thing that deserves a second look, at these parameter values, but for what the file silences."""
    values = values or model.values()
    try:
        rest = static_loads(model, values)
        findings, found = [*_loads(rest.axles), *_deflections(static_deflections(model, values, rest))], list[str]()
        findings += _lifts(model, values, rest.hinges)
    except InputError as error:
        findings, found = [], [error.message]
    findings += (*_gyration(model, values), *_gaps(model, values), *_links(model, values), *_modes(model, values))
    found += _acting_at_rest(model, values)
    return [*found, *(text for kind, part, text in findings if not is_silenced(model.vehicle, kind, part))]


def _acting_at_rest(model: EquationsOfMotion, values: Mapping[str, float]) -> Iterator[str]:
    """Warn of laws whose travel counts from static equilibrium, and that push there all the same."""
    at_rest, pushes, where = dict.fromkeys((TRAVEL, RATE, STATIC), sp.S.Zero), list[sp.Expr](), list[str]()
    for element in model.elements:
        for term in element.laws:
            if term.origin == "static" and not term.asks_static:
                pushes.append(term.step().now.subs(at_rest).subs({sp.Symbol(f"_{name}", real=True): 0 for name in term.law.states}))
                where.append(f"{term.law.name} on the {element.kind} {element.name}")
    for text, push in zip(where, model.evaluate_list(pushes, values), strict=True):
        if abs(push) > LEAST_PUSH * GRAVITY * model.total_mass(values):
            yield (
                f"{text} pushes with {five_digits(push)} N at rest, which static loads leave out: the vehicle starts out of balance; "
                "with `from: unloaded` it counts"
            )


def _loads(loads: Mapping[str, float]) -> Iterator[Finding]:
    for name, force in loads.items():
        if force < 0:
            text = f"negative load on {name}: {on_terminal(kilonewtons(force))} kN; its tyre would have to pull the vehicle down"
            yield "negative_load", name, text


def _lifts(model: EquationsOfMotion, values: Mapping[str, float], hinges: Mapping[str, float]) -> Iterator[Finding]:
    """Find hinges at which a body lifts the one that pulls it, all its axles being behind: not a bogie under a frame, nor a sprung arm."""
    layout, vehicle = model.layout, model.vehicle
    linked = [set(link.points) for link in vehicle.links.values()]
    for name, hinge in vehicle.hinges.items():
        (first, second), force = hinge.points, hinges[name]
        for ahead, behind, carried in ((first, second, force), (second, first, -force)):
            axles = [layout.axles[axle] for axle, item in vehicle.axles.items() if item.body == behind]
            mass, pin, *places = model.evaluate_list([to_sympy(vehicle.bodies[behind].mass), layout.hinges[name][0], *axles], values)
            pulled = pin > max(places, default=np.inf) and {ahead, behind} not in linked
            if pulled and carried < -LIFT * GRAVITY * mass:
                lifts = f"{behind} lifts {ahead} by {on_terminal(kilonewtons(-carried))} kN"
                yield "lift", name, f"at {name}, {lifts}: its COG is behind its axles; is a sign of its places wrong?"


def _deflections(deflections: Mapping[tuple[str, str], float]) -> Iterator[Finding]:
    for (kind, name), travel in deflections.items():
        if travel > DEFLECTION.get(kind, np.inf):
            yield (
                "deflection",
                name,
                f"the {kind} of {name} is pressed in by {travel:.2f} m at rest: too much load or too soft",
            )


def _gyration(model: EquationsOfMotion, values: Mapping[str, float]) -> Iterator[Finding]:
    vehicle = model.vehicle
    for name, body in vehicle.bodies.items():
        places = [to_sympy(axle.x) for axle in vehicle.axles.values() if axle.body == name]
        places += [to_sympy(joint.points[name].x) for joint in (*vehicle.hinges.values(), *vehicle.links.values()) if name in joint.points]
        if "pitch" not in body.motions or len(places) < 2:
            continue
        mass, inertia, *x = model.evaluate_list([to_sympy(body.mass), pitch_inertia(body), *places], values)
        span = max(x) - min(x)
        if span <= 0 or mass <= 0:
            continue
        radius = float(np.sqrt(inertia / mass))
        if not GYRATION[0] <= radius / span <= GYRATION[1]:
            yield (
                "gyration",
                name,
                f"radius of gyration of {name} out of scale: {radius:.2f} m for a body whose joints and axles span {span:.2f} m "
                f"({GYRATION[0] * span:.2f} to {GYRATION[1] * span:.2f} m would be usual)",
            )


def _gaps(model: EquationsOfMotion, values: Mapping[str, float]) -> Iterator[Finding]:
    offsets = model.wheel_offsets(values)
    names = list(model.vehicle.axles)
    order = np.argsort(offsets)
    for first, second in itertools.pairwise(order):
        gap = offsets[second] - offsets[first]
        if gap < AXLE_GAP:
            text = f"overlapping axles: {names[first]} and {names[second]} are {gap:.2f} m apart"
            yield "axle_gap", names[second], text


def _links(model: EquationsOfMotion, values: Mapping[str, float]) -> Iterator[Finding]:
    vehicle, bodies = model.vehicle, model.layout.bodies
    linked = {name: link.ends for name, link in vehicle.links.items() if GROUND not in link.points}
    apart = [
        bodies[one][0] + to_sympy(first.x) - bodies[other][0] - to_sympy(second.x) for (one, first), (other, second) in linked.values()
    ]
    for name, gap in zip(linked, model.evaluate_list(apart, values), strict=True):
        if abs(gap) > LINK_GAP:
            text = f"the ends of the link {name} stand {abs(gap):.2f} m apart along the vehicle; a link acts vertically: put its `x` right"
            yield "link_gap", name, text


def _modes(model: EquationsOfMotion, values: Mapping[str, float]) -> Iterator[Finding]:
    vehicle = model.vehicle
    if not vehicle.axles:
        return  # a rig may move as fast or as slowly as it likes
    unsprung = {axle.body for axle in vehicle.axles.values() if axle.suspension is None and len(vehicle.axles) > 1}
    mounted = mounted_bodies(model, values)
    rigid = [item.motion in ("heave", "pitch") and item.owner not in unsprung for item in model.coordinates]
    for mode in natural_modes(model, values):
        share = mode.energy * rigid
        if share.sum() <= 0.5:
            continue
        body = model.coordinates[int(np.argmax(share))].owner
        what, (low, high) = ("mount mode", MOUNT_BAND) if body in mounted else ("body mode", BODY_BAND)
        if not low <= mode.undamped_hz <= high:
            yield "body_mode", body, f"{what} outside {low:g}-{high:g} Hz: {mode.name} at {mode.undamped_hz:.2f} Hz"


def mounted_bodies(model: EquationsOfMotion, values: Mapping[str, float]) -> set[str]:
    """Return the bodies that are mounted on others by links alone, as cabs, seats and engines are; never the heaviest body."""
    vehicle = model.vehicle
    masses = dict(zip(vehicle.bodies, model.evaluate_list([to_sympy(body.mass) for body in vehicle.bodies.values()], values), strict=True))
    held = {axle.body for axle in vehicle.axles.values()} | {name for hinge in vehicle.hinges.values() for name in hinge.points}
    linked = {name for link in vehicle.links.values() for name in link.points if GROUND not in link.points}
    return (linked & set(masses)) - held - {max(masses, key=masses.__getitem__)}
