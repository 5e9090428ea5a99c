"""Textbook Newmark on dense matrices, one individual at a time, compiled with numba.

Average acceleration (beta = 1/4, gamma = 1/2) in displacement form, as in Bathe, Finite Element Procedures, Table 9.3: effective
stiffness inverted once, displacement, velocity and acceleration carried along.
"""

from __future__ import annotations

import importlib.util

import numpy as np
from systems import Array, Systems, n_kept

TITLE = "numba, dense textbook Newmark"


def available() -> str | None:
    """Return why this peer cannot run, or None."""
    return None if importlib.util.find_spec("numba") else "numba is not installed"


def run(systems: Systems, inputs: Array, dt: float, keep: int, threads: int = 1) -> Array:
    """Return the accelerations at the sensors, `shape (n_individuals, n_kept, n_sensors)`."""
    import _dense_numba_kernel as kernel

    out = np.empty((len(systems), n_kept(inputs, keep), systems.S.shape[1]))
    advance = kernel.advance_serial if threads == 1 else kernel.advance_parallel
    a0 = 4.0 / dt**2
    inverse = np.linalg.inv(a0 * systems.M + 2.0 / dt * systems.C + systems.K)
    advance(systems.M, systems.C, systems.K, systems.P, systems.S, inverse, np.ascontiguousarray(inputs), dt, keep, out)
    return out
