"""Equations of motion as plain data: written as text, read again without sympy and without running anything, evaluated in numbers."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from vehgen.mechanics.coordinates import Coordinate
from vehgen.mechanics.numeric_model import NumericModel

if TYPE_CHECKING:
    import sympy as sp

    from vehgen.mechanics.equations_of_motion import EquationsOfMotion

Node = list[Any]
"""`["value", 2.5]`, `["name", "k1"]`, or `["add" | "multiply" | "power", NUMBERS OF NODES BEFORE IT]`."""
Entries = list[list[int]]
"""Row, column, and number of the node, of every entry of a matrix."""


@dataclass(frozen=True)
class PlainEquations:
    """The matrices of equations without channels, as one list of nodes; evaluated bit for bit as the expressions they were made of.

    `definitions` are dependent parameters with their nodes, in the order in which they can be computed; `shapes` and `matrices` hold M, C,
    K, P, Q, F and `weight`, a column.
    """

    coordinates: tuple[Coordinate, ...]
    parameters: tuple[str, ...]
    definitions: tuple[tuple[str, int], ...]
    nodes: tuple[Node, ...]
    shapes: dict[str, tuple[int, int]]
    matrices: dict[str, Entries]

    @classmethod
    def of(cls, model: EquationsOfMotion) -> PlainEquations | None:
        """Return equations as data; None where their expressions hold other functions than sums, products and powers."""
        writer = _Writer()
        try:
            definitions = tuple((symbol.name, writer.node(expression)) for symbol, expression in model.definitions)
            shaped = model.matrix_entries()
            matrices = {key: [[i, j, writer.node(value)] for (i, j), value in entries.items()] for key, (entries, _) in shaped.items()}
            matrices["weight"] = [[i, 0, writer.node(value)] for i, value in model.weight_entries.items()]
        except _UnknownFunctionError:
            return None
        shapes = {key: shape for key, (_, shape) in shaped.items()} | {"weight": (model.n_dof, 1)}
        return cls(model.coordinates, model.parameters, definitions, tuple(writer.nodes), shapes, matrices)

    def to_text(self) -> str:
        """Return JSON."""
        return json.dumps(asdict(self))

    @classmethod
    def from_text(cls, text: str) -> PlainEquations:
        """Return what :meth:`to_text` wrote."""
        data = json.loads(text)
        return cls(
            tuple(Coordinate(**item) for item in data["coordinates"]),
            tuple(data["parameters"]),
            tuple((name, number) for name, number in data["definitions"]),
            tuple(data["nodes"]),
            {key: (rows, columns) for key, (rows, columns) in data["shapes"].items()},
            data["matrices"],
        )

    def numeric(self, values: Mapping[str, float]) -> NumericModel:
        """Evaluate all matrices at values of `parameters` [SI]; see :meth:`EquationsOfMotion.numeric`."""
        known = {name: float(values[name]) for name in self.parameters}
        found: list[float] = []
        ends = [(number, name) for name, number in self.definitions]
        for number, (kind, *of) in enumerate(self.nodes):
            found.append(_value(kind, of, known, found))
            while ends and ends[0][0] <= number:
                defined, name = ends.pop(0)
                known[name] = found[defined]
        arrays = {key: self._matrix(key, found) for key in self.matrices}
        weight = arrays.pop("weight")[:, 0]
        n, width, forces = self.shapes["P"][0], self.shapes["P"][1], self.shapes["F"][1]
        columns = {"acceleration": n, "velocity": n, "displacement": n, "input": width, "input_rate": width, "force": forces}
        return NumericModel(**arrays, weight=weight, outputs={key: np.zeros((0, count)) for key, count in columns.items()})

    def _matrix(self, key: str, found: list[float]) -> NDArray[np.float64]:
        matrix = np.zeros(self.shapes[key])
        for i, j, number in self.matrices[key]:
            matrix[i, j] = found[number]
        return matrix


def _value(kind: str, of: list[Any], known: Mapping[str, float], found: list[float]) -> float:
    if kind == "value":
        return float(of[0])
    if kind == "name":
        return known[of[0]]
    arguments: Iterable[float] = [found[number] for number in of]
    if kind == "add":
        return float(sum(arguments))
    if kind == "multiply":
        return float(math.prod(arguments))
    base, exponent = arguments
    return float(base**exponent)


class _UnknownFunctionError(Exception):
    """An expression holds a function that plain equations do not know."""


class _Writer:
    """Writes expressions as nodes, equal ones once."""

    def __init__(self) -> None:
        self.nodes: list[Node] = []
        self._numbers: dict[sp.Expr, int] = {}

    def node(self, expression: sp.Expr) -> int:
        """Return the number of an expression's node."""
        if expression not in self._numbers:
            node = self._written(expression)
            self._numbers[expression] = len(self.nodes)
            self.nodes.append(node)
        return self._numbers[expression]

    def _written(self, expression: sp.Expr) -> Node:
        if expression.is_Symbol:
            return ["name", expression.name]
        if expression.is_Number:
            return ["value", float(expression)]
        for kind, fits in (("add", expression.is_Add), ("multiply", expression.is_Mul), ("power", expression.is_Pow)):
            if fits:
                return [kind, *(self.node(argument) for argument in expression.args)]
        raise _UnknownFunctionError
