"""The equations of motion as a LaTeX document that plain pdflatex compiles."""

from __future__ import annotations

import re

import sympy as sp

from vehgen.mechanics import GRAVITY, EquationsOfMotion
from vehgen.report.equations.notation import Latex, latex_text
from vehgen.report.equations.writing import (
    LAWS_NOTE,
    WHOLE_MATRIX,
    Matrix,
    balance,
    coordinate_latex,
    is_long,
    latex_printer,
    law_rows,
    matrices,
    nonlinear,
    parameter_rows,
    place_text,
    vectors,
)  # fmt: skip

_MAX_LINE_SIGNS = 66
"""A sum is broken into lines of about this many signs."""

_DOCUMENT_HEAD = r"""\documentclass[10pt]{article}
\usepackage[utf8]{inputenc}
\usepackage[T1]{fontenc}
\usepackage{amsmath}
\usepackage{graphicx}
\usepackage{longtable}
\usepackage[a4paper,margin=20mm]{geometry}
\setlength{\parindent}{0pt}
\allowdisplaybreaks
\newcommand{\fitted}[1]{\[\resizebox{\ifdim\width>\linewidth\linewidth\else\width\fi}{!}{$\displaystyle #1$}\]}
\begin{document}"""


def equations_latex(model: EquationsOfMotion) -> str:
    """Return a complete LaTeX document: legend of symbols, equation of motion, matrices, weight, force laws."""
    printer = latex_printer(model)
    vehicle = model.vehicle
    lines = [_DOCUMENT_HEAD.replace(r"\allowdisplaybreaks", rf"\allowdisplaybreaks\setcounter{{MaxMatrixCols}}{{{WHOLE_MATRIX + 1}}}")]
    lines.append(rf"\section*{{{latex_text(vehicle.title or vehicle.name)}}}")
    if vehicle.source:
        lines.append(f"Source: {latex_text(vehicle.source)}\n")
    lines += [r"\subsection*{Equation of motion}", rf"\[ {_balance(model)} \]"]
    lines.append("The pitch plane of ISO 8855: $x$ forward, $z$ up, pitch $\\theta$ positive nose-down. Entries not listed are zero.\n")
    lines += [r"\subsection*{Coordinates and inputs}", *_table("rlll", _coordinates(model))]
    lines += [r"\subsection*{Parameters}", *_table(r"llp{0.62\linewidth}", _parameters(model, printer))]
    for matrix in matrices(model):
        symmetric = ", symmetric" if matrix.symmetric else ""
        lines.append(rf"\subsection*{{${matrix.symbol}$: {latex_text(matrix.meaning)}{symmetric}}}")
        lines += _matrix(matrix, printer)
    if nonlinear(model):
        lines += [r"\subsection*{Force laws}", latex_text(LAWS_NOTE) + "\n", *_laws(model, printer)]
    lines.append(r"\end{document}")
    return "\n".join(lines) + "\n"


def _balance(model: EquationsOfMotion) -> str:
    marks = {"": "{}", "'": r"\dot {}", "''": r"\ddot {}"}
    sides = {
        side: " + ".join(f"{a}{marks[c].format(b)}" for where, a, b, c in balance(model) if where == side) for side in ("left", "right")
    }
    return f"{sides['left']} = {sides['right']}"


def _table(columns: str, rows: list[list[str]]) -> list[str]:
    return [rf"\begin{{longtable}}[l]{{@{{}}{columns}@{{}}}}", *(" & ".join(row) + r" \\" for row in rows), r"\end{longtable}"]


def _coordinates(model: EquationsOfMotion) -> list[list[str]]:
    symbols = coordinate_latex(model)
    rows = [
        [f"$q_{{{i}}}$", f"${symbol}$", f"$\\mathrm{{{item.unit}}}$", latex_text(item.meaning)]
        for i, (item, symbol) in enumerate(zip(model.coordinates, symbols, strict=True), 1)
    ]
    for symbol, meanings in vectors(model):
        for i, meaning in enumerate(meanings, 1):
            text, _, unit = meaning.rpartition(" [")
            rows.append([f"${symbol}_{{{i}}}$", "", f"$\\mathrm{{{unit[:-1]}}}$", latex_text(text)])
    return rows


def _parameters(model: EquationsOfMotion, printer: Latex) -> list[list[str]]:
    rows = []
    for name, definition, unit, meaning in parameter_rows(model):
        symbol = printer.doprint(sp.Symbol(name, real=True))
        if definition is None:
            rows.append([f"${symbol}$", unit_latex(unit), latex_text(meaning)])
            continue
        pieces = [rf"$\displaystyle {'=' if i == 0 else ''} {part}$" for i, part in enumerate(_pieces(definition, printer, 60))]
        rows.append([f"${symbol}$", unit_latex(unit), r" \newline ".join([latex_text(meaning), *pieces] if meaning else pieces)])
    return [*rows, ["$g$", unit_latex("m/s^2"), f"acceleration of gravity, {GRAVITY}"]]


def _matrix(matrix: Matrix, printer: Latex) -> list[str]:
    lines, rows = [], list(matrix.entries)
    if max(matrix.shape) <= WHOLE_MATRIX:
        cells = []
        for i in range(matrix.shape[0]):
            row = []
            for j in range(matrix.shape[1]):
                place, value = matrix.at(i, j)
                row.append(_left(matrix, place) if value != 0 and is_long(value) else printer.doprint(value))
            cells.append(" & ".join(row))
        lines.append(rf"\fitted{{{matrix.symbol} = \begin{{bmatrix}}" + " \\\\\n".join(cells) + r"\end{bmatrix}}")
        rows = [place for place in rows if is_long(matrix.entries[place])]
    if rows:
        entries = [rf"{_left(matrix, place)} &= {_broken(matrix.entries[place], printer)}" for place in rows]
        lines += [r"\begin{align*}", " \\\\\n".join(entries), r"\end{align*}"]
    return lines


def _left(matrix: Matrix, place: tuple[int, int]) -> str:
    return f"{matrix.symbol}_{{{place_text(matrix, place)}}}"


def _broken(expression: sp.Expr, printer: Latex) -> str:
    """Write an expression, a long sum over several lines."""
    return " \\\\\n&\\quad ".join(_pieces(expression, printer, _MAX_LINE_SIGNS))


def _pieces(expression: sp.Expr, printer: Latex, limit: int) -> list[str]:
    terms = [printer.doprint(term) for term in (expression.args if expression.is_Add else (expression,))]
    terms.sort(key=lambda term: term.startswith("-"))
    pieces = [terms[0]]
    for term in terms[1:]:
        signed = f" {term}" if term.startswith("-") else f" + {term}"
        if _signs(pieces[-1]) + _signs(signed) > limit:
            pieces.append("{}" + signed)
        else:
            pieces[-1] += signed
    return pieces


def _signs(latex: str) -> int:
    """Return about how many signs will be seen of a piece of LaTeX."""
    return len(re.sub(r"\\[a-zA-Z]+|[\s{}_^\\]", "", latex))


def _laws(model: EquationsOfMotion, printer: Latex) -> list[str]:
    lines = []
    for column, (where, travel, laws) in enumerate(law_rows(model), 1):
        lines.append(rf"\paragraph{{$n_{{{column}}}$, {latex_text(where)}}} $d = {printer.doprint(travel)}$\\")
        for title, equation, parameters in laws:
            given = ", ".join(rf"{latex_text(key)} $= {printer.doprint(value)}$ [{unit_latex(unit)}]" for key, value, unit in parameters)
            lines.append(rf"{latex_text(title)}: \texttt{{{latex_text(equation)}}}" + (f"; {given}" if given else "") + r"\\")
        lines.append("")
    return lines


def unit_latex(unit: str) -> str:
    """Write a unit such as kg m^2 in LaTeX."""
    if unit == "no unit":
        return "--"
    return r"$\mathrm{" + re.sub(r"\^(-?\d+)", r"^{\1}", unit).replace(" ", r"\,") + "}$"
