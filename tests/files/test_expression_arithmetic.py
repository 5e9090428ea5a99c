"""Expressions made of others: their texts read back as the trees that the arithmetic asks for."""

from __future__ import annotations

import operator
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from vehgen.errors import InputError
from vehgen.files.expression_parser import MAX_LENGTH
from vehgen.files.expression_tree import Number, Symbol, SyntaxNode
from vehgen.files.expressions import Expression, parse

SIGNS = {"+": operator.add, "-": operator.sub, "*": operator.mul, "/": operator.truediv}
Pair = tuple[Expression | float, Any]
"""An operand, and the tree that it must have: a name, a number with its dimension, or an operator before its operands."""


def shape(node: SyntaxNode) -> Any:
    if isinstance(node, Number):
        return (node.value, str(node.dimension))
    return node.name if isinstance(node, Symbol) else (node.operator, *map(shape, node.arguments))


def joined(sign: str, left: Pair, right: Pair) -> Pair:
    if not (isinstance(left[0], Expression) or isinstance(right[0], Expression)):
        left = (Expression.symbol("a"), "a")
    return SIGNS[sign](left[0], right[0]), (sign, left[1], right[1])


def negated(pair: Pair) -> Pair:
    expression = pair[0] if isinstance(pair[0], Expression) else Expression.quantity(pair[0])
    return -expression, ("neg", pair[1])


def squared(pair: Pair) -> Pair:
    expression = pair[0] if isinstance(pair[0], Expression) else Expression.quantity(pair[0])
    return expression**2, ("**", pair[1], (2.0, "no unit"))


LEAVES: list[Pair] = [
    *((Expression.symbol(name), name) for name in ("a", "m1", "h_2")),
    (Expression.quantity(3.5, "m"), (3.5, "m")),
    (parse(" 2 N s/m "), (2.0, "N s/m")),
    (parse("a + b*3 m"), ("+", "a", ("*", "b", (3.0, "m")))),
    (parse("-a*b"), ("*", ("neg", "a"), "b")),
    (parse("min(a, b)"), ("min", "a", "b")),
    (2, (2.0, "no unit")),
    (0.1, (0.1, "no unit")),
]
TREES = st.recursive(
    st.sampled_from(LEAVES),
    lambda inner: st.one_of(st.builds(joined, st.sampled_from(list(SIGNS)), inner, inner), inner.map(negated), inner.map(squared)),
    max_leaves=12,
)


@settings(max_examples=300, deadline=None)
@given(TREES)
def test_the_text_of_arithmetic_reads_as_its_tree(pair: Pair):
    expression, expected = pair
    if isinstance(expression, Expression):
        assert shape(expression.root) == expected
        assert parse(expression.text) == expression
        assert all(expression.text[item.offset :].startswith(item.name) for item in expression.symbols)


def test_texts_have_the_parentheses_that_they_need_and_no_more():
    mass, ratio = parse("22 t"), Expression.symbol("ratio")
    assert (mass - ratio).text == "22 t - ratio"
    assert (2 * ratio * mass.sqrt()).text == "2*ratio*sqrt(22 t)"
    assert (2 * (ratio - 1) ** 2 / (1 + ratio)).text == "2*(ratio - 1)**2/(1 + ratio)"
    assert (ratio - (-ratio)).text == "ratio - (-ratio)"
    assert (2 * mass).text == "2*(22 t)"


def test_names_are_replaced_by_expressions():
    found = parse("k*d^3 + k").substituted({"k": parse("a + b"), "d": Expression.symbol("d")})
    assert found.text == "(a + b)*d^3 + (a + b)"


@pytest.mark.parametrize("value", [float("nan"), float("inf")])
def test_only_finite_numbers_enter(value: float):
    with pytest.raises(InputError, match="finite"):
        Expression.symbol("a") * value


def test_an_expression_that_no_file_could_hold_is_refused():
    long = parse(" + ".join(["a" * 60] * (MAX_LENGTH // 70)))
    with pytest.raises(InputError, match="too long"):
        long * long
