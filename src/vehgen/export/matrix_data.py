"""Equations of motion as plain data: matrices in numbers, what their rows and columns are, parameters, static loads, force laws."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from vehgen.export.source import ExportSource
from vehgen.files.provenance import versions
from vehgen.files.result_fields import Array1D, Array2D
from vehgen.mechanics import GRAVITY

if TYPE_CHECKING:
    from pydantic import TypeAdapter

EQUATION = "M q'' + C q' + K q = P w + Q w' + F f"
OUTPUT_EQUATION = "y = acceleration q'' + velocity q' + displacement q + input w + input_rate w' + force f"


@dataclass(frozen=True)
class Quantity:
    """A coordinate, input, force or output: its name, SI unit, and what it is."""

    name: str
    unit: str
    meaning: str


@dataclass(frozen=True)
class ParameterValue:
    """A parameter: its value in its SI unit; `equals` is how it follows from others, null for a free one."""

    name: str
    value: float
    unit: str
    meaning: str
    equals: str | None


@dataclass(frozen=True)
class OutputMatrices:
    """Coefficients of the outputs, a row each: of q'', q', q `shape (p, n)`, of w and w' `shape (p, m)`, of f `shape (p, n_forces)`."""

    acceleration: Array2D
    velocity: Array2D
    displacement: Array2D
    input: Array2D
    input_rate: Array2D
    force: Array2D


@dataclass(frozen=True)
class StaticData:
    """Static equilibrium under gravity: load of every axle and vertical force in every hinge [N], and the coordinates [m, rad].

    `outputs` is what a `tyre_load` or `hinge_load` has of it beside y [N], 0 for other outputs.
    """

    gravity: float
    axles: dict[str, float]
    hinges: dict[str, float]
    displacement: Array1D
    outputs: Array1D


@dataclass(frozen=True)
class ForceLaw:
    """A force law beside the linear equations; its element's travel is d = row q + input_row w.

    The equations gain -row^T f on the right. `static_force` is what the element carries in equilibrium [N, N m], compression positive.
    """

    law: str
    equation: str
    kind: str
    element: str
    travel_from: Literal["static", "unloaded"]
    parameters: dict[str, float]
    row: Array1D
    input_row: Array1D
    static_force: float


@dataclass(frozen=True)
class VehicleLabel:
    """Which vehicle it is."""

    name: str
    title: str
    source: str


@dataclass(frozen=True)
class MatrixData:
    """Equations of motion about static equilibrium, SI units throughout.

    M, C, K `shape (n, n)`, P and Q `shape (n, m)`, F `shape (n, k)`, weight `shape (n,)`: rows in the order of `coordinates`, columns of P
    and Q in that of `inputs`, of F in that of `forces`. `axle_offsets` is how far each axle runs behind the first [m].
    """

    format: Literal["vehgen equations of motion"]
    format_version: Literal[1]
    vehicle: VehicleLabel
    equation: str
    output_equation: str
    coordinates: tuple[Quantity, ...]
    inputs: tuple[Quantity, ...]
    forces: tuple[Quantity, ...]
    outputs: tuple[Quantity, ...]
    M: Array2D
    C: Array2D
    K: Array2D
    P: Array2D
    Q: Array2D
    F: Array2D
    weight: Array1D
    output_matrices: OutputMatrices
    parameters: tuple[ParameterValue, ...]
    static: StaticData
    axle_offsets: dict[str, float]
    force_laws: tuple[ForceLaw, ...]
    versions: dict[str, str]


def matrix_data(source: ExportSource) -> MatrixData:
    """Return a model as plain data."""
    model, numeric, loads = source.model, source.numeric, source.loads
    vehicle = model.vehicle
    return MatrixData(
        format="vehgen equations of motion",
        format_version=1,
        vehicle=VehicleLabel(vehicle.name, vehicle.title, vehicle.source),
        equation=EQUATION,
        output_equation=OUTPUT_EQUATION,
        coordinates=tuple(Quantity(item.name, item.unit, item.meaning) for item in model.coordinates),
        inputs=tuple(Quantity(name, "m", _input_meaning(name)) for name in model.inputs),
        forces=tuple(Quantity(name, "N", f"upward force at {name}") for name in model.forces),
        outputs=tuple(Quantity(item.name, item.unit, f"{item.quantity} of {item.owner}") for item in model.channels),
        M=numeric.M,
        C=numeric.C,
        K=numeric.K,
        P=numeric.P,
        Q=numeric.Q,
        F=numeric.F,
        weight=numeric.weight,
        output_matrices=OutputMatrices(**numeric.outputs),
        parameters=_parameters(source),
        static=StaticData(GRAVITY if vehicle.gravity else 0.0, loads.axles, loads.hinges, loads.displacement, source.static_outputs),
        axle_offsets=dict(zip(vehicle.axles, model.wheel_offsets(source.values).tolist(), strict=True)),
        force_laws=() if source.linear else _force_laws(source),
        versions=versions(),
    )


def plain(data: MatrixData) -> dict[str, Any]:
    """Return lists, texts and numbers for JSON."""
    found: dict[str, Any] = _adapter().dump_python(data, mode="json")
    return found


def matrix_schema() -> dict[str, Any]:
    """Return the JSON Schema of an exported `json` file."""
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **_adapter().json_schema(mode="validation")}


@cache
def _adapter() -> TypeAdapter[MatrixData]:
    from pydantic import TypeAdapter

    return TypeAdapter(MatrixData)


def _input_meaning(name: str) -> str:
    kind, _, owner = name.partition(".")
    return f"height of the road under {owner}" if kind == "road" else f"height of the ground end of {owner}"


def _parameters(source: ExportSource) -> tuple[ParameterValue, ...]:
    """Return the vehicle's parameters, then how far each sensor and force is moved forward."""
    model = source.model
    vehicle, dimensions = model.vehicle, model.vehicle.dimensions
    own = [
        ParameterValue(
            name, source.all_values[name], str(dimensions[name]), item.meaning, None if item.equals is None else item.equals.text
        )
        for name, item in vehicle.parameters.items()
    ]
    shifts = [name for name in model.parameters if name not in vehicle.parameters]
    moved = [ParameterValue(name, source.values[name], "m", f"moves {name.removesuffix('.shift')} forward", None) for name in shifts]
    return (*own, *moved)


def _force_laws(source: ExportSource) -> tuple[ForceLaw, ...]:
    from vehgen.report.equations.writing import law_equation  # with it come the libraries that draw

    model, found = source.model, []
    for element in model.elements:
        row, input_row = np.zeros(model.n_dof), np.zeros(len(model.inputs))
        row[list(element.row)] = model.evaluate_list(element.row.values(), source.values)
        input_row[list(element.input_row)] = model.evaluate_list(element.input_row.values(), source.values)
        for term in element.laws:
            given = model.evaluate_list(term.parameters.values(), source.values)
            found.append(
                ForceLaw(
                    law=term.law.name,
                    equation=law_equation(element, term),
                    kind=element.kind,
                    element=element.name,
                    travel_from=term.origin,
                    parameters=dict(zip(term.parameters, given, strict=True)),
                    row=row,
                    input_row=input_row,
                    static_force=source.loads.elements[element.kind, element.name],
                )
            )
    return tuple(found)
