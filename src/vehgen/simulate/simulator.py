"""One vehicle or a population over a run; and simulators that trials and candidates share."""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Mapping, Sequence
from functools import cached_property

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from vehgen.codegen import Kernel, KernelResult
from vehgen.errors import ArgumentError, InputError, ModelWarning, did_you_mean, shown
from vehgen.mechanics import ElementOutput, EquationsOfMotion, Output, Place, derive, static_loads
from vehgen.mechanics.quantities import WITH_STATIC
from vehgen.simulate.acquired import acquire, kept_samples
from vehgen.simulate.budgets import check_population
from vehgen.simulate.lint import lint
from vehgen.simulate.population import as_population, population_of
from vehgen.simulate.profile_warnings import doubtful_profiles
from vehgen.simulate.response import Response, ResponseChannel
from vehgen.simulate.run_file.loading import RunLike, as_run
from vehgen.simulate.run_scenario import make_scenario
from vehgen.simulate.scenario import Scenario
from vehgen.simulate.table_warnings import doubtful_tables
from vehgen.simulate.warnings import at_every_step, doubtful_scenario, lift_off, missed_peaks
from vehgen.vehicle import Vehicle, VehicleLike

Array = NDArray[np.float64]
REMEMBERED = 1000
"""So many layouts of axles are remembered."""


class Simulator:
    """Runs a vehicle, once derived and compiled, as often as wanted.

    Parameters
    ----------
    vehicle
        A vehicle, its file, or the name of a bundled model.
    outputs
        The channels to compute.
    forces
        Where forces act.
    """

    def __init__(self, vehicle: VehicleLike, outputs: Iterable[Output], forces: Iterable[Place] = ()) -> None:
        self.model: EquationsOfMotion = derive(vehicle, outputs, forces)
        self.kernel = Kernel(self.model)
        self._known_offsets: dict[tuple[float, ...], Array] = {}

    def parameters(self, values: Mapping[str, float] | Sequence[Mapping[str, float]] | None = None) -> Array:
        """Return the array of a population from values by name [SI]; see :func:`vehgen.simulate.population.population_of`."""
        return population_of(self.model, values)

    def run(self, parameters: Array, scenario: Scenario, threads: int | None = None) -> KernelResult:
        """Simulate a population over a scenario.

        Individuals whose axles stand at the same distances share their wheel inputs and run together.

        Parameters
        ----------
        parameters
            `shape (n_individuals, n_parameters)`.
        scenario
            Road, speed and other inputs, and the chains that acquire the channels.
        threads
            How many cores to use (default: all).

        Returns
        -------
        Responses and failures; a failed individual raises a ModelWarning and leaves the others unharmed.
        """
        parameters = as_population(self.model, parameters)
        if not isinstance(scenario, Scenario):
            what = type(scenario).__name__
            raise ArgumentError(f"`scenario`: what `make_scenario` makes of a run was expected, found {what}", "scenario")
        names = [channel.name for channel in self.model.channels]
        check_population(len(parameters), kept_samples(scenario, names, self.kernel.source.nonlinear), len(names))
        distinct, group = self.layouts(parameters)
        responses: Array | None = None
        failures: dict[int, str] = {}
        residuals = np.zeros(len(parameters))
        for index, layout in enumerate(distinct):
            members = np.flatnonzero(group == index)
            result = acquire(self.kernel, parameters[members], scenario, layout, threads)
            failures.update({int(members[i]): reason for i, reason in result.failures.items()})
            residuals[members] = result.residuals
            part = result.responses
            if len(distinct) == 1:
                responses = part
            else:
                if responses is None:
                    responses = np.empty((len(parameters), *part.shape[1:]))
                responses[members] = part
        assert responses is not None
        _warn_of(failures, len(parameters))
        return KernelResult(self._add_static(parameters, responses, failures), failures, residuals)

    @cached_property
    def single_kernel(self) -> Kernel:
        """The kernel in single precision; see :mod:`vehgen.simulate.ranking` for where it serves."""
        return Kernel(self.model, precision="single")

    def layouts(self, parameters: Array) -> tuple[Array, NDArray[np.intp]]:
        """Return the distinct layouts of axles in a population `shape (n_layouts, n_axles)` [m], and the number of each individual's."""
        return _distinct_rows(np.round(self.wheel_offsets(parameters), 12))

    def run_nearby(self, parameters: Array, scenario: Scenario, others: Sequence[Scenario]) -> Array:
        """Simulate individuals that hardly differ, over a scenario and others alike: right to the first order, for derivatives.

        Parameters
        ----------
        parameters
            `shape (1 + len(others), n_parameters)`.
        scenario, others
            One for each individual, of the same length, step and chains.

        Returns
        -------
        Responses `shape (1 + len(others), n_samples, n_channels)`, that of `scenario` first.
        """
        layout, *layouts = np.round(self.wheel_offsets(parameters), 12)
        result = acquire(self.kernel, parameters, scenario, layout, 1, list(zip(others, layouts, strict=True)))
        return self._add_static(parameters, result.responses, result.failures)

    def jacobian(self, parameters: Array, scenario: Scenario, names: Sequence[str], relative_step: float = 1e-4) -> tuple[Array, Array]:
        """Return one individual's response and its derivatives, by perturbed lanes of one population.

        Parameters
        ----------
        parameters
            `shape (n_parameters,)`.
        scenario
            Road, speed and other inputs.
        names
            The parameters to differentiate by.
        relative_step
            Step of the central differences over the parameter's magnitude (over 1 where it is 0).

        Returns
        -------
        response `shape (n_samples, n_channels)` and derivatives `shape (len(names), n_samples, n_channels)` per SI unit.
        """
        columns = [self._column(name) for name in names]
        steps = np.array([relative_step * (abs(parameters[column]) or 1.0) for column in columns])
        population = np.repeat(parameters[None, :], 2 * len(columns) + 1, axis=0)
        for i, (column, step) in enumerate(zip(columns, steps, strict=True)):
            population[2 * i + 1, column] += step
            population[2 * i + 2, column] -= step
        responses = self.run(population, scenario).responses
        return responses[0], (responses[1::2] - responses[2::2]) / (2 * steps[:, None, None])

    def _column(self, name: str) -> int:
        if name not in self.model.parameters:
            raise InputError(f"no parameter {shown(name)}; {did_you_mean(name, self.model.parameters)}")
        return self.model.parameters.index(name)

    def wheel_offsets(self, parameters: Array) -> Array:
        """Return each axle's distance behind the first to arrive, `shape (n_individuals, n_axles)` [m]."""
        columns = self._layout_columns
        if not columns:
            return np.repeat(self._offsets(parameters[0], ())[None, :], len(parameters), axis=0)
        distinct, group = _distinct_rows(parameters[:, columns])
        first = [int(np.argmax(group == i)) for i in range(len(distinct))]
        rows = [self._offsets(parameters[i], tuple(parameters[i, columns].tolist())) for i in first]
        return np.array(rows)[group]

    def _offsets(self, individual: Array, layout: tuple[float, ...]) -> Array:
        """Return one individual's distances `shape (n_axles,)`, which its `layout` decides: the last ones are remembered."""
        if layout not in self._known_offsets:
            if len(self._known_offsets) >= REMEMBERED:
                self._known_offsets.clear()
            self._known_offsets[layout] = self.model.wheel_offsets(dict(zip(self.model.parameters, individual, strict=True)))
        return self._known_offsets[layout]

    @cached_property
    def distance_parameters(self) -> dict[str, frozenset[str]]:
        """By axle, the names of the parameters that its distance from the layout's first axle depends on."""
        given = dict(self.model.definitions)
        found: dict[str, frozenset[str]] = {}
        for axle, x in self.model.layout.axles.items():
            distance = x - next(iter(self.model.layout.axles.values()))
            while distance.free_symbols & given.keys():
                distance = distance.xreplace(given)
            found[axle] = frozenset(symbol.name for symbol in sp.expand(distance).free_symbols)
        return found

    @cached_property
    def layout_parameters(self) -> frozenset[str]:
        """Names of the parameters that the distances between axles depend on."""
        return frozenset().union(*self.distance_parameters.values())

    @cached_property
    def _layout_columns(self) -> list[int]:
        return [i for i, name in enumerate(self.model.parameters) if name in self.layout_parameters]

    def _add_static(self, parameters: Array, responses: Array, failures: Mapping[int, str]) -> Array:
        """Add the static load to channels that ask for the whole load of a tyre or hinge, except where an individual failed."""
        for column, channel in enumerate(self.model.channels):
            if channel.quantity in WITH_STATIC:
                for row, individual in enumerate(parameters):
                    if row in failures or not np.isfinite(individual).all():
                        continue
                    loads = static_loads(self.model, dict(zip(self.model.parameters, individual, strict=True)))
                    responses[row, :, column] += loads.within(channel.quantity, channel.owner)
        return responses


def _warn_of(failures: Mapping[int, str], n_individuals: int) -> None:
    if failures and n_individuals > 1:
        first = min(failures)
        text = f"{len(failures)} of {n_individuals} individuals failed; individual {first}: {failures[first]}"
        warnings.warn(ModelWarning(text), stacklevel=3)


def simulate(run: RunLike, *, vehicle: VehicleLike | None = None) -> Response:
    """Simulate a run and look for what makes the answer doubtful.

    Channels are in the units, and of the signs, that the run file gives to their columns, as its recording would be.

    Parameters
    ----------
    run
        A run or its file.
    vehicle
        In place of the one that the run names: itself, its file, or the name of a bundled model.

    Raises
    ------
    InputError
        When the response is not finite.
    """
    run = as_run(run, vehicle)
    wanted = run.outputs()
    tyres = [ElementOutput(f"tyre force of {name}", name, "tyre_force") for name in run.vehicle.axles]
    simulator = Simulator(run.vehicle, (*wanted, *tyres), run.forces())
    values = simulator.model.values(overrides=run.values())
    scenario = make_scenario(run, simulator.model, values)
    parameters = simulator.parameters(values)
    result = simulator.run(parameters, scenario)
    responses = result.responses
    if result.failures:
        raise InputError(f"the vehicle has no finite response: {result.failures[0]}", run.document.find(("vehicle",)))
    n, readings = len(wanted), run.readings()
    items, factors = simulator.model.channels[:n], np.array([factor for _, factor in readings])
    channels = tuple(ResponseChannel(item.name, item.quantity, unit) for item, (unit, _) in zip(items, readings, strict=True))
    read = responses[:, :, :n] / factors
    steps = at_every_step(simulator, parameters, scenario, responses[0])
    messages = [
        *lift_off(simulator.model, values, steps[:, n:]),
        *missed_peaks(channels, scenario, read[0], steps[:, :n] / factors),
        *doubtful_scenario(simulator.model, values, scenario, run.places()),
        *doubtful_profiles(simulator.model, values, scenario),
        *doubtful_tables(run, simulator.model, scenario),
        *lint(simulator.model, values),
    ]
    time = np.arange(responses.shape[1], dtype=np.float64) * scenario.dt * scenario.decimation
    return Response(time, read, channels, tuple(messages))


def _distinct_rows(rows: Array) -> tuple[Array, NDArray[np.intp]]:
    """Return the distinct rows of a matrix, and the number of each row among them; sorting is spared where all are alike."""
    if np.all(rows == rows[0]):
        return rows[:1], np.zeros(len(rows), dtype=np.intp)
    distinct, group = np.unique(rows, axis=0, return_inverse=True)
    return distinct, group.ravel()


class SimulatorPool:
    """Makes a simulator where it has none for what is asked, and returns the same one whenever the same is asked again."""

    def __init__(self) -> None:
        self._simulators: dict[str, list[tuple[Vehicle, Simulator]]] = {}

    def simulator(self, vehicle: Vehicle, outputs: Iterable[Output], forces: Iterable[Place] = ()) -> Simulator:
        """Return the simulator of a vehicle with these channels and forces; equal vehicles share one."""
        channels, acting = tuple(outputs), tuple(forces)
        alike = self._simulators.setdefault(_key(channels, acting), [])
        for known, simulator in alike:
            if known is vehicle or known == vehicle:
                return simulator
        alike.append((vehicle, Simulator(vehicle, channels, acting)))
        return alike[-1][1]

    def add(self, vehicle: Vehicle, outputs: Iterable[Output], forces: Iterable[Place], simulator: Simulator) -> None:
        """Keep a simulator that was made elsewhere for this vehicle, these channels and forces."""
        self._simulators.setdefault(_key(tuple(outputs), tuple(forces)), []).append((vehicle, simulator))


def _key(outputs: tuple[Output, ...], forces: tuple[Place, ...]) -> str:
    """Expressions within places cannot be hashed: their texts can."""
    return repr((outputs, forces))
