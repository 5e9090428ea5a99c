"""The vehicles that are to be found again: printed matrices and exact integration, in numpy and scipy alone.

Nothing here is shared with vehgen: the matrices are those of Wu & Li 2023 (doi:10.3390/s23249691, Eqs. 10 to 13 and Table A1's model) with
the signs put back, written for q = [z_T, th_T, th_S, z1..z5] and q = [z, th, zf, zr], z up and pitch nose-down positive.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy.linalg
import scipy.optimize

Array = np.ndarray
Matrices = tuple[Array, Array, Array, Array]
DT = 0.01
"""Spacing of a phone's samples [s]."""
FINE = 40
"""Exact steps of a sample (0.25 ms): a hump's edges fall off a coarse grid."""

DHCM_TRUCK = {
    "mS": 4.77, "IT": 45.75, "IS": 95.89,
    "m1": 0.11, "m2": 0.40, "m3": 0.48, "m4": 0.57, "m5": 0.34,
    "k1": 198.83, "k2": 93.02, "k3": 869.88, "k4": 537.26, "k5": 1313.27,
    "c1": 12.57, "c2": 33.04, "c3": 6.80, "c4": 36.52, "c5": 23.60,
    "kt1": 1460.53, "kt2": 4488.70, "kt3": 4360.85, "kt4": 2689.24, "kt5": 808.00,
}  # fmt: skip
"""Table A2's DHCM row without its distances, over the tractor's mass."""
DHCM_DISTANCES = {"a1": 0.97, "a2": 0.82, "b1": 1.32, "b6": 4.14}
DHCM_SEDAN = {
    "mf": 0.06, "mr": 0.10, "IZ": 1.76, "kf": 41.67, "kr": 47.77, "cf": 2.18, "cr": 2.97, "ktf": 448.76, "ktr": 408.65,
}  # fmt: skip
"""Table A1's DHCM row without Lf, over the body's mass."""
TRACTOR_MASS, BODY_MASS = 8000.0, 1500.0
"""Assumed [kg]: the tables divide by them."""
WHEELBASE = 2.8


@dataclass(frozen=True)
class System:
    """M, C, K, P of one vehicle; `offsets` [m] of its axles behind the first; `rows` gives a sensor's weights of q in (heave, pitch)."""

    matrices: Matrices
    offsets: Array
    rows: Callable[[str, float], Array]
    bodies: int
    """How many of the degrees of freedom belong to bodies; one per axle follows."""

    def frequencies(self) -> dict[str, float]:
        """Return undamped frequencies [Hz]: body1, body2, ... in ascending order, and hop1, hop2, ... each by its axle's energy."""
        M, _, K, _ = self.matrices
        squared, shapes = scipy.linalg.eigh(K, M)
        hertz = np.sqrt(squared) / (2 * np.pi)
        energy = shapes**2 * np.diag(M)[:, None]
        axles = energy[self.bodies :]
        modes = scipy.optimize.linear_sum_assignment(-axles)[1]
        rest = sorted(hertz[[i for i in range(len(hertz)) if i not in modes]])
        return {f"body{i + 1}": float(f) for i, f in enumerate(rest)} | {f"hop{i + 1}": float(hertz[j]) for i, j in enumerate(modes)}


def truck(p: dict[str, float]) -> System:
    """Return the five-axle tractor-semitrailer (8 degrees of freedom) of parameters in SI units."""
    mT, mS, IT, IS, a1, a2, b1, b6 = (p[name] for name in ("mT", "mS", "IT", "IS", "a1", "a2", "b1", "b6"))
    b2, b3, b7, b4, b5 = 3.46 - b1, 4.80 - b1, 3.75 - b1, 8.50 - b6, 9.73 - b6
    B4, B5 = b4 + b6, b5 + b6
    mu = mT * mS / (mT + mS)
    M = np.zeros((8, 8))
    M[0, :3] = mT + mS, b7 * mS, b6 * mS
    M[1, 1:3] = IT + b7**2 * mS + mu * a1**2, b6 * b7 * mS - mu * a1 * a2
    M[2, 2] = IS + b6**2 * mS + mu * a2**2
    M[np.arange(3, 8), np.arange(3, 8)] = [p[f"m{i}"] for i in range(1, 6)]
    M = np.triu(M) + np.triu(M, 1).T

    def coupled(v: list[float]) -> Array:
        v1, v2, v3, v4, v5 = v
        X = np.zeros((8, 8))
        X[0, :3] = sum(v), -b1 * v1 + b2 * v2 + b3 * v3 + b7 * (v4 + v5), B4 * v4 + B5 * v5
        X[1, 1:3] = b1**2 * v1 + b2**2 * v2 + b3**2 * v3 + b7**2 * (v4 + v5), b7 * (B4 * v4 + B5 * v5)
        X[2, 2] = B4**2 * v4 + B5**2 * v5
        X[0, 3:] = [-item for item in v]
        X[1, 3:] = b1 * v1, -b2 * v2, -b3 * v3, -b7 * v4, -b7 * v5
        X[2, 6:] = -B4 * v4, -B5 * v5
        X[np.arange(3, 8), np.arange(3, 8)] = v
        return np.triu(X) + np.triu(X, 1).T

    K, C = coupled([p[f"k{i}"] for i in range(1, 6)]), coupled([p[f"c{i}"] for i in range(1, 6)])
    P = np.zeros((8, 5))
    for i in range(5):
        P[3 + i, i] = p[f"kt{i + 1}"]
        K[3 + i, 3 + i] += p[f"kt{i + 1}"]

    def rows(body: str, d: float) -> Array:
        found = np.zeros((2, 8))
        if body == "tractor":  # d behind axle 1
            found[0, :2], found[1, 1] = (1.0, -(b1 - d)), 1.0
        else:  # d behind the hinge
            found[0, :3], found[1, 2] = (1.0, b7, d), 1.0
        return found

    return System((M, C, K, P), np.array([0.0, 3.46, 4.80, 3.75 + 8.50, 3.75 + 9.73]), rows, 3)


def sedan(p: dict[str, float]) -> System:
    """Return the two-axle sedan (4 degrees of freedom) of parameters in SI units."""
    Lf, Lr = p["Lf"], WHEELBASE - p["Lf"]
    M = np.diag([p["mH"], p["IZ"], p["mf"], p["mr"]])

    def coupled(f: float, r: float) -> Array:
        return np.array(
            [
                [f + r, -Lf * f + Lr * r, -f, -r],
                [-Lf * f + Lr * r, Lf**2 * f + Lr**2 * r, Lf * f, -Lr * r],
                [-f, Lf * f, f, 0.0],
                [-r, -Lr * r, 0.0, r],
            ]
        )

    K, C = coupled(p["kf"], p["kr"]), coupled(p["cf"], p["cr"])
    K[2, 2] += p["ktf"]
    K[3, 3] += p["ktr"]
    P = np.zeros((4, 2))
    P[2, 0], P[3, 1] = p["ktf"], p["ktr"]

    def rows(body: str, d: float) -> Array:
        return np.array([[1.0, -(Lf - d), 0.0, 0.0], [0.0, 1.0, 0.0, 0.0]])  # d behind the front axle

    return System((M, C, K, P), np.array([0.0, WHEELBASE]), rows, 2)


def drawn(kind: str, seed: int, spread: float = 0.1) -> dict[str, float]:
    """Return a true vehicle [SI]: the DHCM row of `truck` or `sedan`, every parameter but the scale times exp(spread N(0, 1))."""
    table, distances, mass = (DHCM_TRUCK, DHCM_DISTANCES, TRACTOR_MASS) if kind == "truck" else (DHCM_SEDAN, {"Lf": 1.18}, BODY_MASS)
    random = np.random.default_rng(seed)
    values = {name: value * mass for name, value in table.items()} | distances
    return {"mT" if kind == "truck" else "mH": mass} | {
        name: value * float(np.exp(spread * random.standard_normal())) for name, value in values.items()
    }


def respond(system: System, road: Callable[[Array], Array], speed: float, times: Array, sensors: dict[str, tuple[str, float]]) -> Array:
    """Return accelerations and pitch rates of sensors, `shape (n_samples, 2 n_sensors)`, by the exact first-order hold.

    Parameters
    ----------
    system
        The vehicle, at rest before `times[0]`.
    road
        Height [m] at positions [m]; the first wheel is at `speed * t`.
    speed
        [m/s].
    times
        Samples DT apart [s].
    sensors
        Body and distance [m] of each.
    """
    M, C, K, P = system.matrices
    n, n_axles, h = len(M), P.shape[1], DT / FINE
    t = times[0] + np.arange((len(times) - 1) * FINE + 1) * h
    w = np.column_stack([road(speed * t - offset) for offset in system.offsets])
    inverse = np.linalg.inv(M)
    A = np.block([[np.zeros((n, n)), np.eye(n)], [-inverse @ K, -inverse @ C]])
    B = np.vstack([np.zeros((n, n_axles)), inverse @ P])
    size = 2 * n + 2 * n_axles
    big = np.zeros((size, size))
    big[: 2 * n, : 2 * n], big[: 2 * n, 2 * n : 2 * n + n_axles] = A * h, B * h
    big[2 * n : 2 * n + n_axles, 2 * n + n_axles :] = np.eye(n_axles)
    E = scipy.linalg.expm(big)[: 2 * n]
    Ad, G1, G2 = E[:, : 2 * n], E[:, 2 * n : 2 * n + n_axles], E[:, 2 * n + n_axles :]
    push = w[:-1] @ (G1 - G2).T + w[1:] @ G2.T
    state = np.zeros(2 * n)
    kept = np.zeros((len(times), 2 * n))
    for i in range(len(push)):
        state = Ad @ state + push[i]
        if (i + 1) % FINE == 0:
            kept[(i + 1) // FINE] = state
    accelerations = kept @ A[n:].T + w[::FINE] @ B[n:].T
    channels = []
    for body, d in sensors.values():
        row = system.rows(body, d)
        channels += [accelerations @ row[0], kept[:, n:] @ row[1]]
    return np.column_stack(channels)
