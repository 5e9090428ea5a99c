"""A candidate: one effect at one place, as something that can be fitted together with the base parameters."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import product

import numpy as np
from numpy.typing import NDArray

from vehgen.effects import Effect, EffectLocator
from vehgen.fit.adjustments import Adjustment, Footprint, Gain, SensorDelay, SpeedScale, Tilt
from vehgen.fit.harmonic import harmonic_adjustments
from vehgen.fit.misfit import Noises
from vehgen.fit.problem import Problem
from vehgen.fit.space import SearchSpace
from vehgen.fit.trial import Trial
from vehgen.measure import RecordedChannel
from vehgen.simulate import Simulator
from vehgen.vehicle import Vehicle
from vehgen.vehicle.loading import extend_vehicle

Array = NDArray[np.float64]
KINDS: dict[str, tuple[type[Adjustment], float, float]] = {
    "speed": (SpeedScale, 0.01, 1.0),
    "footprint": (Footprint, 0.05, 0.0),
    "gain": (Gain, 0.05, 1.0),
    "sensor_delay": (SensorDelay, 0.01, 0.0),
    "tilt": (Tilt, 0.1, 0.0),
}
"""Adjustments by what effects call them: class, scale, neutral number."""


@dataclass(frozen=True)
class Candidate:
    """An effect at a place.

    `parameters` are the names its parameters take in the search space; `shared` the adjustment of an effect of runs or sensors.
    """

    effect: Effect
    place: str
    parameters: tuple[str, ...]
    shared: tuple[Adjustment, ...] = ()

    @property
    def label(self) -> str:
        """Its name in words."""
        return f"{self.effect.name} at {self.place}"


def list_candidates(vehicle: Vehicle, trials: Sequence[Trial], effects: Sequence[Effect], noises: Noises | None = None) -> list[Candidate]:
    """Return every effect at every place at which it can live; the noise of the runs weighs channels where an effect needs it."""
    sigma = {name: noise.sigma for name, noise in (noises or {}).items()}
    sensors = tuple(dict.fromkeys(channel.sensor for trial in trials for channel in trial.recording.channels))
    channels = tuple(dict.fromkeys(name for trial in trials for name in trial.channels))
    found = []
    for effect in effects:
        for place in effect.places(vehicle, channels if effect.adjusts == "gain" else sensors):
            shared: tuple[Adjustment, ...] = ()
            names: tuple[str, ...] = ()
            if effect.edit is not None:
                names = tuple(effect.symbols(place).values())
            elif effect.adjusts == "position":
                names = tuple(f"{channel.output.place.name}.shift" for channel in _of_sensor(trials, place)[:1])
            elif effect.adjusts in KINDS:
                kind, scale, neutral = KINDS[effect.adjusts]
                bounds = [(item.low, item.high) for item in effect.parameters] or [(-np.inf, np.inf)]
                shared = (kind(place, scale, neutral, *bounds[0]),)
            elif effect.adjusts == "harmonic":
                shared = tuple(harmonic_adjustments(place, sigma))
            else:
                continue
            found.append(Candidate(effect, place, names, shared))
    return found


def _of_sensor(trials: Sequence[Trial], sensor: str) -> list[RecordedChannel]:
    return [channel for trial in trials for channel in trial.recording.channels if channel.sensor == sensor]


def build_problem(candidate: Candidate, base: Problem, surveyor: EffectLocator, simulators: dict[object, Simulator]) -> Problem:
    """Return the base problem with the candidate's effect added to the vehicle and its parameters to the search.

    Parameters
    ----------
    candidate
        What to add.
    base
        The base problem; its space's `start` is where the base parameters begin.
    surveyor
        Knows the sizes of places.
    simulators
        Compiled simulators to share; filled as needed.
    """
    effect = candidate.effect
    if effect.edit is not None:
        site = surveyor.site(candidate.place)
        vehicle = extend_vehicle(base.trials[0].run.vehicle, effect.change(site), candidate.label)
        trials = [retarget(trial, vehicle, simulators) for trial in base.trials]
        bounds = [parameter.bounds(site) for parameter in effect.parameters]
        first = [parameter.first(site)[0] for parameter in effect.parameters]
    else:
        trials = list(base.trials)
        bounds = [(parameter.low, parameter.high) for parameter in effect.parameters][: len(candidate.parameters)]
        first = [0.0] * len(candidate.parameters)
    space = SearchSpace(
        (*base.space.names, *candidate.parameters),
        np.concatenate([base.space.lower, [low for low, _ in bounds]]),
        np.concatenate([base.space.upper, [high for _, high in bounds]]),
        np.concatenate([base.space.start, first]),
    )
    return Problem(tuple(trials), space)


def starts(candidate: Candidate, surveyor: EffectLocator) -> Iterator[tuple[float, ...]]:
    """Yield where the effect's own parameters may begin."""
    if candidate.effect.edit is None:
        options = [parameter.starts for parameter in candidate.effect.parameters]
    else:
        site = surveyor.site(candidate.place)
        options = [parameter.first(site) for parameter in candidate.effect.parameters]
    yield from product(*options)


def retarget(trial: Trial, vehicle: Vehicle, simulators: dict[object, Simulator]) -> Trial:
    """Return a trial with another vehicle that has at least its parameters."""
    run = replace(trial.run, vehicle=vehicle)
    outputs = tuple(channel.output for channel in trial.recording.channels)
    key = (id(vehicle), repr(outputs), repr(run.forces()))
    if key not in simulators:
        simulators[key] = Simulator(vehicle, outputs, run.forces())
    simulator = simulators[key]
    values = simulator.model.values(overrides=run.values())
    return replace(trial, run=run, simulator=simulator, values=values)
