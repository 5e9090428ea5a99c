"""Bodies of loops over lanes, written as text of LLVM (its "intermediate representation") that computes several lanes at once.

See :mod:`vehgen.codegen.emit_llvm` for what a body may hold.
"""

from __future__ import annotations

import ast
import struct
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

CACHE_LINE = 64
"""Bytes; a vector that is longer begins on one."""
_BYTES = {"float": 4, "double": 8}
_OPERATIONS = {ast.Add: "fadd", ast.Sub: "fsub", ast.Mult: "fmul", ast.Div: "fdiv"}
_FUSED = "contract nsz"
"""Products may be fused with sums, and the sign of zero may be lost."""


def write_function(name: str, body: Sequence[ast.stmt], widths: Sequence[int], row: int, number: str, reread: bool = False) -> str:
    """Return the text of a function `(work, active, dt, rows, steps)`.

    Lanes that are computed at once take all steps before the next ones begin, each step with its row of drives. What a step changes is
    read before the first and written after the last, so that it may stay in registers; what it does not change may take them up instead,
    unless it is read anew every step.

    Parameters
    ----------
    name
        What it is called; another function of that name must be the same.
    body
        Its statements.
    widths
        Lanes that are computed at once: the first number while more lanes are left than the next one could take, and so on.
    row
        Numbers in a row of drives.
    number
        Type of all numbers: "float" or "double".
    reread
        Whether what a step does not change is read anew every step, where it is used.
    """
    writers = [_Writer(width, number, reread) for width in widths]
    loops = "".join(writer.loops(body, row, spare) for writer, spare in zip(writers, [*widths[1:], 0], strict=True))
    declared = sorted({item for writer in writers for item in writer.declared})
    array = f"{number}* noalias"
    arguments = f"{array} %work, i64 %active, {number} %dt, {array} %rows, i64 %steps"
    return f"""{"".join(f"declare {item}{chr(10)}" for item in declared)}
define weak_odr void @"{name}"({arguments}) noinline nounwind {{
begin:
  %first = alloca i64
  store i64 0, i64* %first
  %some = icmp sgt i64 %steps, 0
  br i1 %some, label %w{widths[0]}.check, label %w0.check
{loops}w0.check:
  ret void
}}
"""


@dataclass(frozen=True)
class _Value:
    """A number: how it is written, its type, and whether each lane has its own."""

    text: str
    number: str
    wide: bool


class _Writer:
    """Writes statements as instructions; `known` are values by name, `held` those of places that are written."""

    def __init__(self, lanes: int, number: str, reread: bool) -> None:
        self.reread = reread
        self.lanes, self.number, self.vector, self.prefix = lanes, number, f"<{lanes} x {number}>", f"w{lanes}."
        self.known = {"dt": _Value("%dt", number, False)}
        self.held: dict[int, _Value] = {}
        self.lines: list[str] = []
        self.declared: set[str] = set()
        self._splats: dict[str, _Value] = {}
        self._names = 0

    def loops(self, body: Sequence[ast.stmt], row: int, spare: int) -> str:
        """Return the loops over groups of lanes, as long as more than `spare` are left, and over the steps of each."""
        w, number = self.prefix, self.number
        targets = [statement.targets[0] for statement in body if isinstance(statement, ast.Assign)]
        places = {self._start(item): self._place(item) for item in targets if isinstance(item, ast.Subscript)}
        self.held = {start: _Value(f"%{w}held{start}", number, True) for start in places}
        group = self._taken() + [f"%{w}from{start} = load {self.vector}, {place}" for start, place in places.items()]
        for statement in body:
            self.write(statement)
        states = [
            f"%{w}held{start} = phi {self.vector} [%{w}from{start}, %{w}group], [{value.text}, %{w}step]"
            for start, value in self.held.items()
        ]
        anew = [
            f"%{w}here = phi {number}* [%{w}work, %{w}group], [%{w}there, %{w}step]",
            f'%{w}there = call {number}* asm "", "=r,0"({number}* %{w}here)',  # the same place, which LLVM cannot know
        ]
        blocks = {
            "check": [
                f"%{w}j = load i64, i64* %first",
                f"%{w}past = add i64 %{w}j, {spare}",
                f"%{w}more = icmp slt i64 %{w}past, %active",
                f"br i1 %{w}more, label %{w}group, label %w{spare}.check",
            ],
            "group": [
                f"%{w}work = getelementptr {number}, {number}* %work, i64 %{w}j",
                *group,
                f"br label %{w}step",
            ],
            "step": [
                f"%{w}n = phi i64 [0, %{w}group], [%{w}later, %{w}step]",
                *states,
                *(anew if self.reread else []),
                f"%{w}start = mul i64 %{w}n, {row}",
                f"%{w}shared = getelementptr {number}, {number}* %rows, i64 %{w}start",
                f"%{w}drives = getelementptr {number}, {number}* %{w}shared, i64 %{w}j",
                *self._taken(),
                f"%{w}later = add i64 %{w}n, 1",
                f"%{w}again = icmp slt i64 %{w}later, %steps",
                f"br i1 %{w}again, label %{w}step, label %{w}done",
            ],
            "done": [
                *(f"store {self.vector} {value.text}, {places[start]}" for start, value in self.held.items()),
                f"%{w}next = add i64 %{w}j, {self.lanes}",
                f"store i64 %{w}next, i64* %first",
                f"br label %{w}check",
            ],
        }
        return "".join(f"{w}{name}:\n" + "".join(f"  {line}\n" for line in lines) for name, lines in blocks.items())

    def _taken(self) -> list[str]:
        """Return the lines written so far, and begin anew."""
        lines, self.lines = self.lines, []
        return lines

    def write(self, statement: ast.stmt) -> None:
        """Write one statement."""
        assert isinstance(statement, ast.Assign), ast.dump(statement)
        target = statement.targets[0]
        value = self.value(statement.value)
        if isinstance(target, ast.Name):
            self.known[target.id] = value
            return
        assert isinstance(target, ast.Subscript), ast.dump(target)
        self.held[self._start(target)] = self._wide(self._as(value, self.number))

    def value(self, item: ast.expr) -> _Value:
        """Return an expression's value."""
        if isinstance(item, ast.Name):
            return self.known[item.id]
        if isinstance(item, ast.Constant):
            assert isinstance(item.value, int | float), ast.dump(item)
            return _Value(_literal(float(item.value)), "double", False)
        if isinstance(item, ast.Subscript):
            if isinstance(item.slice, ast.Constant):
                return self._new(f"load {self.number}, {self._address('shared', item.slice.value)}", self.number, False)
            if _array(item) == "work" and self._start(item) in self.held:
                return self.held[self._start(item)]
            return self._new(f"load {self.vector}, {self._place(item, 'here' if self.reread else 'work')}", self.number, True)
        if isinstance(item, ast.UnaryOp):
            assert isinstance(item.op, ast.USub), ast.dump(item)
            value = self.value(item.operand)
            return self._new(f"fneg {self._kind(value)} {value.text}", value.number, value.wide)
        if isinstance(item, ast.BinOp):
            left, right = self._alike(self.value(item.left), self.value(item.right))
            if isinstance(item.op, ast.Pow):
                return self._function("pow", [left, right])
            return self._new(f"{_OPERATIONS[type(item.op)]} {_FUSED} {self._kind(left)} {left.text}, {right.text}", left.number, left.wide)
        assert isinstance(item, ast.Call), ast.dump(item)
        assert isinstance(item.func, ast.Attribute | ast.Name), ast.dump(item)
        name = item.func.attr if isinstance(item.func, ast.Attribute) else item.func.id
        return self._call(name, [self.value(argument) for argument in item.args])

    def _call(self, name: str, arguments: list[_Value]) -> _Value:
        if name in ("float32", "float64"):
            return self._as(arguments[0], "float" if name == "float32" else "double")
        if name in ("sqrt", "abs"):
            return self._function({"sqrt": "sqrt", "abs": "fabs"}[name], arguments)
        if name in ("lower", "upper"):
            left, right = self._alike(*arguments)
            return self._select("olt" if name == "lower" else "ogt", (left, right), (left, right))
        assert name in ("step", "sign"), name
        (value,) = arguments
        one, zero, minus = (self._alike(_Value(_literal(number), value.number, False), value)[0] for number in (1.0, 0.0, -1.0))
        low = zero if name == "step" else self._select("olt", (value, zero), (minus, zero))
        return self._select("ogt", (value, zero), (one, low))

    def _select(self, relation: str, pair: tuple[_Value, _Value], choice: tuple[_Value, _Value]) -> _Value:
        kind, (yes, no) = self._kind(pair[0]), choice
        bit = f"<{self.lanes} x i1>" if pair[0].wide else "i1"
        test = self._new(f"fcmp {_FUSED} {relation} {kind} {pair[0].text}, {pair[1].text}", "i1", pair[0].wide)
        return self._new(f"select {bit} {test.text}, {kind} {yes.text}, {kind} {no.text}", yes.number, yes.wide)

    def _function(self, name: str, arguments: list[_Value]) -> _Value:
        """Call one of LLVM's own functions."""
        value = arguments[0]
        kind, bits = self._kind(value), 8 * _BYTES[value.number]
        full = f"@llvm.{name}.v{self.lanes}f{bits}" if value.wide else f"@llvm.{name}.f{bits}"
        self.declared.add(f"{kind} {full}({', '.join([kind] * len(arguments))})")
        return self._new(f"call {kind} {full}({', '.join(f'{kind} {item.text}' for item in arguments)})", value.number, value.wide)

    def _new(self, instruction: str, number: str, wide: bool) -> _Value:
        self._names += 1
        name = f"%{self.prefix}{self._names}"
        self.lines.append(f"{name} = {instruction}")
        return _Value(name, number, wide)

    def _kind(self, value: _Value) -> str:
        return f"<{self.lanes} x {value.number}>" if value.wide else value.number

    def _alike(self, left: _Value, right: _Value) -> tuple[_Value, _Value]:
        """Return two values in the wider of their types, as vectors where one of them is."""
        number = "float" if left.number == right.number == "float" else "double"
        left, right = self._as(left, number), self._as(right, number)
        return (self._wide(left), self._wide(right)) if left.wide or right.wide else (left, right)

    def _as(self, value: _Value, number: str) -> _Value:
        if value.number == number:
            return value
        if not value.text.startswith("%"):  # a constant
            return (
                _Value(_literal(_rounded(value.text)), number, value.wide) if number == "float" else _Value(value.text, number, value.wide)
            )
        kind = self._kind(_Value("", number, value.wide))
        return self._new(f"{'fptrunc' if number == 'float' else 'fpext'} {self._kind(value)} {value.text} to {kind}", number, value.wide)

    def _wide(self, value: _Value) -> _Value:
        """Return a value as a vector of lanes."""
        if value.wide:
            return value
        if not value.text.startswith("%"):
            return _Value(f"<{', '.join([f'{value.number} {value.text}'] * self.lanes)}>", value.number, True)
        if value.text not in self._splats:
            kind = f"<{self.lanes} x {value.number}>"
            first = self._new(f"insertelement {kind} undef, {value.number} {value.text}, i32 0", value.number, True)
            splat = f"shufflevector {kind} {first.text}, {kind} undef, <{self.lanes} x i32> zeroinitializer"
            self._splats[value.text] = self._new(splat, value.number, True)
        return self._splats[value.text]

    def _start(self, item: ast.Subscript) -> int:
        """Return the number of array[number + j]."""
        assert isinstance(item.slice, ast.BinOp)
        assert isinstance(item.slice.left, ast.Constant)
        start = item.slice.left.value
        assert isinstance(start, int)
        assert start % self.lanes == 0
        return start

    def _place(self, item: ast.Subscript, work: str = "work") -> str:
        """Return the address of array[number + j] with its alignment."""
        address = self._address(work if _array(item) == "work" else _array(item), self._start(item))
        wide = self._new(f"bitcast {address} to {self.vector}*", self.number, False)
        return f"{self.vector}* {wide.text}, align {min(CACHE_LINE, self.lanes * _BYTES[self.number])}"

    def _address(self, base: str, place: object) -> str:
        """Return the address of a number that is `place` numbers beyond another one."""
        start = f"{self.number}* %{self.prefix}{base}"
        return f"{self.number}* {self._new(f'getelementptr {self.number}, {start}, i64 {place}', self.number, False).text}"


def _array(item: ast.Subscript) -> str:
    assert isinstance(item.value, ast.Name)
    return item.value.id


def _literal(value: float) -> str:
    """Return a number as LLVM reads it back, digit for digit: the bits of it in double precision."""
    return f"0x{struct.unpack('<Q', struct.pack('<d', value))[0]:016X}"


def _rounded(text: str) -> float:
    """Return the number of a literal, rounded to single precision."""
    return float(np.float32(struct.unpack("<d", struct.pack("<Q", int(text, 16)))[0]))
