"""Nonlinear vehicles integrated by scipy at tight tolerance, with the laws written out again and dry friction by events."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial

import numpy as np
from scipy.integrate import solve_ivp


@dataclass
class Branch:
    """One element with a law: its travel row, input row, force(d, v, s), rates of its states, bound of dry friction and what it is about.

    With `bound`, its one state is the force of an elasto-plastic element (see `integrate_plastic`).
    """

    row: np.ndarray
    inputs: np.ndarray
    force: Callable = lambda d, v, s: 0.0
    rates: Callable = lambda d, v, s: np.zeros(0)
    n_states: int = 0
    friction: float = 0.0
    middle: float = 0.0
    bound: float = 0.0
    mode: int = field(default=0)


def integrate(numeric, branches: list[Branch], road: Callable, times: np.ndarray, breaks: list[float]) -> tuple[np.ndarray, np.ndarray]:
    """Return displacements and accelerations at `times`; `road(t)` gives inputs and their rates; integration restarts at `breaks`."""
    n = len(numeric.M)
    inverse = np.linalg.inv(numeric.M)
    counts = [branch.n_states for branch in branches]
    slots = np.cumsum([2 * n, *counts])
    rough = [branch for branch in branches if branch.friction > 0]
    J = np.array([branch.row for branch in rough]).reshape(len(rough), n)

    def smooth(t, x):
        w, dw = road(t)
        q, v = x[:n], x[n : 2 * n]
        force = numeric.P @ w + numeric.Q @ dw - numeric.K @ q - numeric.C @ v
        rates = []
        for branch, first, last in zip(branches, slots[:-1], slots[1:], strict=True):
            d, rate, s = branch.row @ q + branch.inputs @ w, branch.row @ v + branch.inputs @ dw, x[first:last]
            force = force - branch.row * branch.force(d, rate, s)
            rates.append(branch.rates(d, rate, s))
        return force, np.concatenate([*rates, np.zeros(0)])

    def friction(force):
        """Sliding branches pull with their bound; sticking ones with what keeps them still."""
        pull = np.array([branch.mode * branch.friction + branch.middle for branch in rough])
        still = [i for i, branch in enumerate(rough) if branch.mode == 0]
        if still:
            S, pull[still] = J[still], 0.0
            pull[still] = np.linalg.solve(S @ inverse @ S.T, S @ inverse @ (force - J.T @ pull))
        return pull

    def field_(t, x):
        force, rates = smooth(t, x)
        if rough:
            force = force - J.T @ friction(force)
        return np.concatenate([x[n : 2 * n], inverse @ force, rates])

    def beyond(t, x, i):
        """What keeps a sticking branch still, from the middle of its bounds."""
        return friction(smooth(t, x)[0])[i] - rough[i].middle

    def slips_on(t, x, i):
        return J[i] @ x[n : 2 * n] * rough[i].mode + 1e-12

    def holds(t, x, i):
        return rough[i].friction - abs(beyond(t, x, i))

    def events():
        found = [partial(slips_on if branch.mode else holds, i=i) for i, branch in enumerate(rough)]
        for event in found:
            event.terminal, event.direction = True, -1
        return found

    x, t = np.zeros(slots[-1]), times[0]
    q_out, a_out = np.zeros((len(times), n)), np.zeros((len(times), n))
    ends = [*sorted(b for b in breaks if times[0] < b < times[-1]), times[-1]]
    while t < times[-1] - 1e-12:
        end = next(b for b in ends if b > t + 1e-12)
        solution = solve_ivp(
            field_, (t, end), x, method="DOP853", rtol=1e-7, atol=1e-10, max_step=0.02, dense_output=True, events=events() or None
        )
        reached = solution.t[-1]
        for k in np.flatnonzero((times >= t) & (times <= reached)):
            y = solution.sol(times[k])
            q_out[k], a_out[k] = y[:n], field_(times[k], y)[n : 2 * n]
        t, x = reached, solution.y[:, -1].copy()
        if solution.status == 1:
            hit = next(i for i, when in enumerate(solution.t_events) if len(when))
            if rough[hit].mode:
                rough[hit].mode = 0
                x[n : 2 * n] -= inverse @ J[hit] * (J[hit] @ x[n : 2 * n]) / (J[hit] @ inverse @ J[hit])
                if abs(beyond(t, x, hit)) > rough[hit].friction:
                    rough[hit].mode = int(np.sign(beyond(t, x, hit)))
            else:
                rough[hit].mode = int(np.sign(beyond(t, x, hit)))
    return q_out, a_out


def integrate_plastic(numeric, branches: list[Branch], road: Callable, times: np.ndarray, substeps: int) -> tuple[np.ndarray, np.ndarray]:
    """As `integrate`, for elasto-plastic branches: explicit midpoint steps with the state clipped to +-bound (return mapping)."""
    n = len(numeric.M)
    inverse = np.linalg.inv(numeric.M)
    rows, inputs = np.array([b.row for b in branches]), np.array([b.inputs for b in branches])
    bounds = np.array([b.bound for b in branches])
    stiffness = np.array([b.rates(0.0, 1.0, np.zeros(1))[0] for b in branches])

    def acceleration(t, q, v, s):
        w, dw = road(t)
        return inverse @ (numeric.P @ w + numeric.Q @ dw - numeric.K @ q - numeric.C @ v - rows.T @ s)

    q, v, s = np.zeros(n), np.zeros(n), np.zeros(len(branches))
    q_out, a_out = np.zeros((len(times), n)), np.zeros((len(times), n))
    dt = (times[1] - times[0]) / substeps
    for k, t0 in enumerate(times):
        q_out[k], a_out[k] = q, acceleration(t0, q, v, s)
        if k == len(times) - 1:
            break
        for i in range(substeps):
            t = t0 + i * dt
            q_mid, v_mid = q + dt / 2 * v, v + dt / 2 * acceleration(t, q, v, s)
            pull = stiffness * (rows @ v_mid + inputs @ road(t + dt / 2)[1])
            s_mid = np.clip(s + dt / 2 * pull, -bounds, bounds)
            q, v, s = q + dt * v_mid, v + dt * acceleration(t + dt / 2, q_mid, v_mid, s_mid), np.clip(s + dt * pull, -bounds, bounds)
    return q_out, a_out
