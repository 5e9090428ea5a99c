"""A candidate: one effect at one place, as something that can be fitted together with the base parameters."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from vehgen.effects import Effect, EffectLocator
from vehgen.effects.places import members, nowhere
from vehgen.fit.adjustments import Adjustment
from vehgen.fit.misfit import Noises
from vehgen.fit.problem import Problem
from vehgen.fit.space import SearchSpace
from vehgen.fit.trial import Trial
from vehgen.simulate import SimulatorPool
from vehgen.vehicle import Vehicle

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Candidate:
    """An effect at a place.

    `parameters` are the names its parameters take in the search space; `shared` its adjustments of runs or sensors; `freed` the base
    parameters that it searches within the file's whole range; `members` the axles that its place is of, where it is of several.
    """

    effect: Effect
    place: str
    parameters: tuple[str, ...]
    shared: tuple[Adjustment, ...] = ()
    freed: tuple[str, ...] = ()
    members: tuple[str, ...] = ()

    @property
    def label(self) -> str:
        """Its name in words."""
        return f"{self.effect.name} at {self.place}"

    def holds(self, other: Candidate) -> bool:
        """Return whether another candidate is a special case of it."""
        return (self.effect.special_case, self.place) == (other.effect.name, other.place)

    def is_alike(self, other: Candidate) -> bool:
        """Return whether another candidate is the same effect, at a place that holds this one's or lies in it."""
        return self.effect.name == other.effect.name and self._lies_with(other)

    def _lies_with(self, other: Candidate) -> bool:
        own, others = (set(item.members or (item.place,)) for item in (self, other))
        return own <= others or others <= own

    def _is_kin(self, other: Candidate) -> bool:
        """Return whether one candidate's effect is a special case of the other's, at a place that holds the other's or lies in it."""
        kin = self.effect.special_case == other.effect.name or other.effect.special_case == self.effect.name
        return kin and self._lies_with(other)

    def is_among(self, others: Iterable[Candidate]) -> bool:
        """Return whether it, its special case, or something that searches or adjusts the same, is among others."""
        own = {(type(item), item.place) for item in self.shared}
        return any(
            self.is_alike(item)
            or self._is_kin(item)
            or not set(self.parameters).isdisjoint(item.parameters)
            or not own.isdisjoint((type(other), other.place) for other in item.shared)
            for item in others
        )


@dataclass(frozen=True, kw_only=True)
class FreedBase(Effect):
    """No effect at all, but the freedom that another one gives the base parameters at its place: something that can be fitted, too."""

    def n_numbers(self, n_runs: int) -> int:
        """Return 0: it adds no parameter."""
        return 0


FREED_BASE = FreedBase(name="freed_base", title="Base parameters beyond the file's", attaches="base", places=nowhere)


def freed_alone(names: tuple[str, ...]) -> Candidate:
    """Return the candidate that sets base parameters free and adds nothing."""
    return Candidate(FREED_BASE, ", ".join(names), (), (), names)


def list_candidates(vehicle: Vehicle, trials: Sequence[Trial], effects: Sequence[Effect], noises: Noises | None = None) -> list[Candidate]:
    """Return every effect at every place at which it can live; the noise of the runs weighs channels where an effect needs it."""
    sigma = {name: noise.sigma for name, noise in (noises or {}).items()}
    found = []
    for effect in effects:
        for place in effect.places(vehicle, trials):
            own = effect.at(place, vehicle)
            names, shared, freed = own.search_names(place), own.adjustments(place, sigma), own.freed(place, vehicle)
            found.append(Candidate(own, place, names, shared, freed, members(vehicle, place)))
    return found


def has_room(candidate: Candidate, locator: EffectLocator) -> bool:
    """Return whether there is something to search: not where a range is a multiple of a damping that another effect has taken away."""
    return all(item.low < item.high for item in candidate.effect.search_dimensions(candidate.place, locator))


def build_problem(candidate: Candidate, base: Problem, locator: EffectLocator, simulators: SimulatorPool) -> Problem:
    """Return the base problem with the candidate's effect added to its trials and its parameters to the search.

    The base parameters that the effect frees are searched within the range of the vehicle's file.

    Parameters
    ----------
    candidate
        What to add.
    base
        The base problem; its space's `start` is where the base parameters begin.
    locator
        Knows the sizes of places.
    simulators
        Simulators to share.
    """
    trials = candidate.effect.change_trials(base.trials, candidate.place, locator, simulators)
    added = candidate.effect.search_dimensions(candidate.place, locator)
    known = widened(base.space, base.trials[0].run.vehicle.ranges(), candidate.freed)
    space = SearchSpace(
        (*known.names, *(item.name for item in added)),
        np.concatenate([known.lower, [item.low for item in added]]),
        np.concatenate([known.upper, [item.high for item in added]]),
        np.concatenate([known.start, [item.start for item in added]]),
    )
    return Problem(trials, space)


def widened(space: SearchSpace, ranges: Mapping[str, tuple[float, float]], names: Sequence[str]) -> SearchSpace:
    """Return a space with some of its parameters searched within their `ranges` [SI], where those are wider."""
    lower, upper = space.lower.copy(), space.upper.copy()
    for i, name in enumerate(space.names):
        if name in names and name in ranges:
            lower[i], upper[i] = min(lower[i], ranges[name][0]), max(upper[i], ranges[name][1])
    return replace(space, lower=lower, upper=upper)


def carried(unit: Array, old: SearchSpace, new: SearchSpace) -> Array:
    """Return points of a space's unit cube, `shape (..., old.size)`, in that of another space whose first parameters are the same."""
    n = old.size
    first = SearchSpace(old.names, new.lower[:n], new.upper[:n], new.start[:n])
    alike = (old.lower == first.lower) & (old.upper == first.upper)
    return np.asarray(np.where(alike, unit, first.unit(old.values(unit))))
