"""Programs printed as statements of C99, from the same graph that kernels are printed from."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import ClassVar

from vehgen.codegen.printing import PythonPrinter
from vehgen.codegen.program import Node

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
