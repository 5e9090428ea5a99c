"""A descent of a misfit's sum of squares: residuals and derivatives for the minimiser, each computed once at a point."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from vehgen.fit.bounded import LinearisedPoint, minimise
from vehgen.fit.linearisation import Linearisation, Lineariser
from vehgen.fit.misfit import Misfit
from vehgen.fit.parallel import one_blas_thread
from vehgen.fit.prior_data import PriorData

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]


def descend(
    misfit: Misfit,
    x: Array,
    derive: Lineariser,
    bounds: tuple[Array, Array],
    tolerance: float,
    max_steps: int,
    *,
    priors: Array | None = None,
    prior_data: PriorData | None = None,
    renewed: bool = False,
) -> Array:
    """Return unknowns at which a misfit's sum of squares is least.

    Parameters
    ----------
    misfit, derive
        The misfit, and what linearises it.
    x
        Where to begin, `shape (n_unknowns,)`.
    bounds, tolerance, max_steps
        As :func:`vehgen.fit.bounded.minimise` takes them.
    priors
        Standard deviation of every parameter's prior about the space's start, in the unit cube, `shape (n_parameters,)` (default: none).
    prior_data
        What is known from elsewhere.
    renewed
        End only where derivatives computed anew lead no further, too.
    """
    n, space = misfit.n_parameters, misfit.problem.space
    middle, weights = space.unit(space.start), np.zeros(n) if priors is None else priors**-2.0
    last: list[tuple[Array, list[Complex]]] = []

    def square(x: Array) -> float:
        lines = misfit.whitened_spectrum(x)
        last[:] = [*last[-1:], (x, lines)]
        errors = misfit.split(x)[1]
        total = sum(float(np.vdot(line, line).real) * 2 for line in lines) + float(errors @ errors + weights @ (x[:n] - middle) ** 2)
        return total if prior_data is None else total + float((prior_data.residuals(space.values(x[:n])) ** 2).sum())

    def linearised(x: Array, how: Callable[[Array, list[Complex]], Linearisation] = derive) -> LinearisedPoint:
        lines = next((own for at, own in last if at is x), None) or misfit.whitened_spectrum(x)
        information, gradient = how(x, lines).normal(lines, x)
        information[:n, :n] += np.diag(weights)
        gradient[:n] += weights * (x[:n] - middle)
        if prior_data is not None:
            values = space.values(x[:n])
            slopes = prior_data.jacobian(values) * space.slopes(values)
            information[:n, :n] += slopes.T @ slopes
            gradient[:n] += slopes.T @ prior_data.residuals(values)
        return LinearisedPoint(information, gradient)

    with one_blas_thread():  # small matrices: more threads only wait for one another
        renew = (lambda x: linearised(x, derive.linearise_anew)) if renewed else None
        return minimise(square, linearised, x, bounds, tolerance, max_steps, renew)
