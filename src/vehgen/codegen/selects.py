"""Choices without branches for generated kernels: each becomes one select instruction.

A conditional expression in a compiled function is a branch with blocks of its own; hundreds of them make compilation slow and vectorisation
doubtful. These are the same choices as plain instructions of the intermediate code.
"""

from __future__ import annotations

from typing import Any

from llvmlite import ir
from numba.core import types
from numba.extending import intrinsic


def _binary(compare: str) -> Any:
    def choose(context: Any, left: Any, right: Any) -> Any:
        def code(_context: Any, builder: Any, _signature: Any, arguments: Any) -> Any:
            first, second = arguments
            return builder.select(builder.fcmp_ordered(compare, first, second), first, second)

        return types.float64(types.float64, types.float64), code

    return intrinsic(choose)


lower = _binary("<")
"""lower(a, b): the smaller of two numbers; b where one is not a number."""
upper = _binary(">")
"""upper(a, b): the larger of two numbers; b where one is not a number."""


@intrinsic
def step(context: Any, value: Any) -> Any:
    """step(a): 1 where a > 0, else 0."""

    def code(_context: Any, builder: Any, _signature: Any, arguments: Any) -> Any:
        one, zero = (ir.Constant(ir.DoubleType(), number) for number in (1.0, 0.0))
        return builder.select(builder.fcmp_ordered(">", arguments[0], zero), one, zero)

    return types.float64(types.float64), code


@intrinsic
def sign(context: Any, value: Any) -> Any:
    """sign(a): 1, 0 or -1."""

    def code(_context: Any, builder: Any, _signature: Any, arguments: Any) -> Any:
        one, zero, minus = (ir.Constant(ir.DoubleType(), number) for number in (1.0, 0.0, -1.0))
        below = builder.select(builder.fcmp_ordered("<", arguments[0], zero), minus, zero)
        return builder.select(builder.fcmp_ordered(">", arguments[0], zero), one, below)

    return types.float64(types.float64), code
