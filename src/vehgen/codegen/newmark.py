"""One time step of average-acceleration Newmark, written out for a vehicle.

With beta = 1/4 and gamma = 1/2, and the acceleration consistent with equilibrium at the start of a step, Newmark's method (J. Eng. Mech.
Div. 85(3), 1959) is the implicit midpoint rule on displacement u and velocity v:
    (2/h M + C + h/2 K) v_mid = 2/h M v_n - K u_n + (F_n + F_{n+1})/2,
    v_{n+1} = 2 v_mid - v_n,    u_{n+1} = u_n + h v_mid.
No acceleration is carried; at kept samples it follows from equilibrium, M a = F - C v - K u. The two forms give the same numbers.
"""

from __future__ import annotations

from vehgen.codegen.condensation import Condensation
from vehgen.codegen.factorisation import Matrix, factorise
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
    laws, further = None, []
    if any(element.laws for element in model.elements):
        laws = Condensation(model, program, terms.symbols, terms.memo, h, factor, K, sweeps)
        nonlinear = laws.write(middle, u, v, drives)
        middle, further = nonlinear.middle, nonlinear.states
    middle = [program.label(node, f"vm{i}") for i, node in enumerate(middle)]
    next_v = [program.subtract(program.add(middle[i], middle[i]), v[i]) for i in range(n)]
    next_u = [program.add(u[i], program.multiply(h, middle[i])) for i in range(n)]

    channels = _channels(terms, (M, C, K, loads), (u, v, drives), laws)
    states = [*zip(u, next_u, strict=True), *zip(v, next_v, strict=True), *further]
    return StepProgram(program, terms.parameters, laws.static_travels if laws else {}, h, drives, states, channels)


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
    now = laws.now(u, v, drives) if laws else []
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

    carrying = {element: joint for joint, element in enumerate(i for i, item in enumerate(model.elements) if item.laws)}
    found = []
    for number, channel in enumerate(model.channels):
        parts = terms.channel_terms(number, (acceleration, v, u), drives)
        if channel.laws:
            parts += terms.times({joint: channel.laws[element] for element, joint in carrying.items() if element in channel.laws}, now)
        found.append(program.total(parts))
    return found
