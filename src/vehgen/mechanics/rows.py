"""Sparse rows: a motion as the coefficients of the coordinates it depends on."""

from __future__ import annotations

from collections.abc import Iterable

import sympy as sp

Row = dict[int, sp.Expr]
"""Coordinate index -> coefficient; what is absent is zero."""
SparseMatrix = dict[tuple[int, int], sp.Expr]
"""(row, column) -> entry of a sparse matrix; what is absent is zero."""


def unit(index: int) -> Row:
    """Return the row of one coordinate."""
    return {index: sp.S.One}


def combine(*parts: tuple[sp.Expr, Row]) -> Row:
    """Return the sum of factor * row over the parts."""
    result: Row = {}
    for factor, row in parts:
        for index, coefficient in row.items():
            result[index] = result.get(index, sp.S.Zero) + factor * coefficient
    return {index: coefficient for index, coefficient in result.items() if coefficient != 0}


def add_outer(entries: SparseMatrix, factor: sp.Expr, left: Row, right: Row) -> None:
    """Add factor * left^T right to the entries of a matrix."""
    if factor == 0:
        return
    for i, a in left.items():
        for j, b in right.items():
            entries[i, j] = entries.get((i, j), sp.S.Zero) + factor * a * b


def to_matrix(entries: SparseMatrix, rows: int, columns: int) -> sp.ImmutableSparseMatrix:
    """Return the entries as a sympy matrix."""
    return sp.ImmutableSparseMatrix(rows, columns, {key: value for key, value in entries.items() if value != 0})


def evaluate(row: Row, values: Iterable[sp.Expr]) -> sp.Expr:
    """Return the row times a vector."""
    vector = list(values)
    return sp.Add(*(coefficient * vector[index] for index, coefficient in sorted(row.items())))
