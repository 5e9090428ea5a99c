"""Expressions of a vehicle file as sympy expressions, rebuilt node by node (no text is ever evaluated)."""

from __future__ import annotations

from fractions import Fraction
from functools import cache

import sympy as sp

from vehgen.files.expression_tree import ARITHMETIC
from vehgen.files.expressions import Expression


@cache
def parameter(name: str) -> sp.Symbol:
    """Return the symbol of a parameter; all are real numbers."""
    return sp.Symbol(name, real=True)


def number(value: float) -> sp.Expr:
    """Return a number as sympy keeps it best: whole numbers exactly, others as floats."""
    return sp.Integer(int(value)) if float(value).is_integer() and abs(value) < 1e15 else sp.Float(repr(value), 17)


def _exact(value: sp.Expr) -> sp.Expr:
    """Return a number as the fraction that its decimal digits say: 0.5 as 1/2 (`sympy.nsimplify` would execute a text for it)."""
    return value if value.is_Rational else sp.Rational(*Fraction(repr(float(value))).as_integer_ratio())


_OF_SYMBOLS = {
    **ARITHMETIC,
    "**": lambda base, exponent: base ** _exact(exponent),
    "sqrt": sp.sqrt,
    "abs": sp.Abs,
    "sign": sp.sign,
    "min": sp.Min,
    "max": sp.Max,
}


def derivative(expression: sp.Expr, symbol: sp.Symbol) -> sp.Expr:
    """Return the derivative of an expression by a symbol; where `sign` jumps it has none, and counts as level."""
    found = sp.diff(expression, symbol)
    return found.replace(sp.DiracDelta, lambda *_: sp.S.Zero) if found.has(sp.DiracDelta) else found


def to_sympy(expression: Expression) -> sp.Expr:
    """Return an expression of a vehicle or run file in SI units as a sympy expression."""
    return expression.fold(number, parameter, _OF_SYMBOLS)
