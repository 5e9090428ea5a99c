"""pyyeti's SolveUnc, one individual at a time (exact for inputs that are linear within a step, through complex modes)."""

from __future__ import annotations

import importlib.util

import numpy as np

from benchmarks.peers.systems import Array, Systems


def available() -> str | None:
    """Return why it cannot run, or None."""
    return None if importlib.util.find_spec("pyyeti") else "pyyeti is not installed (extra `bench`)"


def run(systems: Systems, inputs: Array, dt: float, keep: int) -> Array:
    """Return sensor accelerations, `shape (n_individuals, n_samples, 2)`."""
    from pyyeti import ode

    found = []
    for M, C, K, P, S in zip(systems.M, systems.C, systems.K, systems.P, systems.S, strict=True):
        solution = ode.SolveUnc(M, C, K, dt).tsolve(P @ inputs.T)
        found.append((S @ solution.a)[:, ::keep].T)
    return np.array(found)
