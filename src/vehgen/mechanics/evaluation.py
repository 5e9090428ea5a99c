"""Values of sympy expressions for whole populations, in numpy."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import reduce
from typing import Any

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from vehgen.mechanics.equations_of_motion import EquationsOfMotion

Array = NDArray[np.float64]
_NUMPY_FUNCTIONS: dict[str, Callable[..., Any]] = {
    "Abs": np.abs,
    "sign": np.sign,
    "Max": lambda *items: reduce(np.maximum, items),
    "Min": lambda *items: reduce(np.minimum, items),
    "Heaviside": lambda value, _at_zero: np.asarray(value > 0, dtype=np.float64),
}


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
        return np.broadcast_to(np.asarray(_value(expression, known), dtype=np.float64), (self.n,))


def _value(expression: sp.Expr, known: Mapping[sp.Expr, Any]) -> Any:
    if expression in known:
        return known[expression]
    if expression.is_Number:
        return float(expression)
    arguments = [_value(argument, known) for argument in expression.args]
    if expression.is_Add:
        return reduce(np.add, arguments)
    if expression.is_Mul:
        return reduce(np.multiply, arguments)
    if expression.is_Pow:
        exponent = arguments[1]
        whole = isinstance(exponent, float) and exponent == int(exponent)
        return np.asarray(arguments[0], dtype=np.float64) ** (int(exponent) if whole else exponent)
    return _NUMPY_FUNCTIONS[type(expression).__name__](*arguments)
