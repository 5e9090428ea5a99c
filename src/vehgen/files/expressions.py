"""Expressions of vehicle and run files: parsed safely, never executed.

A text such as `3.46 m - b1` becomes a small tree of numbers, names and arithmetic. Nothing from a file reaches Python's
compiler as code: the text is tokenised here, quantities are replaced by placeholders, and Python's `ast` module only supplies
operator precedence. Every node outside the short list below is refused.
"""

from __future__ import annotations

import ast
import math
import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, TypeVar

from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import CoreSchema, PydanticCustomError, core_schema

from vehgen.errors import InputError, did_you_mean, shortened, shown
from vehgen.files.units import NONE, Dimension, nearest_unit, read_unit

MAX_LENGTH = 1000
MAX_EXPRESSION_DEPTH = 100
_NUMBER_TOKEN = re.compile(r"(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?", re.ASCII)
_SYMBOL = re.compile(r"[A-Za-z_]\w*", re.ASCII)
_SIGN_CHARACTERS = "+-*/^(),"
_OPERATORS: dict[type[ast.operator], str] = {ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/", ast.Pow: "**"}
FUNCTIONS = ("sqrt", "abs", "sign", "min", "max")
_ALLOWED = f"only numbers, units, parameter names, + - * / ** and {', '.join(FUNCTIONS)} may stand in an expression"

T = TypeVar("T")


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
class Name:
    """A parameter's name."""

    name: str
    offset: int = 0


@dataclass(frozen=True)
class Operation:
    """`+ - * / **`, `neg`, or a function's name, applied to its arguments."""

    operator: str
    arguments: tuple[SyntaxNode, ...]
    offset: int = 0


SyntaxNode = Number | Name | Operation


@dataclass(frozen=True)
class Expression:
    """A parsed expression; equal texts are equal expressions."""

    text: str
    root: SyntaxNode

    @property
    def names(self) -> frozenset[str]:
        """The parameter names it uses."""
        return frozenset(symbol.name for symbol in self.symbols)

    @property
    def symbols(self) -> tuple[Name, ...]:
        """Each use of a parameter's name, from left to right."""
        return tuple(_symbols(self.root))

    def evaluate(self, values: Mapping[str, float]) -> float:
        """Return its value in SI units; raises ExpressionError where it is undefined."""
        try:
            return self.fold(lambda number: number.value, lambda name: values[name.name], apply_float)
        except (ZeroDivisionError, OverflowError, ValueError) as error:
            raise ExpressionError(f"{shown(self.text)} has no value: {error}") from error

    def dimension(self, dimensions: Mapping[str, Dimension]) -> Dimension:
        """Return its dimension; raises ExpressionError where units do not fit together."""
        return _dimension(self.root, dimensions)

    def fold(
        self,
        number: Callable[[Number], T],
        name: Callable[[Name], T],
        operation: Callable[[str, list[T]], T],
    ) -> T:
        """Rebuild the expression bottom-up in another algebra (floats, sympy)."""

        def visit(node: SyntaxNode) -> T:
            if isinstance(node, Number):
                return number(node)
            if isinstance(node, Name):
                return name(node)
            return operation(node.operator, [visit(argument) for argument in node.arguments])

        return visit(self.root)

    def __str__(self) -> str:
        return self.text

    @classmethod
    def __get_pydantic_core_schema__(cls, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        """Let pydantic models hold expressions: numbers and texts are parsed, expressions pass."""
        return core_schema.no_info_plain_validator_function(_validate)

    @classmethod
    def __get_pydantic_json_schema__(cls, schema: CoreSchema, handler: GetJsonSchemaHandler) -> JsonSchemaValue:
        """Describe an expression to editors."""
        return {
            "type": ["string", "number"],
            "description": "a number with its unit, or an expression of parameters, e.g. '3.46 m - b1'",
        }


def _validate(value: Any) -> Expression:
    if isinstance(value, Expression):
        return value
    if isinstance(value, bool) or not isinstance(value, (int, float, str)):
        raise PydanticCustomError("expression", "expected a number with its unit or an expression, such as '3.46 m - b1'")
    try:
        return parse(str(value))
    except ExpressionError as error:
        raise PydanticCustomError("expression", "{reason}", {"reason": str(error), "offset": error.offset}) from error


def parse(text: str, extra_functions: tuple[str, ...] = ()) -> Expression:
    """Parse a text into an Expression.

    Raises
    ------
    ExpressionError
        For calls other than `sqrt`, `abs`, `sign`, `min`, `max`, attributes, subscripts, comparisons, unknown units and the like.

    """
    if len(text) > MAX_LENGTH:
        raise ExpressionError(f"an expression of {len(text)} characters is too long (at most {MAX_LENGTH})")
    if not text.strip():
        raise ExpressionError("an expression is empty")
    source, quantities, offsets = _replace_quantities(text)
    try:
        tree = ast.parse(source, mode="eval")
    except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
        column = getattr(error, "offset", None) or 1
        offset = offsets[min(max(column - 1, 0), len(offsets) - 1)]
        raise ExpressionError(f"cannot read {shown(text)} as an expression", offset) from error
    try:
        return Expression(text, _convert(tree.body, quantities, offsets))
    except RecursionError as error:
        raise ExpressionError(f"{shown(text)} is nested too deeply") from error


def _replace_quantities(text: str) -> tuple[str, list[tuple[float, Dimension]], list[int]]:
    """Swap each number (with its unit) for `_q0`, `_q1`, ...; keep, for each output character, its place in `text`."""
    pieces: list[str] = []
    offsets: list[int] = []
    quantities: list[tuple[float, Dimension]] = []
    position = 0
    while position < len(text):
        name = _SYMBOL.match(text, position)
        number = _NUMBER_TOKEN.match(text, position)
        if name:
            if name.group().startswith("_"):
                raise ExpressionError(f"a name may not start with an underscore: {shown(name.group())}", position)
            piece, end = name.group(), name.end()
        elif number:
            piece, end = f" _q{len(quantities)} ", number.end()
            value, dimension = float(number.group()), NONE
            if math.isinf(value):
                raise ExpressionError(f"{number.group()[:40]} is too large a number", position)
            blank = end
            while blank < len(text) and text[blank] == " ":
                blank += 1
            try:
                unit = read_unit(text, blank)
            except InputError as error:
                raise ExpressionError(error.message, blank) from error
            if unit is not None:
                value, dimension, end = value * unit[0], unit[1], unit[2]
            elif _SYMBOL.match(text, blank):
                word = _SYMBOL.match(text, blank)
                assert word is not None
                raise ExpressionError(
                    f"{shown(word.group())} after {shortened(number.group())} is not a unit; {nearest_unit(word.group())} "
                    f"(to multiply, write {shortened(number.group())} * {shortened(word.group())})",
                    blank,
                )
            quantities.append((value, dimension))
        elif text[position].isspace():
            piece, end = " ", position + 1
        elif text[position] in _SIGN_CHARACTERS:
            piece, end = ("**" if text[position] == "^" else text[position]), position + 1
        else:
            raise ExpressionError(f"{_ALLOWED}, found {text[position]!r}", position)
        pieces.append(piece)
        offsets.extend([position] * len(piece))
        position = end
    source = "".join(pieces)
    lead = len(source) - len(source.lstrip())
    return source.strip(), quantities, (offsets[lead:] or [0]) + [len(text)]


def _convert(node: ast.expr, quantities: list[tuple[float, Dimension]], offsets: list[int], depth: int = 0) -> SyntaxNode:
    offset = offsets[min(node.col_offset, len(offsets) - 1)]
    if depth > MAX_EXPRESSION_DEPTH:
        raise ExpressionError(f"an expression is nested more than {MAX_EXPRESSION_DEPTH} deep", offset)

    def inside(child: ast.expr) -> SyntaxNode:
        return _convert(child, quantities, offsets, depth + 1)

    match node:
        case ast.Name(id=name) if name.startswith("_q"):
            value, dimension = quantities[int(name[2:])]
            return Number(value, dimension, offset)
        case ast.Name(id=name):
            return Name(name, offset)
        case ast.UnaryOp(op=ast.USub(), operand=operand):
            return Operation("neg", (inside(operand),), offset)
        case ast.UnaryOp(op=ast.UAdd(), operand=operand):
            return inside(operand)
        case ast.BinOp(op=operator, left=left, right=right) if type(operator) in _OPERATORS:
            symbol = _OPERATORS[type(operator)]
            arguments = (inside(left), inside(right))
            if symbol == "**":
                _check_exponent(arguments[1], offset)
            return Operation(symbol, arguments, offset)
        case ast.Call(func=ast.Name(id=function), args=arguments_, keywords=[]) if function in FUNCTIONS:
            count = 2 if function in ("min", "max") else 1
            if len(arguments_) != count:
                raise ExpressionError(f"{function} takes {count} argument{'s' if count > 1 else ''}", offset)
            return Operation(function, tuple(inside(argument) for argument in arguments_), offset)
        case ast.Call():
            raise ExpressionError(f"only {', '.join(FUNCTIONS)} may be called in an expression", offset)
    raise ExpressionError(_ALLOWED, offset)


def _check_exponent(node: SyntaxNode, offset: int) -> None:
    value = _constant(node)
    if value is None or not abs(value) <= 10:
        raise ExpressionError("an exponent must be a plain number between -10 and 10", offset)


def _constant(node: SyntaxNode) -> float | None:
    if isinstance(node, Number) and node.dimension == NONE:
        return node.value
    if isinstance(node, Operation) and node.operator == "neg":
        inner = _constant(node.arguments[0])
        return None if inner is None else -inner
    if isinstance(node, Operation) and node.operator == "/":
        top, bottom = (_constant(argument) for argument in node.arguments)
        return top / bottom if top is not None and bottom else None
    return None


def _symbols(node: SyntaxNode) -> Iterator[Name]:
    if isinstance(node, Name):
        yield node
    elif isinstance(node, Operation):
        for argument in node.arguments:
            yield from _symbols(argument)


def apply_float(operator: str, arguments: list[float]) -> float:
    """Apply one operator of the expression language to floats."""
    first = arguments[0]
    match operator:
        case "neg":
            return -first
        case "+":
            return first + arguments[1]
        case "-":
            return first - arguments[1]
        case "*":
            return first * arguments[1]
        case "/":
            return first / arguments[1]
        case "**":
            result = first ** arguments[1]
            if isinstance(result, complex):
                raise ValueError("a negative number has no real root")
            return float(result)
        case "sqrt":
            return math.sqrt(first)
        case "abs":
            return abs(first)
        case "sign":
            return math.copysign(1.0, first) if first else 0.0
        case "min":
            return min(arguments)
        case _:
            return max(arguments)


def _dimension(node: SyntaxNode, dimensions: Mapping[str, Dimension]) -> Dimension:
    if isinstance(node, Number):
        return node.dimension
    if isinstance(node, Name):
        if node.name not in dimensions:
            raise ExpressionError(f"unknown symbol {shown(node.name)}; {did_you_mean(node.name, dimensions)}", node.offset)
        return dimensions[node.name]
    parts = [_dimension(argument, dimensions) for argument in node.arguments]
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
            exponent = _constant(node.arguments[1]) or 0.0
            return parts[0].power(Fraction(exponent).limit_denominator(12))
        case _:
            left, right = parts
            for zero, other in ((node.arguments[0], right), (node.arguments[1], left)):
                if isinstance(zero, Number) and zero.value == 0.0:
                    return other
            if left != right:
                word = {"+": "add", "-": "subtract"}.get(node.operator, "compare")
                raise ExpressionError(f"cannot {word} {left} and {right}", node.offset)
            return left
