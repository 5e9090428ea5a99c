"""The linear equations of motion in state space, x' = A x + B u and y = C x + D u, with the names of states, inputs and outputs."""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import ClassVar, Literal, get_args

import numpy as np
from numpy.typing import NDArray

from vehgen.errors import ArgumentError, ModelWarning, did_you_mean
from vehgen.files.result_fields import Array2D
from vehgen.files.results import Cell, Result, Table
from vehgen.mechanics import EquationsOfMotion, ModelLike, NumericModel, Output, Place, all_values, derive
from vehgen.simulate.build import body_channels
from vehgen.vehicle import as_vehicle

Array = NDArray[np.float64]
InputRates = Literal["inputs", "states"]
ROUNDING = 1e-12
"""Below this share of its terms a sum is zero."""


@dataclass(frozen=True, eq=False)
class StateSpace(Result):
    """A vehicle in state space: `A`, `B`, `C`, `D` in SI units, n states, m inputs, p outputs.

    `A shape (n, n)`, `B shape (n, m)`, `C shape (p, n)`, `D shape (p, m)`: scipy.signal.StateSpace(A, B, C, D) takes them as they are.
    `states`, `inputs` and `outputs` name their rows and columns, `state_units`, `input_units` and `units` (of the outputs) are their units.
    """

    KIND: ClassVar[str] = "state space"
    FORMAT_VERSION: ClassVar[int] = 2
    DRAWING: ClassVar[str] = "vehgen.report.plots.result_plots:plot_poles"

    A: Array2D
    B: Array2D
    C: Array2D
    D: Array2D
    states: tuple[str, ...]
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    units: tuple[str, ...]
    state_units: tuple[str, ...]
    input_units: tuple[str, ...]

    def __post_init__(self) -> None:
        n, m, p = len(self.states), len(self.inputs), len(self.outputs)
        shapes = [self.A.shape, self.B.shape, self.C.shape, self.D.shape]
        counts = [len(self.state_units), len(self.input_units), len(self.units)]
        if shapes != [(n, n), (n, m), (p, n), (p, m)] or counts != [n, m, p]:
            raise ValueError("matrices of as many rows and columns as states, inputs and outputs were expected")

    @property
    def poles(self) -> NDArray[np.complex128]:
        """The eigenvalues of A, `shape (n,)` [1/s], by ascending magnitude."""
        found = np.linalg.eigvals(self.A).astype(np.complex128)
        return found[np.lexsort((found.imag, np.round(np.abs(found), 9)))]

    def table(self) -> Table:
        """Return the poles, a row each: real and imaginary part, frequency and damping ratio."""
        rows: list[tuple[Cell, ...]] = []
        for pole in self.poles:
            radius = float(abs(pole))
            rows.append((float(pole.real), float(pole.imag), radius / (2 * np.pi), float(-pole.real) / radius if radius else None))
        return ("real [1/s]", "imaginary [rad/s]", "frequency [Hz]", "damping ratio"), rows


def state_space(
    model: ModelLike,
    *,
    outputs: Iterable[Output] = (),
    forces: Iterable[Place] = (),
    values: Mapping[str, float] | None = None,
    parameter_set: str | None = None,
    input_rates: InputRates = "inputs",
) -> StateSpace:
    """Return the linear equations of motion in state space.

    Parameters
    ----------
    model
        Equations of motion, or a vehicle: itself, its file, or the name of a bundled model.
    outputs
        What comes out (default: the model's channels; those of a vehicle are acceleration and pitch rate of every body).
    forces
        Where vertical forces act (default: the model's, where its own outputs come out).
    values
        Parameters [SI] by name; what is not named keeps the value of the set, or the file's.
    parameter_set
        One of the vehicle's sets.
    input_rates
        What becomes of the rates of the inputs, which damped tyres and damped ground links feel. `inputs`: they are inputs of their own,
        NAME.rate [m/s]. `states`: none are needed, since the states of the velocities are then q' less what the inputs' jumps give
        them; this works where no output feels a rate directly, as the acceleration of an axle on a damped tyre does.

    Returns
    -------
    The matrices with their names. States are the coordinates, then their rates; inputs the displacements under the axles and at ground
    links [m], their rates [m/s], the forces [N]; outputs lack the static part of a tyre's or hinge's load. Force laws are not in it: a
    ModelWarning says so.

    Raises
    ------
    InputError
        For names that the vehicle lacks, and for rates that the states cannot take up.
    """
    if input_rates not in get_args(InputRates):
        known = did_you_mean(str(input_rates), get_args(InputRates))
        raise ArgumentError(f"`input_rates`: unknown choice {input_rates!r}; {known}", "input_rates")
    found = model_with_channels(model, outputs, forces)
    if any(element.laws for element in found.elements):
        warnings.warn(ModelWarning(f"the force laws of {found.vehicle.name} are left out: these equations are linear"), stacklevel=2)
    numeric = found.numeric(all_values(found, values, parameter_set))
    A, B = numeric.state_matrices()
    C, D, felt = _output_matrices(numeric, A, B)
    width = len(found.inputs)
    rates = [width + i for i in range(width) if B[:, width + i].any() or felt[:, i].any()]
    if input_rates == "states":
        _refuse_felt_rates(found, felt)
        lift = B[:, width : 2 * width]
        B, D = B.copy(), D.copy()
        B[:, :width] += A @ lift
        D[:, :width] += C @ lift
        rates = []
    columns = [*range(width), *rates, *range(2 * width, 2 * width + len(found.forces))]
    return _named(found, A, B, C, D, columns)


def _named(model: EquationsOfMotion, A: Array, B: Array, C: Array, D: Array, columns: list[int]) -> StateSpace:
    """Return matrices with the names of a model; `columns` of displacements, rates and forces are its inputs."""
    names = [*model.inputs, *(f"{name}.rate" for name in model.inputs), *(f"force.{name}" for name in model.forces)]
    units = ["m"] * len(model.inputs) + ["m/s"] * len(model.inputs) + ["N"] * len(model.forces)
    coordinates = [item.name for item in model.coordinates]
    return StateSpace(
        A,
        B[:, columns],
        C,
        D[:, columns],
        states=(*coordinates, *(f"{name}.rate" for name in coordinates)),
        inputs=tuple(names[i] for i in columns),
        outputs=tuple(channel.name for channel in model.channels),
        units=tuple(channel.unit for channel in model.channels),
        state_units=(*(item.unit for item in model.coordinates), *(f"{item.unit}/s" for item in model.coordinates)),
        input_units=tuple(units[i] for i in columns),
    )


def model_with_channels(model: ModelLike, outputs: Iterable[Output] = (), forces: Iterable[Place] = ()) -> EquationsOfMotion:
    """Return equations of motion with channels: those asked for, else the model's own, else acceleration and pitch rate of every body.

    Raises
    ------
    ArgumentError
        For a model that was derived with forces, or channels, which deriving it anew would drop.
    """
    outputs, forces = tuple(outputs), tuple(forces)
    if isinstance(model, EquationsOfMotion):
        if model.channels and not outputs and not forces:
            return model
        if model.forces and not forces:
            said = f"the model has forces ({', '.join(model.forces)}), which would be left out where it is derived anew for its outputs"
            raise ArgumentError(f"{said}: give `forces`, too, or derive it with both", "forces")
        if model.channels and not outputs:
            said = (
                f"the model has outputs ({', '.join(item.name for item in model.channels)}), which would be left out where forces are added"
            )
            raise ArgumentError(f"{said}: give `outputs`, too, or derive it with both", "outputs")
    vehicle = model.vehicle if isinstance(model, EquationsOfMotion) else as_vehicle(model)
    return derive(vehicle, outputs or body_channels(vehicle), forces)


def _output_matrices(numeric: NumericModel, A: Array, B: Array) -> tuple[Array, Array, Array]:
    """Return C, D, and the part of D that input rates have, with what is mere rounding set to zero."""
    n, width = len(numeric.M), numeric.P.shape[1]
    rows = numeric.outputs
    C = rows["acceleration"] @ A[n:] + np.hstack([rows["displacement"], rows["velocity"]])
    direct = np.hstack([rows["input"], rows["input_rate"], rows["force"]])
    D = rows["acceleration"] @ B[n:] + direct
    D[np.abs(D) <= ROUNDING * (np.abs(rows["acceleration"]) @ np.abs(B[n:]) + np.abs(direct))] = 0.0
    return C, D, D[:, width : 2 * width]


def _refuse_felt_rates(model: EquationsOfMotion, felt: Array) -> None:
    if felt.any():
        channel, column = np.argwhere(felt)[0]
        raise ArgumentError(
            f"{model.channels[channel].name} feels the rate of {model.inputs[column]} directly, so that no state can take it up: "
            "`input_rates` must be 'inputs'",
            "input_rates",
        )
