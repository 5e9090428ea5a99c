"""From a System to time histories: assembly of the constant matrices, and a compiled fourth-order Runge-Kutta of fixed step.

Smooth and piecewise-linear laws go through Runge-Kutta as they are. Dry friction is set-valued: over a step its force is a constant
lambda that brings the slip velocity at the end of the step to zero, or +-F where that is not enough (Moreau's time stepping,
doi:10.1007/978-3-7091-2624-0_1); the step is repeated with lambda corrected through the compliance h g M^-1 g' until it no longer changes.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import NDArray

from benchmarks.hidden_effects.generator.laws import FREE_PLAY, LIFTOFF, N_PARAMETERS, law_force
from benchmarks.hidden_effects.generator.system import System, Term

Array = NDArray[np.float64]


@dataclass(frozen=True)
class OutputRow:
    """A channel y = on_q @ q + on_v @ v + on_a @ a."""

    on_q: Array
    on_v: Array
    on_a: Array


@dataclass(frozen=True)
class Assembled:
    """The constant matrices: a = Aq q + Av v + B u + W f(laws), u = [road heights, road rates, forces]."""

    wheels: tuple[str, ...]
    n_forces: int
    Aq: Array
    Av: Array
    B: Array
    G: Array
    Gu: Array
    Gv: Array
    W: Array
    k: Array
    c: Array
    dry: Array
    first: NDArray[np.int64]
    kind: NDArray[np.int64]
    at: NDArray[np.int64]
    parameters: Array
    states: Array


def assemble(system: System, force_terms: list[list[Term]]) -> Assembled:
    """Return the matrices of a system on which generalised forces act along the given terms."""
    mobility, _ = system.mobility()
    wheels = tuple(system.layout.axles)
    n, n_wheels, n_forces = len(system.coordinates), len(wheels), len(force_terms)
    n_inputs = 2 * n_wheels + n_forces
    Aq, Av, B = np.zeros((n, n)), np.zeros((n, n)), np.zeros((n, n_inputs))
    G, Gu, Gv, W, k, c, dry, first, kind, at, parameters, states = [], [], [], [], [], [], [], [0], [], [], [], []
    for element in system.elements.values():
        row = system.row(element.terms)
        w, wd = np.zeros(n_inputs), np.zeros(n_inputs)
        if element.wheel is not None:
            w[wheels.index(element.wheel)] = 1.0
            wd[n_wheels + wheels.index(element.wheel)] = 1.0
        push = -mobility @ row
        Aq += element.k * np.outer(push, row)
        Av += element.c * np.outer(push, row)
        B += np.outer(push, element.k * w + element.c * wd)
        if not element.laws and element.dry == 0.0:
            continue
        for item, value in zip((G, Gu, Gv, W, k, c, dry), (row, w, wd, push, element.k, element.c, element.dry), strict=True):
            item.append(value)
        for law in sorted(element.laws, key=lambda law: law.kind == LIFTOFF):
            kind.append(law.kind)
            at.append(len(states))
            parameters.append(law.parameters + (0.0,) * (N_PARAMETERS - len(law.parameters)))
            states.extend(law.states)
        first.append(len(kind))
    for j, terms in enumerate(force_terms):
        B[:, 2 * n_wheels + j] = mobility @ system.row(terms)

    def table(rows: list[Array], width: int) -> Array:
        return np.ascontiguousarray(np.array(rows, dtype=np.float64).reshape(len(rows), width))

    return Assembled(
        wheels, n_forces, Aq, Av, B, table(G, n), table(Gu, n_inputs), table(Gv, n_inputs), np.ascontiguousarray(table(W, n).T),
        np.array(k), np.array(c), np.array(dry), np.array(first), np.array(kind, dtype=np.int64), np.array(at, dtype=np.int64),
        table(parameters, N_PARAMETERS), np.array(states),
    )  # fmt: skip


def integrate(model: Assembled, u: Array, h: float, outputs: list[OutputRow], q0: Array | None = None, v0: Array | None = None) -> Array:
    """Integrate from (q0, v0), default rest, and return the outputs at every step, `shape (n_steps + 1, n_outputs)`.

    u holds the inputs at every half step, `shape (2 n_steps + 1, n_inputs)`; h is the step [s]. Raises FloatingPointError where the
    motion is not finite.
    """
    n = len(model.Aq)
    q = np.zeros(n) if q0 is None else np.array(q0, dtype=np.float64)
    v = np.zeros(n) if v0 is None else np.array(v0, dtype=np.float64)
    C = np.array([[o.on_q, o.on_v, o.on_a] for o in outputs])
    out = np.zeros(((len(u) - 1) // 2 + 1, len(outputs)))
    m = model
    worst = _run(
        q,
        v,
        m.states.copy(),
        np.ascontiguousarray(u),
        h,
        m.Aq,
        m.Av,
        m.B,
        m.G,
        m.Gu,
        m.Gv,
        m.W,
        m.k,
        m.c,
        m.dry,
        m.first,
        m.kind,
        m.at,
        m.parameters,
        C,
        out,
    )
    if not np.all(np.isfinite(out)):
        raise FloatingPointError("the motion grew without bound: check the effect's values and the step")
    if worst > 1e-6:
        raise FloatingPointError(f"dry friction did not settle within a step (relative change {worst:.1e}): take a smaller step")
    return out


@njit(cache=True, error_model="numpy")
def _rates(q, v, s, u, Aq, Av, B, G, Gu, Gv, W, k, c, first, kind, at, parameters, lam, a, ds):
    for i in range(q.size):
        total = 0.0
        for j in range(q.size):
            total += Aq[i, j] * q[j] + Av[i, j] * v[j]
        for j in range(u.size):
            total += B[i, j] * u[j]
        a[i] = total
    for e in range(k.size):
        d = 0.0
        rate = 0.0
        for j in range(q.size):
            d += G[e, j] * q[j]
            rate += G[e, j] * v[j]
        for j in range(u.size):
            d += Gu[e, j] * u[j]
            rate += Gv[e, j] * u[j]
        force = lam[e]
        linear = k[e] * d + c[e] * rate
        for i in range(first[e], first[e + 1]):
            force += law_force(kind[i], parameters[i], d, rate, s, ds, at[i], linear + force)
        for i in range(q.size):
            a[i] += W[i, e] * force


@njit(cache=True, error_model="numpy")
def _run(q, v, s, u, h, Aq, Av, B, G, Gu, Gv, W, k, c, dry, first, kind, at, parameters, C, out):
    n, n_laws, n_elements, n_states = q.size, kind.size, k.size, s.size
    n_steps = out.shape[0] - 1
    lam, before, new = np.zeros(n_elements), np.zeros(n_elements), np.zeros(n_elements)
    a1, a2, a3, a4 = np.zeros(n), np.zeros(n), np.zeros(n), np.zeros(n)
    d1, d2, d3, d4 = np.zeros(n_states), np.zeros(n_states), np.zeros(n_states), np.zeros(n_states)
    v2, v3, v4, q1, vn, sn = np.zeros(n), np.zeros(n), np.zeros(n), np.zeros(n), np.zeros(n), np.zeros(n_states)
    compliance = np.zeros((n_elements, n_elements))
    any_dry = False
    for e in range(n_elements):
        any_dry = any_dry or dry[e] > 0.0
        for f in range(n_elements):
            for j in range(n):
                compliance[e, f] -= h * G[e, j] * W[j, f]
    worst = 0.0
    for step in range(n_steps + 1):
        before[:] = lam
        last = step == n_steps
        ua, ub, uc = u[2 * step], u[min(2 * step + 1, 2 * n_steps)], u[min(2 * step + 2, 2 * n_steps)]
        change = 1.0
        sweep = 0
        while sweep < 30 and (sweep == 0 or (any_dry and not last and change > 1e-10)):
            sweep += 1
            _rates(q, v, s, ua, Aq, Av, B, G, Gu, Gv, W, k, c, first, kind, at, parameters, lam, a1, d1)
            if last:
                break
            for j in range(n):
                v2[j] = v[j] + 0.5 * h * a1[j]
                q1[j] = q[j] + 0.5 * h * v[j]
            for j in range(n_states):
                sn[j] = s[j] + 0.5 * h * d1[j]
            _rates(q1, v2, sn, ub, Aq, Av, B, G, Gu, Gv, W, k, c, first, kind, at, parameters, lam, a2, d2)
            for j in range(n):
                v3[j] = v[j] + 0.5 * h * a2[j]
                q1[j] = q[j] + 0.5 * h * v2[j]
            for j in range(n_states):
                sn[j] = s[j] + 0.5 * h * d2[j]
            _rates(q1, v3, sn, ub, Aq, Av, B, G, Gu, Gv, W, k, c, first, kind, at, parameters, lam, a3, d3)
            for j in range(n):
                v4[j] = v[j] + h * a3[j]
                q1[j] = q[j] + h * v3[j]
            for j in range(n_states):
                sn[j] = s[j] + h * d3[j]
            _rates(q1, v4, sn, uc, Aq, Av, B, G, Gu, Gv, W, k, c, first, kind, at, parameters, lam, a4, d4)
            for j in range(n):
                q1[j] = q[j] + h / 6.0 * (v[j] + 2.0 * v2[j] + 2.0 * v3[j] + v4[j])
                vn[j] = v[j] + h / 6.0 * (a1[j] + 2.0 * a2[j] + 2.0 * a3[j] + a4[j])
            for j in range(n_states):
                sn[j] = s[j] + h / 6.0 * (d1[j] + 2.0 * d2[j] + 2.0 * d3[j] + d4[j])
            if any_dry:
                change = _settle(vn, uc, G, Gv, compliance, dry, lam, new)
        if any_dry and not last:
            worst = max(worst, change)
        for i in range(out.shape[1]):
            total = 0.0
            for j in range(n):
                acceleration = a1[j]
                for e in range(n_elements):
                    acceleration += 0.5 * W[j, e] * (before[e] - lam[e])
                total += C[i, 0, j] * q[j] + C[i, 1, j] * v[j] + C[i, 2, j] * acceleration
            out[step, i] = total
        if last:
            break
        for i in range(n_laws):
            if kind[i] == FREE_PLAY:
                _follow(i, q, q1, ua, uc, G, Gu, first, at, parameters, sn)
        q[:] = q1
        v[:] = vn
        s[:] = sn
    return worst


@njit(cache=True, error_model="numpy")
def _settle(v, u, G, Gv, compliance, dry, lam, new):
    """Correct the friction forces so that they stop the slip or saturate; return the largest change relative to the force."""
    new[:] = lam
    n = dry.size
    for _ in range(50):
        moved = 0.0
        for e in range(n):
            if dry[e] > 0.0:
                slip = 0.0
                for j in range(v.size):
                    slip += G[e, j] * v[j]
                for j in range(u.size):
                    slip += Gv[e, j] * u[j]
                for f in range(n):
                    slip -= compliance[e, f] * (new[f] - lam[f])
                value = min(max(new[e] + slip / compliance[e, e], -dry[e]), dry[e])
                moved = max(moved, abs(value - new[e]) / dry[e])
                new[e] = value
        if moved < 1e-13:
            break
    change = 0.0
    for e in range(n):
        if dry[e] > 0.0:
            change = max(change, abs(new[e] - lam[e]) / dry[e])
    lam[:] = new
    return change


@njit(cache=True, error_model="numpy")
def _follow(i, q, q1, ua, uc, G, Gu, first, at, parameters, s):
    """Move the joint of a law with free play by the step's travel, between its two contacts."""
    e = 0
    while first[e + 1] <= i:
        e += 1
    step = 0.0
    for j in range(q.size):
        step += G[e, j] * (q1[j] - q[j])
    for j in range(ua.size):
        step += Gu[e, j] * (uc[j] - ua[j])
    half = 0.5 * parameters[i, 1]
    s[at[i]] = min(max(s[at[i]] + step, -half), half)
