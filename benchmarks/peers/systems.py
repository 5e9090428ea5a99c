"""What every peer is given: a population of linear systems M q'' + C q' + K q = P w(t), and the five-axle truck as one.

The truck is the unladen tractor-semitrailer of J. Wu and Y. Li, "Parameter calibration of heavy-duty truck dynamics", Sensors 23(24),
9691 (2023), with the values of its Table A2 (row DHCM-1&2), all divided by the tractor's sprung mass. The matrices are typed here from
the equations and do not come from vehgen, so that a peer can also catch vehgen out.
"""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

# Table A2, DHCM-1&2, per unit of the tractor's sprung mass: [-], [m^2], [1/s^2], [1/s], [1/s^2], [m]
MASS_S, INERTIA_T, INERTIA_S = 4.77, 45.75, 95.89
AXLE_MASS = (0.11, 0.40, 0.48, 0.57, 0.34)
STIFFNESS = (198.83, 93.02, 869.88, 537.26, 1313.27)
DAMPING = (12.57, 33.04, 6.80, 36.52, 23.60)
TYRE = (1460.53, 4488.70, 4360.85, 2689.24, 808.00)
HINGE_ABOVE_T, HINGE_ABOVE_S, AXLE1_AHEAD, HINGE_AHEAD_S = 0.97, 0.82, 1.32, 4.14
# measured distances [m]: axle 1 to axle 2, axle 3 and the hinge; the hinge to axle 4 and axle 5
TO_AXLE2, TO_AXLE3, TO_HINGE, TO_AXLE4, TO_AXLE5 = 3.46, 4.80, 3.75, 8.50, 9.73
WHEELS = (0.0, TO_AXLE2, TO_AXLE3, TO_HINGE + TO_AXLE4, TO_HINGE + TO_AXLE5)
# sensors: on the tractor 0.29 m ahead of axle 1, on the semitrailer 5.76 m behind the hinge [m]
SENSOR_T_BEHIND_AXLE1, SENSOR_S_BEHIND_HINGE = -0.29, 5.76


@dataclass(frozen=True)
class Systems:
    """A population: `M`, `C`, `K` `shape (n_individuals, n, n)`, `P` `shape (n_individuals, n, n_inputs)`.

    The acceleration at the sensors is `S @ q''`, `S` `shape (n_individuals, n_sensors, n)`.
    """

    M: Array
    C: Array
    K: Array
    P: Array
    S: Array

    def __len__(self) -> int:
        return len(self.M)

    def first(self, number: int) -> Systems:
        """Return the first individuals only, for a peer too slow for them all."""
        return Systems(*(getattr(self, field.name)[:number] for field in fields(self)))


def n_kept(inputs: Array, keep: int) -> int:
    """Return how many samples are kept: sample 0 and every `keep`-th after it."""
    return (len(inputs) - 1) // keep + 1


def tractor5_population(n_individuals: int, seed: int, spread: float = 0.1) -> Systems:
    """Return five-axle trucks, q = [z_T, theta_T, theta_S, z_1 .. z_5], pitch positive nose-down.

    Parameters
    ----------
    n_individuals
        How many; the first is the truck of Table A2.
    seed
        Of the random generator.
    spread
        Every parameter but the measured distances is multiplied by a factor drawn from 1 - spread to 1 + spread.
    """
    factor = 1.0 + spread * np.random.default_rng(seed).uniform(-1.0, 1.0, (n_individuals, 27))
    factor[:1] = 1.0
    scalars = (factor[:, i] * value for i, value in enumerate((MASS_S, INERTIA_T, INERTIA_S, HINGE_ABOVE_T, HINGE_ABOVE_S)))
    mS, IT, IS, a1, a2 = scalars
    b1, b6 = factor[:, 5] * AXLE1_AHEAD, factor[:, 6] * HINGE_AHEAD_S
    m, k, c, kt = (factor[:, 7 + 5 * i : 12 + 5 * i] * value for i, value in enumerate((AXLE_MASS, STIFFNESS, DAMPING, TYRE)))
    b7 = TO_HINGE - b1
    mu = mS / (1.0 + mS)

    body = np.empty((n_individuals, 3, 3))
    body[:, 0, 0] = 1.0 + mS
    body[:, 0, 1] = body[:, 1, 0] = b7 * mS
    body[:, 0, 2] = body[:, 2, 0] = b6 * mS
    body[:, 1, 1] = IT + b7**2 * mS + mu * a1**2
    body[:, 1, 2] = body[:, 2, 1] = b6 * b7 * mS - mu * a1 * a2
    body[:, 2, 2] = IS + b6**2 * mS + mu * a2**2

    # height of each axle's upper end is g @ [z_T, theta_T, theta_S]
    one, zero = np.ones(n_individuals), np.zeros(n_individuals)
    rows = [(one, -b1, zero), (one, TO_AXLE2 - b1, zero), (one, TO_AXLE3 - b1, zero), (one, b7, zero + TO_AXLE4), (one, b7, zero + TO_AXLE5)]
    g = np.stack([np.stack(row, axis=1) for row in rows], axis=1)
    incidence = np.concatenate([-g, np.broadcast_to(np.eye(5), (n_individuals, 5, 5))], axis=2)

    M, P, S = np.zeros((n_individuals, 8, 8)), np.zeros((n_individuals, 8, 5)), np.zeros((n_individuals, 2, 8))
    M[:, :3, :3] = body
    axle = np.arange(5)
    M[:, 3 + axle, 3 + axle] = m
    K = np.einsum("nai,na,naj->nij", incidence, k, incidence)
    C = np.einsum("nai,na,naj->nij", incidence, c, incidence)
    K[:, 3 + axle, 3 + axle] += kt
    P[:, 3 + axle, axle] = kt
    S[:, 0, :2] = np.stack([one, -(b1 - SENSOR_T_BEHIND_AXLE1)], axis=1)
    S[:, 1, :3] = np.stack([one, b7, zero + SENSOR_S_BEHIND_HINGE], axis=1)
    return Systems(M, C, K, P, S)


def half_sine_inputs(n_steps: int, dt: float, speed: float = 2.0, at: float = 1.0, length: float = 0.4, height: float = 0.03) -> Array:
    """Return the road under the five wheels over a half-sine hump, `shape (n_steps + 1, 5)` [m]: one track, each wheel later than the last.

    Parameters
    ----------
    n_steps, dt
        Number of steps and their size [s].
    speed, at, length, height
        Speed [m/s]; where the hump begins ahead of wheel 1, its length and its height [m].
    """
    x = speed * dt * np.arange(n_steps + 1)[:, None] - at - np.array(WHEELS)
    return np.where((x > 0.0) & (x < length), height * np.sin(np.pi * x / length), 0.0)
