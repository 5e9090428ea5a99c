"""The equations of motion to be read: LaTeX with symbols, Markdown with numbers."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import NDArray

from vehgen.errors import escaped
from vehgen.export.matrix_data import MatrixData, matrix_data
from vehgen.export.source import ExportSource

MARKDOWN_SIGNS = re.compile(r"([\\`*_{}\[\]()!|<>~$&])")
"""Characters that mean something in Markdown or HTML."""


def write_latex(source: ExportSource) -> dict[str, bytes]:
    """Return a document that pdflatex compiles: symbols, matrices and force laws in formulas."""
    from vehgen.report import equations_latex

    return {f"{source.stem}.tex": equations_latex(source.model).encode()}


def write_markdown(source: ExportSource) -> dict[str, bytes]:
    """Return tables of every matrix, name, parameter and static load in numbers."""
    data = matrix_data(source)
    blocks = [
        f"# {plain_markdown(data.vehicle.title or data.vehicle.name)}",
        f"    {data.equation}\n\nSI units; z up, pitch nose-down, about static equilibrium.",
        *_described("Coordinates q", ((item.name, item.unit, item.meaning) for item in data.coordinates)),
        *_described("Inputs w", ((item.name, item.unit, item.meaning) for item in data.inputs)),
        *_described("Forces f", ((item.name, item.unit, item.meaning) for item in data.forces)),
        *_parameters(data),
    ]
    rows = [item.name for item in data.coordinates]
    columns = {"P": data.inputs, "Q": data.inputs, "F": data.forces}
    for name in ("M", "C", "K", "P", "Q", "F"):
        blocks += _matrix(name, getattr(data, name), rows, [item.name for item in columns.get(name, data.coordinates)])
    static = [(name, f"{force:.6g}") for name, force in (*data.static.axles.items(), *data.static.hinges.items())]
    blocks += ["## Static loads", _table(("axle or hinge", "force, N"), static)] if static else []
    blocks += _laws(data)
    return {f"{source.stem}.md": ("\n\n".join(blocks) + "\n").encode()}


def plain_markdown(text: str) -> str:
    """Return a text that Markdown shows as it is, on one line."""
    return MARKDOWN_SIGNS.sub(r"\\\1", escaped(text)).replace("\\<", "&lt;").replace("\\&", "&amp;")


def _described(title: str, rows: Iterable[tuple[str, str, str]]) -> list[str]:
    listed = [(str(i), *row) for i, row in enumerate(rows, 1)]
    return [f"## {title}", _table(("", "name", "unit", "meaning"), listed)] if listed else []


def _parameters(data: MatrixData) -> list[str]:
    rows = [(item.name, f"{item.value:.9g}", item.unit, item.equals or "", item.meaning) for item in data.parameters]
    return ["## Parameters", _table(("name", "value", "unit", "equals", "meaning"), rows)]


def _matrix(name: str, matrix: NDArray[np.float64], rows: Sequence[str], columns: Sequence[str]) -> list[str]:
    """Return a matrix as a table; none that is empty or zero."""
    if not matrix.any():
        return []
    lines = [(label, *(f"{value:.9g}" for value in row)) for label, row in zip(rows, matrix.tolist(), strict=True)]
    return [f"## {name}", _table(("", *columns), lines)]


def _laws(data: MatrixData) -> list[str]:
    rows = [
        (law.element, law.kind, law.law, law.equation, ", ".join(f"{name} = {value:.9g}" for name, value in law.parameters.items()))
        for law in data.force_laws
    ]
    return ["## Force laws", _table(("at", "", "law", "equation", "parameters"), rows)] if rows else []


def _table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    lines = [[plain_markdown(cell) for cell in row] for row in (head, *rows)]
    lines.insert(1, ["---"] * len(head))
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)
