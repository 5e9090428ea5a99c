"""Straight-line functions of generated kernels, turned into machine code without numba's front end.

A kernel's loops hold hundreds of assignments. numba would trace, type and lower every one of them, which takes most of a compilation. A
function decorated with :func:`emit_llvm` is read by Python's own parser instead, and its instructions are written where it is called. It
may hold nothing but

    a, b = drives                       the numbers that are the same for all lanes
    name = expression                   each name once
    work[12 + j] = expression

with + - * / **, lower, upper, sign, step, abs, math.sqrt, float32 and float64 in the expressions, of names, constants, work[12 + j], dt.
"""

from __future__ import annotations

import ast
import inspect
import textwrap
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import numba
import numpy as np
from llvmlite import ir
from numba.core import types
from numba.extending import intrinsic
from numba.np.arrayobj import make_array

SINGLE, DOUBLE = ir.FloatType(), ir.DoubleType()
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


def emit_llvm(function: Callable[..., None]) -> Any:
    """Return a function `(work, j, dt, drives)` of a kernel as something that numba's code can call; see the head of this file.

    Where numba is told not to compile (NUMBA_DISABLE_JIT), it stays a function of plain Python.
    """
    if not compiles():
        function.__globals__.update(_PLAIN_FUNCTIONS)
        return function

    def choose(_context: Any, work: Any, j: Any, dt: Any, drives: Any) -> Any:
        def code(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            array = signature.args[0]
            pointer = make_array(array)(context, builder, arguments[0]).data  # type: ignore[no-untyped-call]
            writer = _Writer(builder, pointer, context.get_data_type(array.dtype), arguments[1], {"dt": arguments[2]}, arguments[3])
            for statement in _body(function):
                writer.write(statement)
            return context.get_dummy_value()

        return types.none(work, j, dt, drives), code

    return intrinsic(choose)


def _body(function: Callable[..., None]) -> list[ast.stmt]:
    definition = ast.parse(textwrap.dedent(inspect.getsource(function))).body[0]
    assert isinstance(definition, ast.FunctionDef)
    return definition.body


class _Writer:
    """Writes statements as instructions at a builder's place; `known` are values by name, `drives` the value of that argument."""

    def __init__(self, builder: Any, work: Any, number: Any, j: Any, known: dict[str, Any], drives: Any) -> None:
        self.builder, self.work, self.number, self.j, self.known, self.drives = builder, work, number, j, known, drives

    def write(self, statement: ast.stmt) -> None:
        """Write one statement."""
        assert isinstance(statement, ast.Assign), ast.dump(statement)
        target = statement.targets[0]
        if isinstance(target, ast.Tuple):
            for i, name in enumerate(target.elts):
                assert isinstance(name, ast.Name)
                self.known[name.id] = self.builder.extract_value(self.drives, i)
            return
        value = self.value(statement.value)
        if isinstance(target, ast.Name):
            self.known[target.id] = value
        else:
            self.builder.store(self._as(value, self.number), self._place(target))

    def value(self, item: ast.expr) -> Any:
        """Return an expression's value."""
        if isinstance(item, ast.Name):
            return self.known[item.id]
        if isinstance(item, ast.Constant):
            return DOUBLE(float(item.value))  # type: ignore[arg-type]
        if isinstance(item, ast.Subscript):
            return self.builder.load(self._place(item))
        if isinstance(item, ast.UnaryOp):
            assert isinstance(item.op, ast.USub), ast.dump(item)
            return self.builder.fneg(self.value(item.operand))
        if isinstance(item, ast.BinOp):
            return self._binary(item)
        assert isinstance(item, ast.Call), ast.dump(item)
        name = item.func.attr if isinstance(item.func, ast.Attribute) else item.func.id  # type: ignore[attr-defined]
        return self._call(name, [self.value(argument) for argument in item.args])

    def _binary(self, item: ast.BinOp) -> Any:
        left, right = self._alike(self.value(item.left), self.value(item.right))
        if isinstance(item.op, ast.Pow):
            return self.builder.call(self.builder.module.declare_intrinsic("llvm.pow", [left.type]), (left, right))
        operations = {ast.Add: "fadd", ast.Sub: "fsub", ast.Mult: "fmul", ast.Div: "fdiv"}
        return getattr(self.builder, operations[type(item.op)])(left, right)

    def _call(self, name: str, arguments: list[Any]) -> Any:
        if name in ("float32", "float64"):
            return self._as(arguments[0], SINGLE if name == "float32" else DOUBLE)
        if name in ("sqrt", "abs"):
            function = self.builder.module.declare_intrinsic({"sqrt": "llvm.sqrt", "abs": "llvm.fabs"}[name], [arguments[0].type])
            return self.builder.call(function, arguments)
        if name in ("lower", "upper"):
            left, right = self._alike(*arguments)
            return self.builder.select(self.builder.fcmp_ordered("<" if name == "lower" else ">", left, right), left, right)
        (value,) = arguments
        one, zero, minus = (value.type(number) for number in (1.0, 0.0, -1.0))
        low = zero if name == "step" else self.builder.select(self.builder.fcmp_ordered("<", value, zero), minus, zero)
        assert name in ("step", "sign"), name
        return self.builder.select(self.builder.fcmp_ordered(">", value, zero), one, low)

    def _alike(self, left: Any, right: Any) -> tuple[Any, Any]:
        """Return two numbers in the wider of their types."""
        kind = SINGLE if left.type == right.type == SINGLE else DOUBLE
        return self._as(left, kind), self._as(right, kind)

    def _as(self, value: Any, kind: Any) -> Any:
        if value.type == kind:
            return value
        if isinstance(value, ir.Constant):
            return kind(value.constant)
        return self.builder.fptrunc(value, kind) if kind == SINGLE else self.builder.fpext(value, kind)

    def _place(self, item: ast.expr) -> Any:
        """Return the address of work[number + j]."""
        assert isinstance(item, ast.Subscript)
        assert isinstance(item.slice, ast.BinOp)
        assert isinstance(item.slice.left, ast.Constant)
        index = self.builder.add(self.j, self.j.type(item.slice.left.value))
        return self.builder.gep(self.work, [index])
