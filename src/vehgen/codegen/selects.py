"""Choices without branches for generated kernels: each becomes one select instruction.

A conditional expression in a compiled function is a branch with blocks of its own; hundreds of them make compilation slow and vectorisation
doubtful. These are the same choices as plain instructions of the intermediate code.
"""

from __future__ import annotations

from typing import Any

from llvmlite import ir
from numba.core import types
from numba.extending import intrinsic


def _kind(*arguments: Any) -> tuple[Any, Any]:
    """Return the type that a choice works in and its type in the intermediate code: single precision where all arguments have it."""
    single = all(argument == types.float32 for argument in arguments)
    return (types.float32, ir.FloatType()) if single else (types.float64, ir.DoubleType())


def _binary(compare: str) -> Any:
    def choose(context: Any, left: Any, right: Any) -> Any:
        def code(_context: Any, builder: Any, _signature: Any, arguments: Any) -> Any:
            first, second = arguments
            return builder.select(builder.fcmp_ordered(compare, first, second), first, second)

        kind, _ = _kind(left, right)
        return kind(kind, kind), code

    return intrinsic(choose)


lower = _binary("<")
"""lower(a, b): the smaller of two numbers; b where one is not a number."""
upper = _binary(">")
"""upper(a, b): the larger of two numbers; b where one is not a number."""


@intrinsic
def step(context: Any, value: Any) -> Any:
    """step(a): 1 where a > 0, else 0."""
    kind, machine = _kind(value)

    def code(_context: Any, builder: Any, _signature: Any, arguments: Any) -> Any:
        one, zero = (ir.Constant(machine, number) for number in (1.0, 0.0))
        return builder.select(builder.fcmp_ordered(">", arguments[0], zero), one, zero)

    return kind(kind), code


@intrinsic
def sign(context: Any, value: Any) -> Any:
    """sign(a): 1, 0 or -1."""
    kind, machine = _kind(value)

    def code(_context: Any, builder: Any, _signature: Any, arguments: Any) -> Any:
        one, zero, minus = (ir.Constant(machine, number) for number in (1.0, 0.0, -1.0))
        below = builder.select(builder.fcmp_ordered("<", arguments[0], zero), minus, zero)
        return builder.select(builder.fcmp_ordered(">", arguments[0], zero), one, below)

    return kind(kind), code
