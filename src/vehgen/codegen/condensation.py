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

from collections.abc import Mapping

import sympy as sp

from vehgen.codegen.factorisation import Factor, Matrix, factorise
from vehgen.codegen.friction import Slip, friction_now, mean_friction
from vehgen.codegen.nonlinear_element import ElementAtBegin, NonlinearElement, NonlinearStep
from vehgen.codegen.program import SAMPLE_PHASE, SETUP_PHASE, STEP_PHASE, Node, Program
from vehgen.mechanics.energies import Element
from vehgen.mechanics.equations_of_motion import EquationsOfMotion
from vehgen.mechanics.law_terms import RATE, REST, STATIC, TIME_STEP, TRAVEL


class Condensation:
    """Writes the nonlinear part of a step into a program.

    Parameters
    ----------
    model
        A model with force laws.
    program, symbols, memo
        The program under construction and how sympy symbols read in it.
    h
        The step.
    factor
        The factorised matrix A of the linear step.
    stiffness
        Entries of K, for static forces.
    sweeps
        Sweeps per step (default: two where every law is smooth with a bounded slope, whose error shrinks some hundredfold in each, else
        three).
    """

    def __init__(
        self,
        model: EquationsOfMotion,
        program: Program,
        symbols: Mapping[sp.Symbol, Node],
        memo: dict[sp.Expr, Node],
        h: Node,
        factor: Factor,
        stiffness: Matrix,
        sweeps: int | None = None,
    ) -> None:
        self.model, self.program, self.symbols, self.memo, self.h = model, program, dict(symbols), memo, h
        self.half_h = program.multiply(program.number(0.5), h)
        self.factor = factor
        self.joints: list[NonlinearElement] = []
        self.static_travels: dict[int, Node] = {}
        static = None if model.is_preloaded else self._static_displacement(stiffness)
        for place, element in enumerate(model.elements):
            if element.laws:
                self.joints.append(self._joint(len(self.joints), place, element, static))
        columns = [self._column(joint) for joint in self.joints]
        self.reach = [
            [program.label(node, f"W{i}_{joint.number}") for i, node in enumerate(column)]
            for joint, column in zip(self.joints, columns, strict=True)
        ]
        self.compliance = [
            [program.label(self._times(one.row, column), f"G{one.number}_{j}") for j, column in enumerate(self.reach)]
            for one in self.joints
        ]
        self.sweeps = sweeps or (2 if all(joint.bounded and not joint.friction for joint in self.joints) else 3)
        self.inverse = [program.divide(program.number(1.0), self.compliance[i][i]) for i in range(len(self.joints))]
        self.normalised = [[program.multiply(self.inverse[i], item) for item in row] for i, row in enumerate(self.compliance)]

    def _joint(self, number: int, index: int, element: Element, static: list[Node] | None) -> NonlinearElement:
        program = self.program
        row = {i: program.convert(value, self.symbols, self.memo) for i, value in element.row.items()}
        input_row = {i: program.convert(value, self.symbols, self.memo) for i, value in element.input_row.items()}
        states: dict[sp.Symbol, str] = {}
        steps = []
        for place, term in enumerate(element.laws):
            own = {name: sp.Symbol(f"_{name}{number}_{place}", real=True) for name in term.law.states}
            states |= {symbol: f"s{number}_{place}_{i}" for i, symbol in enumerate(own.values())}
            steps.append(term.step(element.k, element.c, own))
        force = rest = None
        if self.model.is_preloaded and any(term.origin == "unloaded" or term.asks_static for term in element.laws):
            self.static_travels[index] = rest = program.leaf(f"rest{number}", SETUP_PHASE)
            carried = element.k * REST + sp.Add(*(term.preload() for term in element.laws))
            force = program.label(program.convert(carried, {**self.symbols, REST: rest}), f"static{number}")
        elif not self.model.vehicle.gravity:
            force = rest = program.number(0.0)
        elif static is not None:
            force = program.label(
                program.multiply(program.convert(element.k, self.symbols, self.memo), self._times(row, static)), f"static{number}"
            )
        return NonlinearElement(
            number,
            element,
            row,
            input_row,
            steps,
            force,
            rest,
            states,
            smooth=any(step.force != 0 for step in steps),
            bounded=all(step.slope is not None for step in steps),
            friction=any(step.friction != 0 for step in steps),
        )

    def _static_displacement(self, stiffness: Matrix) -> list[Node] | None:
        """Solve K q = weight where a law asks for its element's static force."""
        if not any(term.asks_static for element in self.model.elements for term in element.laws):
            return None
        program = self.program
        if not self.model.weight_entries:
            return [program.number(0.0)] * self.model.n_dof
        factor = factorise(program, self.model.n_dof, stiffness, "K_")
        weight = [program.convert(self.model.weight_entries.get(i, sp.S.Zero), self.symbols, self.memo) for i in range(self.model.n_dof)]
        return factor.solve(program, weight)

    def _column(self, joint: NonlinearElement) -> list[Node]:
        right = [joint.row.get(i, self.program.number(0.0)) for i in range(self.model.n_dof)]
        return self.factor.solve(self.program, right)

    def _times(self, row: Mapping[int, Node], vector: list[Node]) -> Node:
        return self.program.dot([(value, vector[i]) for i, value in sorted(row.items())])

    def _read(self, joint: NonlinearElement, expression: sp.Expr, d: Node, v: Node, phase: int) -> Node:
        """Convert an expression of a law at a travel and rate."""
        program = self.program
        symbols = {**self.symbols, TRAVEL: d, RATE: v, TIME_STEP: self.h}
        if joint.static is not None:
            symbols[STATIC] = joint.static
        if joint.rest is not None:
            symbols[REST] = joint.rest
        symbols |= {symbol: program.leaf(name, phase) for symbol, name in joint.states.items()}
        return program.convert(expression, symbols)

    def write(self, free: list[Node], u: list[Node], v: list[Node], drives: list[Node]) -> NonlinearStep:
        """Write the sweeps of a step that would reach the velocity `free` without the laws."""
        program, width = self.program, len(self.model.inputs)
        starts = [program.add(self._times(joint.row, u), self._times(joint.input_row, drives[:width])) for joint in self.joints]
        begins = [
            ElementAtBegin(start, self._times(joint.input_row, drives[width:]), self._times(joint.row, free), self._times(joint.row, v))
            for joint, start in zip(self.joints, starts, strict=True)
        ]
        forces = [program.leaf(f"f{joint.number}", STEP_PHASE) for joint in self.joints]
        held: dict[int, Node] = {}
        before = forces
        for number in range(self.sweeps):
            before = forces
            forces, held = self._sweep(before, begins, damped=number % 2 == 1 and number + 1 < self.sweeps)
        middle = [
            program.total([free[i], *(program.negate(program.multiply(self.reach[j][i], forces[j])) for j in range(len(self.joints)))])
            for i in range(self.model.n_dof)
        ]
        states = [(program.leaf(f"f{joint.number}", STEP_PHASE), forces[joint.number]) for joint in self.joints]
        for number, holding in held.items():
            last = program.leaf(f"g{number}", STEP_PHASE)
            states += [(program.leaf(f"h{number}", STEP_PHASE), last), (last, holding)]
        for joint, begin in zip(self.joints, begins, strict=True):
            states += self._law_states(joint, begin, middle)
        states.append((program.leaf("residual", STEP_PHASE), self._residual(before, forces)))
        return NonlinearStep(middle, states)

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

    def _law_states(self, joint: NonlinearElement, begin: ElementAtBegin, middle: list[Node]) -> list[tuple[Node, Node]]:
        """Return the states of an element's laws with their values after the step."""
        program = self.program
        rate = self._times(joint.row, middle)
        d = program.add(begin.travel, program.multiply(self.half_h, rate))
        moved = program.add(rate, begin.ground)
        ends = {
            sp.Symbol(f"_{name}{joint.number}_{place}", real=True): end
            for place, step in enumerate(joint.steps)
            for name, end in step.states.items()
        }
        return [
            (program.leaf(name, STEP_PHASE), self._read(joint, ends[symbol], d, moved, STEP_PHASE)) for symbol, name in joint.states.items()
        ]

    def _smooth(self, joint: NonlinearElement, rate: Node, begin: ElementAtBegin) -> tuple[Node, Node]:
        """Return the smooth force of an element's laws at a rate, and the slope of the step's line through it."""
        zero = self.program.number(0.0)
        if not joint.smooth:
            return zero, zero
        d = self.program.add(begin.travel, self.program.multiply(self.half_h, rate))
        moved = self.program.add(rate, begin.ground)
        smooth = sp.Add(*(step.force for step in joint.steps))
        slope = sp.Add(*(step.slope for step in joint.steps if step.slope is not None)) / 2
        for step in joint.steps:
            if step.slope is None:
                slope += sp.diff(step.force, TRAVEL) * TIME_STEP / 2 + sp.diff(step.force, RATE)
        return self._read(joint, smooth, d, moved, STEP_PHASE), self._read(joint, slope, d, moved, STEP_PHASE)

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
        stopping = program.total([pull, *others, program.negate(smooth), along])
        lost = program.multiply(program.multiply(program.number(0.5), program.add(self.inverse[i], slope)), begin.moving)
        return Slip(program.subtract(stopping, lost), lost, begin.moving, *self._bound(joint))

    def _bound(self, joint: NonlinearElement) -> tuple[Node, Node]:
        """Return the bound of an element's friction, and what it is within the bound of."""
        zero = self.program.number(0.0)
        bound, middle = sp.Add(*(step.friction for step in joint.steps)), sp.Add(*(step.friction_middle for step in joint.steps))
        return self._read(joint, bound, zero, zero, STEP_PHASE), self._read(joint, middle, zero, zero, STEP_PHASE)

    def _residual(self, before: list[Node], after: list[Node]) -> Node:
        worst = self.program.leaf("residual", STEP_PHASE)
        for old, new in zip(before, after, strict=True):
            worst = self.program.apply("max", worst, self.program.apply("abs", self.program.subtract(new, old)))
        return worst

    def now(self, u: list[Node], v: list[Node], drives: list[Node]) -> list[Node]:
        """Return every element's law force at a sample: smooth laws at that instant, friction by the slip there.

        A sample ends a step, half a step after the force last found that would hold the slip; the line through the last two reaches it.
        """
        program, width = self.program, len(self.model.inputs)
        found = []
        for joint in self.joints:
            d = program.add(self._times(joint.row, u), self._times(joint.input_row, drives[:width]))
            rate = program.add(self._times(joint.row, v), self._times(joint.input_row, drives[width:]))
            force = self._read(joint, sp.Add(*(step.now for step in joint.steps)), d, rate, SAMPLE_PHASE)
            if joint.friction:
                last, before = (program.leaf(f"{name}{joint.number}", SAMPLE_PHASE) for name in "gh")
                half = program.multiply(program.number(0.5), program.subtract(last, before))
                stopping = program.multiply(program.multiply(program.number(0.5), self.inverse[joint.number]), self._times(joint.row, v))
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
