"""What moves a vehicle, step by step."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Excitation:
    """What moves a vehicle, at the ends of every step of `dt` [s].

    `inputs`, `rates` `shape (n_steps + 1, n_inputs)`: displacement inputs [m] and their rates [m/s]; `forces` `shape (n_steps + 1,
    n_forces)` [N]. All three may have an axis more ahead, of individuals each with inputs of its own.
    """

    dt: float
    inputs: Array
    rates: Array
    forces: Array

    @property
    def n_steps(self) -> int:
        """Number of time steps."""
        return int(self.inputs.shape[-2]) - 1

    @property
    def time(self) -> Array:
        """Times of the inputs [s]."""
        return np.arange(self.n_steps + 1, dtype=np.float64) * self.dt

    @property
    def nbytes(self) -> int:
        """Size of its arrays [bytes]."""
        return int(self.inputs.nbytes + self.rates.nbytes + self.forces.nbytes)
