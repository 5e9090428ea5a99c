"""Values of sympy expressions, node by node (no code is generated): one vehicle's in floats, populations' and motions' in numpy."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import reduce
from typing import TYPE_CHECKING, Any

import numpy as np
import sympy as sp
from numpy.typing import NDArray

if TYPE_CHECKING:
    from vehgen.mechanics.equations_of_motion import EquationsOfMotion

Array = NDArray[np.float64]
_NUMPY_FUNCTIONS: dict[str, Callable[..., Any]] = {
    "Abs": np.abs,
    "sign": np.sign,
    "Max": lambda *items: reduce(np.maximum, items),
    "Min": lambda *items: reduce(np.minimum, items),
    "Heaviside": lambda value, _at_zero: np.asarray(value > 0, dtype=np.float64),
}


class ExpressionSteps:
    """Expressions as steps, each of which computes a value once: the entries of matrices share most of theirs.

    Parameters
    ----------
    expressions
        Of sums, products, powers, Abs, sign, Max, Min and Heaviside (0 at 0).
    symbols
        Those whose values are given.
    definitions
        Further symbols, each with an expression of those before it.
    """

    def __init__(
        self, expressions: Iterable[sp.Expr], symbols: Sequence[sp.Symbol], definitions: Iterable[tuple[sp.Symbol, sp.Expr]] = ()
    ) -> None:
        self._steps: list[tuple[str, float | tuple[int, ...]]] = []
        numbers: dict[sp.Expr, int] = {symbol: i for i, symbol in enumerate(symbols)}

        def number(expression: sp.Expr) -> int:
            """Return the number of an expression's value, whose steps are added where they are missing."""
            if expression not in numbers:
                given = float(expression) if expression.is_Number else tuple(number(item) for item in expression.args)
                numbers[expression] = len(symbols) + len(self._steps)
                self._steps.append((type(expression).__name__, given))
            return numbers[expression]

        for symbol, expression in definitions:
            numbers[symbol] = number(expression)
        self._wanted = [number(expression) for expression in expressions]

    def __call__(self, values: Sequence[Any]) -> list[Any]:
        """Return the expressions' values from those of the symbols: numbers, or arrays of shapes that broadcast."""
        found = list(values)
        for kind, given in self._steps:
            if isinstance(given, float):
                found.append(given)
                continue
            arguments = [found[i] for i in given]
            if kind == "Mul":
                found.append(math.prod(arguments))
            elif kind == "Add":
                found.append(sum(arguments))
            elif kind == "Pow":
                found.append(_power(*arguments))
            else:
                found.append(_NUMPY_FUNCTIONS[kind](*arguments))
        return [found[i] for i in self._wanted]


def _power(base: Any, exponent: Any) -> Any:
    if not isinstance(base, np.ndarray):
        return base**exponent
    whole = isinstance(exponent, float) and exponent == int(exponent)
    return np.asarray(base, dtype=np.float64) ** (int(exponent) if whole else exponent)


def evaluate_array(expression: sp.Expr, known: Mapping[sp.Symbol, Array]) -> Array:
    """Return an expression's values, of the shape to which those of its symbols broadcast; see :class:`ExpressionSteps`."""
    (found,) = ExpressionSteps([expression], list(known))(list(known.values()))
    return np.asarray(found, dtype=np.float64)


class PopulationValues:
    """A population's parameters `shape (n_individuals, n_parameters)` [SI], and what follows from them.

    Parameters
    ----------
    model
        Whose parameters they are.
    parameters
        In the order of `model.parameters`.
    """

    def __init__(self, model: EquationsOfMotion, parameters: Array) -> None:
        self.n = len(parameters)
        self._known: dict[sp.Expr, Any] = {sp.Symbol(name, real=True): parameters[:, i] for i, name in enumerate(model.parameters)}
        for symbol, expression in model.definitions:
            self._known[symbol] = self.value(expression)

    def value(self, expression: sp.Expr, more: Mapping[sp.Symbol, Array] | None = None) -> Array:
        """Return an expression's values, `shape (n_individuals,)`; `more` gives values of symbols that are no parameters."""
        known = {**self._known, **more} if more else self._known
        return np.broadcast_to(evaluate_array(expression, known), (self.n,))
