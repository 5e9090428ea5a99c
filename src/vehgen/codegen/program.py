"""Straight-line programs: a graph of arithmetic that knows what may be computed once, per step or per sample.

Every node is built once (equal nodes are the same node, so common subexpressions cost nothing) and carries the phase in which its
value is known: SETUP values depend on parameters and the step size alone, STEP values change with every time step, SAMPLE values are
wanted at kept samples only. Nothing is computed for a phase that does not need it.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

import sympy as sp

SETUP_PHASE, STEP_PHASE, SAMPLE_PHASE = 0, 1, 2

Node = int
"""A node of a program: its number."""


@dataclass
class Program:
    """A growing graph of operations over named leaves."""

    operations: list[str] = field(default_factory=list)
    arguments: list[tuple[Node, ...]] = field(default_factory=list)
    phases: list[int] = field(default_factory=list)
    labels: dict[Node, str] = field(default_factory=dict)
    _known: dict[tuple[object, ...], Node] = field(default_factory=dict)
    _values: dict[Node, float] = field(default_factory=dict)

    def _node(self, operation: str, arguments: tuple[Node, ...], phase: int, key: object = None) -> Node:
        identity = (operation, arguments, key)
        if identity not in self._known:
            self._known[identity] = len(self.operations)
            self.operations.append(operation)
            self.arguments.append(arguments)
            self.phases.append(phase)
        return self._known[identity]

    def leaf(self, name: str, phase: int) -> Node:
        """Return a named value that comes from outside."""
        node = self._node("leaf", (), phase, name)
        self.labels[node] = name
        return node

    def number(self, value: float) -> Node:
        """Return a constant."""
        node = self._node("number", (), SETUP_PHASE, float(value))
        self._values[node] = float(value)
        return node

    def value(self, node: Node) -> float | None:
        """Return a constant's value, None for anything else."""
        return self._values.get(node)

    def label(self, node: Node, name: str) -> Node:
        """Name a node in the printed source (the first name stays)."""
        if self.operations[node] not in ("leaf", "number"):
            self.labels.setdefault(node, name)
        return node

    def apply(self, operation: str, *arguments: Node) -> Node:
        """Return a function of nodes: min, max, abs, sqrt, sign, step."""
        return self._node(operation, arguments, max([self.phases[item] for item in arguments]))

    def _is_plain(self, node: Node) -> bool:
        """Whether no rule of arithmetic is for this node: it is no number and has no sign."""
        return node not in self._values and self.operations[node] != "neg"

    def _commuted(self, operation: str, left: Node, right: Node) -> Node:
        return self.apply(operation, left, right) if left <= right else self.apply(operation, right, left)

    def add(self, left: Node, right: Node) -> Node:
        """Return left + right."""
        if self._is_plain(left) and self._is_plain(right):
            return self._commuted("+", left, right)
        if self.value(left) == 0.0:
            return right
        if self.value(right) == 0.0:
            return left
        if self.operations[right] == "neg":
            return self.subtract(left, self.arguments[right][0])
        if self.operations[left] == "neg":
            return self.subtract(right, self.arguments[left][0])
        if (a := self.value(left)) is not None and (b := self.value(right)) is not None:
            return self.number(a + b)
        return self._commuted("+", left, right)

    def subtract(self, left: Node, right: Node) -> Node:
        """Return left - right."""
        if self.value(right) == 0.0:
            return left
        if self.value(left) == 0.0:
            return self.negate(right)
        if self.operations[right] == "neg":
            return self.add(left, self.arguments[right][0])
        if (a := self.value(left)) is not None and (b := self.value(right)) is not None:
            return self.number(a - b)
        return self.apply("-", left, right)

    def negate(self, node: Node) -> Node:
        """Return -node."""
        if self.operations[node] == "neg":
            return self.arguments[node][0]
        if (value := self.value(node)) is not None:
            return self.number(-value)
        return self.apply("neg", node)

    def multiply(self, left: Node, right: Node) -> Node:
        """Return left * right; signs move outwards, so that sums can take them."""
        if self._is_plain(left) and self._is_plain(right):
            return self._commuted("*", left, right)
        for one, other in ((left, right), (right, left)):
            if (value := self.value(one)) in (0.0, 1.0, -1.0):
                return self.number(0.0) if value == 0.0 else other if value == 1.0 else self.negate(other)
            if self.operations[one] == "neg":
                return self.negate(self.multiply(self.arguments[one][0], other))
            if value is not None and value < 0:
                return self.negate(self.multiply(self.number(-value), other))
        if (a := self.value(left)) is not None and (b := self.value(right)) is not None:
            return self.number(a * b)
        return self._commuted("*", left, right)

    def divide(self, left: Node, right: Node) -> Node:
        """Return left / right."""
        if self.value(left) == 0.0 or self.value(right) == 1.0:
            return left
        if self.operations[left] == "neg":
            return self.negate(self.divide(self.arguments[left][0], right))
        return self.apply("/", left, right)

    def total(self, terms: list[Node]) -> Node:
        """Return the sum of the terms: positive ones first, so that no sum starts with a minus."""
        ordered = sorted(terms, key=lambda term: self.operations[term] == "neg")
        result = self.number(0.0)
        for term in ordered:
            result = self.add(result, term)
        return result

    def reach(self, results: Iterable[Node]) -> list[Node]:
        """Return what a loop computes or reads for its results, ascending: all that they need and SETUP does not know."""
        found: set[Node] = set()
        stack = list(results)
        while stack:
            node = stack.pop()
            if node not in found and self.phases[node] != SETUP_PHASE:
                found.add(node)
                stack.extend(self.arguments[node])
        return sorted(found)

    def cost(self, results: Iterable[Node]) -> tuple[int, int]:
        """Return how many operations the results need in a loop, and how many instructions where products are fused with sums."""
        nodes = [node for node in self.reach(results) if self.operations[node] != "leaf"]
        uses = Counter(argument for node in nodes for argument in self.arguments[node])
        fused = sum(
            self.operations[node] in "+-" and any(self.operations[item] == "*" and uses[item] == 1 for item in self.arguments[node])
            for node in nodes
        )
        return len(nodes), len(nodes) - fused

    def dot(self, pairs: list[tuple[Node, Node]]) -> Node:
        """Return the sum of products."""
        return self.total([self.multiply(left, right) for left, right in pairs])

    def convert(self, expression: sp.Expr, symbols: Mapping[sp.Symbol, Node], memo: dict[sp.Expr, Node] | None = None) -> Node:
        """Add a sympy expression to the program."""
        memo = {} if memo is None else memo
        if expression in memo:
            return memo[expression]
        memo[expression] = node = self._convert(expression, symbols, memo)
        return node

    def _convert(self, expression: sp.Expr, symbols: Mapping[sp.Symbol, Node], memo: dict[sp.Expr, Node]) -> Node:
        if expression.is_Symbol:
            return symbols[expression]
        if expression.is_Number:
            return self.number(float(expression))
        if expression.is_Pow:
            return self._power(self.convert(expression.base, symbols, memo), float(expression.exp))
        if isinstance(expression, sp.Heaviside):
            return self.apply("step", self.convert(expression.args[0], symbols, memo))
        arguments = [self.convert(argument, symbols, memo) for argument in expression.args]
        if expression.is_Add:
            return self.total(arguments)
        if expression.is_Mul:
            return self._product(expression, symbols, memo)
        name = {"Abs": "abs", "sign": "sign", "Min": "min", "Max": "max"}[type(expression).__name__]
        result = arguments[0]
        if len(arguments) == 1:
            return self.apply(name, result)
        for argument in arguments[1:]:
            result = self.apply(name, result, argument)
        return result

    def _product(self, expression: sp.Expr, symbols: Mapping[sp.Symbol, Node], memo: dict[sp.Expr, Node]) -> Node:
        top, bottom = self.number(1.0), self.number(1.0)
        for argument in expression.args:
            if argument.is_Pow and argument.exp.is_negative:
                bottom = self.multiply(bottom, self.convert(argument.base ** (-argument.exp), symbols, memo))
            else:
                top = self.multiply(top, self.convert(argument, symbols, memo))
        return self.divide(top, bottom)

    def _power(self, base: Node, exponent: float) -> Node:
        if exponent < 0:
            return self.divide(self.number(1.0), self._power(base, -exponent))
        if exponent == int(exponent):
            result = self.number(1.0)
            for _ in range(int(exponent)):
                result = self.multiply(result, base)
            return result
        if (2 * exponent) == int(2 * exponent):
            return self.multiply(self._power(base, exponent - 0.5), self.apply("sqrt", base))
        return self.apply("**", base, self.number(exponent))
