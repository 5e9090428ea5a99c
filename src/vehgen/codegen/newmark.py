"""One time step of average-acceleration Newmark, written out for a vehicle.

With beta = 1/4 and gamma = 1/2, and the acceleration consistent with equilibrium at the start of a step, Newmark's method (J. Eng. Mech.
Div. 85(3), 1959) is the implicit midpoint rule on displacement u and velocity v:
    (2/h M + C + h/2 K) v_mid = 2/h M v_n - K u_n + (F_n + F_{n+1})/2,
    v_{n+1} = 2 v_mid - v_n,    u_{n+1} = u_n + h v_mid.
No acceleration is carried; at kept samples it follows from equilibrium, M a = F - C v - K u. The two forms give the same numbers.
"""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

from vehgen.codegen.condensation import Condensation
from vehgen.codegen.factorisation import Matrix, factorise
from vehgen.codegen.labels import dependent_label, drive_labels, parameter_label
from vehgen.codegen.program import SAMPLE_PHASE, SETUP_PHASE, STEP_PHASE, Node, Program
from vehgen.mechanics.equations_of_motion import EquationsOfMotion
from vehgen.mechanics.rows import Row, SparseMatrix


@dataclass(frozen=True)
class StepProgram:
    """The program of a step: where its leaves are read from, the states (leaf, value after the step), the channels at a sample.

    The first 2 n_dof states are the displacements and velocities; those of force laws follow. `static_travels` are leaves by the number of
    an element: its travel from the unloaded position to static equilibrium.
    """

    program: Program
    parameters: dict[str, Node]
    static_travels: dict[int, Node]
    time_step: Node
    drives: list[Node]
    sample_drives: list[Node]
    states: list[tuple[Node, Node]]
    channels: list[Node]


def write_step(model: EquationsOfMotion, sweeps: int | None = None) -> StepProgram:
    """Write one Newmark step of a model as a program; `sweeps` as in :class:`vehgen.codegen.condensation.Condensation`.

    The drives are, in order: the displacement inputs w, their rates w', the applied forces f; in a step they stand for the mean over
    the step, at a sample for the value at that time.
    """
    program = Program()
    symbols: dict[sp.Symbol, Node] = {}
    parameters = {}
    for i, name in enumerate(model.parameters):
        parameters[name] = program.leaf(parameter_label(i), SETUP_PHASE)
        symbols[sp.Symbol(name, real=True)] = parameters[name]
    memo: dict[sp.Expr, Node] = {}
    for i, (symbol, expression) in enumerate(model.definitions):
        node = program.convert(expression, symbols, memo)
        symbols[symbol] = program.label(node, dependent_label(i))

    def matrix(entries: SparseMatrix, name: str) -> Matrix:
        converted = {place: program.convert(value, symbols, memo) for place, value in entries.items()}
        return {(i, j): program.label(node, f"{name}{i}_{j}") for (i, j), node in converted.items() if program.value(node) != 0.0}

    h = program.leaf("dt", SETUP_PHASE)
    two_h, half_h = program.divide(program.number(2.0), h), program.multiply(program.number(0.5), h)
    M, C, K = matrix(model.mass_entries, "M"), matrix(model.damping_entries, "C"), matrix(model.stiffness_entries, "K")
    P, Q = matrix(model.input_entries, "P"), matrix(model.input_rate_entries, "Q")
    F = matrix(model.force_entries, "F")
    n = model.n_dof
    u = [program.leaf(f"u{i}", STEP_PHASE) for i in range(n)]
    v = [program.leaf(f"v{i}", STEP_PHASE) for i in range(n)]
    names = drive_labels(len(model.inputs), len(model.forces))
    drives = [program.leaf(name, STEP_PHASE) for name in names]
    loads = _load_matrix(model, P, Q, F)

    factor = factorise(program, n, _effective_matrix(program, (M, C, K), two_h, half_h), "A")
    right = _right_sides(program, (M, K, loads), (u, v, drives), two_h)
    middle = factor.solve(program, right)
    laws, further = None, []
    if any(element.laws for element in model.elements):
        laws = Condensation(model, program, symbols, memo, h, factor, K, sweeps)
        nonlinear = laws.write(middle, u, v, drives)
        middle, further = nonlinear.middle, nonlinear.states
    middle = [program.label(node, f"vm{i}") for i, node in enumerate(middle)]
    next_v = [program.subtract(program.add(middle[i], middle[i]), v[i]) for i in range(n)]
    next_u = [program.add(u[i], program.multiply(h, middle[i])) for i in range(n)]

    su = [program.leaf(f"u{i}", SAMPLE_PHASE) for i in range(n)]
    sv = [program.leaf(f"v{i}", SAMPLE_PHASE) for i in range(n)]
    sample_drives = [program.leaf(name, SAMPLE_PHASE) for name in names]
    channels = _channels(model, program, symbols, memo, (M, C, K, loads), (su, sv, sample_drives), laws)
    states = [*zip(u, next_u, strict=True), *zip(v, next_v, strict=True), *further]
    return StepProgram(program, parameters, laws.static_travels if laws else {}, h, drives, sample_drives, states, channels)


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


def _load_matrix(model: EquationsOfMotion, P: Matrix, Q: Matrix, F: Matrix) -> Matrix:
    """Join the columns of displacement inputs, their rates and forces."""
    width = len(model.inputs)
    joined = dict(P)
    joined.update({(i, j + width): node for (i, j), node in Q.items()})
    joined.update({(i, j + 2 * width): node for (i, j), node in F.items()})
    return joined


def _channels(
    model: EquationsOfMotion,
    program: Program,
    symbols: dict[sp.Symbol, Node],
    memo: dict[sp.Expr, Node],
    matrices: tuple[Matrix, Matrix, Matrix, Matrix],
    state: tuple[list[Node], list[Node], list[Node]],
    laws: Condensation | None,
) -> list[Node]:
    """Write each channel; accelerations follow from equilibrium, and only those that a channel uses are computed."""
    M, C, K, loads = matrices
    u, v, drives = state
    width = len(model.inputs)
    acceleration: list[Node] = []
    now = laws.now(u, v, drives) if laws else []
    pushes = laws.loads(now) if laws else {}
    if any(channel.acceleration for channel in model.channels):
        factor = factorise(program, model.n_dof, M, "M")
        forces = []
        for i in range(model.n_dof):
            terms = [program.multiply(node, drives[j]) for (row, j), node in sorted(loads.items()) if row == i]
            terms += [program.negate(program.multiply(node, v[j])) for (row, j), node in sorted(C.items()) if row == i]
            terms += [program.negate(program.multiply(node, u[j])) for (row, j), node in sorted(K.items()) if row == i]
            terms += [program.negate(pushes[i])] if i in pushes else []
            forces.append(program.total(terms))
        acceleration = [program.label(node, f"a{i}") for i, node in enumerate(factor.solve(program, forces))]

    def times(row: Row, vector: list[Node]) -> list[Node]:
        return [program.multiply(program.convert(value, symbols, memo), vector[j]) for j, value in sorted(row.items())]

    carrying = {element: joint for joint, element in enumerate(i for i, item in enumerate(model.elements) if item.laws)}
    found = []
    for channel in model.channels:
        terms = times(channel.acceleration, acceleration) + times(channel.velocity, v) + times(channel.displacement, u)
        terms += times(channel.input, drives[:width]) + times(channel.input_rate, drives[width : 2 * width])
        terms += times(channel.force, drives[2 * width :])
        if channel.laws:
            terms += times({joint: channel.laws[element] for element, joint in carrying.items() if element in channel.laws}, now)
        found.append(program.total(terms))
    return found
