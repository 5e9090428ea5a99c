"""What a kernel is printed from: the program of a time step, and the terms of a model's equations as nodes of it."""

from __future__ import annotations

from dataclasses import dataclass, field

import sympy as sp

from vehgen.codegen.factorisation import Matrix
from vehgen.codegen.legend import dependent_label, drive_labels, parameter_label
from vehgen.codegen.program import SETUP_PHASE, STEP_PHASE, Node, Program
from vehgen.mechanics.equations_of_motion import EquationsOfMotion
from vehgen.mechanics.rows import Row, SparseMatrix


@dataclass(frozen=True)
class StepProgram:
    """The program of a step: where its leaves are read from, the states (leaf, value after the step), the channels at a sample.

    In the form of displacements and velocities the first 2 n_dof states are these; those of force laws follow. `static_travels` are leaves
    by the number of an element: its travel from the unloaded position to static equilibrium. `sample_means` are leaves of the residual
    form alone: the drives' means over the step that begins at a sample.
    """

    program: Program
    parameters: dict[str, Node]
    static_travels: dict[int, Node]
    time_step: Node
    drives: list[Node]
    states: list[tuple[Node, Node]]
    channels: list[Node]
    sample_means: list[Node] = field(default_factory=list)

    def step_cost(self) -> tuple[int, int]:
        """Return the operations of a step, and its instructions; see :meth:`vehgen.codegen.program.Program.cost`."""
        return self.program.cost(node for _, node in self.states)

    def sample_cost(self) -> tuple[int, int]:
        """Return the operations of a sample, and its instructions."""
        return self.program.cost(self.channels)


class EquationTerms:
    """A new program that knows a model's parameters, and how the terms of its equations read in it.

    Parameters
    ----------
    model
        The model; its names never reach the program, only their numbers do.
    """

    def __init__(self, model: EquationsOfMotion) -> None:
        self.model, self.program = model, Program()
        self.symbols: dict[sp.Symbol, Node] = {}
        self.parameters: dict[str, Node] = {}
        for i, name in enumerate(model.parameters):
            self.parameters[name] = self.program.leaf(parameter_label(i), SETUP_PHASE)
            self.symbols[sp.Symbol(name, real=True)] = self.parameters[name]
        self.memo: dict[sp.Expr, Node] = {}
        for i, (symbol, expression) in enumerate(model.definitions):
            self.symbols[symbol] = self.program.label(self.convert(expression), dependent_label(i))
        self.h = self.program.leaf("dt", SETUP_PHASE)
        self.two_h = self.program.divide(self.program.number(2.0), self.h)
        self.half_h = self.program.multiply(self.program.number(0.5), self.h)

    def drives(self, prefix: str = "") -> list[Node]:
        """Return leaves for the drives: displacement inputs, their rates, applied forces."""
        return [self.program.leaf(prefix + name, STEP_PHASE) for name in drive_labels(len(self.model.inputs), len(self.model.forces))]

    def convert(self, expression: sp.Expr) -> Node:
        """Return a node of the program for an expression of the model's parameters."""
        return self.program.convert(expression, self.symbols, self.memo)

    def matrix(self, entries: SparseMatrix, name: str) -> Matrix:
        """Return the entries that are not zero, labelled `name`, row and column."""
        converted = {place: self.convert(value) for place, value in entries.items()}
        return {(i, j): self.program.label(node, f"{name}{i}_{j}") for (i, j), node in converted.items() if self.program.value(node) != 0.0}

    def load_matrix(self) -> Matrix:
        """Return the columns of displacement inputs, their rates and forces: what each drive adds to each equation."""
        model, width = self.model, len(self.model.inputs)
        joined = self.matrix(model.input_entries, "P")
        joined.update({(i, j + width): node for (i, j), node in self.matrix(model.input_rate_entries, "Q").items()})
        joined.update({(i, j + 2 * width): node for (i, j), node in self.matrix(model.force_entries, "F").items()})
        return joined

    def times(self, row: Row, vector: list[Node]) -> list[Node]:
        """Return the terms of a row times a vector."""
        return [self.program.multiply(self.convert(value), vector[j]) for j, value in sorted(row.items())]

    def channel_terms(self, number: int, motion: tuple[list[Node], list[Node], list[Node]], drives: list[Node]) -> list[Node]:
        """Return the terms of a channel, given accelerations, velocities and displacements and the drives at that time."""
        channel, width = self.model.channels[number], len(self.model.inputs)
        a, v, u = motion
        terms = self.times(channel.acceleration, a) + self.times(channel.velocity, v) + self.times(channel.displacement, u)
        terms += self.times(channel.input, drives[:width]) + self.times(channel.input_rate, drives[width : 2 * width])
        return terms + self.times(channel.force, drives[2 * width :])
