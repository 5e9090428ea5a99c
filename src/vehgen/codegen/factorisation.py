"""Symbolic sparse factorisation of a symmetric positive definite matrix inside a program.

A = L D L^T with the unknowns ordered by minimum degree: leaves of the vehicle (axles, seats, modules) go first and cost the same
whether the vehicle has two or forty of them; the bodies, which everything couples, go last.
"""

from __future__ import annotations

from dataclasses import dataclass

from vehgen.codegen.program import Node, Program

Matrix = dict[tuple[int, int], Node]
"""Entries of a sparse symmetric matrix; both triangles are present."""


@dataclass(frozen=True)
class Factor:
    """L (unit lower, by [row, column]), the reciprocal of D, and the order of elimination."""

    order: list[int]
    lower: Matrix
    inverse: dict[int, Node]

    def solve(self, program: Program, right: list[Node]) -> list[Node]:
        """Return the solution of A x = right as nodes of the program."""
        x = list(right)
        done: list[int] = []
        for row in self.order:
            terms = [program.negate(program.multiply(self.lower[row, j], x[j])) for j in done if (row, j) in self.lower]
            x[row] = program.total([x[row], *terms])
            done.append(row)
        for row in reversed(self.order):
            terms = [program.multiply(self.inverse[row], x[row])]
            terms += [program.negate(program.multiply(factor, x[i])) for (i, j), factor in self.lower.items() if j == row]
            x[row] = program.total(terms)
        return x


def minimum_degree(size: int, pattern: set[tuple[int, int]]) -> list[int]:
    """Return an elimination order: always the unknown with the fewest neighbours left, the last of equals (axles come last)."""
    neighbours = {i: {j for (a, j) in pattern if a == i and j != i} for i in range(size)}
    order = []
    while neighbours:
        best = min(neighbours, key=lambda i: (len(neighbours[i]), -i))
        order.append(best)
        around = neighbours.pop(best)
        for i in around:
            neighbours[i] = (neighbours[i] | around) - {i, best}
    return order


def factorise(program: Program, size: int, matrix: Matrix, name: str) -> Factor:
    """Factorise a symmetric matrix whose entries are nodes; `name` labels the results in the source."""
    order = minimum_degree(size, set(matrix))
    work = dict(matrix)
    lower: Matrix = {}
    inverse: dict[int, Node] = {}
    left = set(range(size))
    for pivot in order:
        left.discard(pivot)
        inverse[pivot] = program.label(program.divide(program.number(1.0), work[pivot, pivot]), f"{name}_inv{pivot}")
        rows = sorted(i for i in left if (i, pivot) in work)
        for i in rows:
            lower[i, pivot] = program.label(program.multiply(work[i, pivot], inverse[pivot]), f"{name}_l{i}_{pivot}")
        for i in rows:
            for j in rows:
                if j <= i:
                    update = program.multiply(lower[i, pivot], work[j, pivot])
                    old = work.get((i, j), program.number(0.0))
                    work[i, j] = work[j, i] = program.subtract(old, update)
    return Factor(order, lower, inverse)
