"""Frequency responses of linear vehicles: what the channels show per unit of road under each axle."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from vehgen.mechanics.equations_of_motion import EquationsOfMotion
from vehgen.mechanics.laws.memory import RELAXATION
from vehgen.mechanics.numeric_model import NumericModel
from vehgen.mechanics.rows import Row
from vehgen.simulate.harmonic_laws import LawResponse
from vehgen.simulate.sensitivity import matrix_derivatives

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
MATRIX_NUMBERS = 2_000_000
"""So many numbers may the dynamic stiffnesses hold that are solved at once: 32 MB."""


class Branch(Protocol):
    """A force that is a complex stiffness times a travel: see :class:`MaxwellBranch`."""

    @property
    def row(self) -> Array:
        """The travel by the coordinates."""
        ...

    @property
    def input_row(self) -> Array:
        """The travel by the displacement inputs."""
        ...

    @property
    def read(self) -> Array:
        """What channels read of the force."""
        ...

    def stiffness(self, omega: Array) -> Complex:
        """Return the force over the travel at angular frequencies [rad/s], `shape (n, 1, 1)`."""
        ...


@dataclass(frozen=True)
class MaxwellBranch:
    """A law that is linear, but remembers: a spring of stiffness `k` [N/m] in series with a dashpot of `k` times `time` [s].

    Its travel is `row` times the coordinates `shape (n_dof,)` plus `input_row` times the displacement inputs `shape (n_inputs,)`; `read
    shape (n_channels,)` is what channels read of its force.
    """

    k: float
    time: float
    row: Array
    input_row: Array
    read: Array

    def stiffness(self, omega: Array) -> Complex:
        """Return its force over its travel at angular frequencies [rad/s], `shape (n, 1, 1)`."""
        turned = 1j * omega[:, None, None] * self.time
        return np.asarray(self.k * turned / (1 + turned), dtype=np.complex128)


def maxwell_branches(model: EquationsOfMotion, values: Mapping[str, float]) -> tuple[MaxwellBranch, ...]:
    """Return the relaxation laws of a vehicle's elements."""
    found = []
    for number, element in enumerate(model.elements):
        for term in element.laws:
            if term.law is RELAXATION:
                row = [element.row.get(i, sp.S.Zero) for i in range(model.n_dof)]
                input_row = [element.input_row.get(i, sp.S.Zero) for i in range(len(model.inputs))]
                read = [channel.laws.get(number, sp.S.Zero) for channel in model.channels]
                k, time, *rest = model.evaluate_list([term.parameters["k"], term.parameters["time"], *row, *input_row, *read], values)
                found.append(MaxwellBranch(k, time, *np.split(np.array(rest), np.cumsum([len(row), len(input_row)]))))
    return tuple(found)


def leaves_laws_out(model: EquationsOfMotion) -> bool:
    """Return whether a vehicle has force laws that no frequency response holds: others than :func:`maxwell_branches`."""
    return any(term.law is not RELAXATION for element in model.elements for term in element.laws)


def transfer_functions(numeric: NumericModel, frequency: Array, branches: Sequence[Branch] = ()) -> tuple[Complex, Complex]:
    """Return the channels per unit of every displacement input and of every force.

    Force laws are not in it, but for the `branches`.

    Parameters
    ----------
    numeric
        The model's matrices.
    frequency
        `shape (n,)` [Hz].
    branches
        Those of :func:`maxwell_branches` that count, or what stands for laws at one amplitude (:func:`harmonic_laws`).

    Returns
    -------
    `shape (n, n_channels, n_inputs)` and `shape (n, n_channels, n_forces)`, complex: amplitude and phase of a channel over the input's.
    """
    count = max(1, MATRIX_NUMBERS // len(numeric.M) ** 2)
    parts = [_transfer(numeric, 2 * np.pi * frequency[i : i + count], branches) for i in range(0, max(len(frequency), 1), count)]
    displaced, pushed = zip(*parts, strict=True)
    return np.concatenate(displaced), np.concatenate(pushed)


def _transfer(numeric: NumericModel, omega: Array, branches: Sequence[Branch]) -> tuple[Complex, Complex]:
    displaced, pushed = _loads(numeric, omega)
    rows, direct = output_rows(numeric.outputs, omega)
    for item in branches:
        _, load, read, reaching = _quarters(item.stiffness(omega) * _block(item), len(item.row))
        displaced, rows, direct = displaced - load, rows + read, direct + reaching
    states = np.linalg.solve(dynamic_stiffness(numeric, omega, branches), np.concatenate([displaced, pushed], axis=2))
    found = rows @ states
    width = direct.shape[2]
    return found[:, :, :width] + direct, np.asarray(found[:, :, width:] + numeric.outputs["force"], dtype=np.complex128)


def force_response(
    model: EquationsOfMotion, values: Mapping[str, float], rows: Sequence[Row], frequency: Array, element: int | None = None
) -> Complex:
    """Return the channels per unit of generalised forces along rows of the coordinates, `shape (n, n_channels, len(rows))`.

    Where the forces are those of an element, by its number, against its travel, channels that read what it transmits feel them directly.
    A constant force on what nothing holds has no answer: there the lines of frequency 0 are those of motionless coordinates. Of the
    vehicle's laws those are in it that :func:`maxwell_branches` returns.
    """
    omega = 2 * np.pi * frequency
    numeric, branches = model.numeric(values), maxwell_branches(model, values)
    entries = {(i, j): value for j, row in enumerate(rows) for i, value in row.items()}
    loads = model.evaluate_matrix(entries, (model.n_dof, len(rows)), values)
    moving = (omega != 0) | (np.linalg.matrix_rank(numeric.K) == model.n_dof)
    states = np.zeros((len(omega), *loads.shape), dtype=np.complex128)
    states[moving] = np.linalg.solve(dynamic_stiffness(numeric, omega[moving], branches), loads.astype(np.complex128)[None])
    read = [sp.S.Zero if element is None else channel.laws.get(element, sp.S.Zero) for channel in model.channels]
    direct = np.array(model.evaluate_list(read, values))
    reading = output_rows(numeric.outputs, omega)[0]
    for item in branches:
        reading = reading + item.stiffness(omega) * np.outer(item.read, item.row)
    return np.asarray(reading @ states - direct[:, None])


def dynamic_stiffness(numeric: NumericModel, omega: Array, branches: Sequence[Branch] = ()) -> Complex:
    """Return K + i w C - w^2 M, with that of branches, at angular frequencies [rad/s], `shape (n, n_dof, n_dof)`."""
    w = omega[:, None, None]
    found = np.asarray(numeric.K + 1j * w * numeric.C - w * w * numeric.M, dtype=np.complex128)
    for item in branches:
        found = found + item.stiffness(omega) * np.outer(item.row, item.row)
    return found


def _block(item: Branch) -> Array:
    """Return what a branch of stiffness 1 adds: to coordinates and channels (rows), by coordinates and inputs (columns)."""
    return np.outer(np.concatenate([item.row, item.read]), np.concatenate([item.row, item.input_row]))


def _moved_block(item: Branch, moved: Branch) -> Array:
    """Return the derivative of :func:`_block` by a parameter that moves the rows of a branch."""
    down, across = np.concatenate([item.row, item.read]), np.concatenate([item.row, item.input_row])
    return np.outer(np.concatenate([moved.row, moved.read]), across) + np.outer(down, np.concatenate([moved.row, moved.input_row]))


def _quarters(block: Complex, n_dof: int) -> tuple[Complex, Complex, Complex, Complex]:
    """Return a block's stiffness of coordinates, their pull at inputs, and what channels read of both."""
    upper, lower = block[:, :n_dof], block[:, n_dof:]
    return upper[:, :, :n_dof], upper[:, :, n_dof:], lower[:, :, :n_dof], lower[:, :, n_dof:]


def output_rows(outputs: Mapping[str, Array], omega: Array) -> tuple[Complex, Complex]:
    """Return the channels per unit of the coordinates and, directly, of the inputs at angular frequencies [rad/s]."""
    w = omega[:, None, None]
    rows = -w * w * outputs["acceleration"] + 1j * w * outputs["velocity"] + outputs["displacement"]
    return np.asarray(rows, dtype=np.complex128), np.asarray(outputs["input"] + 1j * w * outputs["input_rate"], dtype=np.complex128)


def _loads(numeric: NumericModel, omega: Array) -> tuple[Complex, Complex]:
    w = omega[:, None, None]
    return np.asarray(numeric.P + 1j * w * numeric.Q, dtype=np.complex128), np.repeat(
        numeric.F[None].astype(np.complex128), len(omega), axis=0
    )


def response_derivatives(
    model: EquationsOfMotion, values: Mapping[str, float], names: tuple[str, ...], frequency: Array, laws: Sequence[LawResponse] = ()
) -> Complex:
    """Return the derivatives of :func:`transfer_functions` by parameters, exact: by displacement inputs, then by forces.

    With D X = E and H = R X + W, a parameter moves H by dR X + R D^-1 (dE - dD X) + dW. `laws` are those of
    :func:`vehgen.simulate.harmonic_laws.harmonic_laws` at one amplitude, for the same parameters.

    Returns
    -------
    `shape (len(names), n, n_channels, n_inputs + n_forces)` per SI unit of each parameter.
    """
    omega = 2 * np.pi * frequency
    w = omega[:, None, None]
    numeric = model.numeric(values)
    width = numeric.P.shape[1]
    stiffness = dynamic_stiffness(numeric, omega, [item.law for item in laws])
    load, (rows, _) = np.concatenate(_loads(numeric, omega), axis=2), output_rows(numeric.outputs, omega)
    for item in laws:
        _, pulled, read, _ = _quarters(item.law.stiffness(omega) * _block(item.law), model.n_dof)
        load[:, :, :width] -= pulled
        rows = rows + read
    states = np.linalg.solve(stiffness, load)
    adjoint = np.linalg.solve(stiffness.transpose(0, 2, 1), rows.transpose(0, 2, 1)).transpose(0, 2, 1)
    found = np.empty((len(names), len(frequency), rows.shape[1], states.shape[2]), dtype=np.complex128)
    for i, name in enumerate(names):
        d = matrix_derivatives(model, name, values)
        moved_rows, moved_direct = output_rows(d, omega)
        moved_stiffness = np.asarray(d["K"] + 1j * w * d["C"] - w * w * d["M"], dtype=np.complex128)
        moved_load = np.asarray(d["P"] + 1j * w * d["Q"], dtype=np.complex128)
        pushed = np.repeat(d["F"][None].astype(np.complex128), len(omega), axis=0)
        for item in laws:
            moved = item.derivatives[i]
            block = moved.stiffness(omega) * _block(item.law) + item.law.stiffness(omega) * _moved_block(item.law, moved)
            stiffer, pulled, read, reaching = _quarters(block, model.n_dof)
            moved_stiffness, moved_load = moved_stiffness + stiffer, moved_load - pulled
            moved_rows, moved_direct = moved_rows + read, moved_direct + reaching
        direct = np.concatenate([moved_direct, np.repeat(d["force"][None], len(omega), axis=0)], axis=2)
        found[i] = moved_rows @ states + adjoint @ (np.concatenate([moved_load, pushed], axis=2) - moved_stiffness @ states) + direct
    return found
