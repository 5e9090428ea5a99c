"""The force laws of a vehicle's suspensions, tyres, links and hinges: names, parameters and units checked."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal, get_args

import sympy as sp

from vehgen.errors import InputError, did_you_mean, shortened, shown
from vehgen.files.checks import check_dimension, dimension_of, value_of
from vehgen.files.expressions import Expression
from vehgen.files.units import FORCE, LENGTH, MOMENT, NONE, TIME
from vehgen.mechanics.law_slopes import check_slopes
from vehgen.mechanics.laws import LAWS, Kind, Law, LawParameter, LawState, LawStep, custom_law
from vehgen.mechanics.symbols import number, to_sympy
from vehgen.vehicle.model import Vehicle
from vehgen.vehicle.parts import LawEntry, Spring

TravelOrigin = Literal["static", "unloaded"]
"""Where a law's travel counts from: static equilibrium, or the position in which the spring carries nothing."""
TRAVEL, RATE, TIME_STEP, STATIC, REST = (sp.Symbol(name, real=True) for name in ("_d", "_v", "_h", "_static", "_rest"))
"""Travel from equilibrium and its rate, the time step, the element's static force, its travel from unloaded to static equilibrium."""


@dataclass(frozen=True)
class LawTerm:
    """A force law with its parameters as expressions of the vehicle's symbols [SI], and where its travel counts from."""

    law: Law
    parameters: Mapping[str, sp.Expr]
    origin: TravelOrigin = "static"

    def step(
        self,
        k: sp.Expr = sp.S.Zero,
        c: sp.Expr = sp.S.Zero,
        states: Mapping[str, sp.Symbol] | None = None,
        beside: LawStep | None = None,
    ) -> LawStep:
        """Return the law over a step as expressions of TRAVEL, RATE, TIME_STEP, STATIC, REST and its states.

        A law whose travel counts from the unloaded position adds to the static force: f(REST + TRAVEL) - f(REST).

        Parameters
        ----------
        k, c
            Stiffness [N/m] and damping [N s/m] of the element that carries it.
        states
            The symbols of the law's states (default: symbols of their names).
        beside
            What the element's other laws make of the step, where the law limits all of them (default: there are none).
        """
        states = states if states is not None else {name: sp.Symbol(f"_{name}", real=True) for name in self.law.states}
        if self.origin == "static":
            others = {} if beside is None else {"beside": beside}
            return self.law.write(LawState(TRAVEL, RATE, TIME_STEP, k, c, STATIC, states, **others), self.parameters)
        written = self.law.write(LawState(REST + TRAVEL, RATE, TIME_STEP, k, c, STATIC, states), self.parameters)
        return replace(written, force=written.force - self.preload(), now=written.now - self.preload())

    def preload(self) -> sp.Expr:
        """Return what the law carries in static equilibrium, an expression of REST [N]: nothing if it counts from there."""
        if self.origin == "static":
            return sp.S.Zero
        return self.law.write(LawState(REST, sp.S.Zero, TIME_STEP, sp.S.Zero, sp.S.Zero, STATIC), self.parameters).now

    @property
    def asks_static(self) -> bool:
        """Whether the law depends on its element's static force."""
        return STATIC in self.step().force.free_symbols


def element_steps(laws: Sequence[LawTerm], k: sp.Expr, c: sp.Expr, states: Sequence[Mapping[str, sp.Symbol]]) -> list[LawStep]:
    """Return an element's laws over a step, in their order; one that limits the whole force acts on what the others make.

    Parameters
    ----------
    laws
        The element's.
    k, c
        Its stiffness [N/m] and damping [N s/m].
    states
        The symbols of each law's states, by name.
    """
    found: dict[int, LawStep] = {}
    for i in sorted(range(len(laws)), key=lambda i: laws[i].law.limits_all):
        others = list(found.values())
        slopes = [step.slope for step in others if step.force != 0]
        beside = LawStep(
            force=sp.Add(*(step.force for step in others)),
            now=sp.Add(*(step.now for step in others)),
            slope=None if None in slopes else sp.Add(*slopes),
        )
        found[i] = laws[i].step(k, c, states[i], beside)
    return [found[i] for i in range(len(laws))]


def read_laws(vehicle: Vehicle, kind: Kind, name: str) -> tuple[LawTerm, ...]:
    """Return the laws of an axle's suspension or tyre, a link, or a hinge.

    Raises
    ------
    InputError
        For an unknown law or parameter, a missing one, or a wrong unit, at its place in the file.
    """
    path, spring = _find(vehicle, kind, name)
    terms = []
    for index, entry in enumerate(spring.laws):
        for law_name, given in entry.items():
            terms.append(_read(vehicle, kind, (*path, "laws", index, law_name), law_name, given))
    return tuple(terms)


def _find(vehicle: Vehicle, kind: Kind, name: str) -> tuple[tuple[str | int, ...], Spring]:
    if kind == "link":
        return ("links", name), vehicle.links[name]
    if kind == "hinge":
        return ("hinges", name), vehicle.hinges[name]
    axle = vehicle.axles[name]
    spring = axle.suspension if kind == "suspension" else axle.tyre
    assert spring is not None
    return ("axles", name, kind), spring


def _read(vehicle: Vehicle, kind: Kind, path: tuple[str | int, ...], name: str, given: LawEntry) -> LawTerm:
    if name == "law":
        return _read_custom(vehicle, kind, path, given)
    if name not in LAWS:
        raise InputError(f"unknown force law {shown(name)}; {did_you_mean(name, [*LAWS, 'law'])}", vehicle.position(*path, key=True))
    law = LAWS[name]
    if kind not in law.attaches_to:
        raise InputError(f"{name} belongs on a {' or '.join(law.attaches_to)}, not on a {kind}", vehicle.position(*path, key=True))
    known = {parameter.name: parameter for parameter in law.parameters}
    for key in given:
        if key not in known and key != "from":
            raise InputError(
                f"{name} has no parameter {shown(key)}; {did_you_mean(key, [*known, 'from'])}", vehicle.position(*path, key, key=True)
            )
    values = {}
    for key, parameter in known.items():
        expression = given.get(key)
        if expression is None:
            if parameter.default is None:
                raise InputError(f"{name} lacks its parameter {shown(key)}: {parameter.meaning}", vehicle.position(*path, key=True))
            values[key] = number(parameter.default)
            continue
        if not isinstance(expression, Expression):
            raise InputError(f"{key} is a quantity, not a mapping", vehicle.position(*path, key))
        check_dimension(expression, parameter.dimension(kind), vehicle.dimensions, vehicle.document, *path, key)
        _check_range(vehicle, expression, name, parameter, (*path, key))
        values[key] = to_sympy(expression)
    return _with_origin(vehicle, path, given, LawTerm(law, values))


def check_laws(vehicle: Vehicle, free: Mapping[str, float], where: str = "") -> None:
    """Check that quantities of force laws are what they may be, mostly not negative, for these values of the free parameters [SI].

    Raises
    ------
    InputError
        At the first that is; `where` is added to its message.
    """
    known: dict[str, float] | None = None
    for kind, name in _springs(vehicle):
        path, spring = _find(vehicle, kind, name)
        for index, entry in enumerate(spring.laws):
            for law_name, given in entry.items():
                for parameter in LAWS[law_name].parameters if law_name in LAWS else ():
                    expression = given.get(parameter.name)
                    if isinstance(expression, Expression):
                        known = vehicle.all_values(free) if known is None else known
                        place = (*path, "laws", index, law_name, parameter.name)
                        _check_at(vehicle, known, where, expression, law_name, parameter, place)


def _springs(vehicle: Vehicle) -> Iterator[tuple[Kind, str]]:
    """Yield what may carry laws."""
    for name, axle in vehicle.axles.items():
        if axle.suspension is not None:
            yield "suspension", name
        yield "tyre", name
    yield from (("link", name) for name in vehicle.links)
    yield from (("hinge", name) for name in vehicle.hinges)


def _check_range(vehicle: Vehicle, expression: Expression, law: str, parameter: LawParameter, path: tuple[str | int, ...]) -> None:
    """Refuse what cannot be by the file's values, a set's or at the ends of ranges; one without symbols has one value."""
    if not expression.names:
        _check_at(vehicle, {}, "", expression, law, parameter, path)
        return
    values, ranges = vehicle.values(), vehicle.ranges()
    tried = [(values, "")] + [(vehicle.values(name), f" in the set {shown(name)}") for name in vehicle.sets]
    for name in sorted(expression.names & ranges.keys()):
        tried += [({**values, name: end}, f" at the end of the range of {name}") for end in ranges[name]]
    for free, where in tried:
        _check_at(vehicle, vehicle.all_values(free), where, expression, law, parameter, path)


def _check_at(
    vehicle: Vehicle,
    known: Mapping[str, float],
    where: str,
    expression: Expression,
    law: str,
    parameter: LawParameter,
    path: tuple[str | int, ...],
) -> None:
    value = value_of(expression, known, vehicle.document, *path)
    if (reason := parameter.refusal(value)) is not None:
        raise InputError(f"{parameter.name} of {law} {reason}, found {value:g}{where}", vehicle.position(*path))


def _with_origin(vehicle: Vehicle, path: tuple[str | int, ...], given: LawEntry, term: LawTerm) -> LawTerm:
    """Read `from`; only a force that travel alone decides can count from the unloaded position."""
    entry = given.get("from")
    if entry is None:
        return term
    origin: TravelOrigin | None = next(
        (item for item in get_args(TravelOrigin) if isinstance(entry, Expression) and entry.text.strip() == item), None
    )
    if origin is None:
        found = entry.text if isinstance(entry, Expression) else "a mapping"
        raise InputError(f"`from` is static or unloaded, found {shortened(found)}", vehicle.position(*path, "from"))
    step = term.step()
    if origin == "unloaded" and (TRAVEL not in step.now.free_symbols or STATIC in step.now.free_symbols or term.law.states):
        raise InputError(
            f"{term.law.name} has no force at rest that travel decides, so `from: unloaded` means nothing to it; leave it out",
            vehicle.position(*path, "from"),
        )
    return replace(term, origin=origin)


def _read_custom(vehicle: Vehicle, kind: Kind, path: tuple[str | int, ...], given: LawEntry) -> LawTerm:
    force, own = given.get("force"), given.get("parameters", {})
    unknown = [key for key in given if key not in ("force", "parameters", "from")]
    if unknown:
        raise InputError(
            f"an own law has `force`, `parameters`, `from`, not {shown(unknown[0])}", vehicle.position(*path, unknown[0], key=True)
        )
    if not isinstance(force, Expression) or not isinstance(own, dict):
        raise InputError(
            "an own law has `force`, an expression of d, v and its `parameters` {name: value}", vehicle.position(*path, key=True)
        )
    dimensions = dict(vehicle.dimensions)
    for key, expression in own.items():
        if key in ("d", "v"):
            raise InputError(
                f"{shown(key)} is the law's travel or rate and cannot be a parameter", vehicle.position(*path, "parameters", key, key=True)
            )
        dimensions[key] = dimension_of(expression, vehicle.dimensions, vehicle.document, *path, "parameters", key)
    travel, moment = (NONE, MOMENT) if kind == "hinge" else (LENGTH, FORCE)
    dimensions |= {"d": travel, "v": travel / TIME}
    check_dimension(force, moment, dimensions, vehicle.document, *path, "force")
    check_slopes(vehicle, force, own, path)
    law = custom_law(to_sympy(force), {key: to_sympy(value) for key, value in own.items()})
    return _with_origin(vehicle, path, given, LawTerm(law, {}))
