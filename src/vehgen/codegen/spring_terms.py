"""Springs with their dampers as the residual form of a step needs them, and the leaves: unknowns that hang on the others by one of them."""

from __future__ import annotations

from dataclasses import dataclass

from vehgen.codegen.factorisation import Matrix
from vehgen.codegen.program import STEP_PHASE, Node, Program
from vehgen.codegen.step_program import EquationTerms
from vehgen.mechanics.energies import Element


@dataclass(frozen=True)
class Spring:
    """A spring and damper: `row` its travel's coefficients, or for a leaf's own those of the motion it hangs on.

    `place` is its number among the elements, -1 for a leaf's other springs together; `middle` is c + h/2 k, `gain` 2 h k and `reach`
    2 (c + h k); `state` is e = 2 k J u, zero without stiffness.
    """

    place: int
    row: dict[int, Node]
    middle: Node
    gain: Node
    reach: Node
    state: Node
    damped: bool

    def on(self, place: dict[int, int]) -> dict[int, Node]:
        """Return the row with its unknowns renumbered."""
        return {place[j]: node for j, node in self.row.items()}

    def advance(self, program: Program, rate: Node, scale: Node) -> tuple[Node, list[tuple[Node, Node]]]:
        """Return q and the state with its value after the step, at a mean travel rate of scale times `rate`."""
        after = program.add(self.state, program.multiply(program.multiply(self.gain, scale), rate))
        states = [(self.state, after)] if program.operations[self.state] == "leaf" else []
        if not self.damped:
            return after, states
        return program.add(self.state, program.multiply(program.multiply(self.reach, scale), rate)), states


@dataclass(frozen=True)
class Leaf:
    """An unknown that hangs by `spring` on the motion `spring.row`; `own` are its other springs together.

    `end` is the leaf's coefficient in the row of its spring's travel.
    With A the leaf's entry of the matrix S of a step, s = `spring.middle` and l = s/A: `inverse` is 1/A, `scale` 1 - l, by which the leaf's
    states are scaled, `unscale` its reciprocal, `remainder` A - s and `passing` l/(1 - l).
    """

    unknown: int
    spring: Spring
    own: Spring
    end: Node
    inverse: Node
    remainder: Node
    scale: Node
    unscale: Node
    passing: Node


@dataclass(frozen=True)
class Velocities:
    """Velocities in the middle of a step: of unknowns that are no leaves, of the leaves, and of the free springs' travels.

    Those of a leaf are A z and A (z - G), with z its velocity and G that of what it hangs on, scaled as its states are.
    """

    rest: dict[int, Node]
    leaves: list[tuple[Node, Node]]
    free: list[Node]


def find_leaves(terms: EquationTerms, mass: Matrix) -> list[Leaf]:
    """Return the leaves of a model: with a mass that no other unknown shares, on one spring, beside which only springs of their own act.

    Of those springs of their own none carries a force law.
    Of two unknowns on the ends of one spring only one is a leaf.
    """
    elements, taken, found = _elements(terms), set[int](), []
    for i in range(terms.model.n_dof):
        if (i, i) not in mass or any(i in place and place != (i, i) for place in mass):
            continue
        touching = {number: element for number, element in elements.items() if i in element.row}
        hung = [number for number, element in touching.items() if len(element.row) > 1]
        if len(hung) != 1 or not elements[hung[0]].row[i].is_Number or taken & elements[hung[0]].row.keys():
            continue
        own = [element for number, element in touching.items() if number != hung[0]]
        if any(element.laws for element in own):
            continue
        taken.add(i)
        found.append(_leaf(terms, i, mass[i, i], hung[0], own))
    return found


def free_springs(terms: EquationTerms, leaves: list[Leaf]) -> list[Spring]:
    """Return the springs that touch no leaf."""
    taken = {leaf.unknown for leaf in leaves}
    springs = []
    for number, element in _elements(terms).items():
        if not taken & element.row.keys():
            row = {j: terms.convert(value) for j, value in sorted(element.row.items())}
            springs.append(_spring(terms, number, row, (terms.convert(element.k), terms.convert(element.c)), f"e{number}"))
    return springs


def _elements(terms: EquationTerms) -> dict[int, Element]:
    """Return the elements that move and push, by their numbers."""
    return {
        i: element for i, element in enumerate(terms.model.elements) if element.row and (element.k != 0 or element.c != 0 or element.laws)
    }


def _leaf(terms: EquationTerms, unknown: int, mass: Node, number: int, own: list[Element]) -> Leaf:
    """Return a leaf on the element of that number; forces are counted along the leaf's own motion."""
    program, hung = terms.program, terms.model.elements[number]
    end = hung.row[unknown]
    row = {j: terms.convert(-value / end) for j, value in sorted(hung.row.items()) if j != unknown}
    spring = _spring(terms, number, row, (terms.convert(hung.k * end**2), terms.convert(hung.c * end**2)), f"e{number}")
    factors = [
        (terms.convert(element.k * element.row[unknown] ** 2), terms.convert(element.c * element.row[unknown] ** 2)) for element in own
    ]
    stiffness, damping = (program.total([pair[k] for pair in factors]) for k in (0, 1))
    other = _spring(terms, -1, {}, (stiffness, damping), f"o{unknown}")
    remainder = program.add(program.multiply(terms.two_h, mass), other.middle)
    whole = program.add(remainder, spring.middle)
    inverse = program.divide(program.number(1.0), whole)
    return Leaf(
        unknown=unknown,
        spring=spring,
        own=other,
        end=terms.convert(end),
        inverse=inverse,
        remainder=remainder,
        scale=program.multiply(remainder, inverse),
        unscale=program.divide(whole, remainder),
        passing=program.divide(spring.middle, remainder),
    )


def _spring(terms: EquationTerms, place: int, row: dict[int, Node], pair: tuple[Node, Node], label: str) -> Spring:
    program, h = terms.program, terms.h
    k, c = pair
    two = program.number(2.0)
    return Spring(
        place=place,
        row=row,
        middle=program.add(c, program.multiply(terms.half_h, k)),
        gain=program.multiply(program.multiply(two, h), k),
        reach=program.multiply(two, program.add(c, program.multiply(h, k))),
        state=program.number(0.0) if program.value(k) == 0.0 else program.leaf(label, STEP_PHASE),
        damped=program.value(c) != 0.0,
    )
