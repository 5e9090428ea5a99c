"""The equations of motion for reading: text, LaTeX, and MathML for the page."""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import cache

import sympy as sp
from sympy.printing.latex import LatexPrinter
from sympy.printing.mathml import MathMLPresentationPrinter
from sympy.printing.str import StrPrinter

from vehgen.mechanics import LinearModel
from vehgen.mechanics.rows import Entries

WHOLE_MATRIX = 10
"""Matrices of more degrees of freedom are listed entry by entry."""
_MATRICES = (
    ("M", "mass_entries", "mass matrix", True),
    ("C", "damping_entries", "damping matrix", True),
    ("K", "stiffness_entries", "stiffness matrix", True),
    ("P", "input_entries", "forces per unit of displacement input", False),
    ("Q", "input_rate_entries", "forces per unit of input velocity", False),
    ("F", "force_entries", "generalised forces per unit of applied force", False),
)


def matrices(model: LinearModel) -> Iterator[tuple[str, str, Entries, tuple[int, int], bool]]:
    """Yield (symbol, meaning, entries, shape, symmetric) of the matrices that are not empty."""
    widths = {"P": len(model.inputs), "Q": len(model.inputs), "F": len(model.forces)}
    for symbol, attribute, meaning, symmetric in _MATRICES:
        entries: Entries = {place: value for place, value in getattr(model, attribute).items() if value != 0}
        if entries:
            yield symbol, meaning, entries, (model.n_dof, widths.get(symbol, model.n_dof)), symmetric


def listed(entries: Entries, symmetric: bool) -> list[tuple[tuple[int, int], sp.Expr]]:
    """Return the entries in order; of a symmetric matrix the upper triangle."""
    return [(place, value) for place, value in sorted(entries.items()) if not symmetric or place[0] <= place[1]]


def equations_text(model: LinearModel) -> str:
    """Return all equations as plain text, indices from 1."""
    printer = StrPrinter({"order": "none"})
    lines = [f"{model.vehicle.title or model.vehicle.name}", "", "M q'' + C q' + K q = P w + Q w' + F f", "", "Coordinates"]
    lines += [f"  q{i} = {item.symbol}: {item.meaning} [{item.unit}]" for i, item in enumerate(model.coordinates, 1)]
    lines += ["", "Inputs w", *(f"  w{i}: {name}" for i, name in enumerate(model.inputs, 1))]
    lines += ["", "Symbols"]
    dimensions = model.vehicle.dimensions
    for name, parameter in model.vehicle.parameters.items():
        equals = f" = {parameter.equals}" if parameter.equals is not None else ""
        lines.append(f"  {name}{equals}: {parameter.meaning} [{dimensions[name]}]")
    for symbol, meaning, entries, _, symmetric in matrices(model):
        lines += ["", f"{symbol}, {meaning}" + (" (symmetric)" if symmetric else "")]
        lines += [f"  {symbol}[{i + 1},{j + 1}] = {printer.doprint(value)}" for (i, j), value in listed(entries, symmetric)]
    lines += ["", "weight, generalised gravity force (static equilibrium: K q = weight)"]
    lines += [f"  weight[{i + 1}] = {printer.doprint(value)}" for i, value in sorted(model.weight_entries.items())]
    return "\n".join(lines) + "\n"


def equations_latex(model: LinearModel) -> str:
    """Return a complete LaTeX document of the equations."""
    printer = LatexPrinter({"order": "none", "symbol_names": _latex_names(model), "mul_symbol": "dot"})
    lines = [
        r"\documentclass{article}",
        r"\usepackage{amsmath}",
        r"\usepackage[a3paper,landscape,margin=15mm]{geometry}",
        r"\setcounter{MaxMatrixCols}{40}",
        r"\begin{document}",
        rf"\section*{{{_escape(model.vehicle.title or model.vehicle.name)}}}",
        r"\[ M\ddot q + C\dot q + Kq = Pw + Q\dot w + Ff \]",
        r"\begin{itemize}",
    ]
    for item in model.coordinates:
        lines.append(rf"\item ${printer.doprint(item.symbol)}$: {_escape(item.meaning)} [{item.unit}]")
    dimensions = model.vehicle.dimensions
    for name, parameter in model.vehicle.parameters.items():
        symbol = printer.doprint(sp.Symbol(name, real=True))
        definition = next((value for key, value in model.definitions if key.name == name), None)
        equals = f" = {printer.doprint(definition)}" if definition is not None else ""
        lines.append(rf"\item ${symbol}{equals}$: {_escape(parameter.meaning)} [${_unit_latex(str(dimensions[name]))}$]")
    lines.append(r"\end{itemize}")
    for name, meaning, entries, shape, symmetric in matrices(model):
        lines.append(rf"\paragraph{{{name}, {meaning}}}")
        if max(shape) <= WHOLE_MATRIX:
            rows = [
                " & ".join(printer.doprint(entries[i, j]) if (i, j) in entries else "0" for j in range(shape[1])) for i in range(shape[0])
            ]
            lines += [r"{\scriptsize\[" + name + r" = \begin{bmatrix}", (r" \\" + "\n").join(rows), r"\end{bmatrix}\]}"]
        else:
            lines += [rf"\[ {name}_{{{i + 1},{j + 1}}} = {printer.doprint(value)} \]" for (i, j), value in listed(entries, symmetric)]
    lines.append(r"\end{document}")
    return "\n".join(lines) + "\n"


def equations_mathml(model: LinearModel) -> list[tuple[str, str, list[tuple[str, str]]]]:
    """Return, for each matrix, (symbol, meaning, [(entry's name, MathML of its value)]) for the page."""
    result = []
    for name, meaning, entries, _, symmetric in matrices(model):
        rows = [(f"{i + 1},{j + 1}", mathml(value)) for (i, j), value in listed(entries, symmetric)]
        result.append((name, meaning + (", symmetric" if symmetric else ""), rows))
    return result


def mathml(expression: sp.Expr) -> str:
    """Return an expression as presentation MathML, which browsers draw without any script."""
    printer = MathMLPresentationPrinter({"order": "none"})
    return f'<math xmlns="http://www.w3.org/1998/Math/MathML">{printer.doprint(expression)}</math>'


def _latex_names(model: LinearModel) -> dict[sp.Symbol, str]:
    names = {sp.Symbol(name, real=True): _subscripted(name) for name in model.vehicle.parameters}
    for item in model.coordinates:
        names[item.symbol] = (r"\theta" if item.motion == "pitch" else "z") + rf"_{{\mathrm{{{_escape(item.owner)}}}}}"
    return names


@cache
def _subscripted(name: str) -> str:
    """Write mT as m_T, kt1 as k_{t1}, other names upright."""
    head, tail = name[0], name[1:]
    if len(name) <= 4:
        return f"{head}_{{{tail}}}" if tail else head
    return rf"\mathrm{{{_escape(name)}}}"


def _unit_latex(unit: str) -> str:
    return r"\mathrm{" + unit.replace(" ", r"\,") + "}"


def _escape(text: str) -> str:
    """Escape text for LaTeX."""
    return re.sub(r"([&%$#_{}])", r"\\\1", text.replace("\\", "")).replace("~", "-").replace("^", "")
