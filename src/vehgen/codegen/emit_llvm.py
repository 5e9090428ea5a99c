"""Straight-line functions of generated kernels, turned into machine code without numba's front end.

A kernel's steps hold hundreds of assignments. numba would trace, type and lower every one of them, and LLVM would have to find out that
neighbouring lanes can be computed together. What :func:`emit_llvm` is given is read by Python's own parser, and written as a function
of LLVM that computes several lanes at once: each name is a vector, or one number where all lanes share it. A body may hold nothing but

    name = expression                   each name once
    work[16 + j] = expression           each place once, or pass

with + - * / **, lower, upper, sign, step, abs, math.sqrt, float32 and float64 in the expressions, of names, constants, work[16 + j],
drives[16 + j], drives[3] (the same for all lanes) and dt. Places of lanes are multiples of their number, and arrays start on a cache line,
so that vectors are read and written whole.
"""

from __future__ import annotations

import ast
import inspect
import textwrap
from collections.abc import Callable
from functools import cache
from types import SimpleNamespace
from typing import Any

import llvmlite.binding as llvm
import numba
import numpy as np
from llvmlite import ir
from numba.core import types
from numba.extending import intrinsic
from numba.np.arrayobj import make_array

from vehgen.codegen.llvm_text import write_function

LEAST_WIDTH = 4
"""Lanes that any machine computes at once."""
_PLAIN_FUNCTIONS = {
    "math": SimpleNamespace(sqrt=np.sqrt),  # of a negative number: not a number, as when compiled
    "lower": lambda a, b: a if a < b else b,
    "upper": lambda a, b: a if a > b else b,
    "step": lambda value: 1.0 if value > 0 else 0.0,
    "sign": lambda value: 1.0 if value > 0 else -1.0 if value < 0 else 0.0,
}
"""What the functions of a kernel's expressions mean, in plain Python."""


def compiles() -> bool:
    """Whether numba compiles, that is, NUMBA_DISABLE_JIT is not set."""
    return not getattr(numba.config, "DISABLE_JIT", 0)


@cache
def _fitting(widths: tuple[int, ...]) -> list[int]:
    """Return how many lanes this machine computes at once: half as many where its vectors are shorter than a cache line, but at least 4.

    Twice as many instructions would need twice the registers, which hold half as much there.
    """
    part = 1 if llvm.get_host_cpu_features().get("avx512f", False) else 2
    return sorted({max(LEAST_WIDTH, width // part) for width in widths}, reverse=True)


def emit_llvm(body: Callable[..., None], *, widths: tuple[int, ...], row: int, reread: bool = False) -> Any:
    """Turn a body `(work, j, dt, drives)` into a function `(work, active, dt, drives, steps)`: so many steps of all active lanes.

    At most `widths` lanes are computed at once, and a step has `row` numbers of `drives`; these and `reread` are those of
    :func:`vehgen.codegen.llvm_text.write_function`. numba's code can call it; where numba is told not to compile (NUMBA_DISABLE_JIT), it is
    plain Python, lane by lane.
    """
    if not compiles():
        return _plain(body, row)

    def choose(_context: Any, work: Any, active: Any, dt: Any, drives: Any, steps: Any) -> Any:
        def code(context: Any, builder: Any, _signature: Any, arguments: Any) -> Any:
            name, number = f"{body.__module__}.{body.__name__}", str(context.get_data_type(work.dtype))
            text = write_function(name, _statements(body), _fitting(widths), row, number, reread)
            context.active_code_library.add_llvm_module(llvm.parse_assembly(text))
            kind = ir.FunctionType(ir.VoidType(), [argument.type for argument in arguments])
            builder.call(ir.Function(builder.module, kind, name), arguments)
            return context.get_dummy_value()

        return types.none(work, active, dt, drives, steps), code

    return intrinsic(choose)


def _statements(function: Callable[..., None]) -> list[ast.stmt]:
    definition = ast.parse(textwrap.dedent(inspect.getsource(function))).body[0]
    assert isinstance(definition, ast.FunctionDef)
    return [statement for statement in definition.body if not isinstance(statement, ast.Pass)]


def _plain(body: Callable[..., None], row: int) -> Callable[..., None]:
    def run(work: Any, active: int, dt: float, drives: Any, steps: int) -> None:
        for step in range(steps):
            for j in range(active):
                body(work, j, dt, drives[step * row :])

    body.__globals__.update(_PLAIN_FUNCTIONS)
    return run


def entry(number: str) -> Callable[[Callable[..., None]], Any]:
    """Return a decorator for the function of a kernel that :func:`call_kernel` calls; its numbers are of numba's type `number`."""
    if not compiles():
        return lambda function: function
    signature = f"void(i8, CPointer({number}), i8, {number}, CPointer({number}), i8, CPointer({number}))"
    decorator: Callable[[Callable[..., None]], Any] = numba.cfunc(signature, cache=True)
    return decorator


def _call_kernel(
    _context: Any, _kernel: Any, _phase: Any, work: Any, _active: Any, _dt: Any, drives: Any, _row: Any, _steps: Any, kept: Any, _place: Any
) -> Any:
    def code(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        address, phase, _, active, dt, _, row, steps, _, place = arguments
        lanes, *rows = (make_array(signature.args[i])(context, builder, arguments[i]) for i in (2, 5, 8))  # type: ignore[no-untyped-call]
        first, sample = (
            builder.gep(item.data, [builder.mul(number, builder.extract_value(item.shape, 1))])
            for item, number in zip(rows, (row, place), strict=True)
        )
        values = [phase, lanes.data, active, dt, first, steps, sample]
        kind = ir.FunctionType(ir.VoidType(), [value.type for value in values])
        builder.call(builder.inttoptr(address, kind.as_pointer()), values)
        return context.get_dummy_value()

    whole = types.int64
    return types.none(whole, whole, work, whole, work.dtype, drives, whole, whole, kept, whole), code


def _call_plainly(
    kernel: Any, phase: int, work: Any, active: int, dt: float, drives: Any, row: int, steps: int, kept: Any, place: int
) -> None:
    kernel(phase, work, active, dt, drives[row:].ravel(), steps, kept[place:].ravel())


call_kernel: Any = intrinsic(_call_kernel) if compiles() else _call_plainly
"""Call a kernel from numba's code: (its address, the phase, work, active lanes, dt, the steps' rows of drives, the first of them, steps,
the samples' rows of drives, the one of them)."""
