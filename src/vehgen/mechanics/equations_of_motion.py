"""The linear equations of motion M q'' + C q' + K q = P w + Q w' + F f, symbolically, with everything their symbols mean."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from vehgen.mechanics.energies import Element, Energies
from vehgen.mechanics.kinematics import Coordinate, Kinematics
from vehgen.mechanics.layout import Layout
from vehgen.mechanics.rows import Row, SparseMatrix, to_matrix
from vehgen.vehicle.model import Vehicle

GRAVITY = 9.81
"""Acceleration of gravity, m/s^2."""


@dataclass(frozen=True)
class Channel:
    """One output: coefficients of q'', q', q, of the displacement inputs w and of their rates w'."""

    name: str
    quantity: str
    unit: str
    owner: str = ""
    acceleration: Row = field(default_factory=dict)
    velocity: Row = field(default_factory=dict)
    displacement: Row = field(default_factory=dict)
    input: Row = field(default_factory=dict)
    input_rate: Row = field(default_factory=dict)


@dataclass(frozen=True)
class NumericModel:
    """The model's matrices at parameter values, SI units.

    M, C, K `shape (n_dof, n_dof)`; P, Q `shape (n_dof, n_inputs)`; F `shape (n_dof, n_forces)`; `weight shape (n_dof,)` the generalised
    gravity force [N, N m]; `outputs` the channels' coefficients of acceleration, velocity, displacement `shape (n_channels, n_dof)`,
    input and input_rate `shape (n_channels, n_inputs)`.
    """

    M: NDArray[np.float64]
    C: NDArray[np.float64]
    K: NDArray[np.float64]
    P: NDArray[np.float64]
    Q: NDArray[np.float64]
    F: NDArray[np.float64]
    weight: NDArray[np.float64]
    outputs: dict[str, NDArray[np.float64]]

    def state_matrices(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return A and B of x' = A x + B u with x = (q, q') and u = (w, w', f): displacement inputs, their rates, forces."""
        n = len(self.M)
        inverse = np.linalg.inv(self.M)
        A = np.block([[np.zeros((n, n)), np.eye(n)], [-inverse @ self.K, -inverse @ self.C]])
        loads = np.hstack([self.P, self.Q, self.F])
        return A, np.vstack([np.zeros((n, loads.shape[1])), inverse @ loads])


@dataclass(frozen=True)
class EquationsOfMotion:
    """A vehicle's equations of motion; made by :func:`vehgen.mechanics.derive`.

    `parameters` are the columns of a population: the vehicle's free parameters, then one `NAME.shift` [m] per sensor or force that has
    a place on a body (0 by default). `definitions` are the dependent parameters in the order in which they can be computed.
    """

    vehicle: Vehicle
    layout: Layout
    motion: Kinematics
    energies: Energies
    parameters: tuple[str, ...]
    defaults: dict[str, float]
    definitions: tuple[tuple[sp.Symbol, sp.Expr], ...]
    inputs: tuple[str, ...]
    forces: tuple[str, ...]
    channels: tuple[Channel, ...]
    mass_entries: SparseMatrix
    damping_entries: SparseMatrix
    stiffness_entries: SparseMatrix
    input_entries: SparseMatrix
    input_rate_entries: SparseMatrix
    force_entries: SparseMatrix
    weight_entries: Row

    @property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """The independent coordinates q."""
        return self.motion.coordinates

    @property
    def elements(self) -> tuple[Element, ...]:
        """The springs and dampers: suspensions, tyres, links, hinges."""
        return self.energies.elements

    @property
    def is_preloaded(self) -> bool:
        """Whether a force law counts its travel from the unloaded position, so that laws share in carrying the weight."""
        return any(term.origin == "unloaded" for element in self.elements for term in element.laws)

    @property
    def n_dof(self) -> int:
        """Number of degrees of freedom."""
        return len(self.coordinates)

    @cached_property
    def M(self) -> sp.ImmutableSparseMatrix:
        """Mass matrix."""
        return to_matrix(self.mass_entries, self.n_dof, self.n_dof)

    @cached_property
    def C(self) -> sp.ImmutableSparseMatrix:
        """Damping matrix."""
        return to_matrix(self.damping_entries, self.n_dof, self.n_dof)

    @cached_property
    def K(self) -> sp.ImmutableSparseMatrix:
        """Stiffness matrix."""
        return to_matrix(self.stiffness_entries, self.n_dof, self.n_dof)

    @cached_property
    def P(self) -> sp.ImmutableSparseMatrix:
        """Forces per unit of displacement input."""
        return to_matrix(self.input_entries, self.n_dof, len(self.inputs))

    @cached_property
    def Q(self) -> sp.ImmutableSparseMatrix:
        """Forces per unit of input velocity (damped tyres and ground links)."""
        return to_matrix(self.input_rate_entries, self.n_dof, len(self.inputs))

    @cached_property
    def F(self) -> sp.ImmutableSparseMatrix:
        """Generalised forces per unit of each applied force."""
        return to_matrix(self.force_entries, self.n_dof, len(self.forces))

    def operation_counts(self) -> dict[str, int]:
        """Return the additions, multiplications and divisions of all matrix entries, written out and after common subexpressions."""
        entries = [value for group in self._groups().values() for value in group.values()]
        entries += [expression for _, expression in self.definitions]
        replacements, reduced = sp.cse(entries, order="none")
        shared = sum(sp.count_ops(expression) for _, expression in replacements) + sum(sp.count_ops(item) for item in reduced)
        return {"written_out": int(sum(sp.count_ops(item) for item in entries)), "after_cse": int(shared)}

    def _groups(self) -> dict[str, SparseMatrix]:
        return {
            "M": self.mass_entries,
            "C": self.damping_entries,
            "K": self.stiffness_entries,
            "P": self.input_entries,
            "Q": self.input_rate_entries,
            "F": self.force_entries,
            "weight": {(i, 0): value for i, value in self.weight_entries.items()},
        }

    def values(self, parameter_set: str | None = None, overrides: Mapping[str, float] | None = None) -> dict[str, float]:
        """Return the value of every column of `parameters` [SI]; see :meth:`vehgen.vehicle.Vehicle.values`."""
        own = {name: value for name, value in (overrides or {}).items() if name not in self.defaults or name in self.vehicle.parameters}
        values = self.vehicle.values(parameter_set, own)
        return {name: values.get(name, (overrides or {}).get(name, self.defaults.get(name, 0.0))) for name in self.parameters}

    def numeric(self, values: Mapping[str, float] | None = None) -> NumericModel:
        """Evaluate all matrices at the values of `parameters` (default: the file's values).

        Parameters
        ----------
        values
            SI values by parameter name, as :meth:`values` gives them.

        """
        values = values or self.values()
        n, n_in = self.n_dof, len(self.inputs)
        shapes = {
            "M": (n, n),
            "C": (n, n),
            "K": (n, n),
            "P": (n, n_in),
            "Q": (n, n_in),
            "F": (n, len(self.forces)),
            "weight": (n, 1),
        }
        arrays = {key: np.zeros(shape) for key, shape in shapes.items()}
        for key, entries in self._groups().items():
            for place, value in self.evaluate(entries, values).items():
                arrays[key][place] = value
        outputs = self._outputs(values)
        return NumericModel(**{**arrays, "weight": arrays["weight"][:, 0]}, outputs=outputs)

    def _outputs(self, values: Mapping[str, float]) -> dict[str, NDArray[np.float64]]:
        widths = {
            "acceleration": self.n_dof,
            "velocity": self.n_dof,
            "displacement": self.n_dof,
            "input": len(self.inputs),
            "input_rate": len(self.inputs),
        }
        groups = {
            key: {(i, j): value for i, channel in enumerate(self.channels) for j, value in getattr(channel, key).items()} for key in widths
        }
        arrays = {key: np.zeros((len(self.channels), width)) for key, width in widths.items()}
        for key, entries in groups.items():
            for place, value in self.evaluate(entries, values).items():
                arrays[key][place] = value
        return arrays

    @cached_property
    def _symbols(self) -> tuple[tuple[str, sp.Symbol], ...]:
        """The symbol of every parameter by its name."""
        return tuple((name, sp.Symbol(name, real=True)) for name in self.parameters)

    def evaluate(self, entries: SparseMatrix, values: Mapping[str, float]) -> dict[tuple[int, int], float]:
        """Evaluate sympy expressions of the vehicle's parameters at the values of `parameters` [SI]."""
        known: dict[sp.Symbol, float] = {symbol: float(values[name]) for name, symbol in self._symbols}
        for symbol, expression in self.definitions:
            known[symbol] = _number(expression, known)
        return {place: _number(value, known) for place, value in entries.items()}

    def wheel_offsets(self, values: Mapping[str, float] | None = None) -> NDArray[np.float64]:
        """Return how far each axle runs behind the first to arrive, `shape (n_axles,)` [m]."""
        entries: SparseMatrix = {(0, i): x for i, x in enumerate(self.layout.axles.values())}
        found = self.evaluate(entries, values or self.values())
        x = np.array([found[0, i] for i in range(len(entries))])
        return x.max(initial=-np.inf) - x if x.size else x


def _number(expression: sp.Expr, known: Mapping[sp.Symbol, float]) -> float:
    """Evaluate with floats, node by node: much faster than subs, and no code is generated."""
    if expression in known:
        return known[expression]
    if expression.is_Number:
        return float(expression)
    arguments = [_number(argument, known) for argument in expression.args]
    if expression.is_Add:
        return sum(arguments)
    if expression.is_Mul:
        product = 1.0
        for argument in arguments:
            product *= argument
        return product
    if expression.is_Pow:
        return float(arguments[0] ** arguments[1])
    return float(expression.func(*arguments))
