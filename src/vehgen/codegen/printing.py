"""Programs printed as Python statements inside a loop over lanes, split by phase, or as statements of C99."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterable, Mapping
from typing import ClassVar

from vehgen.codegen.program import SAMPLE_PHASE, SETUP_PHASE, STEP_PHASE, Node, Program
from vehgen.errors import InputError

_BINARY = {"+": 1, "-": 1, "*": 2, "/": 2}
_POWER_STRENGTH = 3
_MAX_INLINE = 90


class PythonPrinter:
    """Prints what given results need of a program, phase by phase.

    A language of the same operators can be printed by a subclass with other `functions` and another :meth:`power`.

    Parameters
    ----------
    program
        The graph.
    results
        The nodes wanted, by phase (STEP_PHASE: the new state; SAMPLE_PHASE: the channels).
    scalar
        A leaf that is the same for all lanes and stays a plain variable: the time step.
    single
        Whether the loops' numbers are of single precision (a plain one would make its expression double); SETUP_PHASE stays double.
    """

    functions: ClassVar[Mapping[str, str]] = {"min": "lower", "max": "upper", "sqrt": "math.sqrt"}
    """What a program's functions are called, where not by their own names."""

    def __init__(self, program: Program, results: dict[int, list[Node]], scalar: Node, single: bool = False) -> None:
        self.scalar, self.single = scalar, single
        self.program = program
        self.results = results
        self.needed = {phase: program.reach(results.get(phase, ())) for phase in (STEP_PHASE, SAMPLE_PHASE)}
        self.constants = self._constants()
        self.setup = self._reach_setup()
        self.operation_counts = {
            "setup": self._count(self.setup),
            "step": self._count(self.needed[STEP_PHASE]),
            "sample": self._count(self.needed[SAMPLE_PHASE]),
        }

    def _constants(self) -> dict[Node, int]:
        """SETUP nodes that the loops use, with their place in the array of constants."""
        used: set[Node] = set()
        for phase in (STEP_PHASE, SAMPLE_PHASE):
            for node in (*self.needed[phase], *self.results.get(phase, ())):
                for item in (*self.program.arguments[node], node):
                    if self.program.phases[item] == SETUP_PHASE and self.program.operations[item] != "number" and item != self.scalar:
                        used.add(item)
        return {node: place for place, node in enumerate(sorted(used))}

    def _reach_setup(self) -> list[Node]:
        found: set[Node] = set()
        stack = list(self.constants)
        while stack:
            node = stack.pop()
            if node not in found:
                found.add(node)
                stack.extend(self.program.arguments[node])
        return sorted(found)

    def _count(self, nodes: Iterable[Node]) -> int:
        return sum(self.program.operations[node] not in ("leaf", "number") for node in nodes)

    def number(self, value: float) -> str:
        """Return a constant as it stands in the loops; raises InputError for one that is not finite."""
        return f"float32({literal(value)})" if self.single else literal(value)

    def name(self, node: Node) -> str:
        """Return a node's name in the source."""
        return self.program.labels.get(node, f"x{node}")

    def statements(
        self, nodes: list[Node], targets: Iterable[Node], load: Callable[[Node], str | None]
    ) -> tuple[list[str], dict[Node, str]]:
        """Return assignments for the nodes in order, and how each node is written after them.

        Values used once are written where they are used.

        Parameters
        ----------
        nodes
            What to compute, ascending.
        targets
            Nodes that must end up in a variable.
        load
            How a leaf (or a constant from SETUP_PHASE) is read; None for what is already a variable.
        """
        own = set(nodes)
        in_loop = any(self.program.phases[node] != SETUP_PHASE for node in nodes)
        uses: Counter[Node] = Counter()
        for node in nodes:
            uses.update(dict.fromkeys(self.program.arguments[node], 0))
            for argument in self.program.arguments[node]:
                uses[argument] += 1
        wanted = set(targets)
        texts: dict[Node, tuple[str, int]] = {}
        lines: list[str] = []

        def read(node: Node) -> tuple[str, int]:
            if node in texts:
                return texts[node]
            value = self.program.value(node)
            if value is not None:
                number = self.number(value) if in_loop else literal(value)
                texts[node] = (number if value >= 0 else f"({number})", 9)
                return texts[node]
            source = load(node)
            if source is not None and uses[node] > 1:
                lines.append(f"{self.name(node)} = {source}")
                source = None
            texts[node] = (source or self.name(node), 9)
            return texts[node]

        for node in nodes:
            if self.program.operations[node] in ("leaf", "number"):
                continue
            text, strength = self._expression(node, [read(argument) for argument in self.program.arguments[node]])
            inline = uses[node] == 1 and node not in wanted and node not in self.program.labels and len(text) < _MAX_INLINE
            if inline and node in own:
                texts[node] = (text, strength)
            else:
                lines.append(f"{self.name(node)} = {text}")
                texts[node] = (self.name(node), 9)
        for node in wanted:
            if node not in texts:  # a leaf, a number, or what SETUP_PHASE knows
                texts[node] = read(node)
        return lines, {node: text for node, (text, _) in texts.items()}

    def _expression(self, node: Node, arguments: list[tuple[str, int]]) -> tuple[str, int]:
        operation = self.program.operations[node]
        if operation == "**":
            return self.power(*arguments)
        if operation in _BINARY:
            strength = _BINARY[operation]
            (left, left_strength), (right, right_strength) = arguments
            left = f"({left})" if left_strength < strength else left
            tight = right_strength < strength or (right_strength == strength and operation in "-/")
            right = f"({right})" if tight else right
            blank = "" if strength > 1 else " "
            return f"{left}{blank}{operation}{blank}{right}", strength
        texts = [text for text, _ in arguments]
        if operation == "neg":
            return f"-{texts[0]}" if arguments[0][1] >= 2 else f"-({texts[0]})", 1
        return f"{self.functions.get(operation, operation)}({', '.join(texts)})", 9

    def power(self, base: tuple[str, int], exponent: tuple[str, int]) -> tuple[str, int]:
        """Return a power and how strongly it binds, of a base and an exponent with theirs."""
        left = f"({base[0]})" if base[1] <= _POWER_STRENGTH else base[0]  # a power of a power, too: ** binds to the right
        right = f"({exponent[0]})" if exponent[1] < _POWER_STRENGTH else exponent[0]
        return f"{left}**{right}", _POWER_STRENGTH


def literal(value: float) -> str:
    """Return a number as Python reads it back, digit for digit.

    Raises
    ------
    InputError
        For infinity and NaN, which would stand in the source as names.
    """
    if not math.isfinite(value):
        raise InputError("the equations hold a number that is not finite: some quantities of the vehicle are out of any scale")
    return repr(float(value))


C_HELPERS = {
    "lower": "static double lower(double a, double b) { return a < b ? a : b; }",
    "upper": "static double upper(double a, double b) { return a > b ? a : b; }",
    "step": "static double step(double value) { return value > 0.0 ? 1.0 : 0.0; }",
    "sign": "static double sign(double value) { return value > 0.0 ? 1.0 : value < 0.0 ? -1.0 : 0.0; }",
}
"""Functions of programs that the library of C lacks; they are what kernels mean by them."""


class CPrinter(PythonPrinter):
    """Prints what given results need of a program as declarations `const double NAME = EXPRESSION;`."""

    functions: ClassVar[Mapping[str, str]] = {"min": "lower", "max": "upper", "abs": "fabs"}

    def power(self, base: tuple[str, int], exponent: tuple[str, int]) -> tuple[str, int]:
        """Return a power as a call of the library."""
        return f"pow({base[0]}, {exponent[0]})", 9

    def block(self, nodes: list[Node], results: list[Node], target: str, load: Callable[[Node], str | None]) -> list[str]:
        """Return the lines that compute nodes and then store results in the array `target`; `load` as in :meth:`statements`."""
        lines, texts = self.statements(nodes, results, load)
        declared = [f"const double {line};" for line in lines]
        return [*declared, *(f"{target}[{place}] = {texts[node]};" for place, node in enumerate(results))]
