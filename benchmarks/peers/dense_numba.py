"""The loop that a user would write first: dense Newmark, one individual at a time, compiled by numba."""

from __future__ import annotations

import numba
import numpy as np

from benchmarks.peers.systems import Array, Systems


def available() -> str | None:
    """Return why it cannot run, or None."""
    return None


@numba.njit(cache=True, nogil=True)
def _newmark(M, C, K, P, S, inputs, dt, keep, out):
    n, steps = M.shape[0], inputs.shape[0] - 1
    inverse = np.linalg.inv(M + dt / 2 * C + dt * dt / 4 * K)
    u, v, a = np.zeros(n), np.zeros(n), np.linalg.solve(M, P @ inputs[0])
    free_u, free_v, force = np.zeros(n), np.zeros(n), np.zeros(n)
    for step in range(steps + 1):
        if step % keep == 0:
            for j in range(S.shape[0]):
                total = 0.0
                for i in range(n):
                    total += S[j, i] * a[i]
                out[step // keep, j] = total
        if step == steps:
            break
        for i in range(n):
            free_u[i] = u[i] + dt * v[i] + dt * dt / 4 * a[i]
            free_v[i] = v[i] + dt / 2 * a[i]
        for i in range(n):
            total = 0.0
            for j in range(inputs.shape[1]):
                total += P[i, j] * inputs[step + 1, j]
            for j in range(n):
                total -= C[i, j] * free_v[j] + K[i, j] * free_u[j]
            force[i] = total
        for i in range(n):
            total = 0.0
            for j in range(n):
                total += inverse[i, j] * force[j]
            a[i] = total
            v[i] = free_v[i] + dt / 2 * total
            u[i] = free_u[i] + dt * dt / 4 * total


def run(systems: Systems, inputs: Array, dt: float, keep: int) -> Array:
    """Return sensor accelerations, `shape (n_individuals, n_samples, 2)`."""
    out = np.empty((len(systems.M), (len(inputs) - 1) // keep + 1, systems.S.shape[1]))
    for i in range(len(systems.M)):
        _newmark(systems.M[i], systems.C[i], systems.K[i], systems.P[i], systems.S[i], inputs, dt, keep, out[i])
    return out
