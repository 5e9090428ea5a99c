"""What the generated step of a vehicle with force laws knows of each element that carries them."""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

from vehgen.codegen.factorisation import Matrix, factorise
from vehgen.codegen.program import SETUP_PHASE, Node
from vehgen.codegen.step_program import EquationTerms
from vehgen.mechanics.energies import Element
from vehgen.mechanics.law_terms import RATE, REST, STATIC, TIME_STEP, TRAVEL, element_steps
from vehgen.mechanics.laws import LawStep


@dataclass
class NonlinearElement:
    """A nonlinear element in the program: its number among them and among all elements, its rows, laws and states."""

    number: int
    place: int
    element: Element
    row: dict[int, Node]
    input_row: dict[int, Node]
    steps: list[LawStep]
    static: Node | None
    rest: Node | None
    states: dict[sp.Symbol, str]

    @property
    def smooth(self) -> bool:
        """Whether a law's force is more than friction."""
        return any(step.force != 0 for step in self.steps)

    @property
    def bounded(self) -> bool:
        """Whether the slopes of all laws have known bounds."""
        return all(step.slope is not None for step in self.steps)

    @property
    def friction(self) -> bool:
        """Whether a law is dry friction."""
        return any(step.friction != 0 for step in self.steps)

    @property
    def is_moved(self) -> bool:
        """Whether it rubs, and the road or a moved ground end moves it."""
        return self.friction and bool(self.input_row)

    @property
    def asks_travel(self) -> bool:
        """Whether a law depends on the travel."""
        return any(TRAVEL in sp.Tuple(step.force, step.now, *step.states.values()).free_symbols for step in self.steps)

    @property
    def asks_rate(self) -> bool:
        """Whether a law depends on the travel's rate at an instant."""
        return self.friction or any(RATE in step.now.free_symbols for step in self.steps)

    def ends(self) -> dict[sp.Symbol, sp.Expr]:
        """Return the laws' states after a step, by their symbols."""
        return {_own(name, self.number, place): end for place, step in enumerate(self.steps) for name, end in step.states.items()}

    def read(self, terms: EquationTerms, expression: sp.Expr, d: Node, v: Node, phase: int) -> Node:
        """Convert an expression of a law at a travel and rate."""
        symbols = {**terms.symbols, TRAVEL: d, RATE: v, TIME_STEP: terms.h}
        if self.static is not None:
            symbols[STATIC] = self.static
        if self.rest is not None:
            symbols[REST] = self.rest
        symbols |= {symbol: terms.program.leaf(name, phase) for symbol, name in self.states.items()}
        return terms.program.convert(expression, symbols)


@dataclass(frozen=True)
class ElementAtBegin:
    """An element as a step begins: its travel, the ground's part of its rate, its rate without the laws, and the slip of its ends."""

    travel: Node
    ground: Node
    free_rate: Node
    moving: Node


@dataclass(frozen=True)
class LawForces:
    """The elements' forces over a step, those before the last sweep, and what would hold slips, by the elements' numbers."""

    last: list[Node]
    before: list[Node]
    held: dict[int, Node]


def find_nonlinear(terms: EquationTerms, stiffness: Matrix) -> list[NonlinearElement]:
    """Return the elements of a model that carry laws; `stiffness` are the entries of K, for static forces."""
    static = None if terms.model.is_preloaded else _static_displacement(terms, stiffness)
    carrying = [(place, element) for place, element in enumerate(terms.model.elements) if element.laws]
    return [_nonlinear(terms, number, place, element, static) for number, (place, element) in enumerate(carrying)]


def _own(name: str, number: int, place: int) -> sp.Symbol:
    """Return the symbol of a state of an element's law."""
    return sp.Symbol(f"_{name}{number}_{place}", real=True)


def _nonlinear(terms: EquationTerms, number: int, index: int, element: Element, static: list[Node] | None) -> NonlinearElement:
    program, model = terms.program, terms.model
    row = {i: terms.convert(value) for i, value in element.row.items()}
    states: dict[sp.Symbol, str] = {}
    own = [{name: _own(name, number, place) for name in term.law.states} for place, term in enumerate(element.laws)]
    for place, named in enumerate(own):
        states |= {symbol: f"s{number}_{place}_{i}" for i, symbol in enumerate(named.values())}
    steps = element_steps(element.laws, element.k, element.c, own)
    force = rest = None
    if model.is_preloaded and any(term.origin == "unloaded" or term.asks_static for term in element.laws):
        rest = program.leaf(f"rest{number}", SETUP_PHASE)
        carried = element.k * REST + sp.Add(*(term.preload() for term in element.laws))
        force = program.label(program.convert(carried, {**terms.symbols, REST: rest}), f"static{number}")
    elif not model.vehicle.gravity:
        force = rest = program.number(0.0)
    elif static is not None:
        weight = program.dot([(value, static[i]) for i, value in sorted(row.items())])
        force = program.label(program.multiply(terms.convert(element.k), weight), f"static{number}")
    input_row = {i: terms.convert(value) for i, value in element.input_row.items()}
    return NonlinearElement(number, index, element, row, input_row, steps, force, rest, states)


def static_travels(terms: EquationTerms, joints: list[NonlinearElement]) -> dict[int, Node]:
    """Return the leaves that are travels from the unloaded position to static equilibrium, by the elements' places among all."""
    return {joint.place: joint.rest for joint in joints if joint.rest is not None and terms.program.operations[joint.rest] == "leaf"}


def _static_displacement(terms: EquationTerms, stiffness: Matrix) -> list[Node] | None:
    """Solve K q = weight where a law asks for its element's static force."""
    model, program = terms.model, terms.program
    if not any(term.asks_static for element in model.elements for term in element.laws):
        return None
    if not model.weight_entries:
        return [program.number(0.0)] * model.n_dof
    factor = factorise(program, model.n_dof, stiffness, "K_")
    return factor.solve(program, [terms.convert(model.weight_entries.get(i, sp.S.Zero)) for i in range(model.n_dof)])
