"""M, C, K and P of the two vehicles as Wu & Li 2023 print them (doi:10.3390/s23249691; signs restored, nose-down),
and their exact solution."""

from __future__ import annotations

import numpy as np
from scipy.linalg import expm


def sedan(p):
    """Return M, C, K, P over [z, theta, z_front, z_rear]."""
    Lf, Lr = p["Lf"], p["wheelbase"] - p["Lf"]

    def coupling(f, r):
        return np.array(
            [
                [f + r, -Lf * f + Lr * r, -f, -r],
                [-Lf * f + Lr * r, Lf**2 * f + Lr**2 * r, Lf * f, -Lr * r],
                [-f, Lf * f, f, 0],
                [-r, -Lr * r, 0, r],
            ]
        )

    M = np.diag([p["mH"], p["IZ"], p["mf"], p["mr"]])
    P = np.array([[0, 0], [0, 0], [p["ktf"], 0], [0, p["ktr"]]])
    return M, coupling(p["cf"], p["cr"]), coupling(p["kf"], p["kr"]) + np.diag([0, 0, p["ktf"], p["ktr"]]), P


def tractor(p):
    """Return M, C, K, P over [z_T, theta_T, theta_S, z_1..z_5]."""
    b1, b6 = p["b1"], p["b6"]
    b2, b3, b7, B4, B5 = p["L12"] - b1, p["L13"] - b1, p["L1h"] - b1, p["Lh4"], p["Lh5"]
    mT, mS, a1, a2 = p["mT"], p["mS"], p["a1"], p["a2"]
    mu = mT * mS / (mT + mS)
    M = np.diag([mT + mS, p["IT"] + b7**2 * mS + mu * a1**2, p["IS"] + b6**2 * mS + mu * a2**2, *(p[f"m{i}"] for i in range(1, 6))])
    M[0, 1] = M[1, 0] = b7 * mS
    M[0, 2] = M[2, 0] = b6 * mS
    M[1, 2] = M[2, 1] = b6 * b7 * mS - mu * a1 * a2

    def coupling(k):
        out = np.zeros((8, 8))
        out[0, 0] = sum(k)
        out[0, 1] = -b1 * k[0] + b2 * k[1] + b3 * k[2] + b7 * (k[3] + k[4])
        out[0, 2] = B4 * k[3] + B5 * k[4]
        out[1, 1] = b1**2 * k[0] + b2**2 * k[1] + b3**2 * k[2] + b7**2 * (k[3] + k[4])
        out[1, 2] = b7 * (B4 * k[3] + B5 * k[4])
        out[2, 2] = B4**2 * k[3] + B5**2 * k[4]
        out[0, 3:] = [-x for x in k]
        out[1, 3:] = [b1 * k[0], -b2 * k[1], -b3 * k[2], -b7 * k[3], -b7 * k[4]]
        out[2, 6:] = [-B4 * k[3], -B5 * k[4]]
        return np.triu(out) + np.triu(out, 1).T + np.diag([0, 0, 0, *k])

    tyres = [p[f"kt{i}"] for i in range(1, 6)]
    P = np.vstack([np.zeros((3, 5)), np.diag(tyres)])
    return M, coupling([p[f"c{i}"] for i in range(1, 6)]), coupling([p[f"k{i}"] for i in range(1, 6)]) + np.diag([0, 0, 0, *tyres]), P


def first_order_hold(M, C, K, P, w, dt):
    """Return displacements, velocities and accelerations, `shape (n_steps, n)`, for road heights w linear between samples dt apart."""
    n, m = P.shape
    inverse = np.linalg.inv(M)
    A = np.block([[np.zeros((n, n)), np.eye(n)], [-inverse @ K, -inverse @ C]])
    B = np.vstack([np.zeros((n, m)), inverse @ P])
    block = np.zeros((2 * n + 2 * m, 2 * n + 2 * m))
    block[: 2 * n, : 2 * n], block[: 2 * n, 2 * n : 2 * n + m] = A * dt, B * dt
    block[2 * n : 2 * n + m, 2 * n + m :] = np.eye(m)
    exact = expm(block)
    Ad, G1, G2 = exact[: 2 * n, : 2 * n], exact[: 2 * n, 2 * n : 2 * n + m], exact[: 2 * n, 2 * n + m :]
    drive = w[:-1] @ (G1 - G2).T + w[1:] @ G2.T
    x = np.zeros((len(w), 2 * n))
    for i in range(len(w) - 1):
        x[i + 1] = Ad @ x[i] + drive[i]
    rates = x @ A.T + w @ B.T
    return x[:, :n], x[:, n:], rates[:, n:]
