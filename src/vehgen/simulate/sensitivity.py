"""Sensitivities of linear responses by direct differentiation (Wu & Li 2023, Eq. 19, for any parameter).

Differentiating M q'' + C q' + K q = F by a parameter p gives the same system for s = dq/dp under the load
    dF/dp - dM/dp q'' - dC/dp q' - dK/dp q,
solved by the same Newmark method for all parameters at once.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from vehgen.codegen import Excitation
from vehgen.errors import InputError, did_you_mean, shown
from vehgen.mechanics.equations_of_motion import EquationsOfMotion
from vehgen.mechanics.rows import SparseMatrix
from vehgen.simulate.exact import channel_values, newmark_states

Array = NDArray[np.float64]


def direct_sensitivities(
    model: EquationsOfMotion, drive: Excitation, names: Sequence[str], decimation: int = 10, values: Mapping[str, float] | None = None
) -> tuple[Array, Array]:
    """Return a response and its derivatives by parameters, exact for the Newmark solution.

    Parameters
    ----------
    model
        A linear model (no force laws).
    drive
        Inputs; parameters that move axles along the road change it, and that part is not included.
    names
        Parameters of `model.parameters`.
    keep
        Every how many steps a sample is kept.
    values
        SI values by parameter name (default: the file's).

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
    forces = drive.inputs @ numeric.P.T + drive.rates @ numeric.Q.T + drive.forces @ numeric.F.T
    q, v, a = newmark_states(numeric, forces, drive.dt)
    response = channel_values(numeric, a, v, q, drive.inputs, drive.rates)[::decimation]
    loads = np.zeros((*q.shape, len(names)))
    derived = [matrix_derivatives(model, name, values) for name in names]
    for i, d in enumerate(derived):
        load = drive.inputs @ d["P"].T + drive.rates @ d["Q"].T + drive.forces @ d["F"].T
        loads[:, :, i] = load - a @ d["M"].T - v @ d["C"].T - q @ d["K"].T
    sq, sv, sa = newmark_states(numeric, loads, drive.dt)
    rows = numeric.outputs
    sensitivities = np.empty((len(names), *response.shape))
    for i, d in enumerate(derived):
        own = sa[:, :, i] @ rows["acceleration"].T + sv[:, :, i] @ rows["velocity"].T + sq[:, :, i] @ rows["displacement"].T
        moved = a @ d["acceleration"].T + v @ d["velocity"].T + q @ d["displacement"].T
        moved += drive.inputs @ d["input"].T + drive.rates @ d["input_rate"].T
        sensitivities[i] = (own + moved)[::decimation]
    return response, sensitivities


def matrix_derivatives(model: EquationsOfMotion, name: str, values: Mapping[str, float]) -> dict[str, Array]:
    """Return the derivatives of all matrices and output rows by a parameter, through the parameters that follow it.

    The keys are those of :class:`vehgen.mechanics.equations_of_motion.NumericModel` (`M`, `C`, `K`, `P`, `Q`, `F`) and of its `outputs`.
    """
    chain: dict[sp.Symbol, sp.Expr] = {sp.Symbol(name, real=True): sp.S.One}
    for symbol, expression in model.definitions:
        chain[symbol] = _total(expression, chain)
    n, width = model.n_dof, len(model.inputs)
    groups: dict[str, tuple[SparseMatrix, tuple[int, int]]] = {
        "M": (model.mass_entries, (n, n)),
        "C": (model.damping_entries, (n, n)),
        "K": (model.stiffness_entries, (n, n)),
        "P": (model.input_entries, (n, width)),
        "Q": (model.input_rate_entries, (n, width)),
        "F": (model.force_entries, (n, len(model.forces))),
    }
    for key, columns in (("acceleration", n), ("velocity", n), ("displacement", n), ("input", width), ("input_rate", width)):
        entries = {(i, j): value for i, channel in enumerate(model.channels) for j, value in getattr(channel, key).items()}
        groups[key] = (entries, (len(model.channels), columns))
    found = {}
    for key, (entries, shape) in groups.items():
        derived = {place: _total(value, chain) for place, value in entries.items()}
        array = np.zeros(shape)
        for place, value in model.evaluate({place: item for place, item in derived.items() if item != 0}, values).items():
            array[place] = value
        found[key] = array
    return found


def _total(expression: sp.Expr, chain: Mapping[sp.Symbol, sp.Expr]) -> sp.Expr:
    return sp.Add(*(sp.diff(expression, symbol) * rate for symbol, rate in chain.items() if rate != 0 and expression.has(symbol)))
