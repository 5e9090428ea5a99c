"""What is assessed: the motions and forces of a run on an even clock, simulated or recorded."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from vehgen.errors import ArgumentError, InputError
from vehgen.fit.recording import read_recording
from vehgen.mechanics import ElementOutput, Output, PointOutput, static_loads
from vehgen.simulate import Run, Simulator, make_scenario
from vehgen.simulate.budgets import MAX_RESPONSE_NUMBERS
from vehgen.simulate.build import body_channels
from vehgen.simulate.profile_warnings import doubtful_profiles
from vehgen.simulate.table_warnings import doubtful_tables
from vehgen.simulate.warnings import lift_off, step_too_coarse

Array = NDArray[np.float64]
FINEST_RATE = 1000.0
"""A simulation is sampled at its steps, but not more often than so [Hz]: 200 Hz and shocks at 100 Hz want no more."""
FEWEST_ASSESSED = 16
"""Fewer samples are not assessed."""


@dataclass(frozen=True)
class AssessedChannel:
    """One channel: `owner` is its body, axle or link; `is_asked` whether the run itself asks for it; `values shape (n,)` [SI]."""

    name: str
    quantity: str
    unit: str
    owner: str
    on_body: bool
    is_asked: bool
    values: Array


@dataclass(frozen=True)
class AssessedMotion:
    """Channels whose samples are `dt` [s] apart; `loads` are the axles' static loads [N], `warnings` what makes the motion doubtful."""

    dt: float
    channels: tuple[AssessedChannel, ...]
    loads: dict[str, float]
    warnings: tuple[str, ...] = ()

    @property
    def duration(self) -> float:
        """How long it is [s]."""
        return self.dt * len(self.channels[0].values)

    def after(self, start: float) -> AssessedMotion:
        """Return the motion without its first `start` seconds.

        Raises
        ------
        InputError
            Where it is too short for that.
        """
        first = round(start / self.dt) if 0 <= start < np.inf else -1
        left = len(self.channels[0].values) - first
        if first < 0 or left < FEWEST_ASSESSED:
            raise ArgumentError(f"`start`: from 0 to less than the {self.duration:.4g} s of the run, found {start:g}", "start")
        return replace(self, channels=tuple(replace(item, values=item.values[first:]) for item in self.channels))


def simulated_motion(run: Run) -> AssessedMotion:
    """Simulate a run: its channels as the vehicle moves, whatever recorders would make of them.

    Beside the channels that the run asks for there are the acceleration at every sensor on a body (without one, of every body's COG), the
    forces of every tyre and hinge, and the travel of every suspension and link.

    Raises
    ------
    InputError
        For a run that cannot be simulated, or whose response is not finite.
    """
    stride = max(1, int(1 / (FINEST_RATE * run.file.step) + 1e-9))
    fine = replace(run, file=run.file.model_copy(update={"sample": stride * run.file.step}))
    asked = run.outputs()
    outputs = (*asked, *_added(run, asked))
    simulator = Simulator(run.vehicle, outputs, run.forces())
    values = simulator.model.values(overrides=run.values())
    scenario = replace(make_scenario(fine, simulator.model, values), chains={})
    _check_size(run, len(scenario.time) // scenario.decimation, len(outputs))
    result = simulator.run(simulator.parameters(values), scenario)
    if result.failures:
        raise InputError(f"the vehicle has no finite response: {result.failures[0]}", run.document.find(("vehicle",)))
    response = result.responses[0]
    forces = [i for i, item in enumerate(outputs) if i >= len(asked) and item.quantity == "tyre_force"]
    warnings = (
        *lift_off(simulator.model, values, response[:, forces]),
        *step_too_coarse(simulator.model, values, scenario),
        *doubtful_profiles(simulator.model, values, scenario),
        *doubtful_tables(run, simulator.model, scenario),
    )
    channels = tuple(
        AssessedChannel(item.name, item.quantity, item.unit, item.owner, isinstance(output, PointOutput), i < len(asked), response[:, i])
        for i, (item, output) in enumerate(zip(simulator.model.channels, outputs, strict=True))
    )
    return AssessedMotion(scenario.dt * scenario.decimation, channels, static_loads(simulator.model, values).axles, warnings)


def _check_size(run: Run, n_samples: int, n_channels: int) -> None:
    """Refuse a run whose channels, finely sampled, would fill the memory; raises InputError."""
    if (numbers := n_samples * n_channels) > MAX_RESPONSE_NUMBERS:
        said = ("duration",) if run.file.duration is not None else ("speed",)
        raise InputError(
            f"{n_samples} samples of {n_channels} channels are {numbers:.3g} numbers in memory; at most {MAX_RESPONSE_NUMBERS:.3g} "
            "were expected: a shorter run",
            run.document.find(said),
        )


def recorded_motion(run: Run) -> AssessedMotion:
    """Read a run's recording; the axles' static loads are the vehicle's.

    Raises
    ------
    InputError
        For a run without a recording, and for one that cannot be used.
    """
    found = read_recording(run)
    channels = []
    for i, item in enumerate(found.channels):
        output = item.output
        on_body = isinstance(output, PointOutput)
        owner = output.place.body if isinstance(output, PointOutput) else output.owner
        unit = run.file.sensors[item.sensor].quantities[item.quantity]
        channels.append(AssessedChannel(item.name, item.quantity, unit, owner, on_body, True, found.values[:, i]))
    loads = static_loads(run.vehicle, run.values()).axles if run.vehicle.axles else {}
    return AssessedMotion(found.dt, tuple(channels), loads)


def _added(run: Run, asked: tuple[Output, ...]) -> list[Output]:
    """Return what an assessment needs beside what a run asks for."""
    vehicle = run.vehicle
    found: list[Output] = [
        PointOutput(f"{name} acceleration", sensor.place(name), "acceleration")
        for name, sensor in run.file.sensors.items()
        if sensor.body and "acceleration" not in sensor.channels
    ]
    if not any(isinstance(item, PointOutput) and item.quantity == "acceleration" for item in (*asked, *found)):
        found += [
            replace(item, name=f"{item.place.body} acceleration") for item in body_channels(vehicle) if item.quantity == "acceleration"
        ]
    found += [ElementOutput(f"{name} tyre", name, "tyre_force") for name in vehicle.axles]
    known = {(item.owner, item.quantity.replace("hinge_load", "hinge_force")) for item in asked if isinstance(item, ElementOutput)}
    travels = [(name, "suspension_travel") for name, axle in vehicle.axles.items() if axle.suspension is not None]
    travels += [(name, "link_travel") for name in vehicle.links]
    found += [ElementOutput(f"{name} travel", name, quantity) for name, quantity in travels if (name, quantity) not in known]
    found += [ElementOutput(f"hinge {name}", name, "hinge_force") for name in vehicle.hinges if (name, "hinge_force") not in known]
    return found
