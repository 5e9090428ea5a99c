"""The force laws, compiled. d [m] and v [m/s] are travel and rate in compression from static equilibrium; p are the law's parameters, s
its states.

| kind | force [N] | states |
|---|---|---|
| CUBIC | p0 d^3 | |
| PROGRESSIVE | p0 max(d - p1, 0) | |
| STOPS | p0 (max(d - p1, 0) - max(-d - p2, 0)) | |
| ABSOLUTE_DAMPING | p0 abs(v) | |
| QUADRATIC_DAMPING | p0 v abs(v) | |
| BOUC_WEN | p0 z | p1 z' = v - p2 abs(v) abs(z) z - (1 - p2) v z^2 |
| MAXWELL | p0 (d - y) | p1 y' = d - y (y: travel of the dashpot) |
| LIFTOFF | p1 max(-(p0 + all other forces of the element), 0) | |
| FREE_PLAY | -p0 v while the play is open | e: where in the play, held within p1/2; follows d while open |
| POSITION_DAMPING | p0 (d/p1)^2 v | |
| AIR_SPRING | p0 (P1 - p1) | P1, P2: pressures; mu: share of chamber 1's gas moved to 2 |

AIR_SPRING: area p0, static pressure p1, volumes p2 and p3, flow time p4, heat time p5, kappa = 1.4:
    mu' = sign(P1 - P2) sqrt(abs(P1 - P2)/p1)/p4
    P1' = kappa (P1 p0 v - p1 p2 mu')/V1 - (P1 - p1 (1 - mu) p2/V1)/p5,  V1 = p2 - p0 d
    P2' = kappa p1 p2 mu'/p3 - (P2 - p1 (1 + mu p2/p3))/p5
(energy balance of ideal gas in two rigid-walled chambers; the exchanged gas is at ambient temperature.) The square root is linear below
1e-4 of p1.
"""

from __future__ import annotations

import numpy as np
from numba import njit

CUBIC, PROGRESSIVE, STOPS, ABSOLUTE_DAMPING, QUADRATIC_DAMPING, BOUC_WEN, MAXWELL, LIFTOFF, FREE_PLAY, POSITION_DAMPING, AIR_SPRING = range(
    11
)
N_PARAMETERS = 6
KAPPA = 1.4


@njit(cache=True, error_model="numpy")
def law_force(kind, p, d, v, s, ds, at, rest):
    """Return the force [N] of a law whose states start at s[at], and write their rates to ds. `rest`: all other forces of its element
    [N]."""
    if kind == CUBIC:
        return p[0] * d * d * d
    if kind == PROGRESSIVE:
        return p[0] * max(d - p[1], 0.0)
    if kind == STOPS:
        return p[0] * (max(d - p[1], 0.0) - max(-d - p[2], 0.0))
    if kind == ABSOLUTE_DAMPING:
        return p[0] * abs(v)
    if kind == QUADRATIC_DAMPING:
        return p[0] * v * abs(v)
    if kind == BOUC_WEN:
        z = s[at]
        ds[at] = (v - p[2] * abs(v) * abs(z) * z - (1.0 - p[2]) * v * z * z) / p[1]
        return p[0] * z
    if kind == MAXWELL:
        ds[at] = (d - s[at]) / p[1]
        return p[0] * (d - s[at])
    if kind == LIFTOFF:
        return p[1] * max(-(p[0] + rest), 0.0)
    if kind == FREE_PLAY:
        ds[at] = 0.0
        half = 0.5 * p[1]
        engaged = (s[at] >= half and v > 0.0) or (s[at] <= -half and v < 0.0)
        return 0.0 if engaged else -p[0] * v
    if kind == POSITION_DAMPING:
        r = d / p[1]
        return p[0] * r * r * v
    area, p0, volume1, volume2 = p[0], p[1], p[2], p[3]
    P1, P2, mu = s[at], s[at + 1], s[at + 2]
    V1 = volume1 - area * d
    jump = (P1 - P2) / p0
    flow = (jump / 1e-2 if abs(jump) < 1e-4 else np.sign(jump) * np.sqrt(abs(jump))) / p[4]
    ds[at] = KAPPA * (P1 * area * v - p0 * volume1 * flow) / V1 - (P1 - p0 * (1.0 - mu) * volume1 / V1) / p[5]
    ds[at + 1] = KAPPA * p0 * volume1 * flow / volume2 - (P2 - p0 * (1.0 + mu * volume1 / volume2)) / p[5]
    ds[at + 2] = flow
    return area * (P1 - p0)
