"""What an effect is: where it lives, what it changes, what it costs, where its fits begin, and how to say so.

Of the vehicle, of its runs and sensors, or what shakes it: for the kinds see :mod:`vehgen.effects.kinds`.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import KW_ONLY, dataclass
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vehgen.effects.evidence import Origins, PlaceEvidence, Residual, StartingPoint
from vehgen.effects.locator import EffectLocator, EffectSite, Size, base_parameters
from vehgen.effects.places import ALIKE, ALL_SUSPENSIONS, EVERY_TYRE, Places
from vehgen.files.expressions import Expression
from vehgen.fit.adjustments import Adjustment, RunState
from vehgen.fit.trial import Trial
from vehgen.simulate import SimulatorPool
from vehgen.vehicle import Vehicle

Array = NDArray[np.float64]
Change = dict[str, Any]
"""Mappings and lists in the form of a vehicle file, of expressions, texts and numbers."""
Symbols = Mapping[str, Expression]
"""The symbols of an effect's parameters in a vehicle, by the parameters' names."""


def one(site: EffectSite) -> float:
    """Return 1: a parameter that does not scale with its place."""
    return 1.0


@dataclass(frozen=True)
class EffectParameter:
    """A parameter of an effect: searched from `low` to `high`, begun at each of `starts`, all times `scale(site)`, in `unit`.

    `of` says what `scale` is in words, as in "0.002 to 0.4 times the static load"; empty where it is 1. `form` is the share of its value (a
    standard deviation) by which fits stray since no real thing has quite the form of its law.
    """

    name: str
    unit: str
    meaning: str
    _: KW_ONLY
    low: float
    high: float
    starts: tuple[float, ...]
    scale: Callable[[EffectSite], float] = one
    of: str = ""
    form: float = 0.0

    @property
    def searched(self) -> str:
        """What is searched, in words."""
        return f"{self.low:g} to {self.high:g}" + (f" times {self.of}" if self.of else f" {self.unit}" if self.unit else "")

    def bounds(self, site: EffectSite) -> tuple[float, float]:
        """Return what is searched at a place [unit]."""
        size = self.scale(site)
        return self.low * size, self.high * size

    def first(self, site: EffectSite) -> tuple[float, ...]:
        """Return where searches begin at a place [unit]."""
        size = self.scale(site)
        return tuple(start * size for start in self.starts)


@dataclass(frozen=True)
class SearchDimension:
    """A parameter that an effect adds to the search: its name in the vehicle's model, bounds and start [SI]."""

    name: str
    low: float
    high: float
    start: float


@dataclass(frozen=True, kw_only=True)
class Effect(ABC):
    """An effect that could be missing from a model.

    Attributes
    ----------
    name, title
        What it is called.
    equation, meaning, signature, source
        What it does, what it is, what it looks like in recordings, where it comes from.
    attaches
        What it lives at: suspension, tyre, hinge, body, axles, sensor, run.
    places
        Names the places of a vehicle, or the sensors or channels of its runs, at which it can live.
    parameters
        Its parameters.
    is_global
        Whether no single place explains it, or it reaches several: it is tried wherever one unknown force at one place does not suffice.
    frees
        Which base parameters at its place its law redistributes: `k` and `c` of the suspension, link or hinge, `kt` of the tyre. Its fits
        search them within the file's whole range: with the law beside them, they may be far from the file's value.
    tie_advice
        What to do where only effects with this same advice explain the recordings equally well; empty where another run may decide.
    special_case
        The effect, by name, that it is at some value of a parameter: at the same place it is fitted where that one is worth fitting, and
        that one is named where it does as well. Empty where there is none.
    file
        The file of effects that it was read from; empty for those that come with vehgen or were made in Python.
    """

    name: str
    title: str
    equation: str = ""
    meaning: str = ""
    signature: str = ""
    source: str = ""
    attaches: str
    places: Places
    parameters: tuple[EffectParameter, ...] = ()
    is_global: bool = False
    frees: tuple[Size, ...] = ()
    tie_advice: str = ""
    special_case: str = ""
    file: str = ""

    @property
    def shows_in_slow_motions(self) -> bool:
        """Whether a fit to slow motions alone tells something of it."""
        return True

    @property
    def changes_vehicle(self) -> bool:
        """Whether it changes the vehicle; other effects change how its runs and recordings are read."""
        return False

    @property
    def solved_parameters(self) -> tuple[EffectParameter, ...]:
        """Return those of its parameters that are not searched but solved for in every run (see :meth:`solve`)."""
        return ()

    def at(self, place: str, vehicle: Vehicle) -> Effect:
        """Return the effect with the parameters that it has at a place of a vehicle."""
        return self

    def freed(self, place: str, vehicle: Vehicle) -> tuple[str, ...]:
        """Return the free parameters of the vehicle, by name, that it `frees` at a place."""
        return base_parameters(vehicle, place, self.frees)

    @abstractmethod
    def n_numbers(self, n_runs: int) -> int:
        """Return how many numbers it costs to fit it to some runs."""

    def search_dimensions(self, place: str, locator: EffectLocator) -> tuple[SearchDimension, ...]:
        """Return the parameters that it adds to the search at a place."""
        return ()

    def search_names(self, place: str) -> tuple[str, ...]:
        """Return the names of its search dimensions."""
        return ()

    def adjustments(self, place: str, noise_sigma: Mapping[str, Array]) -> tuple[Adjustment, ...]:
        """Return the adjustments of runs or sensors that it adds to a fit.

        Parameters
        ----------
        place
            One of its places.
        noise_sigma
            Standard deviations of the channels' noise by trial, each `shape (n_channels,)`, where the noise is known.
        """
        return ()

    def change(self, site: EffectSite, values: Mapping[str, float] | None = None) -> Change:
        """Return the change of the vehicle at a site and at `values` of its parameters; empty where it leaves the vehicle alone."""
        return {}

    def change_trials(self, trials: Sequence[Trial], place: str, locator: EffectLocator, simulators: SimulatorPool) -> tuple[Trial, ...]:
        """Return the trials with the effect at a place of their vehicle; `simulators` are shared."""
        return tuple(trials)

    def starts(self, place: str, locator: EffectLocator, residual: Residual | None = None) -> list[tuple[float, ...]]:
        """Return where its own numbers may begin, one tuple a start.

        Parameters
        ----------
        place, locator
            Where, and what knows the sizes of places.
        residual
            What the fit that it is added to leaves, where that is known.
        """
        return list(product(*(parameter.starts for parameter in self.parameters)))

    def origins(self, origins: Origins) -> list[StartingPoint]:
        """Return where the base parameters begin when it is fitted; what they absorbed of an effect may mislead."""
        return distinct(origins.placed, origins.fitted)

    def is_likely(self, place: str, evidence: PlaceEvidence) -> bool:
        """Return whether it is worth fitting at a place, by what the place test found."""
        if place in EVERY_TYRE:
            return not evidence.one_force or "tyre" in evidence.kinds
        if place == ALL_SUSPENSIONS or ALIKE in place:
            return not evidence.one_force and (place == ALL_SUSPENSIONS or not evidence.parts.isdisjoint(place.split(ALIKE)))
        touches = not evidence.parts.isdisjoint(place.split("+"))
        return touches or (self.is_global and not evidence.one_force)

    def solve(
        self, place: str, adjustments: Sequence[Adjustment], trial: Trial, response: Array, values: Mapping[str, float], state: RunState
    ) -> Array:
        """Return its `solved_parameters` in a run, `shape (n_solved,)`.

        Parameters
        ----------
        place, adjustments
            Where, and its adjustments, whose neutral numbers are the fitted ones.
        trial
            The run.
        response
            What the sensors would read without it, `shape (n_samples, n_channels)`.
        values
            The vehicle's parameters [SI].
        state
            What is supposed of the run.
        """
        return np.zeros(0)


def distinct(*points: StartingPoint) -> list[StartingPoint]:
    """Return starting points, each once."""
    return [point for i, point in enumerate(points) if all(point is not other for other in points[:i])]


def merge(data: Change, change: Change) -> None:
    """Lay a change over data, mapping by mapping; a list replaces the one before, which it repeats."""
    for key, value in change.items():
        if isinstance(value, dict) and isinstance(data.get(key), dict):
            merge(data[key], value)
        else:
            data[key] = value
