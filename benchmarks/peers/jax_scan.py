"""JAX: vmap over individuals, scan over steps, jit, float64."""

from __future__ import annotations

import functools
import importlib.util
from typing import Any

import numpy as np

from benchmarks.peers.systems import Array, Systems


def available() -> str | None:
    """Return why it cannot run, or None."""
    return None if importlib.util.find_spec("jax") else "JAX is not installed (extra `bench`)"


@functools.cache
def _compiled(keep: int) -> Any:
    import jax
    import jax.numpy as jnp

    jax.config.update("jax_enable_x64", True)

    def one(M: Any, C: Any, K: Any, P: Any, S: Any, inputs: Any, dt: Any) -> Any:
        inverse = jnp.linalg.inv(M + dt / 2 * C + dt * dt / 4 * K)

        def step(state: Any, w: Any) -> Any:
            u, v, a = state
            free_u, free_v = u + dt * v + dt * dt / 4 * a, v + dt / 2 * a
            new = inverse @ (P @ w - C @ free_v - K @ free_u)
            return (free_u + dt * dt / 4 * new, free_v + dt / 2 * new, new), None

        def sample(state: Any, w: Any) -> Any:
            state, _ = jax.lax.scan(step, state, w)
            return state, S @ state[2]

        first = jnp.linalg.solve(M, P @ inputs[0])
        zero = jnp.zeros_like(first)
        _, found = jax.lax.scan(sample, (zero, zero, first), inputs[1:].reshape(-1, keep, inputs.shape[1]))
        return jnp.concatenate([(S @ first)[None], found])

    return jax.jit(jax.vmap(one, in_axes=(0, 0, 0, 0, 0, None, None)))


def run(systems: Systems, inputs: Array, dt: float, keep: int) -> Array:
    """Return sensor accelerations, `shape (n_individuals, n_samples, 2)`; the number of steps is a multiple of `keep`."""
    return np.asarray(_compiled(keep)(systems.M, systems.C, systems.K, systems.P, systems.S, inputs, dt))
