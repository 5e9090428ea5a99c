"""scipy.signal.lsim on the state space, one individual at a time (exact for inputs that are linear within a step)."""

from __future__ import annotations

import numpy as np
import scipy.signal

from benchmarks.peers.systems import Array, Systems


def available() -> str | None:
    """Return why it cannot run, or None."""
    return None


def run(systems: Systems, inputs: Array, dt: float, keep: int) -> Array:
    """Return sensor accelerations, `shape (n_individuals, n_samples, 2)`."""
    found = []
    time = np.arange(len(inputs)) * dt
    n = systems.M.shape[1]
    for M, C, K, P, S in zip(systems.M, systems.C, systems.K, systems.P, systems.S, strict=True):
        inverse = np.linalg.inv(M)
        A = np.block([[np.zeros((n, n)), np.eye(n)], [-inverse @ K, -inverse @ C]])
        B = np.vstack([np.zeros((n, P.shape[1])), inverse @ P])
        out = S @ np.hstack([-inverse @ K, -inverse @ C])
        _, y, _ = scipy.signal.lsim((A, B, out, S @ inverse @ P), inputs, time)
        found.append(y[::keep])
    return np.array(found)
