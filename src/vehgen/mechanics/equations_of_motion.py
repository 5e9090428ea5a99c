"""The linear equations of motion M q'' + C q' + K q = P w + Q w' + F f, symbolically, with everything their symbols mean."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from vehgen.errors import ArgumentError, shown
from vehgen.mechanics.coordinates import Coordinate
from vehgen.mechanics.energies import Element, Energies
from vehgen.mechanics.evaluation import ExpressionSteps
from vehgen.mechanics.kinematics import Kinematics
from vehgen.mechanics.layout import Layout
from vehgen.mechanics.numeric_model import NumericModel
from vehgen.mechanics.rows import Row, SparseMatrix, to_matrix
from vehgen.vehicle.model import Vehicle, by_name

GRAVITY = 9.81
"""Acceleration of gravity, m/s^2."""


@dataclass(frozen=True)
class Channel:
    """One output: coefficients of q'', q', q, of the displacement inputs w, of their rates w' and of the applied forces f.

    `laws` are those of the force laws' forces, by the number of the element that carries them.
    """

    name: str
    quantity: str
    unit: str
    owner: str = ""
    acceleration: Row = field(default_factory=dict)
    velocity: Row = field(default_factory=dict)
    displacement: Row = field(default_factory=dict)
    input: Row = field(default_factory=dict)
    input_rate: Row = field(default_factory=dict)
    force: Row = field(default_factory=dict)
    laws: Row = field(default_factory=dict)


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

    def element_number(self, kind: str, name: str) -> int | None:
        """Return the number of the element of a kind and name; None where there is none."""
        return next((i for i, item in enumerate(self.elements) if (item.kind, item.name) == (kind, name)), None)

    @property
    def is_preloaded(self) -> bool:
        """Whether a force law counts its travel from the unloaded position, so that laws share in carrying the weight."""
        return self.vehicle.gravity and any(term.origin == "unloaded" for element in self.elements for term in element.laws)

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
        entries = [value for group, _ in self.matrix_entries().values() for value in group.values()]
        entries += [*self.weight_entries.values(), *(expression for _, expression in self.definitions)]
        replacements, reduced = sp.cse(entries, order="none")
        shared = sum(sp.count_ops(expression) for _, expression in replacements) + sum(sp.count_ops(item) for item in reduced)
        return {"written_out": int(sum(sp.count_ops(item) for item in entries)), "after_cse": int(shared)}

    def matrix_entries(self) -> dict[str, tuple[SparseMatrix, tuple[int, int]]]:
        """Return the entries and the shape of M, C, K, P, Q, F."""
        n, width = self.n_dof, len(self.inputs)
        return {
            "M": (self.mass_entries, (n, n)),
            "C": (self.damping_entries, (n, n)),
            "K": (self.stiffness_entries, (n, n)),
            "P": (self.input_entries, (n, width)),
            "Q": (self.input_rate_entries, (n, width)),
            "F": (self.force_entries, (n, len(self.forces))),
        }

    def output_entries(self) -> dict[str, tuple[SparseMatrix, tuple[int, int]]]:
        """Return the entries and the shape of the channels' coefficients, one row per channel."""
        n, width = self.n_dof, len(self.inputs)
        columns = {"acceleration": n, "velocity": n, "displacement": n, "input": width, "input_rate": width, "force": len(self.forces)}
        return {
            key: (
                {(i, j): value for i, channel in enumerate(self.channels) for j, value in getattr(channel, key).items()},
                (len(self.channels), count),
            )
            for key, count in columns.items()
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

        Raises
        ------
        InputError
            For values that are not by name, or not of all parameters.
        """
        found = iter(self._entry_steps(self._ordered(values if values is not None and len(values) else self.values())))
        own, read = ({key: _filled(entries, shape, found) for key, (entries, shape) in item.items()} for item in self._matrices)
        return NumericModel(**own, weight=np.fromiter(found, dtype=np.float64, count=self.n_dof), outputs=read)

    @cached_property
    def _matrices(self) -> tuple[dict[str, tuple[SparseMatrix, tuple[int, int]]], dict[str, tuple[SparseMatrix, tuple[int, int]]]]:
        """The entries and shapes of the matrices and of the channels' coefficients."""
        return self.matrix_entries(), self.output_entries()

    @cached_property
    def _entry_steps(self) -> ExpressionSteps:
        """What computes all entries of the matrices, of the channels' coefficients, and the weights."""
        entries = [value for item in self._matrices for group, _ in item.values() for value in group.values()]
        return self._steps((*entries, *(self.weight_entries.get(i, sp.S.Zero) for i in range(self.n_dof))))

    @cached_property
    def _known_steps(self) -> dict[tuple[sp.Expr, ...], ExpressionSteps]:
        """Steps by the expressions that they compute: the same ones are asked for again and again, at other values."""
        return {}

    def _steps(self, expressions: tuple[sp.Expr, ...]) -> ExpressionSteps:
        if expressions not in self._known_steps:
            symbols = [sp.Symbol(name, real=True) for name in self.parameters]
            self._known_steps[expressions] = ExpressionSteps(expressions, symbols, self.definitions)
        return self._known_steps[expressions]

    def _ordered(self, values: Mapping[str, float]) -> list[float]:
        values = by_name(values)
        if (lacking := next((name for name in self.parameters if name not in values), None)) is not None:
            wanted = "the value of every parameter by name was expected, as `values(overrides=...)` gives it"
            raise ArgumentError(f"`values`: {wanted}; found no {shown(lacking)}", "values")
        return [float(values[name]) for name in self.parameters]

    def evaluate_list(self, expressions: Iterable[sp.Expr], values: Mapping[str, float]) -> list[float]:
        """Return the values of sympy expressions of the vehicle's parameters, in their order.

        Parameters
        ----------
        expressions
            Of symbols of `parameters` and of those that follow from them.
        values
            The value of every one of `parameters` [SI].
        """
        return [float(value) for value in self._steps(tuple(expressions))(self._ordered(values))]

    def evaluate_matrix(self, entries: SparseMatrix, shape: tuple[int, int], values: Mapping[str, float]) -> NDArray[np.float64]:
        """Return a matrix of sympy expressions in numbers, zero where it has no entry; see :meth:`evaluate_list`."""
        return _filled(entries, shape, iter(self.evaluate_list(entries.values(), values)))

    def total_weight(self, values: Mapping[str, float] | None = None) -> float:
        """Return the weight of all bodies and axles [N], none without gravity."""
        return GRAVITY * self.total_mass(values) if self.vehicle.gravity else 0.0

    def total_mass(self, values: Mapping[str, float] | None = None) -> float:
        """Return the mass of all bodies and axles [kg]."""
        return float(sum(self.evaluate_list((term.inertia for term in self.energies.weights), values or self.values())))

    def wheel_offsets(self, values: Mapping[str, float] | None = None) -> NDArray[np.float64]:
        """Return how far each axle runs behind the first to arrive, `shape (n_axles,)` [m]."""
        x = np.array(self.evaluate_list(self.layout.axles.values(), values or self.values()))
        return x.max(initial=-np.inf) - x if x.size else x


def _filled(entries: SparseMatrix, shape: tuple[int, int], values: Iterator[float]) -> NDArray[np.float64]:
    """Return a matrix whose entries are the next of some values."""
    found = np.zeros(shape)
    for place in entries:
        found[place] = next(values)
    return found
