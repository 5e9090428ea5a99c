"""Recordings of runs from a source that shares no code with the kernels: Newton-Euler matrices, exact integration."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import scipy.linalg

DT = 0.01
FINE = 40
"""Exact steps of a sample: hump edges fall off a coarse grid."""


def two_axle(p: dict[str, float]) -> tuple[np.ndarray, ...]:
    """Return M, C, K, P of a sedan by force balance, nose-down pitch positive: a point x ahead moves by -x theta."""
    front, rear = p["Lf"], -(2.8 - p["Lf"])
    M = np.diag([p["mH"], p["IZ"], p["mf"], p["mr"]])
    C, K = np.zeros((4, 4)), np.zeros((4, 4))
    for x, k, c, slot in ((front, p["kf"], p["cf"], 2), (rear, p["kr"], p["cr"], 3)):
        row = np.array([1.0, -x, 0.0, 0.0])
        row[slot] = -1.0
        K += k * np.outer(row, row)
        C += c * np.outer(row, row)
    P = np.zeros((4, 2))
    P[2, 0], P[3, 1] = p["ktf"], p["ktr"]
    K[2, 2] += p["ktf"]
    K[3, 3] += p["ktr"]
    return M, C, K, P


def respond(p: dict[str, float], road, speed: float, duration: float, places: dict[str, float]) -> tuple[np.ndarray, np.ndarray]:
    """Return times and channels (acceleration, pitch rate of each place, x ahead of the COG) of a sedan by the exact first-order hold."""
    M, C, K, P = two_axle(p)
    h = DT / FINE
    t = np.arange(round(duration / DT) * FINE + 1) * h
    w = np.column_stack([road(speed * t), road(speed * t - 2.8)])
    inverse = np.linalg.inv(M)
    A = np.block([[np.zeros((4, 4)), np.eye(4)], [-inverse @ K, -inverse @ C]])
    B = np.vstack([np.zeros((4, 2)), inverse @ P])
    big = np.zeros((12, 12))
    big[:8, :8], big[:8, 8:10], big[8:10, 10:] = A * h, B * h, np.eye(2)
    E = scipy.linalg.expm(big)
    Ad, G1, G2 = E[:8, :8], E[:8, 8:10], E[:8, 10:]
    push = w[:-1] @ (G1 - G2).T + w[1:] @ G2.T
    x = np.zeros((len(t), 8))
    for i in range(len(t) - 1):
        x[i + 1] = Ad @ x[i] + push[i]
    a = x @ A[4:].T + w @ B[4:].T
    channels = []
    for place in places.values():
        channels += [a[:, 0] - place * a[:, 1], x[:, 5]]
    return t[::FINE], np.column_stack(channels)[::FINE]


def half_sine(at: float, length: float, height: float):
    return lambda s: np.where((s > at) & (s < at + length), height * np.sin(np.pi * np.clip((s - at) / length, 0, 1)), 0.0)


def write_run(
    folder: Path, name: str, p: dict[str, float], speed: float = 2.5, noise: float = 0.01, seed: int = 0, rough: float = 0.0
) -> Path:
    """Write a run file with the recording of a sedan over a hump, noise as a share of each channel's rms; returns the run file's path."""
    random = np.random.default_rng(seed)
    hump = half_sine(4.0, 0.5, 0.03)
    knots = np.arange(-20.0, 40.0, 0.05)
    heights = np.cumsum(random.standard_normal(len(knots))) * rough
    heights -= heights[knots <= 0][-1]

    def road(s: np.ndarray) -> np.ndarray:
        return hump(s) + np.interp(s, knots, heights)

    duration = (4.0 + 2.8) / speed + 4.0
    t, values = respond(p, road, speed, duration, {"F": p["Lf"], "R": -(2.8 - p["Lf"])})
    values = values + noise * values.std(axis=0) * random.standard_normal(values.shape)
    rows = np.column_stack([t, values])
    np.savetxt(folder / f"{name}.csv", rows, fmt="%.9g", delimiter=",", header="t,F_az,F_q,R_az,R_q", comments="")
    path = folder / f"{name}.yaml"
    path.write_text(
        f"""vehicle: sedan2.yaml
speed: {speed} m/s
road:
  - hump: {{shape: half_sine, length: 0.5 m, height: 0.03 m, at: 4 m}}
sensors:
  F: {{body: body, behind: front, channels: {{acceleration: F_az, pitch_rate: F_q}}}}
  R: {{body: body, behind: rear, channels: {{acceleration: R_az, pitch_rate: R_q}}}}
recording: {name}.csv
""",
        encoding="utf-8",
    )
    return path


def sedan_truth(seed: int = 1, spread: float = 0.1) -> dict[str, float]:
    """Return parameters of a sedan that differ from the bundled model's."""
    nominal = {
        "mH": 1500.0, "Lf": 1.18, "mf": 90.0, "mr": 150.0, "IZ": 2640.0, "kf": 62505.0,
        "kr": 71655.0, "cf": 3270.0, "cr": 4455.0, "ktf": 673140.0, "ktr": 612975.0,
    }  # fmt: skip
    random = np.random.default_rng(seed)
    return {name: value if name == "mH" else value * float(np.exp(random.normal(0, spread))) for name, value in nominal.items()}
