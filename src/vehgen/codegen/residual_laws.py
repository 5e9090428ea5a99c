"""Force laws in the residual form of a step.

A law's mean force f over a step takes J^T f off what is to be balanced, S v_mid = r - J^T f, and adds 2 f to q of its spring. Without the
laws the velocities follow from r, with them from what their forces leave of it; the sweeps between are those of condensation.py. Of the
travels and slips at the start of a step, which this form does not hold, those that a law asks for are carried along.

The step from zero before the first one must leave the laws' forces at zero. Where a law may act at rest (a stop that is met there), they
are switched on when that step is over.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import sympy as sp

from vehgen.codegen.condensation import Condensation
from vehgen.codegen.nonlinear_element import ElementAtBegin, LawForces, NonlinearElement
from vehgen.codegen.program import STEP_PHASE, Node
from vehgen.codegen.spring_terms import Leaf, Spring, Velocities
from vehgen.codegen.step_program import EquationTerms
from vehgen.mechanics.equations_of_motion import EquationsOfMotion
from vehgen.mechanics.law_terms import RATE, TRAVEL


def takes_residual_form(model: EquationsOfMotion) -> bool:
    """Whether the laws of a model, if any, can be written so: the road moves no element that carries one."""
    return not any(element.input_row for element in model.elements if element.laws)


def _acts_at_rest(joint: NonlinearElement, expression: sp.Expr) -> bool:
    """Whether an expression of an element's laws may be other than zero where nothing has moved yet."""
    return bool(expression.subs(dict.fromkeys([TRAVEL, RATE, *joint.states], sp.S.Zero)) != 0)


class ResidualLaws:
    """Writes what laws add to a step in residual form.

    Parameters
    ----------
    terms, joints
        The program under construction, and the elements that carry laws.
    leaves, free
        The leaves of the model, and the springs that touch none.
    solve
        Returns the velocities in the middle of a step for what is to be balanced.
    sweeps
        As in :class:`vehgen.codegen.condensation.Condensation`.
    """

    def __init__(
        self,
        terms: EquationTerms,
        joints: list[NonlinearElement],
        leaves: list[Leaf],
        free: list[Spring],
        solve: Callable[[list[Node]], Velocities],
        sweeps: int | None,
    ) -> None:
        self.terms, self.program, self.joints, self.solve = terms, terms.program, joints, solve
        self.leaves = {leaf.spring.place: (i, leaf) for i, leaf in enumerate(leaves)}
        self.free = {spring.place: (i, spring) for i, spring in enumerate(free)}
        self.condensed = Condensation(terms, joints, self._compliance(), sweeps)
        acting = any(_acts_at_rest(joint, step.force) for joint in joints for step in joint.steps)
        self.started = self.program.leaf("started", STEP_PHASE) if acting else None

    def write(self, r: list[Node]) -> tuple[Velocities, dict[int, Node], list[tuple[Node, Node]]]:
        """Return the velocities in the middle of a step, what is added to q by springs' places, and states with their values after it."""
        program = self.program
        two, zero = program.number(2.0), program.number(0.0)
        begins = [
            ElementAtBegin(self._travel(joint), zero, program.multiply(*pair), self._slip(joint))
            for joint, pair in zip(self.joints, self._rates(self.solve(r)), strict=True)
        ]
        found = self._started(self.condensed.solve(begins))
        motion = self.solve(self._left(r, found.last))
        rates = self._rates(motion)
        pushes = {
            joint.place: program.multiply(program.multiply(two, self._scale(joint)), force)
            for joint, force in zip(self.joints, found.last, strict=True)
        }
        states = [] if self.started is None else [(self.started, program.number(1.0))]
        for joint, begin, (factor, node) in zip(self.joints, begins, rates, strict=True):
            if joint.asks_travel:
                moved = program.multiply(program.multiply(self.terms.h, factor), node)
                states.append((begin.travel, program.add(begin.travel, moved)))
            if joint.asks_rate:
                slip = program.multiply(program.multiply(two, factor), node)
                states.append((begin.moving, program.subtract(slip, begin.moving)))
        further = self.condensed.states(found, begins, [program.multiply(*pair) for pair in rates])
        return motion, pushes, [*states, *further]

    def _travel(self, joint: NonlinearElement) -> Node:
        """Return an element's travel as a step begins, or at a sample."""
        return self.program.leaf(f"d{joint.number}", STEP_PHASE)

    def _slip(self, joint: NonlinearElement) -> Node:
        """Return the rate of an element's travel as a step begins, or at a sample."""
        return self.program.leaf(f"m{joint.number}", STEP_PHASE)

    def now(self) -> list[Node]:
        """Return the laws' forces at a sample."""
        rates = [self._slip(joint) for joint in self.joints]
        return self.condensed.now([self._travel(joint) for joint in self.joints], rates, rates)

    def _compliance(self) -> list[list[Node]]:
        """Return G: how fast the elements' ends give way, each in turn pushed by 1 N."""
        program = self.program
        zero, one = program.number(0.0), program.number(1.0)
        columns = []
        for joint in self.joints:
            forces = [one if other is joint else zero for other in self.joints]
            pushed = self._left([zero] * self.terms.model.n_dof, forces)
            columns.append([program.negate(program.multiply(*pair)) for pair in self._rates(self.solve(pushed))])
        return [list(row) for row in zip(*columns, strict=True)]

    def _rates(self, motion: Velocities) -> list[tuple[Node, Node]]:
        """Return the rates of the elements' travels, each as a factor and what of the motion it multiplies."""
        program, found = self.program, []
        for joint in self.joints:
            if joint.place in self.leaves:
                number, leaf = self.leaves[joint.place]
                found.append((program.divide(leaf.end, leaf.remainder), motion.leaves[number][1]))
            else:
                found.append((program.number(1.0), motion.free[self.free[joint.place][0]]))
        return found

    def _scale(self, joint: NonlinearElement) -> Node:
        """Return by how much a force of an element counts along its spring, scaled as its states are."""
        if joint.place not in self.leaves:
            return self.program.number(1.0)
        leaf = self.leaves[joint.place][1]
        return self.program.multiply(leaf.end, leaf.scale)

    def _left(self, r: list[Node], forces: list[Node]) -> list[Node]:
        """Return what the laws' forces leave to be balanced."""
        program, left = self.program, list(r)
        for joint, force in zip(self.joints, forces, strict=True):
            push = program.multiply(self._scale(joint), force)
            if joint.place in self.leaves:
                leaf = self.leaves[joint.place][1]
                left[leaf.unknown] = program.subtract(left[leaf.unknown], push)
                for i, a in leaf.spring.row.items():
                    left[i] = program.add(left[i], program.multiply(a, push))
            else:
                for i, a in self.free[joint.place][1].row.items():
                    left[i] = program.subtract(left[i], program.multiply(a, push))
        return left

    def _started(self, found: LawForces) -> LawForces:
        """Return the forces as they act: not at all before the first step."""
        if self.started is None:
            return found
        last, before = ([self.program.multiply(self.started, force) for force in forces] for forces in (found.last, found.before))
        held = {number: self.program.multiply(self.started, force) for number, force in found.held.items()}
        return replace(found, last=last, before=before, held=held)
