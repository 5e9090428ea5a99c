"""The equations of motion for reading: text, LaTeX, and MathML for the page."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import sympy as sp

from vehgen.mechanics import GRAVITY, EquationsOfMotion
from vehgen.mechanics.energies import Element
from vehgen.mechanics.law_terms import LawTerm
from vehgen.mechanics.laws import LawState
from vehgen.mechanics.rows import SparseMatrix
from vehgen.report.equations.notation import Latex, MathMl, Name, Plain, coordinate_name, gravity_symbol, latex_name, symbol_names, tidy

WHOLE_MATRIX = 10
"""Matrices of more degrees of freedom are only listed entry by entry."""
_LONG_MATRIX = 3
"""A matrix shows the symbols of entries that have more operations than this; their values follow in the list."""
_MATRICES = (
    ("M", "mass_entries", "mass matrix", True),
    ("C", "damping_entries", "damping matrix", True),
    ("K", "stiffness_entries", "stiffness matrix", True),
    ("P", "input_entries", "forces per unit of displacement input", False),
    ("Q", "input_rate_entries", "forces per unit of input velocity", False),
    ("F", "force_entries", "generalised forces per unit of applied force", False),
)


@dataclass(frozen=True)
class Matrix:
    """A matrix for reading: its entries tidied, of a symmetric one the upper triangle; what is absent is zero."""

    symbol: str
    meaning: str
    shape: tuple[int, int]
    symmetric: bool
    entries: dict[tuple[int, int], sp.Expr]

    def at(self, row: int, column: int) -> tuple[tuple[int, int], sp.Expr]:
        """Return where an entry is listed, and the entry."""
        place = (column, row) if self.symmetric and row > column else (row, column)
        return place, self.entries.get(place, sp.S.Zero)


def matrices(model: EquationsOfMotion) -> Iterator[Matrix]:
    """Yield the matrices that are not empty, and the weight vector."""
    widths = {"P": len(model.inputs), "Q": len(model.inputs), "F": len(model.forces)}
    for symbol, attribute, meaning, symmetric in _MATRICES:
        found: SparseMatrix = getattr(model, attribute)
        kept = {place: tidy(value) for place, value in sorted(found.items()) if value != 0 and not (symmetric and place[0] > place[1])}
        if kept:
            yield Matrix(symbol, meaning, (model.n_dof, widths.get(symbol, model.n_dof)), symmetric, kept)
    weight = {(i, 0): tidy(gravity_symbol(value, GRAVITY)) for i, value in sorted(model.weight_entries.items())}
    yield Matrix("W", "generalised weight; static equilibrium: K q = W", (model.n_dof, 1), False, weight)


def place_text(matrix: Matrix, place: tuple[int, int]) -> str:
    """Return the indices of an entry, from 1."""
    return f"{place[0] + 1}" if matrix.shape[1] == 1 and matrix.symbol == "W" else f"{place[0] + 1},{place[1] + 1}"


def nonlinear(model: EquationsOfMotion) -> list[Element]:
    """Return the elements with force laws."""
    return [element for element in model.elements if element.laws]


def balance(model: EquationsOfMotion) -> list[tuple[str, str, str, str]]:
    """Return the terms of the equation of motion: (side, matrix, vector, its derivative marks)."""
    terms = [("left", "M", "q", "''"), ("left", "C", "q", "'"), ("left", "K", "q", "")]
    terms += [("left", "L", "n", "")] if nonlinear(model) else []
    terms += [("right", "P", "w", "")]
    terms += [("right", "Q", "w", "'")] if any(value != 0 for value in model.input_rate_entries.values()) else []
    return terms + ([("right", "F", "f", "")] if model.forces else [])


def balance_text(model: EquationsOfMotion) -> str:
    """Return the equation of motion as text."""
    sides = {side: " + ".join(f"{a} {b}{c}" for where, a, b, c in balance(model) if where == side) for side in ("left", "right")}
    return f"{sides['left']} = {sides['right']}"


def vectors(model: EquationsOfMotion) -> list[tuple[str, list[str]]]:
    """Return what the other vectors of the equation hold: (symbol, what each component is)."""
    said = {"road": "height of the road under {} [m]", "ground": "height of the ground end of {} [m]"}
    inputs = [said[kind].format(name) for kind, _, name in (item.partition(".") for item in model.inputs)]
    forces = [f"vertical force at {name} [N]" for name in model.forces]
    return [("w", inputs), ("f", forces)] if forces else [("w", inputs)]


def law_rows(model: EquationsOfMotion) -> list[tuple[str, sp.Expr, list[tuple[str, str, list[tuple[str, sp.Expr, str]]]]]]:
    """Return every element with laws: (where it is, travel d, [(law, its equation, [(parameter, value, unit)])])."""
    rows = []
    for element in nonlinear(model):
        travel = sp.Add(*(tidy(value * model.coordinates[i].symbol) for i, value in sorted(element.row.items())))
        travel += sp.Add(*(value * sp.Symbol(f"w_{i + 1}", real=True) for i, value in sorted(element.input_row.items())))
        where = f"{element.kind} of {element.name}" if element.kind in ("suspension", "tyre") else f"{element.kind} {element.name}"
        laws = []
        for term in element.laws:
            assert element.kind != "bending"
            units = {parameter.name: str(parameter.dimension(element.kind)) for parameter in term.law.parameters}
            parameters = [(key, tidy(value), units[key]) for key, value in term.parameters.items()]
            laws.append((term.law.title, law_equation(element, term), parameters))
        rows.append((where, travel, laws))
    return rows


def law_equation(element: Element, term: LawTerm) -> str:
    """Return a law's equation; of an own law with its parameters put in."""
    counted = "" if term.origin == "static" else f"; {UNLOADED_NOTE}"
    if term.law.parameters:
        return term.law.equation + counted
    d, v, h, static = (sp.Symbol(name, real=True) for name in ("d", "v", "h", "static"))
    return f"f = {Plain().doprint(term.law.write(LawState(d, v, h, element.k, element.c, static), term.parameters).now)}{counted}"


UNLOADED_NOTE = "here d counts from the unloaded position, and n holds what f adds to its static value"


LAWS_NOTE = (
    "n holds, for each element with force laws, the sum of its laws f(d, v): beside k and c, and like the travel d and the rate v = d' "
    "positive in compression and counted from static equilibrium. A column of L holds the coefficients of the coordinates in its d."
)


def parameter_rows(model: EquationsOfMotion) -> list[tuple[str, sp.Expr | None, str, str]]:
    """Return every parameter: (name, definition if dependent, unit, meaning); shifts of sensors and forces included."""
    dimensions, definitions = model.vehicle.dimensions, {symbol.name: value for symbol, value in model.definitions}
    rows: list[tuple[str, sp.Expr | None, str, str]] = [
        (name, definitions.get(name), str(dimensions[name]), item.meaning) for name, item in model.vehicle.parameters.items()
    ]
    used = {symbol.name for entries in (model.force_entries,) for value in entries.values() for symbol in value.free_symbols}
    shifts = [name for name in model.parameters if name not in model.vehicle.parameters and name in used]
    return rows + [(name, None, "m", f"moves {name.removesuffix('.shift')} forward; 0 unless set") for name in shifts]


def equations_text(model: EquationsOfMotion) -> str:
    """Return all equations as plain text, indices from 1."""
    text = Plain().doprint
    lines = [model.vehicle.title or model.vehicle.name, "", balance_text(model), "", "Coordinates q"]
    lines += [f"  q{i} = {item.symbol}: {item.meaning} [{item.unit}]" for i, item in enumerate(model.coordinates, 1)]
    for symbol, meanings in vectors(model):
        lines += ["", f"{'Inputs' if symbol == 'w' else 'Forces'} {symbol}"]
        lines += [f"  {symbol}{i}: {meaning}" for i, meaning in enumerate(meanings, 1)]
    lines += ["", "Parameters"]
    for name, definition, unit, meaning in parameter_rows(model):
        lines.append(f"  {name}{'' if definition is None else ' = ' + text(definition)}: {meaning} [{unit}]")
    lines.append(f"  g = {GRAVITY}: acceleration of gravity [m/s^2]")
    for matrix in matrices(model):
        lines += ["", f"{matrix.symbol}, {matrix.meaning}" + (" (symmetric; upper triangle)" if matrix.symmetric else "")]
        lines += [f"  {matrix.symbol}[{place_text(matrix, place)}] = {text(value)}" for place, value in matrix.entries.items()]
    if nonlinear(model):
        lines += ["", f"Force laws. {LAWS_NOTE}"]
    for column, (where, travel, laws) in enumerate(law_rows(model), 1):
        lines.append(f"  n{column}, {where}: d = {text(travel)}")
        for title, equation, parameters in laws:
            given = ", ".join(f"{key} = {text(value)} [{unit}]" for key, value, unit in parameters)
            lines.append(f"    {title}: {equation}" + (f"; {given}" if given else ""))
    return "\n".join(lines) + "\n"


@dataclass(frozen=True)
class Section:
    """A matrix as MathML: the whole (small ones only), and its listed entries as (place, left side, value)."""

    symbol: str
    meaning: str
    whole: str
    rows: list[tuple[str, str, str]]


def equations_mathml(model: EquationsOfMotion) -> list[Section]:
    """Return every matrix as presentation MathML for the page; nothing in it needs a script."""
    printer = MathMl(symbol_names(model))
    sections = []
    for matrix in matrices(model):
        values = {place: printer.doprint(value) for place, value in matrix.entries.items()}
        left = {place: _entry_mathml(matrix, place) for place in values}
        whole, rows = "", list(values)
        if max(matrix.shape) <= WHOLE_MATRIX:
            cells = []
            for i in range(matrix.shape[0]):
                row = []
                for j in range(matrix.shape[1]):
                    place, value = matrix.at(i, j)
                    row.append("<mn>0</mn>" if value == 0 else left[place] if is_long(value) else values[place])
                cells.append("<mtr>" + "".join(f"<mtd>{cell}</mtd>" for cell in row) + "</mtr>")
            whole = math(f"<mi>{matrix.symbol}</mi><mo>=</mo><mtable>{''.join(cells)}</mtable>")
            rows = [place for place in values if is_long(matrix.entries[place])]
        listed = [(place_text(matrix, place), math(left[place] + "<mo>=</mo>"), math(values[place])) for place in rows]
        sections.append(Section(matrix.symbol, matrix.meaning + (" (symmetric)" if matrix.symmetric else ""), whole, listed))
    return sections


def is_long(value: sp.Expr) -> bool:
    """Tell whether an entry is too long to stand inside a matrix."""
    return int(sp.count_ops(value)) > _LONG_MATRIX


def _entry_mathml(matrix: Matrix, place: tuple[int, int]) -> str:
    return f"<msub><mi>{matrix.symbol}</mi><mtext>{place_text(matrix, place)}</mtext></msub>"


def math(content: str) -> str:
    """Return MathML content as an element of a page."""
    return f"<math>{content.replace('<mo>-</mo>', '<mo>−</mo>')}</math>"


def balance_mathml(model: EquationsOfMotion) -> str:
    """Return the equation of motion as MathML."""
    signs = {"": "<mi>{}</mi>", "'": "<mover><mi>{}</mi><mo>˙</mo></mover>", "''": "<mover><mi>{}</mi><mo>¨</mo></mover>"}
    sides = {
        side: "<mo>+</mo>".join(f"<mi>{a}</mi>" + signs[c].format(b) for where, a, b, c in balance(model) if where == side)
        for side in ("left", "right")
    }
    return math(f"{sides['left']}<mo>=</mo>{sides['right']}")


def coordinate_mathml(model: EquationsOfMotion) -> list[str]:
    """Return the symbols of the coordinates as MathML."""
    printer = MathMl({})
    return [math(printer.name(coordinate_name(item)).toxml()) for item in model.coordinates]


def expression_mathml(model: EquationsOfMotion, expression: sp.Expr) -> str:
    """Return an expression of parameters and coordinates as MathML."""
    names = {item.symbol: coordinate_name(item) for item in model.coordinates}
    return math(MathMl({**names, **symbol_names(model), **_input_names(model)}).doprint(expression))


def _input_names(model: EquationsOfMotion) -> dict[sp.Symbol, Name]:
    return {sp.Symbol(f"w_{i + 1}", real=True): Name("w", str(i + 1)) for i in range(len(model.inputs))}


def latex_printer(model: EquationsOfMotion) -> Latex:
    """Return a printer that knows a model's parameters and coordinates."""
    names = {item.symbol: coordinate_name(item) for item in model.coordinates}
    return Latex({**names, **symbol_names(model), **_input_names(model)})


def coordinate_latex(model: EquationsOfMotion) -> list[str]:
    """Return the symbols of the coordinates in LaTeX."""
    return [latex_name(coordinate_name(item)) for item in model.coordinates]
