"""Effects of one's own as entries of a YAML file: a force law of the library, or a force written as an expression."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from functools import partial
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import Field

from vehgen.effects.base import Change, Effect, EffectParameter
from vehgen.effects.library.law_effect import Given, law_edit
from vehgen.effects.locator import EffectSite
from vehgen.effects.places import axles, hinges, suspensions
from vehgen.effects.registry import library
from vehgen.errors import InputError, did_you_mean, shown
from vehgen.files.document import Located, read_document
from vehgen.files.expressions import Expression, ExpressionError
from vehgen.files.names import FreeText, Identifier, Name
from vehgen.files.units import DAMPING, FORCE, INERTIA, LENGTH, MASS, MOMENT, NONE, STIFFNESS, TIME, Dimension, parse_unit
from vehgen.mechanics.laws import LAWS
from vehgen.vehicle import Vehicle
from vehgen.vehicle.loading import validate
from vehgen.vehicle.model import FileModel

LawPlace = Literal["suspension", "tyre", "hinge"]
Finite = Annotated[float, Field(allow_inf_nan=False)]
PLACES: dict[LawPlace, Callable[[Vehicle, tuple[str, ...]], tuple[str, ...]]] = {"suspension": suspensions, "tyre": axles, "hinge": hinges}
SIZES: dict[str, Dimension] = {
    "load": FORCE,
    "k": STIFFNESS,
    "c": DAMPING,
    "kt": STIFFNESS,
    "mass": MASS,
    "inertia": INERTIA,
    "length": LENGTH,
    "travel": LENGTH,
}
"""What `times` may use: the sizes of a :class:`~vehgen.effects.locator.Site`."""


class ParameterEntry(FileModel):
    """A parameter of an effect: searched from `low` to `high`, begun at each of `starts`."""

    meaning: FreeText
    unit: str = Field("", description="of its values, e.g. N/m^3")
    low: Finite
    high: Finite
    starts: tuple[Finite, ...] = Field(min_length=1, description="where searches begin, one to three values")
    times: Expression | None = Field(
        None, description=f"low, high and starts are multiples of this size of the place, an expression of {', '.join(SIZES)}"
    )


class EffectEntry(FileModel):
    """An effect that could be missing at a suspension, tyre or hinge."""

    title: FreeText
    meaning: FreeText = Field(description="what it is")
    signature: FreeText = Field("", description="what it looks like in recordings")
    source: FreeText = Field("", description="where it comes from")
    attaches: LawPlace
    law: dict[Name, dict[Name, Expression]] | None = Field(None, description="{law of the library: {its parameter: value or expression}}")
    force: Expression | None = Field(None, description="instead of `law`: an expression of travel d, rate v and the effect's parameters")
    parameters: dict[Identifier, ParameterEntry]


class EffectsFile(FileModel):
    """A file of effects, by name."""

    effects: dict[Identifier, EffectEntry]


def effects_schema() -> dict[str, Any]:
    """Return the JSON Schema of a file of effects, for editors."""
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **EffectsFile.model_json_schema(), "title": "vehgen effects file"}


def extended_library(paths: Iterable[str | Path]) -> dict[str, Effect]:
    """Return all effects known, then those of files.

    Raises
    ------
    InputError
        As :func:`load_effects`, and for names that two files share.
    """
    known = library()
    for path in paths:
        known |= load_effects(path, known)
    return known


def load_effects(path: str | Path, taken: Mapping[str, Effect] | None = None) -> dict[str, Effect]:
    """Read and check a file of effects.

    Parameters
    ----------
    path
        The file.
    taken
        Effects whose names it may not use (default: all of the library).

    Raises
    ------
    InputError
        With file, line and column, what is wrong and what would be right.
    """
    document = read_document(Path(path))
    if not isinstance(document.value, dict):
        raise InputError("a file of `key: value` lines was expected", document.position)
    file = validate(EffectsFile, document.plain(), document)
    known = library() if taken is None else taken
    found = {}
    for name, entry in file.effects.items():
        if name in known:
            raise InputError(f"an effect is named {name!r} already; choose another name", document.find(("effects", name), key=True))
        found[name] = _Reader(document, name, entry).effect()
    return found


class _Reader:
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
        parameters = tuple(self.parameter(name, item) for name, item in entry.parameters.items())
        if (entry.law is None) == (entry.force is None):
            raise self.wrong("an effect has either `law`, one of the library, or `force`, an expression of d and v", key=True)
        if entry.force is not None:
            self.expect(entry.force, self.force(), {"d": self.travel(), "v": self.travel() / TIME}, "force")
            self.all_used(entry.force.names)
            law, equation, write = "law", f"f = {entry.force.text}", partial(_own_law, entry.force.text)
        else:
            law, given = self.library_law(entry.law or {})
            equation, write = LAWS[law].equation, partial(_library_law, given)
        return Effect(
            self.name,
            entry.title,
            equation,
            entry.meaning,
            entry.signature,
            entry.source,
            entry.attaches,
            parameters,
            PLACES[entry.attaches],
            law_edit(entry.attaches, law, write),
        )

    def travel(self) -> Dimension:
        return NONE if self.entry.attaches == "hinge" else LENGTH

    def force(self) -> Dimension:
        return MOMENT if self.entry.attaches == "hinge" else FORCE

    def parameter(self, name: str, item: ParameterEntry) -> EffectParameter:
        """Return a parameter in SI units."""
        path = ("parameters", name)
        if name in ("d", "v"):
            raise self.wrong(f"{name!r} is the travel or rate of a law", *path, key=True)
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
            return EffectParameter(name, unit, item.meaning, item.low, item.high, item.starts, partial(_size, item.times))
        starts = tuple(start * factor for start in item.starts)
        return EffectParameter(name, unit, item.meaning, item.low * factor, item.high * factor, starts)

    def library_law(self, given: dict[str, dict[str, Expression]]) -> tuple[str, dict[str, Expression]]:
        """Return the law's name and what its parameters are."""
        if len(given) != 1:
            raise self.wrong("`law` names one law of the library: {name: {parameter: value}}", "law", key=True)
        ((name, values),) = given.items()
        if name not in LAWS:
            hint = " (your own law is an expression under `force`)" if name == "law" else ""
            raise self.wrong(f"unknown force law {name!r}; {did_you_mean(name, LAWS)}{hint}", "law", name, key=True)
        law, kind = LAWS[name], self.entry.attaches
        if kind not in law.attaches_to:
            raise self.wrong(f"{name} belongs on a {' or '.join(law.attaches_to)}, not on a {kind}", "law", name, key=True)
        known = {item.name: item for item in law.parameters}
        for key in values:
            if key not in known and key != "from":
                raise self.wrong(f"{name} has no parameter {key!r}; {did_you_mean(key, [*known, 'from'])}", "law", name, key, key=True)
        for key, item in known.items():
            if key in values:
                self.expect(values[key], item.dimension(kind), {}, "law", name, key)
            elif item.default is None:
                raise self.wrong(f"{name} lacks its parameter {key!r}: {item.meaning}", "law", name, key=True)
        self.all_used({used for key, value in values.items() if key != "from" for used in value.names})
        return name, values

    def all_used(self, names: Iterable[str]) -> None:
        """Refuse a parameter that no law uses: a search could not find it."""
        for name in self.own.keys() - set(names):
            raise self.wrong(f"the parameter {name!r} is used nowhere", "parameters", name, key=True)

    def expect(
        self,
        expression: Expression,
        dimension: Dimension,
        more: Mapping[str, Dimension],
        *path: str | int,
        names: Mapping[str, Dimension] | None = None,
    ) -> None:
        """Refuse an expression of unknown names or of another dimension."""
        try:
            found = expression.dimension({**(self.own if names is None else names), **more})
            plain = None if expression.names else expression.evaluate({})
        except ExpressionError as error:
            raise self.wrong(str(error), *path, offset=error.offset) from error
        if found != dimension and plain != 0.0:
            raise self.wrong(f"{path[-1]} must be in {dimension}, found {found} in {shown(expression.text)}", *path)


def _size(times: Expression, site: EffectSite) -> float:
    """Return the size of a place that `times` asks for [SI]."""
    try:
        return times.evaluate({name: float(getattr(site, name)) for name in SIZES})
    except ExpressionError as error:
        raise InputError(f"at {site.place}: {error}") from error


def _own_law(force: str, site: EffectSite, symbols: Given) -> Change:
    return {"force": force, "parameters": dict(symbols)}


def _library_law(given: dict[str, Expression], site: EffectSite, symbols: Given) -> Change:
    return {key: value.text if key == "from" else _renamed(value, symbols) for key, value in given.items()}


def _renamed(expression: Expression, symbols: Given) -> str:
    """Return the text of an expression with other names in it."""
    text = expression.text
    for item in sorted(expression.symbols, key=lambda name: name.offset, reverse=True):
        text = text[: item.offset] + symbols[item.name] + text[item.offset + len(item.name) :]
    return text
