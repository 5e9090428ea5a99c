"""One vehicle that carries many candidate laws at once, each at the strength at which it adds nothing.

Every variant is then an individual of one population: a single kernel is compiled, and a candidate is switched on by its strength.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from vehgen.errors import InputError, did_you_mean, shown
from vehgen.files.expressions import Expression
from vehgen.files.units import NONE
from vehgen.mechanics.laws import LAWS, Kind, Law, LawParameter
from vehgen.vehicle.model import Vehicle
from vehgen.vehicle.parts import Parameter, Spring

CandidateLaw = tuple[str, Kind, str]
"""Where and which: the axle's, link's or hinge's name, `suspension`, `tyre`, `link` or `hinge`, the law's name in LAWS."""


@dataclass(frozen=True)
class Superset:
    """A vehicle with candidate laws, and the names of their parameters.

    `names[candidate][parameter of the law]` is the parameter of the vehicle; `vehicle` gives each a value (the strength's is neutral)
    and, where that lies inside it, the law's usual range.
    """

    vehicle: Vehicle
    names: Mapping[CandidateLaw, Mapping[str, str]]

    def strength(self, candidate: CandidateLaw) -> str:
        """Return the vehicle's parameter that switches a candidate on."""
        return self.names[candidate][LAWS[candidate[2]].strength]


def add_laws(vehicle: Vehicle, candidates: Iterable[CandidateLaw]) -> Superset:
    """Return the vehicle with every candidate law added, switched off.

    Parameters
    ----------
    vehicle
        A checked vehicle; laws that it has stay.
    candidates
        Places and laws, for example `("axle1", "suspension", "dry_friction")`.

    Raises
    ------
    InputError
        For a place or law that does not exist, a law that does not belong there, or a candidate given twice.
    """
    names: dict[CandidateLaw, dict[str, str]] = {}
    parameters = dict(vehicle.parameters)
    groups: dict[str, dict[str, Any]] = {"axles": dict(vehicle.axles), "links": dict(vehicle.links), "hinges": dict(vehicle.hinges)}
    for candidate in candidates:
        owner, kind, law_name = candidate
        if candidate in names:
            raise InputError(f"the candidate {law_name} on the {kind} of {owner} is given twice")
        law = _find_law(kind, law_name)
        own = names[candidate] = {}
        for item in law.parameters:
            own[item.name] = _free_name(f"{owner}_{kind}_{law_name}_{item.name}", parameters)
            parameters[own[item.name]] = _parameter(law, item, kind, owner)
        entry = {law_name: {key: Expression.symbol(name) for key, name in own.items()}}
        group = groups["axles" if kind in ("suspension", "tyre") else f"{kind}s"]
        if owner not in group:
            raise InputError(f"{vehicle.name} has no {kind} {shown(owner)}; {did_you_mean(owner, group)}")
        holder = group[owner]
        if kind in ("suspension", "tyre"):
            spring: Spring | None = getattr(holder, kind)
            if spring is None:
                raise InputError(f"{owner} of {vehicle.name} has no {kind}: its wheel sits on the body")
            change: dict[str, object] = {kind: spring.model_copy(update={"laws": (*spring.laws, entry)})}
        else:
            change = {"laws": (*holder.laws, entry)}
        group[owner] = holder.model_copy(update=change)
    return Superset(vehicle.model_copy(update={**groups, "parameters": parameters}), names)


def _find_law(kind: Kind, name: str) -> Law:
    if name not in LAWS:
        raise InputError(f"unknown force law {shown(name)}; {did_you_mean(name, LAWS)}")
    law = LAWS[name]
    if kind not in law.attaches_to:
        raise InputError(f"{name} belongs on a {' or '.join(law.attaches_to)}, not on a {kind}")
    return law


def _free_name(wanted: str, taken: Mapping[str, object]) -> str:
    name, number = wanted, 1
    while name in taken:
        number += 1
        name = f"{wanted}_{number}"
    return name


def _parameter(law: Law, item: LawParameter, kind: Kind, owner: str) -> Parameter:
    """Return a law's parameter: its strength neutral, others at their default or in the middle of their usual range."""
    if item.name == law.strength:
        value = law.neutral
    elif item.default is not None:
        value = item.default
    else:
        value = math.sqrt(item.low * item.high) if item.low > 0 else (item.low + item.high) / 2
    dimension = item.dimension(kind)
    unit = "" if dimension == NONE else str(dimension)
    inside = item.low <= value <= item.high
    return Parameter(
        value=Expression.quantity(value, unit),
        range=(Expression.quantity(item.low, unit), Expression.quantity(item.high, unit)) if inside else None,
        meaning=f"{law.title} on the {kind} of {owner}: {item.meaning}",
    )
