"""Reads the text of an expression into a tree, safely.

Nothing from a file reaches Python's compiler as code: the text is tokenised here, quantities are replaced by placeholders, and Python's
`ast` module only supplies operator precedence. Every node outside a short list is refused.
"""

from __future__ import annotations

import ast
import math
import re

from vehgen.errors import InputError, shortened, shown
from vehgen.files.expression_tree import FUNCTIONS, ExpressionError, Number, Operation, Symbol, SyntaxNode, constant
from vehgen.files.units import NONE, Dimension, nearest_unit, read_unit

MAX_LENGTH = 1000
MAX_EXPRESSION_DEPTH = 100
_NUMBER_TOKEN = re.compile(r"(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?", re.ASCII)
_COMMA_IN_NUMBER = re.compile(r"(?<=\d),(?=\d)", re.ASCII)
_SYMBOL = re.compile(r"[A-Za-z_]\w*", re.ASCII)
_SIGN_CHARACTERS = "+-*/^(),"
_OPERATORS: dict[type[ast.operator], str] = {ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/", ast.Pow: "**"}
_ALLOWED = f"only numbers, units, parameter names, + - * / ** and {', '.join(FUNCTIONS)} may stand in an expression"


def read_tree(text: str) -> SyntaxNode:
    """Return the tree of an expression's text.

    Raises
    ------
    ExpressionError
        For calls other than those of FUNCTIONS, attributes, subscripts, comparisons, unknown units, too long a text and the like.
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
        return _convert(tree.body, quantities, offsets)
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
        elif _COMMA_IN_NUMBER.match(text, position) and pieces.count("(") == pieces.count(")"):
            raise ExpressionError("found a comma; decimals are written with a point: 10.8 km/h", position)
        elif text[position] in _SIGN_CHARACTERS:
            piece, end = ("**" if text[position] == "^" else text[position]), position + 1
        else:
            hint = "; a share is a plain number, 0.05 for 5 %" if text[position] == "%" else ""
            raise ExpressionError(f"{_ALLOWED}, found {text[position]!r}{hint}", position)
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
            return Symbol(name, offset)
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
    value = constant(node)
    if value is None or not abs(value) <= 10:
        raise ExpressionError("an exponent must be a plain number between -10 and 10", offset)
