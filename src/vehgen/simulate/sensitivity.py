"""Sensitivities of linear responses by direct differentiation (Wu & Li 2023, Eq. 19, for any parameter).

Differentiating M q'' + C q' + K q = F by a parameter p gives the same system for s = dq/dp under the load
    dF/dp - dM/dp q'' - dC/dp q' - dK/dp q,
solved by the same Newmark method for all parameters at once.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from vehgen.codegen import Excitation
from vehgen.errors import InputError, did_you_mean, shown
from vehgen.mechanics.equations_of_motion import EquationsOfMotion
from vehgen.mechanics.symbols import derivative
from vehgen.simulate.exact import channel_values, newmark_states

Array = NDArray[np.float64]
SensitivityProgress = Callable[[str, int, int], None]
"""Is told a piece of work, and how much of how much is done."""


def direct_sensitivities(
    model: EquationsOfMotion,
    excitation: Excitation,
    names: Sequence[str],
    decimation: int = 10,
    values: Mapping[str, float] | None = None,
    progress: SensitivityProgress | None = None,
) -> tuple[Array, Array]:
    """Return a response and its derivatives by parameters, exact for the Newmark solution.

    Parameters
    ----------
    model
        A linear model (no force laws).
    excitation
        Inputs; parameters that move axles along the road change it, and that part is not included.
    names
        Parameters of `model.parameters`.
    decimation
        Every how many steps a sample is kept.
    values
        SI values by parameter name (default: the file's).
    progress
        Is told of every piece of work how much of how much is done.

    Returns
    -------
    response `shape (n_samples, n_channels)` and derivatives `shape (len(names), n_samples, n_channels)` per SI unit.
    """
    if any(element.laws for element in model.elements):
        raise InputError("direct differentiation is for linear vehicles; this one has force laws (use Simulator.jacobian)")
    for name in names:
        if name not in model.parameters:
            raise InputError(f"no parameter {shown(name)}; {did_you_mean(name, model.parameters)}")
    values = values or model.values()
    numeric = model.numeric(values)
    forces = excitation.inputs @ numeric.P.T + excitation.rates @ numeric.Q.T + excitation.forces @ numeric.F.T
    q, v, a = newmark_states(numeric, forces, excitation.dt)
    response = channel_values(numeric, a, v, q, excitation, excitation.rates)[::decimation]
    loads = np.zeros((*q.shape, len(names)))
    tell = progress or _silent
    derived = []
    for i, name in enumerate(names, 1):
        derived.append(matrix_derivatives(model, name, values))
        tell("derivatives", i, len(names))
    for i, d in enumerate(derived):
        load = excitation.inputs @ d["P"].T + excitation.rates @ d["Q"].T + excitation.forces @ d["F"].T
        loads[:, :, i] = load - a @ d["M"].T - v @ d["C"].T - q @ d["K"].T
    n_steps = len(q) - 1
    sq, sv, sa = newmark_states(numeric, loads, excitation.dt, progress=lambda done, total: tell("sensitivities", done, total))
    tell("sensitivities", n_steps, n_steps)
    rows = numeric.outputs
    sensitivities = np.empty((len(names), *response.shape))
    for i, d in enumerate(derived):
        own = sa[:, :, i] @ rows["acceleration"].T + sv[:, :, i] @ rows["velocity"].T + sq[:, :, i] @ rows["displacement"].T
        moved = a @ d["acceleration"].T + v @ d["velocity"].T + q @ d["displacement"].T
        moved += excitation.inputs @ d["input"].T + excitation.rates @ d["input_rate"].T + excitation.forces @ d["force"].T
        sensitivities[i] = (own + moved)[::decimation]
    return response, sensitivities


def _silent(label: str, done: int, total: int) -> None:
    """Tell nobody."""


def matrix_derivatives(model: EquationsOfMotion, name: str, values: Mapping[str, float]) -> dict[str, Array]:
    """Return the derivatives of all matrices and output rows by a parameter, through the parameters that follow it.

    The keys are those of :class:`vehgen.mechanics.equations_of_motion.NumericModel` (`M`, `C`, `K`, `P`, `Q`, `F`) and of its `outputs`.
    """
    chain, found = chain_of(model, name), {}
    for key, (entries, shape) in {**model.matrix_entries(), **model.output_entries()}.items():
        derived = {place: total_derivative(value, chain) for place, value in entries.items()}
        found[key] = model.evaluate_matrix({place: item for place, item in derived.items() if item != 0}, shape, values)
    return found


def chain_of(model: EquationsOfMotion, name: str) -> dict[sp.Symbol, sp.Expr]:
    """Return the derivatives of a parameter and of all symbols that follow from it."""
    chain: dict[sp.Symbol, sp.Expr] = {sp.Symbol(name, real=True): sp.S.One}
    for symbol, expression in model.definitions:
        rate = total_derivative(expression, chain)
        if rate != 0:
            chain[symbol] = rate
    return chain


def total_derivative(expression: sp.Expr, chain: Mapping[sp.Symbol, sp.Expr]) -> sp.Expr:
    """Return an expression's derivative along the derivatives of its symbols."""
    return sp.Add(*(derivative(expression, symbol) * rate for symbol, rate in chain.items() if expression.has(symbol)))
