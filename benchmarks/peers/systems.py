"""The population that every peer simulates: Table A2's five-axle vehicle (Wu & Li 2023, doi:10.3390/s23249691), written out by hand."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
MASS = 8000.0
TABLE = {
    "mS": 4.77, "m1": 0.11, "m2": 0.40, "m3": 0.48, "m4": 0.57, "m5": 0.34, "IT": 45.75, "IS": 95.89,
    "k1": 198.83, "k2": 93.02, "k3": 869.88, "k4": 537.26, "k5": 1313.27,
    "c1": 12.57, "c2": 33.04, "c3": 6.80, "c4": 36.52, "c5": 23.60,
    "kt1": 1460.53, "kt2": 4488.70, "kt3": 4360.85, "kt4": 2689.24, "kt5": 808.00,
}  # fmt: skip
GEOMETRY = {"a1": 0.97, "a2": 0.82, "b1": 1.32, "b6": 4.14}


@dataclass(frozen=True)
class Systems:
    """Matrices of a population.

    M, C, K `shape (n_individuals, 8, 8)`, P `(n_individuals, 8, 5)`, sensor rows
    S `(n_individuals, 2, 8)`, and the physical parameters behind them.
    """

    M: Array
    C: Array
    K: Array
    P: Array
    S: Array
    parameters: dict[str, Array]

    def part(self, count: int) -> Systems:
        """Return the first individuals."""
        own = {key: value[:count] for key, value in self.parameters.items()}
        return Systems(self.M[:count], self.C[:count], self.K[:count], self.P[:count], self.S[:count], own)


def tractor5_population(n_individuals: int, seed: int = 0, spread: float = 0.1) -> Systems:
    """Return a population around the table, everything that calibration searches varied by +-spread."""
    rng = np.random.default_rng(seed)
    p = {"mT": np.full(n_individuals, MASS)}
    for name, value in TABLE.items():
        p[name] = value * MASS * rng.uniform(1 - spread, 1 + spread, n_individuals)
    for name, value in GEOMETRY.items():
        p[name] = value * rng.uniform(1 - spread, 1 + spread, n_individuals)
    a1, a2, b1, b6, mS = (p[name] for name in ("a1", "a2", "b1", "b6", "mS"))
    b7, one, none = 3.75 - b1, np.ones(n_individuals), np.zeros(n_individuals)
    M, C, K = (np.zeros((n_individuals, 8, 8)) for _ in range(3))
    mu = p["mT"] * mS / (p["mT"] + mS)
    M[:, 0, 0], M[:, 0, 1], M[:, 0, 2] = p["mT"] + mS, b7 * mS, b6 * mS
    M[:, 1, 1], M[:, 1, 2] = p["IT"] + b7**2 * mS + mu * a1**2, b6 * b7 * mS - mu * a1 * a2
    M[:, 2, 2] = p["IS"] + b6**2 * mS + mu * a2**2
    M[:, 1, 0], M[:, 2, 0], M[:, 2, 1] = M[:, 0, 1], M[:, 0, 2], M[:, 1, 2]
    P = np.zeros((n_individuals, 8, 5))
    rows = [(one, -b1, none), (one, 3.46 - b1, none), (one, 4.80 - b1, none), (one, b7, 8.50 * one), (one, b7, 9.73 * one)]
    for i, row in enumerate(rows):
        travel = np.zeros((n_individuals, 8))
        travel[:, :3], travel[:, 3 + i] = np.column_stack(row), -1
        square = np.einsum("ni,nj->nij", travel, travel)
        M[:, 3 + i, 3 + i] = p[f"m{i + 1}"]
        C += p[f"c{i + 1}"][:, None, None] * square
        K += p[f"k{i + 1}"][:, None, None] * square
        K[:, 3 + i, 3 + i] += p[f"kt{i + 1}"]
        P[:, 3 + i, i] = p[f"kt{i + 1}"]
    S = np.zeros((n_individuals, 2, 8))
    S[:, 0, :3] = np.column_stack([one, -(b1 + 0.29), none])
    S[:, 1, :3] = np.column_stack([one, b7, 9.32 * one])
    return Systems(M, C, K, P, S, p)


def hump_inputs(n_steps: int, dt: float) -> Array:
    """Return the road under five axles that cross a half-sine hump of 0.5 m x 0.03 m at 2 m/s, `shape (n_steps + 1, 5)`."""
    s = 2.0 * dt * np.arange(n_steps + 1)[:, None] - 1.0 - np.array([0.0, 3.46, 4.80, 12.25, 13.48])
    return np.where((s > 0) & (s < 0.5), 0.03 * np.sin(np.pi * s / 0.5), 0.0)
