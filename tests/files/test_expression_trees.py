"""Random expression trees, printed with as few brackets as Python needs, against an evaluation that shares no code with the parser."""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from vehgen.files.expressions import Expression, ExpressionError, parse
from vehgen.files.units import Dimension

VALUES = {"b1": 1.32, "L13": 4.8, "mT": 8000.0, "ratio": -0.375}
EXPONENTS = {"b1": (1, 0), "L13": (1, 0), "mT": (0, 1), "ratio": (0, 0)}
"""Exponents of metre and kilogram of each name."""
UNITS = {"": (1.0, (0, 0)), "m": (1.0, (1, 0)), "mm": (1e-3, (1, 0)), "km": (1e3, (1, 0)), "kg": (1.0, (0, 1)), "t": (1e3, (0, 1))}
PRECEDENCE = {"+": 1, "-": 1, "*": 2, "/": 2, "neg": 3, "**": 4}
POWERS = {
    "2": (2.0, Fraction(2)),
    "-1": (-1.0, Fraction(-1)),
    "0.5": (0.5, Fraction(1, 2)),
    "(1/3)": (1 / 3, Fraction(1, 3)),
    "-2": (-2.0, Fraction(-2)),
}


@dataclass(frozen=True)
class Leaf:
    """A name, or a number with its unit."""

    text: str
    value: float
    exponents: tuple[int, int]
    is_quantity: bool


@dataclass(frozen=True)
class Branch:
    """An operator or function with its arguments; `**` has its exponent as a text of POWERS."""

    operator: str
    arguments: tuple[Any, ...]
    power: str = ""


def quantity(number: str, blank: str, unit: str) -> Leaf:
    factor, exponents = UNITS[unit]
    return Leaf(f"{number}{blank}{unit}" if unit else number, float(number) * factor, exponents, bool(unit))


names = st.sampled_from([Leaf(name, value, EXPONENTS[name], False) for name, value in VALUES.items()])
numbers = st.one_of(
    st.integers(1, 99).map(str),
    st.floats(0.01, 1e3, allow_nan=False).map(lambda x: f"{x:.3f}").filter(lambda text: float(text) > 0),
    st.sampled_from(["1e3", "2.5E-2", ".5", "7.", "1e+2"]),
)
leaves = st.one_of(names, st.builds(quantity, numbers, st.sampled_from([" ", "  ", ""]), st.sampled_from(sorted(UNITS))))


def branches(inner: st.SearchStrategy[Any]) -> st.SearchStrategy[Any]:
    return st.one_of(
        st.builds(lambda o, a, b: Branch(o, (a, b)), st.sampled_from(["+", "-", "*", "/", "min", "max"]), inner, inner),
        st.builds(lambda o, a: Branch(o, (a,)), st.sampled_from(["neg", "sqrt", "abs", "sign"]), inner),
        st.builds(lambda a, p: Branch("**", (a,), p), inner, st.sampled_from(sorted(POWERS))),
    )


trees = st.recursive(leaves, branches, max_leaves=15)


def show(tree: Leaf | Branch, around: int = 0) -> str:
    """Print a tree; `around` is the precedence that what surrounds it demands."""
    if isinstance(tree, Leaf):
        return f"({tree.text})" if tree.is_quantity and around > 2 else tree.text
    if tree.operator in ("min", "max", "sqrt", "abs", "sign"):
        return f"{tree.operator}({', '.join(show(item) for item in tree.arguments)})"
    own = PRECEDENCE[tree.operator]
    if tree.operator == "neg":
        text = f"-{show(tree.arguments[0], own)}"
    elif tree.operator == "**":
        text = f"{show(tree.arguments[0], own + 1)}**{tree.power}"
    else:
        left, right = tree.arguments
        text = f"{show(left, own)} {tree.operator} {show(right, own + 1)}"
    return f"({text})" if own < around else text


def compute(tree: Leaf | Branch) -> float:
    """Evaluate a tree; raises ArithmeticError or ValueError where it has no value."""
    if isinstance(tree, Leaf):
        return tree.value
    values = [compute(item) for item in tree.arguments]
    match tree.operator:
        case "+":
            return values[0] + values[1]
        case "-":
            return values[0] - values[1]
        case "*":
            return values[0] * values[1]
        case "/":
            return values[0] / values[1]
        case "neg":
            return -values[0]
        case "sqrt":
            return math.sqrt(values[0])
        case "abs":
            return math.fabs(values[0])
        case "sign":
            return float((values[0] > 0) - (values[0] < 0))
        case "min":
            return values[1] if values[1] < values[0] else values[0]
        case "max":
            return values[1] if values[1] > values[0] else values[0]
    return math.pow(values[0], POWERS[tree.power][0])


def exponents_of(tree: Leaf | Branch) -> tuple[Fraction, Fraction] | None:
    """Return the exponents of metre and kilogram, None where unlike ones are added or compared."""
    if isinstance(tree, Leaf):
        return Fraction(tree.exponents[0]), Fraction(tree.exponents[1])
    found = [exponents_of(item) for item in tree.arguments]
    if None in found:
        return None
    first, *rest = found
    assert first is not None
    match tree.operator:
        case "+" | "-" | "min" | "max":
            return first if rest == [first] else None
        case "*" | "/":
            sign = 1 if tree.operator == "*" else -1
            return first[0] + sign * rest[0][0], first[1] + sign * rest[0][1]
        case "sign":
            return Fraction(0), Fraction(0)
        case "sqrt":
            return first[0] / 2, first[1] / 2
        case "**":
            power = POWERS[tree.power][1]
            return first[0] * power, first[1] * power
    return first


def symbols_of(tree: Leaf | Branch) -> list[str]:
    if isinstance(tree, Leaf):
        return [tree.text] if tree.text in VALUES else []
    return [name for item in tree.arguments for name in symbols_of(item)]


DIMENSIONS = {name: Dimension(Fraction(length), Fraction(mass)) for name, (length, mass) in EXPONENTS.items()}


@settings(max_examples=400, deadline=None, derandomize=True)
@given(trees)
def test_a_printed_tree_reads_back_with_the_same_value_names_and_dimension(tree: Leaf | Branch):
    text = show(tree)
    expression = parse(text)
    assert str(expression) == text
    assert [symbol.name for symbol in expression.symbols] == symbols_of(tree)
    assert all(text[symbol.offset :].startswith(symbol.name) for symbol in expression.symbols)
    _same_value(expression, tree)
    expected = exponents_of(tree)
    if expected is None:
        with pytest.raises(ExpressionError, match=r"cannot (add|subtract|compare)"):
            expression.dimension(DIMENSIONS)
    else:
        assert expression.dimension(DIMENSIONS) == Dimension(*expected)


def _same_value(expression: Expression, tree: Leaf | Branch) -> None:
    try:
        expected = compute(tree)
    except (ArithmeticError, ValueError):
        with pytest.raises(ExpressionError, match="has no value"):
            expression.evaluate(VALUES)
        return
    assert expression.evaluate(VALUES) == pytest.approx(expected, rel=1e-15, abs=0.0, nan_ok=True)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("2 - 3 - 4", -5.0),
        ("2 / 4 / 2", 0.25),
        ("(2**3)**2", 64.0),
        ("-2**2", -4.0),
        ("2**-1", 0.5),
        ("2 * -3", -6.0),
        ("+3", 3.0),
        ("2^3", 8.0),
        ("6 m / 3 m", 2.0),
        ("6 m / (2 * 3 m)", 1.0),
        ("1 m^2 / 1 m", 1.0),
        ("(3 m)^2", 9.0),
        ("3 m^2", 3.0),
        ("1\n+\n2", 3.0),
        ("  1 +\t2  ", 3.0),
        ("8**(1/3)", 2.0),
        ("min(2, 1) + max(2, 1)", 3.0),
        ("sign(0)", 0.0),
    ],
)
def test_precedence_and_blanks(text: str, value: float):
    assert parse(text).evaluate({}) == pytest.approx(value, rel=1e-15)


def test_a_plain_zero_fits_any_dimension():
    metre = Dimension(Fraction(1))
    assert parse("b1 - 0").dimension({"b1": metre}) == metre
    assert parse("max(0, b1)").dimension({"b1": metre}) == metre
    with pytest.raises(ExpressionError, match="cannot add no unit and m"):
        parse("1 + b1").dimension({"b1": metre})


def test_equal_texts_are_equal_expressions():
    assert parse("3.46 m - b1") == parse("3.46 m - b1")
    assert parse("3.46 m - b1") != parse("3.46 m - b2")
    assert parse("b1*b1 + b2").names == {"b1", "b2"}
