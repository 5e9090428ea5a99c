"""Frequency responses as a result: from the road or the inputs under each axle, and from forces, to channels."""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from numbers import Real
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from vehgen.errors import ArgumentError, ModelWarning, shown
from vehgen.files.limits import FREQUENCY_LIMIT, SPEED_LIMIT
from vehgen.files.result_fields import Array1D, Array3D
from vehgen.files.results import Cell, Result, Table
from vehgen.mechanics import EquationsOfMotion, ModelLike, Output, Place, all_values
from vehgen.simulate.frequency import leaves_laws_out, maxwell_branches, transfer_functions
from vehgen.simulate.state_space import model_with_channels

DEFAULT_FREQUENCY_HZ = (0.1, 30.0, 0.05)
"""Where responses are computed unless told: first, last, step [Hz]."""
DEFAULT_SPEED_M_S = 20.0
"""Of a vehicle over a road whose responses are told, unless another is given."""
ROAD = "road"
"""The one input of all axles that follow each other over a road."""


@dataclass(frozen=True, eq=False)
class FrequencyResponse(Result):
    """Outputs per unit of each input over frequency, complex: amplitude, and phase of the output over the input's.

    `frequency shape (n,)` [Hz]; `real` and `imaginary` `shape (n, n_outputs, n_inputs)`, in the outputs' `units` per m or N; `speed` [m/s]
    of the vehicle where the axles follow each other over one road, else None.
    """

    KIND: ClassVar[str] = "frequency response"
    DRAWING: ClassVar[str] = "vehgen.report.plots.result_plots:plot_frequency_response"

    frequency: Array1D
    real: Array3D
    imaginary: Array3D
    outputs: tuple[str, ...]
    units: tuple[str, ...]
    inputs: tuple[str, ...]
    speed: float | None = None

    def __post_init__(self) -> None:
        shape = len(self.frequency), len(self.outputs), len(self.inputs)
        if self.real.shape != shape or self.imaginary.shape != shape or len(self.units) != shape[1]:
            raise ValueError("a number for every frequency, output and input was expected")

    @property
    def values(self) -> NDArray[np.complex128]:
        """The response, `shape (n, n_outputs, n_inputs)`."""
        return np.asarray(self.real + 1j * self.imaginary, dtype=np.complex128)

    def table(self) -> Table:
        """Return amplitudes, a row a frequency and a column an output and input."""
        names = [f"{output} per {name}" for output in self.outputs for name in self.inputs]
        amplitude = np.abs(self.values).reshape(len(self.frequency), -1).tolist()
        rows: list[tuple[Cell, ...]] = [(float(f), *row) for f, row in zip(self.frequency, amplitude, strict=True)]
        return ("frequency [Hz]", *names), rows


def frequency_response(
    model: ModelLike,
    frequency: ArrayLike | None = None,
    *,
    outputs: Iterable[Output] = (),
    forces: Iterable[Place] = (),
    values: Mapping[str, float] | None = None,
    parameter_set: str | None = None,
    speed: float | None = None,
) -> FrequencyResponse:
    """Return the linear response of channels to inputs at frequencies.

    Parameters
    ----------
    model, outputs, forces, values, parameter_set
        As in :func:`vehgen.state_space`.
    frequency
        `shape (n,)` [Hz] (default: 0.1 to 30 Hz, every 0.05 Hz).
    speed
        Of the vehicle [m/s]: every axle then meets the same road, later by its distance behind the first, and `road` is one input in place
        of the axles'. Without it each axle has an input of its own.

    Returns
    -------
    The response. Force laws are not in it, but for relaxation, which is linear: a ModelWarning says so.

    Raises
    ------
    InputError
        For names that the vehicle lacks, frequencies that are none, a speed for a vehicle without axles, and one that cannot be.
    """
    f = _frequencies(frequency)
    found = model_with_channels(model, outputs, forces)
    if leaves_laws_out(found):
        warnings.warn(ModelWarning(f"the force laws of {found.vehicle.name} are left out: this response is linear"), stacklevel=2)
    known = all_values(found, values, parameter_set)
    displaced, pushed = transfer_functions(found.numeric(known), f, maxwell_branches(found, known))
    inputs = found.inputs
    if speed is not None:
        delays = axle_delays(found, known, speed)
        n_axles = len(delays)
        road = _one_road(displaced, f, delays)[:, :, None]
        displaced, inputs = np.concatenate([road, displaced[:, :, n_axles:]], axis=2), (ROAD, *inputs[n_axles:])
    response = np.concatenate([displaced, pushed], axis=2)
    return FrequencyResponse(
        f,
        response.real.copy(),
        response.imag.copy(),
        outputs=tuple(channel.name for channel in found.channels),
        units=tuple(channel.unit for channel in found.channels),
        inputs=(*inputs, *(f"force.{name}" for name in found.forces)),
        speed=speed,
    )


def over_one_road(
    model: EquationsOfMotion, values: Mapping[str, float], frequency: NDArray[np.float64], delays: NDArray[np.float64]
) -> NDArray[np.complex128]:
    """Return the channels per metre of one road that all axles meet, force laws left out, but for relaxation.

    Parameters
    ----------
    model, values
        Equations of motion and their parameters [SI].
    frequency
        `shape (n,)` [Hz].
    delays
        How much later than the first each axle meets the road [s], `shape (n_axles,)`.

    Returns
    -------
    `shape (n, n_channels)`, complex.
    """
    return _one_road(transfer_functions(model.numeric(values), frequency, maxwell_branches(model, values))[0], frequency, delays)


def _one_road(displaced: NDArray[np.complex128], f: NDArray[np.float64], delays: NDArray[np.float64]) -> NDArray[np.complex128]:
    turned = np.exp(-2j * np.pi * f[:, None] * delays)
    return np.asarray((displaced[:, :, : len(delays)] @ turned[:, :, None])[:, :, 0])


def axle_delays(model: EquationsOfMotion, values: Mapping[str, float], speed: float) -> NDArray[np.float64]:
    """Return how much later than the first each axle meets the road [s], `shape (n_axles,)`.

    Raises
    ------
    InputError
        For a vehicle without axles, and a speed [m/s] that cannot be.
    """
    if not model.vehicle.axles:
        raise ArgumentError(f"`speed`: {model.vehicle.name} has no axles", "speed")
    if isinstance(speed, bool) or not isinstance(speed, Real):
        raise ArgumentError(f"`speed`: a number in m/s was expected, found {shown(speed)}", "speed")
    if not speed > 0:
        raise ArgumentError(f"`speed`: must be above 0, found {speed:g}", "speed")
    if (reason := SPEED_LIMIT.refusal(speed)) is not None:
        raise ArgumentError(f"`speed`: {reason}", "speed")
    return model.wheel_offsets(values) / speed


def _frequencies(frequency: ArrayLike | None) -> NDArray[np.float64]:
    if frequency is None:
        low, high, step = DEFAULT_FREQUENCY_HZ
        return np.linspace(low, high, round((high - low) / step) + 1)
    try:
        found = np.atleast_1d(np.asarray(frequency, dtype=np.float64))
    except (TypeError, ValueError) as error:
        raise ArgumentError("`frequency`: numbers in Hz were expected", "frequency") from error
    if found.ndim != 1 or not found.size or not (np.isfinite(found) & (found >= 0)).all() or found.max() > FREQUENCY_LIMIT.high:
        raise ArgumentError(f"`frequency`: a list of numbers from 0 to {FREQUENCY_LIMIT.high:g} Hz was expected", "frequency")
    return found
