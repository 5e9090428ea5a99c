"""A half-car on a random road, integrated by scipy alone: what two places and the pitch rate do, and the true ratios between them."""

from __future__ import annotations

import numpy as np
import scipy.linalg
import scipy.signal

WHEELBASE = 2.8
SEDAN = {
    "mH": 1500.0, "IZ": 2640.0, "Lf": 1.18, "mf": 90.0, "mr": 150.0, "kf": 62505.0, "kr": 71655.0, "cf": 3270.0, "cr": 4455.0,
    "ktf": 673140.0, "ktr": 612975.0,
}  # fmt: skip
PLACES = {"F": 1.1, "R": -1.5}
"""Phones ahead of the COG [m]."""
FINE = 10
"""Steps of a sample."""


def state_space(p):
    """Return A, B, C, D of a half-car: from both wheels' heights to the accelerations of both places and the pitch rate (nose-down)."""
    front, rear = p["Lf"], p["Lf"] - WHEELBASE
    M = np.diag([p["mH"], p["IZ"], p["mf"], p["mr"]])
    damping, K = np.zeros((4, 4)), np.zeros((4, 4))
    for slot, (x, axle) in enumerate(((front, "f"), (rear, "r")), start=2):
        row = np.zeros(4)
        row[[0, 1, slot]] = 1.0, -x, -1.0
        K += p["k" + axle] * np.outer(row, row)
        damping += p["c" + axle] * np.outer(row, row)
        K[slot, slot] += p["kt" + axle]
    push = np.zeros((4, 2))
    push[2, 0], push[3, 1] = p["ktf"], p["ktr"]
    A = np.block([[np.zeros((4, 4)), np.eye(4)], [-np.linalg.solve(M, K), -np.linalg.solve(M, damping)]])
    B = np.vstack([np.zeros((4, 2)), np.linalg.solve(M, push)])
    rows = np.array([[1.0, -x, 0.0, 0.0] for x in PLACES.values()])
    C = np.vstack([rows @ A[4:], np.eye(8)[5]])
    D = np.vstack([rows @ B[4:], np.zeros(2)])
    return A, B, C, D


def true_response(p, frequency, speed):
    """Return all channels per metre of road, `shape (n, 3)`."""
    A, B, C, D = state_space(p)
    delayed = np.exp(-2j * np.pi * frequency[:, None] * np.array([0.0, WHEELBASE / speed]))
    inner = np.linalg.solve(2j * np.pi * frequency[:, None, None] * np.eye(8) - A, np.repeat(B[None].astype(complex), len(frequency), 0))
    return ((C @ inner + D) @ delayed[:, :, None])[:, :, 0]


def drive(p, duration, speed, seed, rate=100.0, roughness=256e-6):
    """Return times [s] and channels `shape (n, 3)` on a road of Gd(n) = roughness (n/0.1)^-2, by the exact first-order hold.

    `speed` [m/s] is a number, or a function of times.
    """
    random = np.random.default_rng(seed)
    h = 1 / (rate * FINE)
    t = np.arange(round((duration + 4.0) / h)) * h
    v = np.full(len(t), speed) if np.isscalar(speed) else speed(t - 4.0)
    way = np.concatenate([[0.0], np.cumsum((v[1:] + v[:-1]) * h / 2)]) + 10.0
    spacing = 0.02
    count = int(way[-1] / spacing) + 100
    n = np.fft.rfftfreq(count, spacing)
    amplitude = np.zeros(len(n))
    inside = (n > 0.005) & (n < 10.0)
    amplitude[inside] = np.sqrt(2 * roughness * (n[inside] / 0.1) ** -2 / (count * spacing))
    lines = random.normal(size=(len(n), 2)) @ np.array([1.0, 1j]) / np.sqrt(2)
    heights = np.fft.irfft(0.5 * count * amplitude * lines, count)
    s = spacing * np.arange(count)
    w = np.column_stack([np.interp(way - offset, s, heights) for offset in (0.0, WHEELBASE)])
    A, B, C, D = state_space(p)
    big = np.zeros((12, 12))
    big[:8, :8], big[:8, 8:10], big[8:10, 10:] = A * h, B * h, np.eye(2)
    E = scipy.linalg.expm(big)
    Ad, G1, G2 = E[:8, :8], E[:8, 8:10], E[:8, 10:]
    values, vectors = np.linalg.eig(Ad)
    push = (w[:-1] @ (G1 - G2).T + w[1:] @ G2.T) @ np.linalg.inv(vectors).T
    modal = np.column_stack([scipy.signal.lfilter([1.0], [1.0, -value], column) for value, column in zip(values, push.T, strict=True)])
    x = np.vstack([np.zeros(8), (modal @ vectors.T).real])
    found = (x @ C.T + w @ D.T)[round(4.0 / h) :]
    low_pass = scipy.signal.firwin(16 * FINE + 1, 0.5 * rate, fs=rate * FINE)
    kept = scipy.signal.oaconvolve(found, low_pass[:, None], mode="same", axes=0)[::FINE]
    return np.arange(len(kept)) / rate, kept
