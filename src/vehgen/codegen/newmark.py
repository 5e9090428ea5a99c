"""One time step of average-acceleration Newmark, written out for a vehicle.

With beta = 1/4 and gamma = 1/2, and the acceleration consistent with equilibrium at the start of a step, Newmark's method (J. Eng. Mech.
Div. 85(3), 1959) is the implicit midpoint rule on displacement u and velocity v:
    (2/h M + C + h/2 K) v_mid = 2/h M v_n - K u_n + (F_n + F_{n+1})/2,
    v_{n+1} = 2 v_mid - v_n,    u_{n+1} = u_n + h v_mid.
No acceleration is carried; at kept samples it follows from equilibrium, M a = F - C v - K u. The two forms give the same numbers.
"""

from __future__ import annotations

from dataclasses import replace

from vehgen.codegen.condensation import Condensation
from vehgen.codegen.factorisation import Factor, Matrix, factorise
from vehgen.codegen.nonlinear_element import ElementAtBegin, NonlinearElement, find_nonlinear, static_travels
from vehgen.codegen.program import STEP_PHASE, Node, Program
from vehgen.codegen.step_program import EquationTerms, StepProgram
from vehgen.mechanics.equations_of_motion import EquationsOfMotion


def write_step(model: EquationsOfMotion, sweeps: int | None = None) -> StepProgram:
    """Write one Newmark step of a model as a program; `sweeps` as in :class:`vehgen.codegen.condensation.Condensation`.

    The drives are, in order: the displacement inputs w, their rates w', the applied forces f; in a step they stand for the mean over
    the step, at a sample for the value at that time.
    """
    terms = EquationTerms(model)
    program, h = terms.program, terms.h
    M, C, K = terms.matrix(model.mass_entries, "M"), terms.matrix(model.damping_entries, "C"), terms.matrix(model.stiffness_entries, "K")
    loads = terms.load_matrix()
    n = model.n_dof
    u = [program.leaf(f"u{i}", STEP_PHASE) for i in range(n)]
    v = [program.leaf(f"v{i}", STEP_PHASE) for i in range(n)]
    drives = terms.drives()

    factor = factorise(program, n, _effective_matrix(program, (M, C, K), terms.two_h, terms.half_h), "A")
    right = _right_sides(program, (M, K, loads), (u, v, drives), terms.two_h)
    middle = factor.solve(program, right)
    joints = find_nonlinear(terms, K)
    laws, further = None, list[tuple[Node, Node]]()
    if joints:
        reach = _reach(terms, factor, joints)
        laws = Condensation(terms, joints, [[_along(terms, joint, column) for column in reach] for joint in joints], sweeps)
        begins = [
            replace(begin, moving=program.add(begin.moving, _ground_at_begin(program, joint, begin.ground)))
            for joint, begin in zip(joints, _begins(terms, joints, (u, v, drives), middle), strict=True)
        ]
        found = laws.solve(begins)
        for column, force in zip(reach, found.last, strict=True):
            middle = [program.subtract(node, program.multiply(item, force)) for node, item in zip(middle, column, strict=True)]
        further = laws.states(found, begins, [_along(terms, joint, middle) for joint in joints])
        further += _ground_states(program, joints, begins)
    middle = [program.label(node, f"vm{i}") for i, node in enumerate(middle)]
    next_v = [program.subtract(program.add(middle[i], middle[i]), v[i]) for i in range(n)]
    next_u = [program.add(u[i], program.multiply(h, middle[i])) for i in range(n)]

    channels = _channels(terms, (M, C, K, loads), (u, v, drives), laws)
    states = [*zip(u, next_u, strict=True), *zip(v, next_v, strict=True), *further]
    return StepProgram(program, terms.parameters, static_travels(terms, joints), h, drives, states, channels)


def _reach(terms: EquationTerms, factor: Factor, joints: list[NonlinearElement]) -> list[list[Node]]:
    """Return the columns of W = A^-1 J^T."""
    program, n = terms.program, terms.model.n_dof
    columns = [factor.solve(program, [joint.row.get(i, program.number(0.0)) for i in range(n)]) for joint in joints]
    return [[program.label(node, f"W{i}_{j}") for i, node in enumerate(column)] for j, column in enumerate(columns)]


def _along(terms: EquationTerms, joint: NonlinearElement, vector: list[Node]) -> Node:
    """Return an element's travel, or its rate, of the unknowns' displacements or velocities."""
    return terms.program.dot([(value, vector[i]) for i, value in sorted(joint.row.items())])


def _ground(terms: EquationTerms, joint: NonlinearElement, drives: list[Node]) -> Node:
    """Return the ground's part of an element's travel, or of its rate."""
    return terms.program.dot([(value, drives[i]) for i, value in sorted(joint.input_row.items())])


def _ground_before(program: Program, joint: NonlinearElement) -> Node:
    """Return the leaf of the ground's part of an element's rate, its mean over the step before."""
    return program.leaf(f"b{joint.number}", STEP_PHASE)


def _ground_after(program: Program, joint: NonlinearElement) -> Node:
    """Return the leaf of the ground's part of an element's slip at a sample, as the step before ended: with it a slip that stuck is 0.

    The drive's value there is another by the square of the step, and at a sample even tiny slips count.
    """
    return program.leaf(f"m{joint.number}", STEP_PHASE)


def _ground_states(program: Program, joints: list[NonlinearElement], begins: list[ElementAtBegin]) -> list[tuple[Node, Node]]:
    """Return what is remembered of how the ground moves elements with friction, with its values after the step."""
    found = []
    for joint, begin in zip(joints, begins, strict=True):
        if joint.is_moved:
            twice = program.multiply(program.number(2.0), begin.ground)
            after = program.subtract(twice, _ground_at_begin(program, joint, begin.ground))
            found += [(_ground_before(program, joint), begin.ground), (_ground_after(program, joint), after)]
    return found


def _ground_at_begin(program: Program, joint: NonlinearElement, mean: Node) -> Node:
    """Return the ground's part of the slip of an element with friction as a step begins, given its mean over the step.

    It lies between this mean and that of the step before.
    """
    if not joint.is_moved:
        return program.number(0.0)
    return program.multiply(program.number(0.5), program.add(_ground_before(program, joint), mean))


def _begins(
    terms: EquationTerms, joints: list[NonlinearElement], state: tuple[list[Node], list[Node], list[Node]], free: list[Node]
) -> list[ElementAtBegin]:
    """Return the elements as a step begins that would reach the velocity `free` without the laws, `moving` without the ground's part."""
    u, v, drives = state
    rates = drives[len(terms.model.inputs) :]
    return [
        ElementAtBegin(
            terms.program.add(_along(terms, joint, u), _ground(terms, joint, drives)),
            _ground(terms, joint, rates),
            _along(terms, joint, free),
            _along(terms, joint, v),
        )
        for joint in joints
    ]


def _effective_matrix(program: Program, matrices: tuple[Matrix, Matrix, Matrix], two_h: Node, half_h: Node) -> Matrix:
    """Return 2/h M + C + h/2 K."""
    M, C, K = matrices
    zero = program.number(0.0)
    return {
        place: program.total(
            [program.multiply(two_h, M.get(place, zero)), C.get(place, zero), program.multiply(half_h, K.get(place, zero))]
        )
        for place in {*M, *C, *K}
    }


def _right_sides(
    program: Program, matrices: tuple[Matrix, Matrix, Matrix], state: tuple[list[Node], list[Node], list[Node]], two_h: Node
) -> list[Node]:
    """Return 2/h M v - K u + (mean load), one node a degree of freedom."""
    M, K, loads = matrices
    u, v, drives = state
    momentum = {place: program.multiply(two_h, node) for place, node in M.items()}
    right = []
    for i in range(len(u)):
        terms = [program.multiply(node, v[j]) for (row, j), node in sorted(momentum.items()) if row == i]
        terms += [program.negate(program.multiply(node, u[j])) for (row, j), node in sorted(K.items()) if row == i]
        terms += [program.multiply(node, drives[j]) for (row, j), node in sorted(loads.items()) if row == i]
        right.append(program.label(program.total(terms), f"r{i}"))
    return right


def _channels(
    terms: EquationTerms,
    matrices: tuple[Matrix, Matrix, Matrix, Matrix],
    state: tuple[list[Node], list[Node], list[Node]],
    laws: Condensation | None,
) -> list[Node]:
    """Write each channel; accelerations follow from equilibrium, and only those that a channel uses are computed."""
    model, program = terms.model, terms.program
    M, C, K, loads = matrices
    u, v, drives = state
    acceleration: list[Node] = []
    now: list[Node] = []
    if laws:
        begins = _begins(terms, laws.joints, state, v)
        rates = [program.add(begin.moving, begin.ground) for begin in begins]
        slips = [
            program.add(begin.moving, _ground_after(program, joint)) if joint.is_moved else begin.moving
            for joint, begin in zip(laws.joints, begins, strict=True)
        ]
        now = laws.now([begin.travel for begin in begins], rates, slips)
    pushes = laws.loads(now) if laws else {}
    if any(channel.acceleration for channel in model.channels):
        factor = factorise(program, model.n_dof, M, "M")
        forces = []
        for i in range(model.n_dof):
            parts = [program.multiply(node, drives[j]) for (row, j), node in sorted(loads.items()) if row == i]
            parts += [program.negate(program.multiply(node, v[j])) for (row, j), node in sorted(C.items()) if row == i]
            parts += [program.negate(program.multiply(node, u[j])) for (row, j), node in sorted(K.items()) if row == i]
            parts += [program.negate(pushes[i])] if i in pushes else []
            forces.append(program.total(parts))
        acceleration = [program.label(node, f"a{i}") for i, node in enumerate(factor.solve(program, forces))]

    found = []
    for number in range(len(model.channels)):
        parts = terms.channel_terms(number, (acceleration, v, u), drives)
        found.append(program.total([*parts, *(laws.channel_terms(number, now) if laws else [])]))
    return found
