"""The matrices of the equations of motion in numbers."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class NumericModel:
    """The model's matrices at parameter values, SI units.

    M, C, K `shape (n_dof, n_dof)`; P, Q `shape (n_dof, n_inputs)`; F `shape (n_dof, n_forces)`; `weight shape (n_dof,)` the generalised
    gravity force [N, N m]; `outputs` the channels' coefficients of acceleration, velocity, displacement `shape (n_channels, n_dof)`,
    input and input_rate `shape (n_channels, n_inputs)`, force `shape (n_channels, n_forces)`.
    """

    M: NDArray[np.float64]
    C: NDArray[np.float64]
    K: NDArray[np.float64]
    P: NDArray[np.float64]
    Q: NDArray[np.float64]
    F: NDArray[np.float64]
    weight: NDArray[np.float64]
    outputs: dict[str, NDArray[np.float64]]

    def state_matrices(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return A and B of x' = A x + B u with x = (q, q') and u = (w, w', f): displacement inputs, their rates, forces."""
        n = len(self.M)
        inverse = np.linalg.inv(self.M)
        A = np.block([[np.zeros((n, n)), np.eye(n)], [-inverse @ self.K, -inverse @ self.C]])
        loads = np.hstack([self.P, self.Q, self.F])
        return A, np.vstack([np.zeros((n, loads.shape[1])), inverse @ loads])
