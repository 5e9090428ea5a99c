"""Where effects can live: functions that name the places of a vehicle and of its runs."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import pairwise

from vehgen.fit.trial import Trial
from vehgen.mechanics import ElementOutput, PointOutput
from vehgen.vehicle import Vehicle

Places = Callable[[Vehicle, Sequence[Trial]], tuple[str, ...]]
"""Names the places of a vehicle and its runs."""
ALL_TYRES = "all tyres"
EACH_TYRE = "each tyre"
"""All tyres as well, each with numbers of its own."""
EVERY_TYRE = (ALL_TYRES, EACH_TYRE)
ALL_SUSPENSIONS = "all suspensions"
ALIKE = " and "
"""Joins the axles of a group whose suspensions change alike, by the same numbers."""
ALL_RUNS = "all runs"


def alike(vehicle: Vehicle, place: str) -> tuple[str, ...]:
    """Return the axles of a group whose suspensions change alike; nothing at other places."""
    if place == ALL_SUSPENSIONS:
        return tuple(_suspended(vehicle))
    return tuple(place.split(ALIKE)) if ALIKE in place else ()


def members(vehicle: Vehicle, place: str) -> tuple[str, ...]:
    """Return the axles that a place is of, or the place itself: all of them, a group, or those joined by `+`."""
    if place in EVERY_TYRE:
        return tuple(vehicle.axles)
    return alike(vehicle, place) or tuple(place.split("+"))


def _suspended(vehicle: Vehicle) -> list[str]:
    return [name for name, axle in vehicle.axles.items() if axle.suspension is not None]


def _groups(vehicle: Vehicle, suspended: Sequence[str]) -> tuple[str, ...]:
    """Return groups of axles: all of them, and neighbours of one body behind the first axle, where these are not all."""
    if len(suspended) < 2:
        return ()
    bodies = dict.fromkeys(vehicle.axles[name].body for name in suspended)
    rear = [[name for name in suspended[1:] if vehicle.axles[name].body == body] for body in bodies]
    return (ALL_SUSPENSIONS, *(ALIKE.join(names) for names in rear if len(names) > 1))


def wheels(vehicle: Vehicle, trials: Sequence[Trial]) -> tuple[str, ...]:
    """Return every axle, where a run moves along a road: on a rig no wheel turns."""
    return tuple(vehicle.axles) if any(trial.scenario.top_speed > 0 for trial in trials) else ()


def nowhere(vehicle: Vehicle, trials: Sequence[Trial]) -> tuple[str, ...]:
    """Return no place."""
    return ()


def suspensions(vehicle: Vehicle, trials: Sequence[Trial]) -> tuple[str, ...]:
    """Return every axle with a suspension, then every link, both a spring and damper with room for laws; then groups of axles."""
    own = _suspended(vehicle)
    return (*own, *vehicle.links, *_groups(vehicle, own))


def dampers(vehicle: Vehicle, trials: Sequence[Trial]) -> tuple[str, ...]:
    """Return the suspensions and links that have a dashpot; then groups of axles, where all have one."""
    springs = {name: axle.suspension for name, axle in vehicle.axles.items() if axle.suspension is not None} | vehicle.links
    damped = {name for name, spring in springs.items() if spring.c.names or spring.c.evaluate({}) > 0}
    return tuple(name for name in suspensions(vehicle, trials) if damped.issuperset(alike(vehicle, name) or (name,)))


def springless(vehicle: Vehicle, trials: Sequence[Trial]) -> tuple[str, ...]:
    """Return the links that have a damper or laws, but no stiffness."""
    return tuple(name for name, link in vehicle.links.items() if not link.k.names and link.k.evaluate({}) == 0)


def axles(vehicle: Vehicle, trials: Sequence[Trial]) -> tuple[str, ...]:
    """Return every axle."""
    return tuple(vehicle.axles)


def all_tyres(vehicle: Vehicle, trials: Sequence[Trial]) -> tuple[str, ...]:
    """Return all tyres as one place."""
    return (ALL_TYRES,) if vehicle.axles else ()


def tyres(vehicle: Vehicle, trials: Sequence[Trial]) -> tuple[str, ...]:
    """Return all tyres as one place, then every axle's."""
    return (ALL_TYRES, *vehicle.axles) if vehicle.axles else ()


def tyres_alike_or_each(vehicle: Vehicle, trials: Sequence[Trial]) -> tuple[str, ...]:
    """Return all tyres as one place, every axle's, then all tyres each for itself, where there are several."""
    return (*tyres(vehicle, trials), *((EACH_TYRE,) if len(vehicle.axles) > 1 else ()))


def hinges(vehicle: Vehicle, trials: Sequence[Trial]) -> tuple[str, ...]:
    """Return every hinge."""
    return tuple(vehicle.hinges)


def pitching_bodies(vehicle: Vehicle, trials: Sequence[Trial]) -> tuple[str, ...]:
    """Return every body that heaves and pitches and rides on axles or hinges; a tandem's beam, which the body carries, is none."""
    carried = {axle.body for axle in vehicle.axles.values()} | {name for hinge in vehicle.hinges.values() for name in hinge.points}
    return tuple(name for name, body in vehicle.bodies.items() if name in carried and body.carried_by is None)


def front_body(vehicle: Vehicle, trials: Sequence[Trial]) -> tuple[str, ...]:
    """Return the body of the first axle of a vehicle of three axles or more: the one that may carry a cab."""
    return (next(iter(vehicle.axles.values())).body,) if len(vehicle.axles) > 2 else ()


def loading_bodies(vehicle: Vehicle, trials: Sequence[Trial]) -> tuple[str, ...]:
    """Return the bodies that may carry a load: all that pitch but the one with the cab, or that one where there is no other."""
    every = pitching_bodies(vehicle, trials)
    return tuple(name for name in every if name not in front_body(vehicle, trials)) or every


def long_bodies(vehicle: Vehicle, trials: Sequence[Trial]) -> tuple[str, ...]:
    """Return bodies that pitch and do not bend yet."""
    return tuple(name for name in pitching_bodies(vehicle, trials) if vehicle.bodies[name].bending is None)


def tandems(vehicle: Vehicle, trials: Sequence[Trial]) -> tuple[str, ...]:
    """Return pairs of neighbouring axles of one body behind the first axle, whose suspensions are linear, as `first+second`.

    Not those of which a suspension's travel or force was recorded, or that a run lifts as it begins: on a beam they have no suspension
    and no hop.
    """
    outputs = [channel.output for trial in trials for channel in trial.recording.channels]
    own = {item.owner for item in outputs if isinstance(item, ElementOutput) and item.quantity.startswith("suspension_")}
    own |= {name for trial in trials for name in trial.run.file.initial}
    names = [name for name, axle in vehicle.axles.items() if axle.suspension is not None and not axle.suspension.laws][1:]
    pairs = [pair for pair in pairwise(names) if own.isdisjoint(pair)]
    return tuple(f"{one}+{two}" for one, two in pairs if vehicle.axles[one].body == vehicle.axles[two].body)


def sensors(vehicle: Vehicle, trials: Sequence[Trial]) -> tuple[str, ...]:
    """Return every sensor of the runs."""
    return tuple(dict.fromkeys(channel.sensor for trial in trials for channel in trial.recording.channels))


def sensors_on_bodies(vehicle: Vehicle, trials: Sequence[Trial]) -> tuple[str, ...]:
    """Return every sensor of the runs that sits at a point of a body; one of an axle or link has no place to shift."""
    every = (channel for trial in trials for channel in trial.recording.channels)
    return tuple(dict.fromkeys(channel.sensor for channel in every if isinstance(channel.output, PointOutput)))


def channels(vehicle: Vehicle, trials: Sequence[Trial]) -> tuple[str, ...]:
    """Return every channel of the runs; not the only one of a rig: its gain is like masses, springs and dampers times a factor."""
    found = tuple(dict.fromkeys(name for trial in trials for name in trial.channels))
    return found if vehicle.axles or len(found) > 1 else ()


def runs(vehicle: Vehicle, trials: Sequence[Trial]) -> tuple[str, ...]:
    """Return all runs as one place, where the vehicle has wheels to run on."""
    return (ALL_RUNS,) if vehicle.axles else ()
