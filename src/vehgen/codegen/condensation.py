"""Nonlinear forces in a Newmark step, condensed to the elements that carry them.

Over a step the velocity in its middle is v = v_free - W f, where v_free ignores the laws, f are their forces and W = A^-1 J^T with A the
constant matrix of the linear step and J the elements' travel rows. Each element then obeys a scalar equation in its own travel rate x,
    x + G_ll f_l(x) = x_free_l - sum over the others of G_lm f_m,    G = J W,
whose left side grows with x. Off the diagonal G is small (only the bodies couple the elements), so a few sweeps, started from the forces
of the last step, converge; all elements step at once in a sweep (Jacobi), because a chain of dependent steps would leave the processor
waiting. Where all elements push one body a sweep overshoots: friction alone on its element is damped in every other sweep, but not in the
last, which leaves a third of the error on a truck whose suspensions stick. Each step follows a line through the laws' present force: for
each law its tangent (Newton), or, where its slope has a known bound, half of that bound. Such a chord never diverges on a law of bounded
slope, and its division is done once per individual. For dry friction, which is set-valued, see friction.py.
"""

from __future__ import annotations

import sympy as sp

from vehgen.codegen.coupling import sweeps_of
from vehgen.codegen.friction import Slip, friction_now, mean_friction
from vehgen.codegen.nonlinear_element import ElementAtBegin, LawForces, NonlinearElement
from vehgen.codegen.program import SAMPLE_PHASE, STEP_PHASE, Node
from vehgen.codegen.step_program import EquationTerms
from vehgen.mechanics.law_terms import RATE, TIME_STEP, TRAVEL
from vehgen.mechanics.symbols import derivative


class Condensation:
    """Writes the nonlinear part of a step into a program.

    Parameters
    ----------
    terms
        The program under construction, and how the model's expressions read in it.
    joints
        The elements that carry laws.
    compliance
        G of these elements.
    sweeps
        Sweeps per step (default: two where every law is smooth with a bounded slope, whose error shrinks some hundredfold in each, else
        three, or more where elements with friction push each other much: see coupling.py).
    """

    def __init__(self, terms: EquationTerms, joints: list[NonlinearElement], compliance: list[list[Node]], sweeps: int | None) -> None:
        self.terms, self.program, self.joints = terms, terms.program, joints
        program = self.program
        self.compliance = [[program.label(item, f"G{i}_{j}") for j, item in enumerate(row)] for i, row in enumerate(compliance)]
        self.sweeps = sweeps or (2 if all(joint.bounded and not joint.friction for joint in joints) else sweeps_of(terms.model, joints))
        self.inverse = [program.divide(program.number(1.0), self.compliance[i][i]) for i in range(len(joints))]
        self.normalised = [[program.multiply(self.inverse[i], item) for item in row] for i, row in enumerate(self.compliance)]

    def solve(self, begins: list[ElementAtBegin]) -> LawForces:
        """Write the sweeps of a step."""
        before = forces = [self._leaf("f", joint) for joint in self.joints]
        held: dict[int, Node] = {}
        for number in range(self.sweeps):
            before = forces
            forces, held = self._sweep(before, begins, damped=number % 2 == 1 and number + 1 < self.sweeps)
        return LawForces(forces, before, held)

    def states(self, found: LawForces, begins: list[ElementAtBegin], rates: list[Node]) -> list[tuple[Node, Node]]:
        """Return the laws' states with their values after the step, given the mean rates of the elements' ends over it."""
        program = self.program
        states = [(self._leaf("f", joint), force) for joint, force in zip(self.joints, found.last, strict=True)]
        for number, holding in found.held.items():
            last = self._leaf("g", self.joints[number])
            states += [(self._leaf("h", self.joints[number]), last), (last, holding)]
        for joint, begin, rate in zip(self.joints, begins, rates, strict=True):
            ends = joint.ends()
            for symbol, name in joint.states.items():
                states.append((program.leaf(name, STEP_PHASE), self._in_step(joint, ends[symbol], begin, rate)))
        worst = program.leaf("residual", STEP_PHASE)
        after = worst
        for old, new in zip(found.before, found.last, strict=True):
            after = program.apply("max", after, program.apply("abs", program.subtract(new, old)))
        return [*states, (worst, after)]

    def _leaf(self, name: str, joint: NonlinearElement) -> Node:
        return self.program.leaf(f"{name}{joint.number}", STEP_PHASE)

    def _in_step(self, joint: NonlinearElement, expression: sp.Expr, begin: ElementAtBegin, rate: Node) -> Node:
        """Convert an expression of a law in the middle of a step."""
        d = self.program.add(begin.travel, self.program.multiply(self.terms.half_h, rate))
        return joint.read(self.terms, expression, d, self.program.add(rate, begin.ground), STEP_PHASE)

    def _sweep(self, before: list[Node], begins: list[ElementAtBegin], damped: bool) -> tuple[list[Node], dict[int, Node]]:
        """Return the laws' forces, of those before, and what would hold the slip of those with friction, by their numbers."""
        program, forces, held = self.program, list[Node](), dict[int, Node]()
        for joint, begin, last in zip(self.joints, begins, before, strict=True):
            i = joint.number
            others = [program.negate(program.multiply(self.compliance[i][j], force)) for j, force in enumerate(before)]
            rate = program.total([begin.free_rate, *others])
            total, slope = self._smooth(joint, rate, begin)
            if joint.friction:
                slip = self._slip(joint, before, begin, total, slope, rate)
                total, held[i] = program.add(total, mean_friction(program, slip)), slip.holding
            kept = self._relaxation(joint, slope)
            if damped and not joint.smooth:
                kept = program.subtract(program.number(1.0), self._damping(i))
            forces.append(program.add(total, program.multiply(kept, program.subtract(last, total))))
        return forces, held

    def _damping(self, number: int) -> Node:
        """Return the share of its change that an element's force takes in a damped sweep."""
        program, one = self.program, self.program.number(1.0)
        sizes = [program.apply("abs", item) for j, item in enumerate(self.normalised[number]) if j != number]
        return program.divide(one, program.add(one, program.multiply(program.number(0.5), program.total(sizes))))

    def _smooth(self, joint: NonlinearElement, rate: Node, begin: ElementAtBegin) -> tuple[Node, Node]:
        """Return the smooth force of an element's laws at a rate, and the slope of the step's line through it."""
        zero = self.program.number(0.0)
        if not joint.smooth:
            return zero, zero
        smooth = sp.Add(*(step.force for step in joint.steps))
        slope = sp.Add(*(step.slope for step in joint.steps if step.slope is not None)) / 2
        for step in joint.steps:
            if step.slope is None:
                slope += derivative(step.force, TRAVEL) * TIME_STEP / 2 + derivative(step.force, RATE)
        return self._in_step(joint, smooth, begin, rate), self._in_step(joint, slope, begin, rate)

    def _relaxation(self, joint: NonlinearElement, slope: Node) -> Node:
        """Return G s/(1 + G s), the share of the last force that a step along a line of slope s keeps."""
        program = self.program
        stiff = program.multiply(self.compliance[joint.number][joint.number], slope)
        return program.divide(stiff, program.add(program.number(1.0), stiff))

    def _slip(self, joint: NonlinearElement, before: list[Node], begin: ElementAtBegin, smooth: Node, slope: Node, rate: Node) -> Slip:
        """Return what friction over the step is found from, given the other laws' forces."""
        program, i = self.program, joint.number
        stop = program.subtract(program.multiply(program.number(0.5), begin.moving), begin.ground)
        pull = program.multiply(self.inverse[i], program.subtract(begin.free_rate, stop))
        others = [program.negate(program.multiply(self.normalised[i][j], force)) for j, force in enumerate(before) if j != i]
        along = program.multiply(slope, program.subtract(rate, stop))
        lost = program.multiply(program.multiply(program.number(0.5), program.add(self.inverse[i], slope)), begin.moving)
        holding = program.total([pull, program.negate(lost), *others, program.negate(smooth), along])
        return Slip(holding, lost, begin.moving, *self._bound(joint))

    def _bound(self, joint: NonlinearElement) -> tuple[Node, Node]:
        """Return the bound of an element's friction, and what it is within the bound of."""
        zero = self.program.number(0.0)
        bound, middle = sp.Add(*(step.friction for step in joint.steps)), sp.Add(*(step.friction_middle for step in joint.steps))
        return joint.read(self.terms, bound, zero, zero, STEP_PHASE), joint.read(self.terms, middle, zero, zero, STEP_PHASE)

    def now(self, travels: list[Node], rates: list[Node], slips: list[Node]) -> list[Node]:
        """Return every element's law force at a sample, given its travel, its rate and the slip of its ends.

        Smooth laws act as at that instant, friction by the slip there. A sample ends a step, half a step after the force last found that
        would hold the slip; the line through the last two reaches it.
        """
        program, found = self.program, []
        for joint, d, rate, slip in zip(self.joints, travels, rates, slips, strict=True):
            force = joint.read(self.terms, sp.Add(*(step.now for step in joint.steps)), d, rate, SAMPLE_PHASE)
            if joint.friction:
                last, before = self._leaf("g", joint), self._leaf("h", joint)
                half = program.multiply(program.number(0.5), program.subtract(last, before))
                stopping = program.multiply(program.multiply(program.number(0.5), self.inverse[joint.number]), slip)
                bound, middle = self._bound(joint)
                holding = program.subtract(program.add(last, half), middle)
                force = program.total([force, middle, friction_now(program, holding, stopping, bound)])
            found.append(force)
        return found

    def loads(self, forces: list[Node]) -> dict[int, Node]:
        """Return the generalised forces J^T f of the elements' forces, by coordinate."""
        total: dict[int, list[Node]] = {}
        for joint, force in zip(self.joints, forces, strict=True):
            for i, value in joint.row.items():
                total.setdefault(i, []).append(self.program.multiply(value, force))
        return {i: self.program.total(terms) for i, terms in total.items()}

    def channel_terms(self, number: int, forces: list[Node]) -> list[Node]:
        """Return the terms of a channel that are elements' law forces."""
        own = self.terms.model.channels[number].laws
        return self.terms.times({joint.number: own[joint.place] for joint in self.joints if joint.place in own}, forces)
