"""One time step of the same Newmark method in residual form, which needs half to nine tenths of the operations where no force law acts.

With S = 2/h M + C + h/2 K the state is what is left to be balanced, r = 2/h M v - K u + F_mid, and of each spring e = 2 k J u, where J is
the row of its travel and F_mid the mean load over the step that begins. A step is
    S v_mid = r,   rho = J v_mid,   q = e + 2 (c + h k) rho,   e' = e + 2 h k rho,   r' = r - sum J^T q + F_mid + F_mid'.
M and u vanish from it, and the loads enter as one sum. Written out, it is the midpoint rule of newmark.py, so the numbers are the same.

A leaf is an unknown that hangs on the others by one spring only: an axle, a seat. Of it z = (r + s G)/A is known as soon as the others are,
where G is their motion where it hangs, s = c + h/2 k that of its spring and A its own entry of S. The others keep the residual that is left
when the leaf is eliminated, R = r_body + g l r_leaf with l = s/A and g the row of G, which obeys
    R' = R + g (1 - l) (q_s + l/(1 - l) t),   t = (loads of the leaf) - q of its other springs.
The states of a leaf are scaled by 1 - l, which saves that product. No division is by a stiffness or a damping, so that each may be zero:
A (1 - l) holds the leaf's mass.
"""

from __future__ import annotations

from functools import cached_property

from vehgen.codegen.factorisation import Factor, Matrix, factorise
from vehgen.codegen.linear_rows import as_rows
from vehgen.codegen.nonlinear_element import find_nonlinear, static_travels
from vehgen.codegen.program import STEP_PHASE, Node, Program
from vehgen.codegen.residual_laws import ResidualLaws
from vehgen.codegen.spring_terms import Leaf, Spring, Velocities, find_leaves, free_springs
from vehgen.codegen.step_program import EquationTerms, StepProgram
from vehgen.mechanics.equations_of_motion import EquationsOfMotion

MOST_FOR_ROWS = 400
"""Operations of a sample beyond which rows of coefficients, which must be compiled, are not worth what they save."""


def write_residual_step(model: EquationsOfMotion, sweeps: int | None = None) -> StepProgram:
    """Write one step of a model, from rest, in residual form; `sweeps` as in :class:`vehgen.codegen.condensation.Condensation`.

    Its laws must take that form, see :func:`vehgen.codegen.residual_laws.takes_residual_form`.

    The drives are those of :func:`vehgen.codegen.newmark.write_step`; in a step they stand for the sum of the means over this step and the
    next one. Before the first step, one step from zero whose drives are the means over the first one sets the state. At a sample `drives`
    are the values at that time, and `sample_means` the means over the step that begins then.
    """
    return _ResidualStep(model, sweeps).write()


class _ResidualStep:
    """Writes the residual form of a model into a program."""

    def __init__(self, model: EquationsOfMotion, sweeps: int | None) -> None:
        self.model, self.terms = model, EquationTerms(model)
        terms, self.program = self.terms, self.terms.program
        self.mass = terms.matrix(model.mass_entries, "M")
        self.damping = terms.matrix(model.damping_entries, "C")
        self.leaves: list[Leaf] = find_leaves(terms, self.mass)
        self.free: list[Spring] = free_springs(terms, self.leaves)
        self.rest = sorted(set(range(model.n_dof)) - {leaf.unknown for leaf in self.leaves})
        self.loads = terms.load_matrix()
        self.drives, self.sample_means = terms.drives(), terms.drives("mean_")
        self.r = [self.program.leaf(f"r{i}", STEP_PHASE) for i in range(model.n_dof)]
        self.u = [self.program.leaf(f"u{i}", STEP_PHASE) for i in range(model.n_dof)]

        self.joints = find_nonlinear(terms, terms.matrix(model.stiffness_entries, "K")) if any(e.laws for e in model.elements) else []
        self.laws = ResidualLaws(terms, self.joints, self.leaves, self.free, self._motion, sweeps) if self.joints else None

    def write(self) -> StepProgram:
        """Return the program."""
        terms, program = self.terms, self.program
        motion, pushes, further = self.laws.write(self.r) if self.laws else (self._motion(self.r), {}, [])
        for unknown, node in motion.rest.items():
            program.label(node, f"vm{unknown}")
        states = [*self._advance(motion, pushes), *self._displacements(motion), *further]
        rests, channels = static_travels(terms, self.joints), self._channels()
        return StepProgram(program, terms.parameters, rests, terms.h, self.drives, states, channels, sample_means=self.sample_means)

    @cached_property
    def _factor(self) -> Factor:
        """S without the leaves, factorised."""
        program, place = self.program, self._place
        matrix: Matrix = {
            (place[i], place[j]): program.multiply(self.terms.two_h, node)
            for (i, j), node in self.mass.items()
            if i in place and j in place
        }
        for leaf in self.leaves:
            _add_outer(program, matrix, program.multiply(leaf.spring.middle, leaf.scale), leaf.spring.on(place))
        for spring in self.free:
            _add_outer(program, matrix, spring.middle, spring.on(place))
        return factorise(program, len(self.rest), matrix, "A")

    @property
    def _place(self) -> dict[int, int]:
        """Where the unknowns that are no leaves stand among each other."""
        return {unknown: i for i, unknown in enumerate(self.rest)}

    def _motion(self, r: list[Node]) -> Velocities:
        """Solve S v_mid = r."""
        program, factor = self.program, self._factor
        solution = _solve(program, factor, [r[i] for i in self.rest])
        rest = {unknown: solution[i] for i, unknown in enumerate(self.rest)}
        rows = [spring.on(self._place) for spring in (*(leaf.spring for leaf in self.leaves), *self.free)]
        direct = len(rows) * len(self.rest) <= _solving_cost(factor) + sum(map(len, rows))
        balance = [r[i] for i in self.rest] if direct else None
        leaves = []
        for leaf, row in zip(self.leaves, rows, strict=False):
            one, left = program.number(1.0), r[leaf.unknown]
            scale = program.multiply(leaf.scale, leaf.remainder)
            hung = self._rate(solution, row, scale, balance)
            pulled = program.multiply(one if direct else scale, hung)
            moved = program.multiply(leaf.passing if direct else program.multiply(leaf.scale, leaf.spring.middle), hung)
            leaves.append((program.add(left, moved), program.subtract(left, pulled)))
        free = [self._rate(solution, row, program.number(1.0), balance) for row in rows[len(leaves) :]]
        return Velocities(rest, leaves, free)

    def _rate(self, solution: list[Node], row: dict[int, Node], scale: Node, balance: list[Node] | None) -> Node:
        """Return a row times the velocities, or `scale` times that straight from what is to be balanced, where that is given."""
        program = self.program
        if balance is None:
            return program.dot([(a, solution[j]) for j, a in row.items()])
        column = _column(program, self._factor, row)
        return program.dot([(program.multiply(node, scale), item) for node, item in zip(column, balance, strict=True)])

    def _advance(self, motion: Velocities, pushes: dict[int, Node]) -> list[tuple[Node, Node]]:
        """Return r and e with their values after the step; `pushes` are what the laws add to q, by their springs' places."""
        program, zero = self.program, self.program.number(0.0)
        gathered = {i: [self.r[i], *self._load(i, self.drives)] for i in self.rest}
        states = []
        for leaf, (moved, travelled) in zip(self.leaves, motion.leaves, strict=True):
            i = leaf.unknown
            push, stretched = leaf.spring.advance(program, travelled, leaf.inverse)
            push = program.add(push, pushes.get(leaf.spring.place, zero))
            own, pressed = leaf.own.advance(program, moved, leaf.inverse)
            loads = [program.multiply(node, self.drives[j]) for node, j in self._scaled_load(leaf)]
            other = program.total([*loads, program.negate(own)])
            states += [*stretched, *pressed, (self.r[i], program.subtract(program.add(self.r[i], other), push))]
            passed = program.add(push, program.multiply(leaf.passing, other))
            for j, a in leaf.spring.row.items():
                gathered[j].append(program.multiply(a, passed))
        for spring, rate in zip(self.free, motion.free, strict=True):
            push, stretched = spring.advance(program, rate, program.number(1.0))
            push = program.add(push, pushes.get(spring.place, zero))
            states += stretched
            for j, a in spring.row.items():
                gathered[j].append(program.negate(program.multiply(a, push)))
        return [*states, *((self.r[i], program.total(terms)) for i, terms in gathered.items())]

    def _displacements(self, motion: Velocities) -> list[tuple[Node, Node]]:
        """Return the displacements that a channel reads, with their values after the step."""
        program, found = self.program, []
        one = program.number(1.0)
        leaves = {
            leaf.unknown: (program.divide(one, leaf.remainder), pair[0]) for leaf, pair in zip(self.leaves, motion.leaves, strict=True)
        }
        for i in sorted({i for channel in self.model.channels for i in channel.displacement}):
            scale, velocity = leaves[i] if i in leaves else (one, motion.rest[i])
            found.append((self.u[i], program.add(self.u[i], program.multiply(program.multiply(self.terms.h, scale), velocity))))
        return found

    def _load(self, unknown: int, drives: list[Node]) -> list[Node]:
        """Return the terms of the load on an unknown."""
        return [self.program.multiply(node, drives[j]) for (i, j), node in sorted(self.loads.items()) if i == unknown]

    def _scaled_load(self, leaf: Leaf) -> list[tuple[Node, int]]:
        """Return the factors of the load on a leaf, scaled as its states are, with the numbers of their drives."""
        return [(self.program.multiply(node, leaf.scale), j) for (i, j), node in sorted(self.loads.items()) if i == leaf.unknown]

    def _channels(self) -> list[Node]:
        """Write each channel: velocities follow from the residual, accelerations from equilibrium."""
        program, model = self.program, self.model
        n = model.n_dof
        velocity: list[Node] = []
        acceleration: list[Node] = []
        now = self.laws.now() if self.laws else []
        if any(channel.acceleration or channel.velocity for channel in model.channels):
            residual, resting = self._whole_residual(), self._resting_forces()
            factor = factorise(program, n, self.mass, "M")
            momentum = []
            for i in range(n):
                parts = [residual[i], resting[i], *map(program.negate, self._load(i, self.sample_means))]
                momentum.append(program.multiply(self.terms.half_h, program.total(parts)))
            velocity = [program.label(node, f"v{i}") for i, node in enumerate(factor.solve(program, momentum))]
            pushes = self.laws.condensed.loads(now) if self.laws else {}
            forces = []
            for i in range(n):
                parts = [program.negate(program.multiply(node, velocity[j])) for (row, j), node in sorted(self.damping.items()) if row == i]
                parts += [program.negate(pushes[i])] if i in pushes else []
                forces.append(program.total([*self._load(i, self.drives), program.negate(resting[i]), *parts]))
            acceleration = [program.label(node, f"a{i}") for i, node in enumerate(factor.solve(program, forces))]
        motion = acceleration, velocity, self.u
        written = []
        for k in range(len(model.channels)):
            own = self.laws.condensed.channel_terms(k, now) if self.laws else []
            written.append(program.total([*self.terms.channel_terms(k, motion, self.drives), *own]))
        operations, instructions = program.cost(written)
        if operations > MOST_FOR_ROWS:
            return written
        rows = as_rows(program, written)
        return rows if program.cost(rows)[1] < instructions else written

    def _whole_residual(self) -> list[Node]:
        """Return r of every unknown, where the state holds what is left of it without the leaves."""
        program = self.program
        parts = {i: [self.r[i]] for i in range(self.model.n_dof)}
        for leaf in self.leaves:
            parts[leaf.unknown] = [program.multiply(leaf.unscale, self.r[leaf.unknown])]
            for j, a in leaf.spring.row.items():
                parts[j].append(program.negate(program.multiply(program.multiply(a, leaf.passing), self.r[leaf.unknown])))
        return [program.total(parts[i]) for i in range(self.model.n_dof)]

    def _resting_forces(self) -> list[Node]:
        """Return K u, which is half the sum of J^T e."""
        program = self.program
        half = program.number(0.5)
        parts: dict[int, list[Node]] = {i: [] for i in range(self.model.n_dof)}
        for leaf in self.leaves:
            share = program.multiply(half, leaf.unscale)
            force = program.multiply(share, leaf.spring.state)
            parts[leaf.unknown] += [force, program.multiply(share, leaf.own.state)]
            for j, a in leaf.spring.row.items():
                parts[j].append(program.negate(program.multiply(a, force)))
        for spring in self.free:
            for j, a in spring.row.items():
                parts[j].append(program.multiply(program.multiply(half, a), spring.state))
        return [program.total(parts[i]) for i in range(self.model.n_dof)]


def _add_outer(program: Program, matrix: Matrix, factor: Node, row: dict[int, Node]) -> None:
    """Add factor row^T row to a matrix."""
    for i, a in row.items():
        for j, b in row.items():
            term = program.multiply(program.multiply(a, b), factor)
            matrix[i, j] = program.add(matrix[i, j], term) if (i, j) in matrix else term


def _column(program: Program, factor: Factor, row: dict[int, Node]) -> list[Node]:
    """Return the solution with a sparse right-hand side."""
    return factor.solve(program, [row.get(i, program.number(0.0)) for i in range(len(factor.order))])


def _solving_cost(factor: Factor) -> int:
    """Return how many products a solution takes."""
    return 2 * len(factor.lower) + len(factor.order)


def _solve(program: Program, factor: Factor, right: list[Node]) -> list[Node]:
    """Return the solution: by the inverse where nothing of it is zero, which costs the same and makes no result wait for another."""
    size = len(right)
    if _solving_cost(factor) < size * size:
        return factor.solve(program, right)
    columns = [_column(program, factor, {j: program.number(1.0)}) for j in range(size)]
    return [program.dot([(columns[j][i], right[j]) for j in range(size)]) for i in range(size)]
