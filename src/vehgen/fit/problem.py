"""The calibration problem: one vehicle's searched parameters against several trials."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from vehgen.errors import InputError, ModelWarning
from vehgen.fit.space import SearchSpace, search_space
from vehgen.fit.trial import Trial
from vehgen.simulate import Scenario, SimulatorPool
from vehgen.simulate.last_used import LastUsed
from vehgen.simulate.ranking import Reduction, rank_population

Array = NDArray[np.float64]
Responses = tuple[Array, NDArray[np.bool_]]
"""Responses `shape (n, n_samples, n_channels)`, and which of them failed `shape (n,)`."""
REMEMBERED_UP_TO = 32
"""Populations of a search come but once; a fit asks again for the few individuals of its points."""
_RESPONSES = LastUsed[Responses](lambda item: item[0].nbytes)


@dataclass(frozen=True)
class Problem:
    """Trials of one vehicle and the parameters to search; made by :func:`make_problem`."""

    trials: tuple[Trial, ...]
    space: SearchSpace

    def population(self, values: Array, trial: Trial) -> Array:
        """Return a trial's population from searched values `shape (n, space.size)` [SI]: `shape (n, n_parameters)`."""
        names = trial.simulator.model.parameters
        base = np.array([trial.values[name] for name in names])
        found = np.repeat(base[None, :], len(values), axis=0)
        for column, name in enumerate(self.space.names):
            if name not in trial.fixed and name in names:
                found[:, names.index(name)] = values[:, column]
        return found

    def respond(self, values: Array, trial: Trial, scenario: Scenario | None = None) -> Responses:
        """Simulate searched values over a trial.

        Parameters
        ----------
        values
            `shape (n, space.size)` [SI].
        trial
            One of `trials`.
        scenario
            In place of the trial's own.

        Returns
        -------
        responses `shape (n, n_samples, n_channels)`, and which of them failed `shape (n,)`; neither is to be written to: the last ones of
        a few individuals are remembered.
        """
        population, scenario = self.population(values, trial), scenario or trial.scenario
        if len(values) > REMEMBERED_UP_TO:
            return _simulated(trial, population, scenario)
        key = id(trial.simulator), scenario.key, population.tobytes()
        return _RESPONSES.find(key, (trial.simulator, scenario.sources), lambda: _simulated(trial, population, scenario))

    def rank(self, values: Array, trial: Trial, reduction: Reduction) -> tuple[Array, NDArray[np.bool_]]:
        """Simulate searched values `shape (n, space.size)` [SI] over a trial for a search, perhaps in single precision.

        Returns
        -------
        What a reduction makes of the responses, and which individuals failed (see :mod:`vehgen.simulate.ranking`).
        """
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", ModelWarning)
            return rank_population(trial.simulator, self.population(values, trial), trial.scenario, reduction)

    def respond_nearby(self, values: Array, trial: Trial, scenario: Scenario, others: Sequence[Scenario]) -> Array:
        """Simulate searched values `shape (1 + len(others), space.size)` [SI] over a scenario of a trial and others, all hardly different.

        Returns
        -------
        Responses `shape (1 + len(others), n_samples, n_channels)`, that of `scenario` first (see :meth:`Simulator.run_nearby`).
        """
        return trial.simulator.run_nearby(self.population(values, trial), scenario, others)

    def lengths_between_axles(self, trial: Trial) -> tuple[int, ...]:
        """Return which searched parameters decide where a trial's axles meet the road."""
        deciding = trial.simulator.layout_parameters if trial.scenario.track.parts else frozenset[str]()
        return tuple(i for i, name in enumerate(self.space.names) if name in deciding and name not in trial.fixed)

    def with_trials(self, trials: Sequence[Trial]) -> Problem:
        """Return the problem over other trials."""
        return replace(self, trials=tuple(trials))

    def of_sensors(self, sensors: Sequence[str]) -> Problem:
        """Return the problem with some sensors only, of each run those that it has; raises InputError for a run that has none of them."""
        shared, trials = SimulatorPool(), []
        for trial in self.trials:
            own = [name for name in sensors if name in trial.run.file.sensors]
            trials.append(trial.of_sensors(own or sensors, shared))
        return self.with_trials(trials)

    def searching(self, names: Sequence[str], fixed: dict[str, float]) -> Problem:
        """Return the problem that searches `names` only, other parameters standing at `fixed` [SI]."""
        trials = [replace(trial, values=trial.values | {k: v for k, v in fixed.items() if k not in trial.fixed}) for trial in self.trials]
        return Problem(tuple(trials), self.space.only(names))

    def values_of(self, values: Array, trial: Trial) -> dict[str, float]:
        """Return all of a trial's parameters [SI] at searched values `shape (space.size,)`; what its run file fixes stands."""
        return trial.values | {name: value for name, value in self.best_values(values).items() if name not in trial.fixed}

    def best_values(self, values: Array) -> dict[str, float]:
        """Return searched values `shape (space.size,)` by name [SI]."""
        return {name: float(value) for name, value in zip(self.space.names, values, strict=True)}


def _simulated(trial: Trial, population: Array, scenario: Scenario) -> Responses:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)
        result = trial.simulator.run(population, scenario)
    failed = np.zeros(len(population), dtype=bool)
    failed[list(result.failures)] = True
    result.responses.setflags(write=False)
    return result.responses, failed


def make_problem(trials: Sequence[Trial], names: Sequence[str] | None = None) -> Problem:
    """Return the problem of trials of one vehicle, searching all parameters with a range or `names` of them.

    Raises
    ------
    InputError
        Where the trials are of different vehicles, or the ranges cannot be searched.
    """
    first = trials[0].run.vehicle
    for trial in trials[1:]:
        if trial.run.vehicle.name != first.name or trial.run.vehicle.parameters != first.parameters:
            raise InputError(
                f"{trial.name} is a run of {trial.run.vehicle.name}, {trials[0].name} one of {first.name}: calibrate one vehicle at a time"
            )
    values = first.values(trials[0].run.file.set)
    space = search_space(first, values, names)
    free = tuple(name for name in space.names if not all(name in trial.fixed for trial in trials))
    return Problem(tuple(trials), space.only(free))
