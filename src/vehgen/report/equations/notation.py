"""How symbols are written: m_T for mT, k_t1 for kt1, theta_tractor for a pitch; in LaTeX and in MathML."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any

import sympy as sp
from sympy.printing.latex import LatexPrinter
from sympy.printing.mathml import MathMLPresentationPrinter
from sympy.printing.str import StrPrinter

from vehgen.mechanics import Coordinate, EquationsOfMotion
from vehgen.mechanics.symbols import number

_GREEK = {
    unicodedata.name(sign).removeprefix("GREEK SMALL LETTER ").lower().replace("lamda", "lambda"): sign for sign in "αβγδεζηθικλμνξπρστφχψω"
}
_SHORT = re.compile(r"([A-Za-z])([A-Za-z]?\d+[A-Za-z]?|[A-Z]|[A-Z][A-Za-z]\d*|[a-z][A-Z]?)?$")
_LATEX = {"\\": r"\textbackslash{}", "~": r"\textasciitilde{}", "^": r"\textasciicircum{}"} | {key: "\\" + key for key in "&%$#_{}"}
_PLAIN_SIGNS = {"–": "--", "—": "---", "‘": "`", "’": "'", "“": "``", "”": "''"}
_PLAIN_SIGNS |= {sign: rf"\ensuremath{{{code}}}" for sign, code in (("·", r"\cdot"), ("×", r"\times"), ("°", r"^\circ"), ("µ", r"\mu"))}
_PLAIN_SIGNS |= {"²": r"\ensuremath{^2}", "³": r"\ensuremath{^3}"}
"""What pdflatex writes of the signs beyond ASCII that a vehicle file is likely to hold."""


@dataclass(frozen=True)
class Name:
    """A symbol as a base and an index; `upright` for words."""

    base: str
    index: str = ""
    upright: bool = False


@cache
def split_name(text: str) -> Name:
    """Split a parameter's name: kt1 -> k, t1; beta2 -> β, 2; k_rear -> k, rear; other words stay whole."""
    head, _, tail = text.partition("_")
    digits = re.fullmatch(r"([A-Za-z]+?)(\d*)", text)
    if digits and digits[1] in _GREEK:
        return Name(_GREEK[digits[1]], digits[2])
    if tail and head in _GREEK:
        return Name(_GREEK[head], tail)
    if tail and (short := _SHORT.match(head)):
        return Name(short[1], ",".join(part for part in (short[2], tail) if part))
    if short := _SHORT.match(text):
        return Name(short[1], short[2] or "")
    return Name(text, upright=True)


def symbol_names(model: EquationsOfMotion) -> dict[sp.Symbol, Name]:
    """Return how the symbols of a model's matrices are written: parameters, and `g`."""
    names = {sp.Symbol(name, real=True): split_name(name) for name in (*model.parameters, *model.vehicle.parameters)}
    return {**names, sp.Symbol("g", real=True): Name("g")}


def coordinate_name(coordinate: Coordinate) -> Name:
    """Return how a coordinate is written."""
    return Name(_GREEK.get(coordinate.letter, coordinate.letter), coordinate.owner)


def tidy(expression: sp.Expr) -> sp.Expr:
    """Turn sums in which every term is negative, -k*(-a - b), into k*(a + b); nothing else changes."""
    if not expression.args:
        return expression
    arguments = [tidy(argument) for argument in expression.args]
    if expression.is_Mul:
        turned = [-argument if _all_negative(argument) else argument for argument in arguments]
        sign = -1 if sum(map(_all_negative, arguments)) % 2 else 1
        return sp.Mul(sign, *turned)
    if expression.is_Pow and expression.exp.is_even and _all_negative(arguments[0]):
        return sp.Pow(-arguments[0], expression.exp)
    return expression.func(*arguments)


def _all_negative(expression: sp.Expr) -> bool:
    return bool(expression.is_Add) and all(term.as_coeff_Mul()[0].is_negative for term in expression.args)


def number_text(value: sp.Float) -> str:
    """Write a number with as many digits as it needs."""
    return f"{float(value):.12g}"


class Plain(StrPrinter):  # type: ignore[misc]
    """Prints expressions as text that the vehicle file's own parser reads."""

    def __init__(self) -> None:
        super().__init__({"order": "none"})

    def _print_Float(self, expr: sp.Float) -> str:
        return number_text(expr)


class Latex(LatexPrinter):  # type: ignore[misc]
    """Prints expressions as LaTeX."""

    def __init__(self, names: Mapping[sp.Symbol, Name]) -> None:
        super().__init__({"order": "none", "mul_symbol": None})
        self.names = names

    def _print_Symbol(self, expr: sp.Symbol, style: str = "plain") -> str:
        return latex_name(self.names.get(expr) or split_name(expr.name))

    def _print_Float(self, expr: sp.Float) -> str:
        mantissa, _, exponent = number_text(expr).partition("e")
        return mantissa + (rf" \cdot 10^{{{int(exponent)}}}" if exponent else "")


class MathMl(MathMLPresentationPrinter):  # type: ignore[misc]
    """Prints expressions as presentation MathML, which browsers draw without any script."""

    def __init__(self, names: Mapping[sp.Symbol, Name]) -> None:
        super().__init__({"order": "none"})
        self.names = names

    def _print_Symbol(self, sym: sp.Symbol, style: str = "plain") -> Any:
        return self.name(self.names.get(sym) or split_name(sym.name))

    def _print_Float(self, expr: sp.Float) -> Any:
        return self._leaf("mn", number_text(expr))

    def name(self, name: Name) -> Any:
        """Return the element of a name."""
        base = self._leaf("mi", name.base)
        if name.upright:
            base.setAttribute("mathvariant", "normal")
        if not name.index:
            return base
        element = self.dom.createElement("msub")
        element.appendChild(base)
        element.appendChild(self._leaf("mn" if name.index.isdigit() else "mtext", name.index))
        return element

    def _leaf(self, tag: str, text: str) -> Any:
        element = self.dom.createElement(tag)
        element.appendChild(self.dom.createTextNode(text))
        return element


def latex_name(name: Name) -> str:
    """Write a name in LaTeX."""
    letters = {sign: "\\" + word for word, sign in _GREEK.items()}
    base = rf"\mathrm{{{latex_text(name.base)}}}" if name.upright else letters.get(name.base, name.base)
    if not name.index:
        return base
    short = len(name.index) <= 3 and name.index.isalnum() and name.index.isascii()
    return rf"{base}_{{{name.index}}}" if short else rf"{base}_{{\mathrm{{{latex_text(name.index)}}}}}"


def latex_text(text: str) -> str:
    """Write text in LaTeX: its own signs escaped, accents kept, what pdflatex cannot set replaced by a question mark."""
    letters = {sign: rf"\ensuremath{{\{word}}}" for word, sign in _GREEK.items()}

    def write(sign: str) -> str:
        if sign in _LATEX:
            return _LATEX[sign]
        if sign in _PLAIN_SIGNS or sign in letters:
            return _PLAIN_SIGNS.get(sign) or letters[sign]
        if sign.isascii():
            return sign if sign.isprintable() else " "
        if sign.isalpha() and sign <= "ž":
            return sign
        plain = unicodedata.normalize("NFKD", sign)
        return "".join(part for part in plain if part.isascii() and part.isprintable() and part not in _LATEX) or "?"

    return "".join(write(sign) for sign in text)


def gravity_symbol(expression: sp.Expr, value: float) -> sp.Expr:
    """Write g for the number of the acceleration of gravity."""
    return expression.xreplace({number(value): sp.Symbol("g", real=True), number(-value): -sp.Symbol("g", real=True)})
