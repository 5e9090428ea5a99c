"""Values of sympy expressions, node by node (no code is generated): one vehicle's in floats, populations' and motions' in numpy."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
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


@dataclass(frozen=True)
class _Arithmetic:
    """How values of one kind are added, multiplied and raised to a power."""

    add: Callable[[Sequence[Any]], Any]
    multiply: Callable[[Sequence[Any]], Any]
    power: Callable[[Any, Any], Any]


def _power_of_arrays(base: Any, exponent: Any) -> Any:
    whole = isinstance(exponent, float) and exponent == int(exponent)
    return np.asarray(base, dtype=np.float64) ** (int(exponent) if whole else exponent)


_FLOATS = _Arithmetic(sum, math.prod, lambda base, exponent: float(base**exponent))
_ARRAYS = _Arithmetic(lambda items: reduce(np.add, items), lambda items: reduce(np.multiply, items), _power_of_arrays)


def _walk(expression: sp.Expr, known: Mapping[sp.Expr, Any], arithmetic: _Arithmetic) -> Any:
    if expression in known:
        return known[expression]
    if expression.is_Number:
        return float(expression)
    arguments = [_walk(argument, known, arithmetic) for argument in expression.args]
    if expression.is_Add:
        return arithmetic.add(arguments)
    if expression.is_Mul:
        return arithmetic.multiply(arguments)
    if expression.is_Pow:
        return arithmetic.power(*arguments)
    return _NUMPY_FUNCTIONS[type(expression).__name__](*arguments)


def evaluate_number(expression: sp.Expr, known: Mapping[sp.Symbol, float]) -> float:
    """Return an expression's value.

    Parameters
    ----------
    expression
        Of sums, products, powers, Abs, sign, Max, Min and Heaviside (0 at 0).
    known
        The value of each of its symbols.
    """
    return float(_walk(expression, known, _FLOATS))


def evaluate_array(expression: sp.Expr, known: Mapping[sp.Symbol, Array]) -> Array:
    """Return an expression's values, of the shape to which those of its symbols broadcast; see :func:`evaluate_number`."""
    return np.asarray(_walk(expression, known, _ARRAYS), dtype=np.float64)


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
