"""Results that are linear in the leaves of a loop, written as rows: one coefficient a leaf, computed once per individual."""

from __future__ import annotations

from vehgen.codegen.program import SETUP_PHASE, Node, Program


def as_rows(program: Program, results: list[Node]) -> list[Node]:
    """Return the results as sums of coefficients times leaves.

    The chain rule backwards through the program gives each coefficient. Sums, and products and quotients by what SETUP knows, are linear;
    what comes out of anything else counts as a leaf.
    """
    return [_row(program, result) for result in results]


def _row(program: Program, result: Node) -> Node:
    weights: dict[Node, list[Node]] = {result: [program.number(1.0)]}
    terms = []
    while weights:
        node = max(weights)
        weight = program.total(weights.pop(node))
        if program.phases[node] == SETUP_PHASE or not _is_linear(program, node):
            terms.append((node, program.multiply(weight, node)))
            continue
        for argument, factor in _factors(program, node, weight):
            weights.setdefault(argument, []).append(factor)
    return program.total([term for _, term in sorted(terms)])


def _is_linear(program: Program, node: Node) -> bool:
    """Whether a node is a sum, or a product or quotient by what SETUP knows."""
    operation, known = program.operations[node], [program.phases[item] == SETUP_PHASE for item in program.arguments[node]]
    return operation in ("neg", "+", "-") or (operation == "*" and any(known)) or (operation == "/" and known[1])


def _factors(program: Program, node: Node, weight: Node) -> list[tuple[Node, Node]]:
    """Return the arguments of a node, each with how the result changes with it if it changes by `weight` with the node."""
    operation, arguments = program.operations[node], program.arguments[node]
    if operation == "neg":
        return [(arguments[0], program.negate(weight))]
    left, right = arguments
    if operation == "+":
        return [(left, weight), (right, weight)]
    if operation == "-":
        return [(left, weight), (right, program.negate(weight))]
    if operation == "/":
        return [(left, program.divide(weight, right))]
    constant, varying = (left, right) if program.phases[left] == SETUP_PHASE else (right, left)
    return [(varying, program.multiply(weight, constant))]
