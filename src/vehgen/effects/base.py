"""What an effect is: a named edit of a vehicle or of its runs, with what its parameters may be and what it looks like."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from vehgen.effects.locator import EffectSite
from vehgen.files.names import MAX_TEXT, joined_name
from vehgen.vehicle import Vehicle

Change = dict[str, Any]
"""Plain mappings, lists, texts and numbers in the form of a vehicle file."""


def one(site: EffectSite) -> float:
    """Return 1: a parameter that does not scale with its place."""
    return 1.0


@dataclass(frozen=True)
class EffectParameter:
    """A parameter of an effect: searched from `low` to `high`, begun at each of `starts`, all times `scale(site)`, in `unit`."""

    name: str
    unit: str
    meaning: str
    low: float
    high: float
    starts: tuple[float, ...]
    scale: Callable[[EffectSite], float] = one

    def bounds(self, site: EffectSite) -> tuple[float, float]:
        """Return what is searched at a place [unit]."""
        size = self.scale(site)
        return self.low * size, self.high * size

    def first(self, site: EffectSite) -> tuple[float, ...]:
        """Return where searches begin at a place [unit]."""
        size = self.scale(site)
        return tuple(start * size for start in self.starts)


@dataclass(frozen=True)
class Effect:
    """An effect that could be missing from a model.

    Attributes
    ----------
    name, title
        What it is called.
    equation, meaning, signature, source
        What it does, what it is, what it looks like in recordings, where it comes from.
    attaches
        What it lives at: suspension, tyre, hinge, body, axles, sensor, run.
    parameters
        Its parameters.
    places
        Names the places of a vehicle (or sensors of its runs) at which it can live.
    edit
        Returns the change of the vehicle's file; the symbols of its parameters are given by name. None for effects of runs.
    adjusts
        For effects of runs: which quantity of a run its one parameter changes (see :mod:`vehgen.fit.adjustments`).
    """

    name: str
    title: str
    equation: str
    meaning: str
    signature: str
    source: str
    attaches: str
    parameters: tuple[EffectParameter, ...]
    places: Callable[[Vehicle, tuple[str, ...]], tuple[str, ...]]
    edit: Callable[[EffectSite, Mapping[str, str]], Change] | None = None
    adjusts: str = ""

    def symbols(self, place: str) -> dict[str, str]:
        """Return the names its parameters take in a vehicle file."""
        safe = "".join(letter if letter.isalnum() else "_" for letter in place)
        return {parameter.name: joined_name(self.name, safe, parameter.name) for parameter in self.parameters}

    def change(self, site: EffectSite, values: Mapping[str, float] | None = None) -> Change:
        """Return the change of a vehicle's file with its parameters declared, at `values` or at their first start."""
        assert self.edit is not None
        symbols = self.symbols(site.place)
        declared: Change = {}
        for parameter in self.parameters:
            low, high = parameter.bounds(site)
            value = (values or {}).get(parameter.name, parameter.first(site)[0])
            unit = f" {parameter.unit}" if parameter.unit else ""
            declared[symbols[parameter.name]] = {
                "value": f"{value!r}{unit}",
                "range": [f"{low!r}{unit}", f"{high!r}{unit}"],
                "meaning": f"{self.title}: {parameter.meaning}"[:MAX_TEXT],
            }
        change = self.edit(site, symbols)
        change["parameters"] = {**declared, **change.get("parameters", {})}
        return change
