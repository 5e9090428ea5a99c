"""The tree of an expression: numbers, names and operations, their dimensions and values."""

from __future__ import annotations

import math
import operator
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from vehgen.errors import did_you_mean, shown
from vehgen.files.units import NONE, Dimension

FUNCTIONS = ("sqrt", "abs", "sign", "min", "max")


class ExpressionError(ValueError):
    """An expression that cannot be read, or whose dimensions do not fit; `offset` counts characters into its text."""

    def __init__(self, message: str, offset: int = 0) -> None:
        super().__init__(message)
        self.offset = offset


@dataclass(frozen=True)
class Number:
    """A number in SI units with its dimension."""

    value: float
    dimension: Dimension
    offset: int = 0


@dataclass(frozen=True)
class Symbol:
    """A parameter's name."""

    name: str
    offset: int = 0


@dataclass(frozen=True)
class Operation:
    """`+ - * / **`, `neg`, or a function's name, applied to its arguments."""

    operator: str
    arguments: tuple[SyntaxNode, ...]
    offset: int = 0


SyntaxNode = Number | Symbol | Operation


def symbols_of(node: SyntaxNode) -> Iterator[Symbol]:
    """Yield each use of a name, from left to right."""
    if isinstance(node, Symbol):
        yield node
    elif isinstance(node, Operation):
        for argument in node.arguments:
            yield from symbols_of(argument)


def constant(node: SyntaxNode) -> float | None:
    """Return the value of a plain number, a quotient of such, or its negative; None for all else."""
    if isinstance(node, Number) and node.dimension == NONE:
        return node.value
    if isinstance(node, Operation) and node.operator == "neg":
        inner = constant(node.arguments[0])
        return None if inner is None else -inner
    if isinstance(node, Operation) and node.operator == "/":
        top, bottom = (constant(argument) for argument in node.arguments)
        return top / bottom if top is not None and bottom else None
    return None


def _power(base: float, exponent: float) -> float:
    result = base**exponent
    if isinstance(result, complex):
        raise ValueError("a negative number has no real root")
    return float(result)


ARITHMETIC: Mapping[str, Callable[..., Any]] = {
    "neg": operator.neg,
    "+": operator.add,
    "-": operator.sub,
    "*": operator.mul,
    "/": operator.truediv,
}
"""Operators of the expression language that numbers and symbols share."""
OF_FLOATS: Mapping[str, Callable[..., float]] = {
    **ARITHMETIC,
    "**": _power,
    "sqrt": math.sqrt,
    "abs": abs,
    "sign": lambda value: math.copysign(1.0, value) if value else 0.0,
    "min": min,
    "max": max,
}
"""What all of them do to floats."""


def dimension_of_node(node: SyntaxNode, dimensions: Mapping[str, Dimension]) -> Dimension:
    """Return the dimension of a tree; raises ExpressionError where units do not fit together."""
    if isinstance(node, Number):
        return node.dimension
    if isinstance(node, Symbol):
        if node.name not in dimensions:
            raise ExpressionError(f"unknown symbol {shown(node.name)}; {did_you_mean(node.name, dimensions)}", node.offset)
        return dimensions[node.name]
    parts = [dimension_of_node(argument, dimensions) for argument in node.arguments]
    match node.operator:
        case "neg" | "abs":
            return parts[0]
        case "sign":
            return NONE
        case "*":
            return parts[0] * parts[1]
        case "/":
            return parts[0] / parts[1]
        case "sqrt":
            return parts[0].power(Fraction(1, 2))
        case "**":
            exponent = constant(node.arguments[1]) or 0.0
            return parts[0].power(Fraction(exponent).limit_denominator(12))
        case _:
            left, right = parts
            for zero, other in ((node.arguments[0], right), (node.arguments[1], left)):
                if isinstance(zero, Number) and zero.value == 0.0:
                    return other
            if left != right:
                word = {"+": "add", "-": "subtract"}.get(node.operator, "compare")
                bare = [item.name for item, found in zip(node.arguments, parts, strict=True) if isinstance(item, Symbol) and found == NONE]
                hint = f"; {shown(bare[0])} has no unit" if bare else ""
                raise ExpressionError(f"cannot {word} {left} and {right}{hint}", node.offset)
            return left
