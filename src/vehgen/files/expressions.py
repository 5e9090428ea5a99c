"""Expressions of vehicle and run files: parsed safely, never executed.

A text such as `3.46 m - b1` becomes a small tree of numbers, names and arithmetic. Expressions are made of others by arithmetic:
`2*stiffness*(mass + 3.0)` of two expressions is the expression of that text.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, TypeVar

from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import CoreSchema, PydanticCustomError, core_schema

from vehgen.errors import InputError, shown
from vehgen.files.expression_parser import read_tree
from vehgen.files.expression_tree import OF_FLOATS, ExpressionError, Number, Operation, Symbol, SyntaxNode, dimension_of_node, symbols_of
from vehgen.files.units import NONE, Dimension

__all__ = ["Expression", "ExpressionError", "parse"]

T = TypeVar("T")
_SUM, _QUANTITY, _PRODUCT, _NEGATIVE, _POWER, _ATOM = range(6)
"""What binds tighter than what. A number with a unit takes parentheses in a product: no sign may be read as part of its unit."""
_BINDING = {"+": _SUM, "-": _SUM, "*": _PRODUCT, "/": _PRODUCT, "neg": _NEGATIVE, "**": _POWER}


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
    def symbols(self) -> tuple[Symbol, ...]:
        """Each use of a parameter's name, from left to right."""
        return tuple(symbols_of(self.root))

    def evaluate(self, values: Mapping[str, float]) -> float:
        """Return its value in SI units; raises ExpressionError where it is undefined."""
        try:
            return self.fold(float, values.__getitem__, OF_FLOATS)
        except (ZeroDivisionError, OverflowError, ValueError) as error:
            raise ExpressionError(f"{shown(self.text)} has no value: {error}") from error

    def dimension(self, dimensions: Mapping[str, Dimension]) -> Dimension:
        """Return its dimension; raises ExpressionError where units do not fit together."""
        return dimension_of_node(self.root, dimensions)

    def fold(self, number: Callable[[float], T], name: Callable[[str], T], operators: Mapping[str, Callable[..., T]]) -> T:
        """Rebuild the expression bottom-up in another algebra (floats, sympy)."""

        def visit(node: SyntaxNode) -> T:
            if isinstance(node, Number):
                return number(node.value)
            if isinstance(node, Symbol):
                return name(node.name)
            return operators[node.operator](*map(visit, node.arguments))

        return visit(self.root)

    def __str__(self) -> str:
        return self.text

    @classmethod
    def symbol(cls, name: str) -> Expression:
        """Return the expression that is a parameter's name."""
        return _composed(name)

    @classmethod
    def quantity(cls, value: float, unit: str = "") -> Expression:
        """Return a number in a unit; it reads back exactly."""
        return _composed(f"{_number_text(value)} {unit}".rstrip())

    def substituted(self, expressions: Mapping[str, Expression]) -> Expression:
        """Return it with expressions in the place of all its names."""
        text = self.text
        for symbol in reversed(self.symbols):
            end = symbol.offset + len(symbol.name)
            text = f"{text[: symbol.offset]}{_operand(expressions[symbol.name], _ATOM)}{text[end:]}"
        return _composed(text)

    def sqrt(self) -> Expression:
        """Return its square root."""
        return _composed(f"sqrt({self.text})")

    def __neg__(self) -> Expression:
        return _composed(f"-{_operand(self, _POWER)}")

    def __add__(self, other: Operand) -> Expression:
        return _joined(self, " + ", other)

    def __radd__(self, other: float) -> Expression:
        return _joined(other, " + ", self)

    def __sub__(self, other: Operand) -> Expression:
        return _joined(self, " - ", other)

    def __rsub__(self, other: float) -> Expression:
        return _joined(other, " - ", self)

    def __mul__(self, other: Operand) -> Expression:
        return _joined(self, "*", other)

    def __rmul__(self, other: float) -> Expression:
        return _joined(other, "*", self)

    def __truediv__(self, other: Operand) -> Expression:
        return _joined(self, "/", other)

    def __rtruediv__(self, other: float) -> Expression:
        return _joined(other, "/", self)

    def __pow__(self, exponent: float) -> Expression:
        return _composed(f"{_operand(self, _ATOM)}**{_operand(exponent, _ATOM)}")

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


def parse(text: str) -> Expression:
    """Parse a text into an Expression; raises ExpressionError as :func:`vehgen.files.expression_parser.read_tree`."""
    return Expression(text, read_tree(text))


Operand = Expression | float
"""What expressions are added to, multiplied with ...: an expression, or a plain number."""


def _joined(left: Operand, sign: str, right: Operand) -> Expression:
    """Return two operands joined by a sign, in parentheses where it would not bind them as a whole."""
    binding = _BINDING[sign.strip()]
    return _composed(f"{_operand(left, binding)}{sign}{_operand(right, binding + 1, leads=False)}")


def _operand(item: Operand, binding: int, *, leads: bool = True) -> str:
    """Return the text of an operand, in parentheses where it binds less tightly than `binding` or is negative behind a sign."""
    expression = item if isinstance(item, Expression) else _composed(_number_text(item))
    text, root = expression.text.strip(), expression.root
    own = _ATOM
    if isinstance(root, Operation):
        own = _BINDING.get(root.operator, _ATOM)
    elif isinstance(root, Number) and root.dimension != NONE:
        own = _QUANTITY
    return text if own >= binding and (leads or own != _NEGATIVE) else f"({text})"


def _number_text(value: float) -> str:
    if not math.isfinite(value):
        raise InputError(f"{value} cannot stand in an expression; a finite number was expected")
    return repr(value) if isinstance(value, int) else repr(float(value))


def _composed(text: str) -> Expression:
    try:
        return parse(text)
    except ExpressionError as error:
        raise InputError(f"cannot make the expression {shown(text)}: {error}") from error
