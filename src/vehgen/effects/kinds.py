"""The kinds of effect: of the vehicle, of its runs and sensors, and of what shakes it: lines of the spectrum, and wheels."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from vehgen.effects.base import Change, Effect, EffectParameter, SearchDimension, Symbols, distinct, merge
from vehgen.effects.evidence import Origins, PlaceEvidence, Residual, StartingPoint
from vehgen.effects.locator import EffectLocator, EffectSite
from vehgen.effects.places import alike
from vehgen.errors import InputError
from vehgen.files.expressions import Expression
from vehgen.files.names import MAX_TEXT, joined_name
from vehgen.fit.adjustments import Adjustment, RunState
from vehgen.fit.harmonic import harmonic_adjustments
from vehgen.fit.shaking import Shaking
from vehgen.fit.trial import Trial
from vehgen.fit.wheel_orders import ORDERS, WheelOrders
from vehgen.simulate import SimulatorPool

Array = NDArray[np.float64]
RADIUS_SCALE = 0.001
"""The size of a typical change of a rolling radius [m]: over a hundred turns it moves a wheel by a third of one."""


@dataclass(frozen=True, kw_only=True)
class VehicleEffect(Effect):
    """An effect of the vehicle: a force law, a mass, a mode that its file lacks.

    Attributes
    ----------
    edit
        Returns the change of the vehicle at a site, from the symbols of its parameters by name.
    """

    edit: Callable[[EffectSite, Symbols], Change]

    @property
    def changes_vehicle(self) -> bool:
        """True."""
        return True

    def n_numbers(self, n_runs: int) -> int:
        """Return the number of its parameters: they hold in all runs."""
        return len(self.parameters)

    def symbols(self, place: str) -> dict[str, str]:
        """Return the names its parameters take in a vehicle file."""
        safe = "".join(letter if letter.isalnum() else "_" for letter in place)
        return {parameter.name: joined_name(self.name, safe, parameter.name) for parameter in self.parameters}

    def search_names(self, place: str) -> tuple[str, ...]:
        """Return the names its parameters take in a vehicle file."""
        return tuple(self.symbols(place).values())

    def search_dimensions(self, place: str, locator: EffectLocator) -> tuple[SearchDimension, ...]:
        """Return its parameters, scaled by the sizes of the place."""
        site = locator.site(place)
        named = zip(self.search_names(place), self.parameters, strict=True)
        return tuple(SearchDimension(name, *item.bounds(site), item.first(site)[0]) for name, item in named)

    def change(self, site: EffectSite, values: Mapping[str, float] | None = None) -> Change:
        """Return the change of a vehicle with its parameters declared, at `values` or at their first start."""
        symbols = self.symbols(site.place)
        declared: Change = {}
        for parameter in self.parameters:
            low, high = parameter.bounds(site)
            value = (values or {}).get(parameter.name, parameter.first(site)[0])
            declared[symbols[parameter.name]] = {
                "value": Expression.quantity(value, parameter.unit),
                "range": [Expression.quantity(low, parameter.unit), Expression.quantity(high, parameter.unit)],
                "meaning": f"{self.title}: {parameter.meaning}"[:MAX_TEXT],
            }
        named = {name: Expression.symbol(symbol) for name, symbol in symbols.items()}
        change: Change = {}
        for place in alike(site.vehicle, site.place) or (site.place,):
            merge(change, self.edit(replace(site, place=place), named))
        change["parameters"] = {**declared, **change.get("parameters", {})}
        return change

    def change_trials(self, trials: Sequence[Trial], place: str, locator: EffectLocator, simulators: SimulatorPool) -> tuple[Trial, ...]:
        """Return the trials with the changed vehicle; raises InputError where a change does not fit it."""
        try:
            vehicle = trials[0].run.vehicle.with_changes(self.change(locator.site(place)))
        except InputError as error:
            raise InputError(f"{self.name} at {place}: {error.message}", error.position) from error
        return tuple(trial.with_vehicle(vehicle, simulators) for trial in trials)

    def starts(self, place: str, locator: EffectLocator, residual: Residual | None = None) -> list[tuple[float, ...]]:
        """Return the starts of its parameters, scaled by the sizes of the place, in every combination."""
        site = locator.site(place)
        return list(product(*(parameter.first(site) for parameter in self.parameters)))


@dataclass(frozen=True, kw_only=True)
class RunEffect(Effect):
    """An effect of all runs or of a sensor: a speed, a contact length, a gain, a delay, a tilt, a position.

    It has one parameter, and more where its adjustment reads the numbers after its own.

    Attributes
    ----------
    adjustment
        The adjustment that its parameter is the number of. None: its parameter is one that every model has, the shift of a sensor along
        its body.
    scale, neutral
        The size of a typical change of the adjustment, and the number that changes nothing.
    """

    adjustment: type[Adjustment] | None
    scale: float = 1.0
    neutral: float = 0.0

    def __post_init__(self) -> None:
        """Refuse what has no parameter."""
        if not self.parameters:
            raise ValueError(f"{self.name}: an effect of runs or sensors has a parameter, found none")

    def n_numbers(self, n_runs: int) -> int:
        """Return the number of its parameters: they hold in all runs."""
        return len(self.parameters)

    def search_names(self, place: str) -> tuple[str, ...]:
        """Return the name of a sensor's shift in the model, for effects that search it."""
        return (f"{place}.shift",) if self.adjustment is None else ()

    def search_dimensions(self, place: str, locator: EffectLocator) -> tuple[SearchDimension, ...]:
        """Return a sensor's shift, begun where the run file says that the sensor is, or as near as its range allows."""
        parameter = self.parameters[0]
        start = min(max(self.neutral, parameter.low), parameter.high)
        return tuple(SearchDimension(name, parameter.low, parameter.high, start) for name in self.search_names(place))

    def adjustments(self, place: str, noise_sigma: Mapping[str, Array]) -> tuple[Adjustment, ...]:
        """Return its adjustment, followed by plain ones that hold its further numbers."""
        if self.adjustment is None:
            return ()
        first, *others = self.parameters
        further = (Adjustment(f"{place} {item.name}", 1.0, item.starts[0], item.low, item.high) for item in others)
        return (self.adjustment(place, self.scale, self.neutral, first.low, first.high), *further)

    def origins(self, origins: Origins) -> list[StartingPoint]:
        """Return where the base parameters begin: for an effect of all runs as filed, as a place tells nothing of it."""
        return distinct(origins.filed, origins.fitted) if self.attaches == "run" else super().origins(origins)

    def is_likely(self, place: str, evidence: PlaceEvidence) -> bool:
        """Return whether leaving out its sensor, or a channel of it, helps; for effects of no sensor as for others."""
        return place in evidence.sensors if self.attaches == "sensor" else super().is_likely(place, evidence)


@dataclass(frozen=True, kw_only=True)
class ShakingEffect(Effect):
    """What shakes the vehicle at phases that no run knows: its first parameters are searched, the last, an amplitude, is solved for.

    Attributes
    ----------
    NAMES
        The names of its parameters.
    NUMBERS_PER_RUN
        So many amplitudes and phases follow linearly in every run.
    """

    NAMES: ClassVar[tuple[str, ...]]
    NUMBERS_PER_RUN: ClassVar[int]

    def __post_init__(self) -> None:
        """Refuse other parameters."""
        if tuple(names := [parameter.name for parameter in self.parameters]) != self.NAMES:
            raise ValueError(f"{self.name}: it has the parameters {', '.join(self.NAMES)}, found {names}")

    @property
    def solved_parameters(self) -> tuple[EffectParameter, ...]:
        """Return the amplitude."""
        return self.parameters[-1:]

    def is_likely(self, place: str, evidence: PlaceEvidence) -> bool:
        """Return whether it is worth fitting at a place: as other effects, or where runs show a line, which the base may have bent to."""
        return evidence.steady_lines or super().is_likely(place, evidence)

    def n_numbers(self, n_runs: int) -> int:
        """Return what is searched, and in every run two phases of each part."""
        return len(self.NAMES) - 1 + self.NUMBERS_PER_RUN * n_runs

    def solve(
        self, place: str, adjustments: Sequence[Adjustment], trial: Trial, response: Array, values: Mapping[str, float], state: RunState
    ) -> Array:
        """Return the amplitude in a run, `shape (1,)`."""
        shaking = adjustments[0]
        assert isinstance(shaking, Shaking)
        numbers = np.array([item.neutral for item in adjustments])
        return np.array([shaking.amplitude(trial, response, numbers, values, state)])


@dataclass(frozen=True, kw_only=True)
class LineEffect(ShakingEffect):
    """A line in the spectrum that a force at a body drives: its frequency and drift are searched, the rest follows linearly in every run.

    Its parameters are the frequency [Hz], the drift over a run, and the force's amplitude [N] (see :mod:`vehgen.fit.harmonic`).

    Attributes
    ----------
    looked_for
        The frequencies between which lines are looked for in what a fit leaves [Hz]; the fit may leave them within the parameter's range.
    """

    NAMES: ClassVar[tuple[str, ...]] = ("frequency", "drift", "amplitude")
    NUMBERS_PER_RUN: ClassVar[int] = 4
    looked_for: tuple[float, float]

    @property
    def shows_in_slow_motions(self) -> bool:
        """Whether a fit to slow motions alone tells something of it: its line is a fast one."""
        return False

    def adjustments(self, place: str, noise_sigma: Mapping[str, Array]) -> tuple[Adjustment, ...]:
        """Return the line and its drift."""
        frequency = self.parameters[0]
        return tuple(harmonic_adjustments(place, noise_sigma, frequency.low, frequency.high))

    def starts(self, place: str, locator: EffectLocator, residual: Residual | None = None) -> list[tuple[float, ...]]:
        """Return the strongest lines of what the fit leaves; without it as other effects."""
        return super().starts(place, locator) if residual is None else list(residual.spectral_lines(*self.looked_for))

    def origins(self, origins: Origins) -> list[StartingPoint]:
        """Return where the last fit ended: the base parameters cannot have absorbed a line."""
        return [origins.fitted]


@dataclass(frozen=True, kw_only=True)
class WheelEffect(ShakingEffect):
    """What turns with the wheels of an axle: their rolling radius is searched, the rest follows linearly in every run.

    Its parameters are the radius [m] and the amplitude of the first order [m] (see :mod:`vehgen.fit.wheel_orders`).
    """

    NAMES: ClassVar[tuple[str, ...]] = ("radius", "amplitude")
    NUMBERS_PER_RUN: ClassVar[int] = 2 * len(ORDERS)

    def adjustments(self, place: str, noise_sigma: Mapping[str, Array]) -> tuple[Adjustment, ...]:
        """Return what turns with the wheels."""
        radius = self.parameters[0]
        return (WheelOrders(place, RADIUS_SCALE, radius.starts[0], radius.low, radius.high, dict(noise_sigma)),)

    def starts(self, place: str, locator: EffectLocator, residual: Residual | None = None) -> list[tuple[float, ...]]:
        """Return the likeliest radii by what the fit leaves; without it as other effects."""
        if residual is None:
            return super().starts(place, locator)
        return [(radius,) for radius in residual.rolling_radii(self.parameters[0].low, self.parameters[0].high)]
