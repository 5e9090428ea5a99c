"""Checks the entries of a file of effects and makes effects of them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from functools import partial
from typing import Any

from vehgen.effects.base import Change, Effect, EffectParameter, Symbols
from vehgen.effects.entry_model import SIZES, EffectEntry, LawPlace, LineEntry, ParameterEntry, RunQuantity
from vehgen.effects.kinds import LineEffect, RunEffect, VehicleEffect
from vehgen.effects.library.bodies import ENGINE_HARMONIC_EFFECT
from vehgen.effects.library.law_effect import LawEdit
from vehgen.effects.library.measuring import (
    SENSOR_DELAY_EFFECT,
    SENSOR_GAIN_EFFECT,
    SENSOR_POSITION_EFFECT,
    SENSOR_TILT_EFFECT,
    SPEED_ERROR_EFFECT,
)
from vehgen.effects.library.tyres import TYRE_FOOTPRINT_EFFECT
from vehgen.effects.locator import EffectSite
from vehgen.effects.places import Places, axles, hinges, suspensions, tyres
from vehgen.errors import InputError, did_you_mean, shown
from vehgen.files.checks import check_dimension
from vehgen.files.document import Located
from vehgen.files.expressions import Expression, ExpressionError
from vehgen.files.units import FORCE, FREQUENCY, LENGTH, MOMENT, NONE, TIME, Dimension, parse_unit
from vehgen.mechanics.laws import LAWS

PLACES: dict[LawPlace, Places] = {"suspension": suspensions, "tyre": axles, "hinge": hinges}
ADJUSTS: dict[RunQuantity, RunEffect] = {
    "speed": SPEED_ERROR_EFFECT,
    "footprint": TYRE_FOOTPRINT_EFFECT,
    "gain": SENSOR_GAIN_EFFECT,
    "delay": SENSOR_DELAY_EFFECT,
    "tilt": SENSOR_TILT_EFFECT,
    "position": SENSOR_POSITION_EFFECT,
}
"""The effects of the library whose number an entry may take."""


class EntryReader:
    """Checks one entry and makes the effect; `document` knows where everything stands."""

    def __init__(self, document: Located, name: str, entry: EffectEntry) -> None:
        self.document, self.name, self.entry = document, name, entry
        self.own: dict[str, Dimension] = {}

    def wrong(self, message: str, *path: str | int, key: bool = False, offset: int | None = None) -> InputError:
        """Return an error at a path within the entry."""
        return InputError(message, self.document.find(("effects", self.name, *path), key=key, offset=offset))

    def effect(self) -> Effect:
        """Return the effect."""
        entry = self.entry
        given = [key for key in ("law", "force", "adjusts", "line") if getattr(entry, key) is not None]
        if len(given) != 1:
            raise self.wrong(
                "an effect has either `law`, one of the library, or `force`, an expression of d and v, or `adjusts`, a quantity of runs or "
                f"sensors, or `line`, a range of frequencies; found {' and '.join(given) or 'none of them'}",
                key=True,
            )
        if entry.adjusts is not None:
            return self.run_effect(ADJUSTS[entry.adjusts])
        return self.line_effect(entry.line) if entry.line is not None else self.vehicle_effect()

    def vehicle_effect(self) -> VehicleEffect:
        """Return the effect of a `law` or `force`."""
        entry = self.entry
        if entry.attaches is None:
            raise self.wrong("an effect with `law` or `force` lacks the key 'attaches': suspension, tyre or hinge", key=True)
        parameters = tuple(self.parameter(name, item) for name, item in entry.parameters.items())
        if entry.force is not None:
            self.expect(entry.force, self.force(), {"d": self.travel(), "v": self.travel() / TIME}, "force")
            self.all_used(entry.force.names)
            law, equation, write = "law", f"f = {entry.force.text}", partial(_own_law, entry.force)
        else:
            law, values = self.library_law(entry.law or {})
            equation, write = LAWS[law].equation, partial(_library_law, values)
        is_global = bool(entry.global_)
        return VehicleEffect(
            name=self.name,
            title=entry.title,
            equation=equation,
            meaning=entry.meaning,
            signature=entry.signature,
            source=entry.source,
            attaches=entry.attaches,
            places=tyres if is_global and entry.attaches == "tyre" else PLACES[entry.attaches],
            parameters=parameters,
            is_global=is_global,
            edit=LawEdit(entry.attaches, law, write),
        )

    def run_effect(self, known: RunEffect) -> RunEffect:
        """Return the effect of runs or sensors that has one of the library's numbers, under its own name, range and starts."""
        entry = self.entry
        self.refuse("attaches", "an effect with `adjusts` lives where its quantity does")
        if len(entry.parameters) != 1:
            raise self.wrong(f"`adjusts` wants one parameter, found {len(entry.parameters)}", "adjusts")
        ((name, item),) = entry.parameters.items()
        if item.times is not None:
            raise self.wrong("runs and sensors have no size: leave `times` out", "parameters", name, "times", key=True)
        parameter, theirs = self.parameter(name, item), known.parameters[0]
        expected = parse_unit(theirs.unit)[1] if theirs.unit else NONE
        if self.own[name] != expected:
            kind = f"in {theirs.unit} or a unit like it" if theirs.unit else "a plain number"
            where = ("parameters", name, "unit") if item.unit else ("parameters", name)
            raise self.wrong(f"{entry.adjusts} is {kind}, found {item.unit or 'no unit'}", *where, key=not item.unit)
        if entry.adjusts in ("speed", "footprint") and item.low <= 0:
            raise self.wrong(f"{entry.adjusts} is above 0, found {item.low:g}", "parameters", name, "low")
        return replace(known, parameters=(parameter, *known.parameters[1:]), **self.description(known))

    def line_effect(self, line: LineEntry) -> LineEffect:
        """Return the line, looked for between its two frequencies."""
        self.refuse("attaches", "a line is driven by a force at a body")
        for name in self.entry.parameters:
            raise self.wrong(
                "a line has no parameters of its own: its range is `line: {low: 20 Hz, high: 60 Hz}`", "parameters", name, key=True
            )
        low, high = self.frequency(line.low, "low"), self.frequency(line.high, "high")
        if not 0 < low < high:
            raise self.wrong(f"`low` must be above 0 and below `high`, found {low:g} and {high:g} Hz", "line", "low")
        frequency, *others = ENGINE_HARMONIC_EFFECT.parameters
        searched = replace(frequency, low=low, high=high, starts=((low + high) / 2,), meaning="frequency of the line at the start of a run")
        return replace(
            ENGINE_HARMONIC_EFFECT, parameters=(searched, *others), looked_for=(low, high), **self.description(ENGINE_HARMONIC_EFFECT)
        )

    def frequency(self, given: Expression, key: str) -> float:
        """Return a frequency [Hz]."""
        self.expect(given, FREQUENCY, {}, "line", key, names={})
        return given.evaluate({})

    def description(self, known: Effect) -> dict[str, Any]:
        """Return what an entry says of itself, where it adapts an effect of the library."""
        entry = self.entry
        is_global = known.is_global if entry.global_ is None else entry.global_
        words = {"title": entry.title, "meaning": entry.meaning, "signature": entry.signature, "source": entry.source}
        return {"name": self.name, "is_global": is_global, **words}

    def refuse(self, key: str, why: str) -> None:
        """Refuse a key that this kind of effect does not have."""
        if getattr(self.entry, key) is not None:
            raise self.wrong(f"{why}: leave `{key}` out", key, key=True)

    def travel(self) -> Dimension:
        """Return the dimension of a travel there."""
        return NONE if self.entry.attaches == "hinge" else LENGTH

    def force(self) -> Dimension:
        """Return the dimension of a force there."""
        return MOMENT if self.entry.attaches == "hinge" else FORCE

    def parameter(self, name: str, item: ParameterEntry) -> EffectParameter:
        """Return a parameter in SI units."""
        path = ("parameters", name)
        if name in ("d", "v"):
            raise self.wrong(f"{shown(name)} is the travel or rate of a law", *path, key=True)
        try:
            factor, dimension = parse_unit(item.unit) if item.unit else (1.0, NONE)
        except InputError as error:
            raise self.wrong(error.message, *path, "unit") from error
        if not item.low < item.high:
            raise self.wrong(f"`low` must be below `high`, found {item.low:g} and {item.high:g}", *path, "low")
        for i, start in enumerate(item.starts):
            if not item.low <= start <= item.high:
                raise self.wrong(f"a start must lie within {item.low:g} to {item.high:g}, found {start:g}", *path, "starts", i)
        self.own[name] = dimension
        unit = item.unit if factor == 1.0 else str(dimension)
        if item.times is not None:
            self.expect(item.times, dimension, {}, *path, "times", names=SIZES)
            scale = partial(_size, item.times)
            return EffectParameter(
                name, unit, item.meaning, low=item.low, high=item.high, starts=item.starts, scale=scale, of=str(item.times)
            )
        starts = tuple(start * factor for start in item.starts)
        return EffectParameter(name, unit, item.meaning, low=item.low * factor, high=item.high * factor, starts=starts)

    def library_law(self, given: dict[str, dict[str, Expression]]) -> tuple[str, dict[str, Expression]]:
        """Return the law's name and what its parameters are."""
        if len(given) != 1:
            raise self.wrong("`law` names one law of the library: {name: {parameter: value}}", "law", key=True)
        ((name, values),) = given.items()
        if name not in LAWS:
            hint = " (your own law is an expression under `force`)" if name == "law" else ""
            raise self.wrong(f"unknown force law {shown(name)}; {did_you_mean(name, LAWS)}{hint}", "law", name, key=True)
        law, kind = LAWS[name], self.entry.attaches
        if kind not in law.attaches_to:
            raise self.wrong(f"{name} belongs on a {' or '.join(law.attaches_to)}, not on a {kind}", "law", name, key=True)
        known = {item.name: item for item in law.parameters}
        for key in values:
            if key not in known and key != "from":
                raise self.wrong(f"{name} has no parameter {shown(key)}; {did_you_mean(key, [*known, 'from'])}", "law", name, key, key=True)
        for key, item in known.items():
            if key in values:
                self.expect(values[key], item.dimension(kind), {}, "law", name, key)
            elif item.default is None:
                raise self.wrong(f"{name} lacks its parameter {shown(key)}: {item.meaning}", "law", name, key=True)
        self.all_used({used for key, value in values.items() if key != "from" for used in value.names})
        return name, values

    def all_used(self, names: Iterable[str]) -> None:
        """Refuse a parameter that no law uses: a search could not find it."""
        for name in self.own.keys() - set(names):
            raise self.wrong(f"the parameter {shown(name)} is used nowhere", "parameters", name, key=True)

    def expect(
        self,
        expression: Expression,
        dimension: Dimension,
        more: Mapping[str, Dimension],
        *path: str | int,
        names: Mapping[str, Dimension] | None = None,
    ) -> None:
        """Refuse an expression of unknown names or of another dimension."""
        known = {**(self.own if names is None else names), **more}
        check_dimension(expression, dimension, known, self.document, "effects", self.name, *path)


def _size(times: Expression, site: EffectSite) -> float:
    """Return the size of a place that `times` asks for [SI]."""
    try:
        return times.evaluate({name: float(getattr(site, name)) for name in SIZES})
    except ExpressionError as error:
        raise InputError(f"at {site.place}: {error}") from error


def _own_law(force: Expression, site: EffectSite, symbols: Symbols) -> Change:
    return {"force": force, "parameters": dict(symbols)}


def _library_law(given: dict[str, Expression], site: EffectSite, symbols: Symbols) -> Change:
    return {key: value if key == "from" else value.substituted(symbols) for key, value in given.items()}
