"""Sensitivities of the measured accelerations to parameters (Wu & Li 2023, Sect. 2.3 and Fig. 5)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from vehgen.errors import InputError
from vehgen.measure import record_psd
from vehgen.mechanics import derive
from vehgen.simulate import Run, make_scenario
from vehgen.simulate.sensitivity import direct_sensitivities

Array = NDArray[np.float64]


@dataclass(frozen=True)
class SensitivityIndices:
    """PSDs of sensitivities: `index shape (n_parameters, n_channels, n)`, in squared units of channel over parameter, per Hz.

    `values shape (n_parameters,)` [SI]; `frequency shape (n,)` [Hz]; `relative shape (n_parameters, n_channels)` is the RMS change of a
    channel for a change of 1 % of the parameter, over the channel's own RMS.
    """

    names: tuple[str, ...]
    values: Array
    channels: tuple[str, ...]
    frequency: Array
    index: Array
    relative: Array


def sensitivity_indices(run: Run, names: Sequence[str] | None = None) -> SensitivityIndices:
    """Return the sensitivity indices, PSD of d(channel)/d(parameter), of a run's channels by direct differentiation (Eq. 19).

    Parameters
    ----------
    run
        A run; it needs no recording.
    names
        Parameters (default: all with a range).

    Raises
    ------
    InputError
        For a vehicle with force laws, or without ranges.
    """
    chosen = tuple(names or run.vehicle.ranges())
    if not chosen:
        raise InputError(f"no parameter of {run.vehicle.name} has a `range`; name those to differentiate by with --parameters")
    model = derive(run.vehicle, run.outputs(), run.forces())
    values = model.values(overrides=run.values())
    scenario = make_scenario(run, model, values)
    excitation = scenario.excitation(model.wheel_offsets(values))
    response, derived = direct_sensitivities(model, excitation, chosen, scenario.decimation, values)
    dt = scenario.dt * scenario.decimation
    frequency, density = record_psd(derived, dt, axis=1)
    rms = np.sqrt(np.mean(response**2, axis=0))
    change = np.sqrt(np.mean(derived**2, axis=1)) * 0.01 * np.abs([[values[name]] for name in chosen])
    relative = change / np.where(rms > 0, rms, np.nan)
    channels = tuple(channel.name for channel in model.channels)
    parameters = np.array([values[name] for name in chosen])
    return SensitivityIndices(chosen, parameters, channels, frequency, density.transpose(0, 2, 1), relative)
