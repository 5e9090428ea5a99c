"""References for linear models that share no code with the kernels.

`exact_response` is exact for inputs that are linear within each step (first-order hold): with x = (q, q') and x' = A x + B u,
    expm([[A dt, B dt, 0], [0, 0, I], [0, 0, 0]]) = [[Ad, G1, G2], ...],   x+ = Ad x + (G1 - G2) u_k + G2 u_{k+1}
(Van Loan, IEEE Trans. Autom. Control 23(3), 1978, doi:10.1109/TAC.1978.1101743). `newmark_response` is the textbook
average-acceleration method with the acceleration as a state, in plain numpy: the oracle of the generated kernels.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
import scipy
from numpy.typing import NDArray

from vehgen.codegen import Excitation
from vehgen.mechanics.equations_of_motion import EquationsOfMotion
from vehgen.mechanics.numeric_model import NumericModel

Array = NDArray[np.float64]
StepProgress = Callable[[int, int], None]
"""Is told how many steps of how many are done."""
STEPS_BETWEEN_REPORTS = 200


def exact_response(
    model: EquationsOfMotion,
    excitation: Excitation,
    decimation: int = 1,
    values: Mapping[str, float] | None = None,
    initial: Array | None = None,
) -> Array:
    """Return the response exact to first-order-hold inputs, `shape (n_steps // decimation + 1, n_channels)`.

    The rates of the displacement inputs are taken as the slopes of that hold (the mean of both sides at a sample).
    """
    numeric = model.numeric(values)
    n, width = model.n_dof, len(model.inputs)
    inverse = np.linalg.inv(numeric.M)
    A, B = numeric.state_matrices()
    m = B.shape[1]
    big = np.zeros((2 * n + 2 * m, 2 * n + 2 * m))
    big[: 2 * n, : 2 * n], big[: 2 * n, 2 * n : 2 * n + m] = A * excitation.dt, B * excitation.dt
    big[2 * n : 2 * n + m, 2 * n + m :] = np.eye(m)
    transition = scipy.linalg.expm(big)
    Ad, G1, G2 = transition[: 2 * n, : 2 * n], transition[: 2 * n, 2 * n : 2 * n + m], transition[: 2 * n, 2 * n + m :]
    slope = np.diff(excitation.inputs, axis=0) / excitation.dt
    start = np.hstack([excitation.inputs[:-1], slope, excitation.forces[:-1]])
    end = np.hstack([excitation.inputs[1:], slope, excitation.forces[1:]])
    x = np.zeros((excitation.n_steps + 1, 2 * n))
    if initial is not None:
        x[0] = initial
    push = start @ (G1 - G2).T + end @ G2.T
    for k in range(excitation.n_steps):
        x[k + 1] = Ad @ x[k] + push[k]
    rates = np.vstack([slope[:1], (slope[1:] + slope[:-1]) / 2, slope[-1:]]) if excitation.n_steps else np.zeros((1, width))
    q, v = x[:, :n], x[:, n:]
    forces = excitation.inputs @ numeric.P.T + rates @ numeric.Q.T + excitation.forces @ numeric.F.T
    a = (forces - v @ numeric.C.T - q @ numeric.K.T) @ inverse.T
    return channel_values(numeric, a, v, q, excitation, rates)[::decimation]


def newmark_response(
    model: EquationsOfMotion,
    excitation: Excitation,
    decimation: int = 1,
    values: Mapping[str, float] | None = None,
    initial: Array | None = None,
) -> Array:
    """Return the response by textbook Newmark (beta 1/4, gamma 1/2), `shape (n_steps // decimation + 1, n_channels)`."""
    numeric = model.numeric(values)
    forces = excitation.inputs @ numeric.P.T + excitation.rates @ numeric.Q.T + excitation.forces @ numeric.F.T
    q, v, a = newmark_states(numeric, forces, excitation.dt, initial)
    return channel_values(numeric, a, v, q, excitation, excitation.rates)[::decimation]


def newmark_states(
    numeric: NumericModel, forces: Array, dt: float, initial: Array | None = None, progress: StepProgress | None = None
) -> tuple[Array, Array, Array]:
    """Return displacements, velocities and accelerations under forces `shape (n_steps + 1, n_dof)` or `(n_steps + 1, n_dof, n_cases)`.

    `progress` is told now and then how many steps of how many are done.
    """
    h, n = dt, forces.shape[1]
    effective = scipy.linalg.lu_factor(numeric.M + h / 2 * numeric.C + h * h / 4 * numeric.K)
    q, v, a = (np.zeros_like(forces) for _ in range(3))
    if initial is not None:
        q[0], v[0] = initial[:n], initial[n:]
    a[0] = np.linalg.solve(numeric.M, forces[0] - numeric.C @ v[0] - numeric.K @ q[0])
    for k in range(len(forces) - 1):
        if progress is not None and k % STEPS_BETWEEN_REPORTS == 0:
            progress(k, len(forces) - 1)
        q_free = q[k] + h * v[k] + h * h / 4 * a[k]
        v_free = v[k] + h / 2 * a[k]
        a[k + 1] = scipy.linalg.lu_solve(effective, forces[k + 1] - numeric.C @ v_free - numeric.K @ q_free)
        v[k + 1] = v_free + h / 2 * a[k + 1]
        q[k + 1] = q_free + h * h / 4 * a[k + 1]
    return q, v, a


def channel_values(numeric: NumericModel, a: Array, v: Array, q: Array, excitation: Excitation, rates: Array) -> Array:
    """Return the channels' values over time, `shape (n_steps + 1, n_channels)`; `rates` are those of the displacement inputs."""
    rows = numeric.outputs
    return np.asarray(
        a @ rows["acceleration"].T
        + v @ rows["velocity"].T
        + q @ rows["displacement"].T
        + excitation.inputs @ rows["input"].T
        + rates @ rows["input_rate"].T
        + excitation.forces @ rows["force"].T
    )
