"""Sensitivities of the measured accelerations to parameters (Wu & Li 2023, Sect. 2.3 and Fig. 5)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated, ClassVar

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from vehgen.errors import ArgumentError, did_you_mean, shown
from vehgen.files.result_fields import Array1D, Array2D, Array3D
from vehgen.files.results import Result, Table
from vehgen.files.units import DAMPING, LENGTH, MASS, STIFFNESS
from vehgen.measure import record_psd
from vehgen.mechanics import derive
from vehgen.simulate import RunLike, as_run, make_scenario
from vehgen.simulate.sensitivity import SensitivityProgress, direct_sensitivities
from vehgen.vehicle import Vehicle, VehicleLike

Array = NDArray[np.float64]
MOST_SENSITIVITIES = 500
"""A file with more channels or parameters than this is refused: no figure could show them."""


@dataclass(frozen=True, eq=False)
class SensitivityIndices(Result):
    """PSDs of sensitivities: `index shape (n_parameters, n_channels, n)`, in squared units of channel over parameter, per Hz.

    `values shape (n_parameters,)` [SI]; `frequency shape (n,)` [Hz]; `relative shape (n_parameters, n_channels)` is the RMS change of a
    channel for a change of 1 % of the parameter, over the channel's own RMS; `kinds` are the parameters' kinds, in words.
    """

    KIND: ClassVar[str] = "sensitivity"
    DRAWING: ClassVar[str] = "vehgen.report.plots.sensitivity_plots:plot_first_channel"

    names: tuple[str, ...]
    values: Array1D
    channels: Annotated[tuple[str, ...], Field(max_length=MOST_SENSITIVITIES)]
    frequency: Array1D
    index: Array3D
    relative: Array2D
    kinds: Annotated[tuple[str, ...], Field(max_length=MOST_SENSITIVITIES)]

    def __post_init__(self) -> None:
        shape = len(self.names), len(self.channels), len(self.frequency)
        if self.index.shape != shape or self.relative.shape != shape[:2] or not len(self.values) == len(self.kinds) == shape[0]:
            raise ValueError("a number for every parameter, channel and frequency was expected")

    def table(self) -> Table:
        """Return the relative changes, a row a parameter."""
        return ("parameter", *self.channels), [(name, *row) for name, row in zip(self.names, self.relative.tolist(), strict=True)]


def sensitivity(
    run: RunLike,
    parameters: Sequence[str] | None = None,
    *,
    vehicle: VehicleLike | None = None,
    progress: SensitivityProgress | None = None,
) -> SensitivityIndices:
    """Return the sensitivity indices, PSD of d(channel)/d(parameter), of a run's channels by direct differentiation (Eq. 19).

    Parameters
    ----------
    run
        A run or its file; it needs no recording.
    parameters
        Those to differentiate by (default: all with a range).
    vehicle
        In place of the one that the run names: itself, its file, or the name of a bundled model.
    progress
        Is told of every piece of work its name, and how much of how much is done.

    Raises
    ------
    InputError
        For a vehicle with force laws, or without ranges.
    """
    run = as_run(run, vehicle)
    chosen = searched_parameters(run.vehicle, parameters)
    model = derive(run.vehicle, run.outputs(), run.forces())
    values = model.values(overrides=run.values())
    scenario = make_scenario(run, model, values)
    excitation = scenario.excitation(model.wheel_offsets(values))
    response, derived = direct_sensitivities(model, excitation, chosen, scenario.decimation, values, progress)
    dt = scenario.dt * scenario.decimation
    frequency, density = record_psd(derived, dt, axis=1)
    rms = np.sqrt(np.mean(response**2, axis=0))
    change = np.sqrt(np.mean(derived**2, axis=1)) * 0.01 * np.abs([[values[name]] for name in chosen])
    relative = change / np.where(rms > 0, rms, np.nan)
    channels = tuple(channel.name for channel in model.channels)
    numbers = np.array([values[name] for name in chosen])
    kinds = tuple(_kind(name, run.vehicle) for name in chosen)
    return SensitivityIndices(chosen, numbers, channels, frequency, density.transpose(0, 2, 1), relative, kinds)


def searched_parameters(vehicle: Vehicle, parameters: Sequence[str] | None) -> tuple[str, ...]:
    """Return the parameters that an argument names, or all of a vehicle with a range.

    Raises
    ------
    InputError
        For a name that no free parameter has, and where there is none.
    """
    if isinstance(parameters, str):
        raise ArgumentError(f"`parameters`: a list was expected, e.g. [{parameters!r}]", "parameters")
    chosen = tuple(parameters or vehicle.ranges())
    for name in chosen:
        if name not in vehicle.free_parameters:
            known = did_you_mean(name, vehicle.free_parameters)
            raise ArgumentError(f"`parameters`: {vehicle.name} has no parameter {shown(name)} with a value; {known}", "parameters")
    if not chosen:
        raise ArgumentError(f"no parameter of {vehicle.name} has a range; name those that matter with `parameters`", "parameters")
    return chosen


def _kind(name: str, vehicle: Vehicle) -> str:
    """Return a parameter's kind in words: masses, suspension stiffnesses, tyre stiffnesses, dampings, distances, others."""
    if any(name in axle.tyre.k.names for axle in vehicle.axles.values()):
        return "tyre stiffnesses"
    kinds = {MASS: "masses", STIFFNESS: "suspension and link stiffnesses", DAMPING: "dampings", LENGTH: "distances"}
    return kinds.get(vehicle.dimensions[name], "inertias and others")
